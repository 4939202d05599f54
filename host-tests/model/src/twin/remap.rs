//! The remap again: the whole raw image at hand, each pixel's place worked out by itself in 64 bits.

use image::GrayImage;
use stereopsis::imaging::RemapTable;

/// A rectified image, and which of its pixels are valid (1 or 0), from the places of a table's lattice.
pub fn remap<const SLOTS: usize>(table: &RemapTable<SLOTS>, raw: &GrayImage) -> (GrayImage, Vec<u8>) {
    let (width, height) = (u32::from(table.size().width), u32::from(table.size().height));
    let mut out = GrayImage::new(width, height);
    let mut valid = vec![0; (width * height) as usize];
    for (pixel, valid) in out.enumerate_pixels_mut().zip(&mut valid) {
        let (u, v, pixel) = pixel;
        if let Some(value) = place(table, u, v).and_then(|place| bilinear(raw, place)) {
            (pixel.0, *valid) = ([value], 1);
        }
    }
    (out, valid)
}

/// Where a rectified pixel is in the raw image, in 65536ths of a pixel, half a 256th added; `None` where the
/// lens is not described.
pub fn place<const SLOTS: usize>(table: &RemapTable<SLOTS>, u: u32, v: u32) -> Option<[i64; 2]> {
    let cell = 1_i64 << table.shift();
    let rows = usize::from(table.size().height).div_ceil(cell as usize) + 3;
    let node = |i: usize, j: usize| table.places()[i * rows + j].map(i64::from);
    let (i, j) = (u as usize / cell as usize, v as usize / cell as usize);
    let corners = [(1, 1), (2, 1), (1, 2), (2, 2)];
    if corners.iter().any(|(x, y)| node(i + x, j + y)[0] & 1 == 1) {
        return None;
    }
    Some([0, 1].map(|axis| {
        // Down the lattice's columns by Lagrange's cubic, in 2^-20.
        let k = i64::from(v) % cell;
        let one = (1 << 20) / (cell * cell * cell);
        let first = -(k * (cell - k) * (2 * cell - k) * one) / 6;
        let second = (cell + k) * (cell - k) * (2 * cell - k) * one / 2;
        let third = (cell + k) * k * (2 * cell - k) * one / 2;
        let weights = [first, second, third, (1 << 20) - first - second - third];
        let [a, b, c, d] = [0, 1, 2, 3].map(|x| {
            let sum: i64 = (0..4).map(|y| weights[y] * node(i + x, j + y)[axis]).sum();
            // To the nearest even number, the lower one of two.
            -2 * ((1 << 20) - sum).div_euclid(1 << 21)
        });
        // Along the row by a parabola, drawn as straight lines.
        let length = 1 << table.piece();
        let pieces = cell / length;
        let to_nearest_even = |x: i64, by: i64| 2 * (x + by).div_euclid(2 * by);
        let bend = to_nearest_even(a + d - b - c, 2 * cell * cell / length);
        let step = to_nearest_even(c - b - length * pieces * (pieces - 1) / 2 * bend, cell);
        let (piece, rest) = ((i64::from(u) % cell) / length, i64::from(u) % length);
        let middle = if length == 1 { 0 } else { bend.div_euclid(4) };
        2 * (b + 128 - middle).div_euclid(2)
            + length * (piece * step + piece * (piece - 1) / 2 * bend)
            + rest * (step + piece * bend)
    }))
}

/// The mean of four pixels, or `None` outside the image.
fn bilinear(raw: &GrayImage, place: [i64; 2]) -> Option<u8> {
    let [x, y] = place.map(|p| p.div_euclid(256));
    let (last_x, last_y) = (i64::from(raw.width()) - 1, i64::from(raw.height()) - 1);
    if x < 0 || y < 0 || x > 256 * last_x || y > 256 * last_y {
        return None;
    }
    let pixel = |x: i64, y: i64| i64::from(raw.get_pixel(x.min(last_x) as u32, y.min(last_y) as u32).0[0]);
    let (i, j, fx, fy) = (x / 256, y / 256, x % 256, y % 256);
    let top = pixel(i, j) * (256 - fx) + pixel(i + 1, j) * fx;
    let bottom = pixel(i, j + 1) * (256 - fx) + pixel(i + 1, j + 1) * fx;
    Some(((top * (256 - fy) + bottom * fy + (1 << 15)) >> 16) as u8)
}
