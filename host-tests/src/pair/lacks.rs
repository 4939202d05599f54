//! What pictures lack: texture, and light that is neither too much nor too little.

use image::GrayImage;

/// The share of the pixels of both pictures that are so.
pub(super) fn share(pictures: [&GrayImage; 2], is_so: impl Fn(u8) -> bool) -> f64 {
    let pixels = || pictures.into_iter().flat_map(|picture| picture.iter());
    pixels().filter(|&&pixel| is_so(pixel)).count() as f64 / pixels().count().max(1) as f64
}

/// The share of a picture around whose pixels nothing changes along the row.
pub(super) fn untextured(picture: &GrayImage) -> f64 {
    const REACH: u32 = 4;
    const CHANGE: u8 = 4;
    let (width, height) = picture.dimensions();
    let changes = |x: u32, y: u32| {
        let [left, right] =
            [x.saturating_sub(1), (x + 1).min(width - 1)].map(|x| picture.get_pixel(x, y).0[0]);
        left.abs_diff(right) >= CHANGE
    };
    // Sums of all rows above and all columns to the left.
    let stride = width as usize + 1;
    let mut sums = vec![0u32; stride * (height as usize + 1)];
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let at = (y as usize + 1) * stride + x as usize + 1;
        sums[at] = u32::from(changes(x, y)) + sums[at - 1] + sums[at - stride] - sums[at - stride - 1];
    }
    let is_flat = |(y, x): &(u32, u32)| {
        let [top, bottom] =
            [y.saturating_sub(REACH), (y + REACH + 1).min(height)].map(|y| y as usize * stride);
        let [first, end] = [x.saturating_sub(REACH), (x + REACH + 1).min(width)].map(|x| x as usize);
        sums[bottom + end] + sums[top + first] == sums[bottom + first] + sums[top + end]
    };
    let flat = (0..height).flat_map(|y| (0..width).map(move |x| (y, x))).filter(is_flat).count();
    flat as f64 / (f64::from(width) * f64::from(height)).max(1.0)
}
