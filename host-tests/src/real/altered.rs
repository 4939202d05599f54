//! A pair as worse cameras would have taken it.

use crate::scene::Random;
use image::{GrayImage, Luma};

/// What is wrong with the cameras.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Alteration {
    /// Nothing.
    Unaltered,
    /// Both sensors have Gaussian noise of this deviation, grey levels.
    Noise(f64),
    /// The right camera is exposed otherwise: its brightness is `gain * grey + offset`.
    Exposure {
        /// Times the brightness.
        gain: f64,
        /// Grey levels more.
        offset: f64,
    },
    /// The right camera has another curve: its brightness is `255 * (grey / 255) ^ gamma`.
    Gamma(f64),
    /// The right camera's rows are half a pixel off: each is the average of those of the pair above it and at
    /// it.
    HalfARowLow,
}

impl Alteration {
    /// Those that are measured.
    pub const ALL: [Self; 6] = [
        Self::Unaltered,
        Self::Noise(2.0),
        Self::Noise(5.0),
        Self::Exposure { gain: 1.2, offset: 15.0 },
        Self::Gamma(0.75),
        Self::HalfARowLow,
    ];

    /// In words.
    pub fn name(self) -> String {
        match self {
            Self::Unaltered => "as taken".into(),
            Self::Noise(sigma) => format!("noise, sigma {sigma}"),
            Self::Exposure { gain, offset } => format!("right x {gain} + {offset}"),
            Self::Gamma(gamma) => format!("right, gamma {gamma}"),
            Self::HalfARowLow => "right, half a row low".into(),
        }
    }

    /// The altered pair, rounded to whole grey levels. Noise is another one for each seed and each side, and
    /// the same for the same.
    pub fn apply(self, [left, right]: [&GrayImage; 2], seed: u64) -> [GrayImage; 2] {
        match self {
            Self::Unaltered => [left.clone(), right.clone()],
            Self::Noise(sigma) => {
                let mut random = Random::new(seed);
                [left, right].map(|image| each(image, |grey| grey + sigma * random.gauss()))
            }
            Self::Exposure { gain, offset } => [left.clone(), each(right, |grey| gain * grey + offset)],
            Self::Gamma(gamma) => [left.clone(), each(right, |grey| 255.0 * (grey / 255.0).powf(gamma))],
            Self::HalfARowLow => [left.clone(), half_a_row_low(right)],
        }
    }
}

/// The picture with every grey level made another.
fn each(image: &GrayImage, mut change: impl FnMut(f64) -> f64) -> GrayImage {
    let mut image = image.clone();
    for Luma([grey]) in image.pixels_mut() {
        *grey = change(f64::from(*grey)).round().clamp(0.0, 255.0) as u8;
    }
    image
}

fn half_a_row_low(image: &GrayImage) -> GrayImage {
    GrayImage::from_fn(image.width(), image.height(), |x, y| {
        let [above, here] = [y.saturating_sub(1), y].map(|y| u16::from(image.get_pixel(x, y).0[0]));
        Luma([(above + here).div_ceil(2) as u8])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn right_of(alteration: Alteration, image: GrayImage) -> Vec<u8> {
        let [left, right] = alteration.apply([&image, &image], 1);
        assert_eq!(left, image, "the left camera stays");
        right.into_raw()
    }

    fn greys(greys: &[u8]) -> GrayImage {
        GrayImage::from_raw(1, greys.len() as u32, greys.to_vec()).expect("a column")
    }

    #[test]
    fn curves() {
        let image = greys(&[0, 64, 100, 200, 255]);
        assert_eq!(right_of(Alteration::Unaltered, image.clone()), [0, 64, 100, 200, 255]);
        let exposure = Alteration::Exposure { gain: 1.2, offset: 15.0 };
        assert_eq!(right_of(exposure, image.clone()), [15, 92, 135, 255, 255]);
        // 255 * (64 / 255)^0.75 = 90.4
        assert_eq!(right_of(Alteration::Gamma(0.75), image), [0, 90, 126, 213, 255]);
    }

    #[test]
    fn rows_between_rows() {
        assert_eq!(right_of(Alteration::HalfARowLow, greys(&[10, 20, 21, 255, 0])), [10, 15, 21, 138, 128]);
    }
}
