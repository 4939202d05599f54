//! Pictures that are hard on a matcher and show nothing.

use super::Random;
use image::{GrayImage, Luma};

/// A way to fill a pair of pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pattern {
    /// One grey level everywhere.
    Constant(u8),
    /// Independent random bytes.
    Noise,
    /// Independent random black and white.
    Saturated,
    /// Random black, white and few grey levels: many ties.
    FewLevels(u8),
    /// Upright stripes, this many px wide.
    Columns(u32),
    /// Lying stripes, this many px high.
    Rows(u32),
    /// Diagonal stripes, this many px wide.
    Diagonals(u32),
    /// Squares of this side, px, black and white in turn.
    Checkerboard(u32),
    /// Brighter by this much per column, and half of it per row, from 0 again after 255.
    Ramp(u32),
    /// The right picture is random, the left one is the right one shifted by up to this many px, each band of
    /// rows by another distance, with noise of this deviation: answers exist.
    Shifted {
        /// The largest shift, px.
        most: usize,
        /// Noise, grey levels.
        noise_grey: f64,
    },
    /// Independent random bytes at the left picture's left half, constant elsewhere.
    HalfBlank,
}

impl Pattern {
    /// The two pictures, left and right, of this pattern.
    pub fn pair(self, width: u32, height: u32, seed: u64) -> (GrayImage, GrayImage) {
        let mut random = Random::new(seed);
        match self {
            Self::Shifted { most, noise_grey } => shifted(width, height, most, noise_grey, &mut random),
            _ => (self.picture(width, height, &mut random), self.picture(width, height, &mut random)),
        }
    }

    fn picture(self, width: u32, height: u32, random: &mut Random) -> GrayImage {
        let level = |on: bool| if on { 255 } else { 0 };
        GrayImage::from_fn(width, height, |x, y| {
            Luma([match self {
                Self::Constant(grey) => grey,
                Self::Noise | Self::Shifted { .. } => random.byte(),
                Self::Saturated => level(random.byte() & 1 == 1),
                Self::FewLevels(levels) => {
                    (random.below(usize::from(levels)) * 255 / usize::from(levels.max(2) - 1)) as u8
                }
                Self::Columns(period) => level(x / period % 2 == 1),
                Self::Rows(period) => level(y / period % 2 == 1),
                Self::Diagonals(period) => level((x + y) / period % 2 == 1),
                Self::Checkerboard(side) => level((x / side + y / side) % 2 == 1),
                Self::Ramp(step) => (x * step + y * step / 2) as u8,
                Self::HalfBlank => {
                    let byte = random.byte();
                    if x < width / 2 { byte } else { 90 }
                }
            }])
        })
    }
}

/// Rows between two changes of the shift.
const BAND: u32 = 7;

fn shifted(
    width: u32,
    height: u32,
    most: usize,
    noise_grey: f64,
    random: &mut Random,
) -> (GrayImage, GrayImage) {
    let right = Pattern::Noise.picture(width, height, random);
    let mut shift = 0;
    let left = GrayImage::from_fn(width, height, |x, y| {
        if x == 0 && y % BAND == 0 {
            shift = random.below(most + 1) as u32;
        }
        let seen = if x >= shift { right.get_pixel(x - shift, y).0[0] } else { random.byte() };
        let grey = f64::from(seen) + noise_grey * random.gauss();
        Luma([grey.round().clamp(0.0, 255.0) as u8])
    });
    (left, right)
}
