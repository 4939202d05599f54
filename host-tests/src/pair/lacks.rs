//! What pictures lack: texture, and light that is neither too much nor too little.

use image::GrayImage;

/// Shares of a picture, of what is shown of it.
pub(super) struct Lacks {
    /// Around those pixels nothing changes along the row.
    pub untextured: f64,
    /// Those are white: 254 and more.
    pub over_exposed: f64,
    /// Those are black: 1 and less.
    pub under_exposed: f64,
    /// The share of the whole picture that shows nothing.
    pub masked: f64,
    /// Of each row, [`Self::untextured`].
    rows: Vec<f64>,
}

impl Lacks {
    /// Of a picture, which shows nothing where `valid` is 0.
    pub fn of(picture: &GrayImage, valid: Option<&GrayImage>) -> Self {
        let is_shown = |x: u32, y: u32| valid.is_none_or(|valid| valid.get_pixel(x, y).0[0] != 0);
        let shown = |&(x, y, _): &(u32, u32, &image::Luma<u8>)| is_shown(x, y);
        let pixels = || picture.enumerate_pixels().filter(shown);
        let count = pixels().count();
        let (all, whole) = (count.max(1) as f64, f64::from(picture.width()) * f64::from(picture.height()));
        let share = |is_so: &dyn Fn(u8) -> bool| {
            pixels().filter(|(_, _, pixel)| is_so(pixel.0[0])).count() as f64 / all
        };
        let sums = ChangeSums::of(picture);
        let row = |y: u32| {
            let shown = || (0..picture.width()).filter(|&x| is_shown(x, y));
            [shown().filter(|&x| sums.is_flat(x, y)).count(), shown().count()]
        };
        let rows: Vec<_> = (0..picture.height()).map(row).collect();
        Self {
            untextured: rows.iter().map(|[flat, _]| flat).sum::<usize>() as f64 / all,
            over_exposed: share(&|pixel| pixel >= 254),
            under_exposed: share(&|pixel| pixel <= 1),
            masked: 1.0 - count as f64 / whole,
            rows: rows.iter().map(|&[flat, shown]| flat as f64 / shown.max(1) as f64).collect(),
        }
    }

    /// The share of this picture that lacks the texture that the other one has in the same rows.
    pub fn lost(&self, other: &Self) -> f64 {
        let more = self.rows.iter().zip(&other.rows).map(|(row, other)| (row - other).max(0.0));
        more.sum::<f64>() / self.rows.len().max(1) as f64
    }
}

/// How many pixels of all rows above and of all columns to the left change along the row.
struct ChangeSums {
    sums: Vec<u32>,
    width: u32,
    height: u32,
}

impl ChangeSums {
    /// The grey levels that a change has at least.
    const CHANGE: u8 = 4;
    /// How far around a pixel changes are looked for, px.
    const REACH: u32 = 4;

    fn of(picture: &GrayImage) -> Self {
        let (width, height) = picture.dimensions();
        let changes = |x: u32, y: u32| {
            let [left, right] =
                [x.saturating_sub(1), (x + 1).min(width - 1)].map(|x| picture.get_pixel(x, y).0[0]);
            left.abs_diff(right) >= Self::CHANGE
        };
        let stride = width as usize + 1;
        let mut sums = vec![0u32; stride * (height as usize + 1)];
        for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            let at = (y as usize + 1) * stride + x as usize + 1;
            sums[at] = u32::from(changes(x, y)) + sums[at - 1] + sums[at - stride] - sums[at - stride - 1];
        }
        Self { sums, width, height }
    }

    /// Whether nothing changes around a pixel.
    fn is_flat(&self, x: u32, y: u32) -> bool {
        let span =
            |at: u32, length: u32| [at.saturating_sub(Self::REACH), (at + Self::REACH + 1).min(length)];
        let stride = self.width as usize + 1;
        let [top, bottom] = span(y, self.height).map(|y| y as usize * stride);
        let [first, end] = span(x, self.width).map(|x| x as usize);
        self.sums[bottom + end] + self.sums[top + first] == self.sums[bottom + first] + self.sums[top + end]
    }
}
