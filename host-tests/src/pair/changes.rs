//! Where a picture changes along its rows by more than its noise does.

use image::GrayImage;

/// How far around a pixel changes are looked for, px.
const REACH: u32 = 4;
/// The grey levels between two pixels beside one that are a change at least.
const CHANGE: u8 = 4;
/// Around one pixel in 128 less changes than what is taken for the least that noise does, as
/// [`stereopsis::imaging::NoiseMeter`] has it.
const QUIETEST: usize = 128;
/// How many times as much noise changes around 99.5 % of the pixels as around the quietest 1/128, at most:
/// 2.5 times where the pixels' noise is independent, 3.2 times where a remap has blended them.
const NOISE_SPREAD: f64 = 3.2;
/// The most that is taken for noise, in squared grey levels: twice the deviation from which on noise is high,
/// 6 grey levels for each of the two pixels that a change is between. What changes by more everywhere is
/// texture.
const MOST_NOISE: f64 = 72.0;

/// Sums of changes along the row over all rows above and all columns to the left.
pub(super) struct Changes {
    /// Squared changes; what overflows comes out right in differences.
    squares: Vec<u32>,
    /// How many changes are of [`CHANGE`] and more, and how many pixels are white or black, where noise is
    /// clipped: the last byte, as a square around a pixel has 81.
    counts: Vec<[u8; 2]>,
    width: u32,
    height: u32,
    /// The mean square that noise does at most.
    noise: f64,
}

/// What is around a pixel.
struct Around {
    mean_square: f64,
    changes: u8,
    clipped: u8,
}

impl Changes {
    pub fn of(picture: &GrayImage) -> Self {
        let (width, height) = picture.dimensions();
        let stride = width as usize + 1;
        let size = stride * (height as usize + 1);
        let (mut squares, mut counts) = (vec![0u32; size], vec![[0u8; 2]; size]);
        for y in 0..height {
            let (mut square, mut count) = (0u32, [0u8; 2]);
            for x in 0..width {
                let [left, here, right] =
                    [x.saturating_sub(1), x, (x + 1).min(width - 1)].map(|x| picture.get_pixel(x, y).0[0]);
                let change = left.abs_diff(right);
                square = square.wrapping_add(u32::from(change).pow(2));
                count[0] = count[0].wrapping_add(u8::from(change >= CHANGE));
                count[1] = count[1].wrapping_add(u8::from(!(2..254).contains(&here)));
                let at = (y as usize + 1) * stride + x as usize + 1;
                squares[at] = squares[at - stride].wrapping_add(square);
                counts[at] = [0, 1].map(|i| counts[at - stride][i].wrapping_add(count[i]));
            }
        }
        let mut sums = Self { squares, counts, width, height, noise: 0.0 };
        sums.noise = (NOISE_SPREAD * sums.quietest()).min(MOST_NOISE);
        sums
    }

    /// The mean square of the changes around the quietest pixels whose noise is not clipped.
    fn quietest(&self) -> f64 {
        let step = REACH as usize;
        let places =
            (0..self.height).step_by(step).flat_map(|y| (0..self.width).step_by(step).map(move |x| (x, y)));
        let around = places.map(|(x, y)| self.around(x, y)).filter(|around| around.clipped == 0);
        let mut found: Vec<f64> = around.map(|around| around.mean_square).collect();
        found.sort_unstable_by(f64::total_cmp);
        found.get(found.len() / QUIETEST).copied().unwrap_or(0.0)
    }

    fn around(&self, x: u32, y: u32) -> Around {
        let span = |at: u32, length: u32| [at.saturating_sub(REACH), (at + REACH + 1).min(length)];
        let stride = self.width as usize + 1;
        let (rows, columns) = (span(y, self.height), span(x, self.width));
        let [top, bottom] = rows.map(|y| y as usize * stride);
        let [first, end] = columns.map(|x| x as usize);
        let corners = [bottom + end, top + first, bottom + first, top + end];
        let [a, b, c, d] = corners.map(|at| self.squares[at]);
        let square = a.wrapping_add(b).wrapping_sub(c).wrapping_sub(d);
        let count = |i: usize| {
            let [a, b, c, d] = corners.map(|at| self.counts[at][i]);
            a.wrapping_add(b).wrapping_sub(c).wrapping_sub(d)
        };
        let pixels = (rows[1] - rows[0]) * (columns[1] - columns[0]);
        Around { mean_square: f64::from(square) / f64::from(pixels), changes: count(0), clipped: count(1) }
    }

    /// Whether nothing changes around a pixel, or not by more than noise does.
    pub fn is_flat(&self, x: u32, y: u32) -> bool {
        let around = self.around(x, y);
        around.changes == 0 || around.mean_square <= self.noise
    }
}
