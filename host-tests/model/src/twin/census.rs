//! Census by its definition: for every pixel, a bit for every neighbour that is darker than it.

use super::smooth::Seen;

/// Up, left, right, down at a distance of 2: (dy, dx), the least significant bit first.
pub const PLUS4: [(isize, isize); 4] = [(-2, 0), (0, -2), (0, 2), (2, 0)];

/// The ring of eight at a distance of 2.
pub const RING8: [(isize, isize); 8] = [(-2, -2), (-2, 0), (-2, 2), (0, -2), (0, 2), (2, -2), (2, 0), (2, 2)];

/// Eight, wide along the row.
pub const WIDE8: [(isize, isize); 8] = [(-2, -4), (-2, 0), (-2, 4), (0, -2), (0, 2), (2, -4), (2, 0), (2, 4)];

/// The census of the pixel (x, y): bit i is set when the i-th neighbour is darker. Neighbours outside of the
/// picture are the nearest pixel inside.
pub fn census_at(picture: &Seen<'_>, neighbours: &[(isize, isize)], x: usize, y: usize) -> u32 {
    let centre = picture.at(x as isize, y as isize, 0);
    let mut word = 0;
    for (bit, &(dy, dx)) in neighbours.iter().enumerate() {
        if picture.at(x as isize + dx, y as isize, dy) < centre {
            word |= 1 << bit;
        }
    }
    word
}

/// The census of every pixel, row by row.
pub fn census(seen: &Seen<'_>, neighbours: &[(isize, isize)]) -> Vec<u32> {
    let (width, height) = (seen.picture.width, seen.picture.height);
    let mut words = Vec::with_capacity(width * height);
    for y in 0..height {
        for x in 0..width {
            words.push(census_at(seen, neighbours, x, y));
        }
    }
    words
}
