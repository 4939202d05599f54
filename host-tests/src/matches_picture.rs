//! Matches over the two images, side by side: a dot at both points, and for a sample of them a line and
//! squares.

use crate::colour::viridis;
use image::{Rgb, RgbImage};

/// Grey columns between the images, px.
const GAP: u32 = 4;
/// Half the side of a square at a point, px.
const SQUARE: i64 = 2;

/// Cells of the left image, across and down: the first match of each has a line, for hundreds of lines hide
/// the images and each other.
const CELLS: [usize; 2] = [10, 6];

/// The picture: the images half as bright, and each match (column and row in the left image, column and row
/// in the right one, px) in a colour that goes by its column on the left.
pub fn matches_picture(
    left: &RgbImage,
    right: &RgbImage,
    matches: impl Iterator<Item = [f32; 4]>,
) -> RgbImage {
    let (mut picture, beside) = side_by_side(left, right);
    let mut taken = [false; CELLS[0] * CELLS[1]];
    for [x1, y1, x2, y2] in matches {
        let colour = viridis(0.2 + 0.8 * x1 / left.width() as f32);
        let (from, to) = ([x1, y1], [x2 + beside as f32, y2]);
        for [x, y] in [from, to] {
            if let Some(pixel) = picture.get_pixel_mut_checked(x.round() as u32, y.round() as u32) {
                *pixel = colour;
            }
        }
        if taken.get_mut(cell(left, from)).is_some_and(|taken| !std::mem::replace(taken, true)) {
            line(&mut picture, from, to, colour);
            for end in [from, to] {
                square(&mut picture, end, colour);
            }
        }
    }
    picture
}

/// The cell of the left image that a point is in.
fn cell(left: &RgbImage, [x, y]: [f32; 2]) -> usize {
    let place =
        |at: f32, side: u32, cells: usize| ((at / side as f32 * cells as f32) as usize).min(cells - 1);
    place(y, left.height(), CELLS[1]) * CELLS[0] + place(x, left.width(), CELLS[0])
}

/// The two images half as bright, and the column at which the right one begins.
pub(crate) fn side_by_side(left: &RgbImage, right: &RgbImage) -> (RgbImage, u32) {
    let beside = left.width() + GAP;
    let mut picture = RgbImage::new(beside + right.width(), left.height().max(right.height()));
    for (image, begin) in [(left, 0), (right, beside)] {
        for (x, y, Rgb(colour)) in image.enumerate_pixels() {
            picture.put_pixel(begin + x, y, Rgb(colour.map(|c| c / 2)));
        }
    }
    (picture, beside)
}

/// A thin line between two points, as bright as what lies below it and half of the colour, so that many can
/// cross.
pub(crate) fn line(picture: &mut RgbImage, [x1, y1]: [f32; 2], [x2, y2]: [f32; 2], Rgb(colour): Rgb<u8>) {
    let steps = (x2 - x1).abs().max((y2 - y1).abs()).ceil().max(1.0);
    for step in 0..=steps as u32 {
        let share = step as f32 / steps;
        let (x, y) = (x1 + share * (x2 - x1), y1 + share * (y2 - y1));
        if let Some(Rgb(below)) = picture.get_pixel_mut_checked(x.round() as u32, y.round() as u32) {
            for (below, over) in below.iter_mut().zip(colour) {
                *below = (*below / 2).saturating_add(over / 2);
            }
        }
    }
}

/// The outline of a square around a point, where the picture has it.
pub(crate) fn square(picture: &mut RgbImage, [x, y]: [f32; 2], colour: Rgb<u8>) {
    let (x, y) = (x.round() as i64, y.round() as i64);
    for (dx, dy) in (-SQUARE..=SQUARE).flat_map(|dy| (-SQUARE..=SQUARE).map(move |dx| (dx, dy))) {
        let place = (u32::try_from(x + dx), u32::try_from(y + dy));
        if dx.abs().max(dy.abs()) == SQUARE
            && let (Ok(x), Ok(y)) = place
            && let Some(pixel) = picture.get_pixel_mut_checked(x, y)
        {
            *pixel = colour;
        }
    }
}
