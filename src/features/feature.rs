//! A feature: a corner with its descriptor, in the pixels of the full picture.

use super::{Corner, Descriptor};

/// A picture among ever smaller ones of the same scene: which one, and how its pixels lie in the full one.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Level {
    index: u8,
    scale: f32,
}

deserialize_checked! {
    Level { index: u8, scale: f32 }
    by |level| match level.scale {
        scale if scale.is_finite() && scale >= 1.0 => Ok(Self { index: level.index, scale }),
        _ => Err("the scale of a level must be finite and at least 1"),
    }
}

impl Level {
    /// The full picture.
    pub const FULL: Self = Self { index: 0, scale: 1.0 };

    /// No picture.
    pub(super) const NONE: Self = Self { index: 0, scale: 0.0 };

    /// The level of a picture that [`Downsample`](super::Downsample) makes of this level's, `N - 1` pixels of
    /// every `N`.
    pub fn downsampled<const N: usize>(self) -> Self {
        const { assert!(2 <= N && N <= 16, "2 to 16 pixels become one less") };
        Self { index: self.index.saturating_add(1), scale: self.scale * N as f32 / (N - 1) as f32 }
    }

    /// 0 for the full picture, one more for every smaller one.
    pub fn index(self) -> u8 {
        self.index
    }

    /// Pixels of the full picture along a pixel of this one.
    pub fn scale(self) -> f32 {
        self.scale
    }

    /// Where a point of this level lies in the full picture, px: pixel centres are at integers in both, the
    /// edges of the pictures half a pixel outside of them, so `(x + 1/2) scale - 1/2`.
    pub fn full_px(self, x: f32) -> f32 {
        (x + 0.5) * self.scale - 0.5
    }
}

/// A corner that can be found again. C reads the same fields in this order.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(C)]
pub struct Feature {
    /// What it looks like.
    pub descriptor: Descriptor,
    /// The column, px of the full picture.
    pub x_px: f32,
    /// The row, px of the full picture.
    pub y_px: f32,
    /// How strong the corner is: the score of [`fast_scores`](super::fast_scores).
    pub score: u8,
    /// The level on which it was found: 0 is the full picture.
    pub level: u8,
}

impl Feature {
    /// A corner of a level, in the full picture.
    pub fn new(corner: &Corner, level: Level, descriptor: Descriptor) -> Self {
        let [x_px, y_px] = corner.position_px().map(|x| level.full_px(x));
        Self { x_px, y_px, score: corner.score, level: level.index, descriptor }
    }
}
