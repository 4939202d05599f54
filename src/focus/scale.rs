//! Focus peaks to metric depth by the lens equation.

use super::lens::finite;
use super::{Breathing, FocusLineError, FocusOrder, FocusPeak, LensError, ThinLens};
use crate::depth::Depth;

/// The depth of every frame of a stack: the image distance `z` between lens and sensor in each, and the lens,
/// whose equation gives `Z` with `sigma_Z = f^2 / (z - f)^2 sigma_z`. Between two frames `z` is a straight
/// line.
///
/// ```
/// use stereopsis::focus::{FocusPeak, FocusScale, ThinLens};
/// let lens = ThinLens::new(0.050)?;
/// let scale = FocusScale::new(lens, &[0.0510, 0.0520, 0.0530])?;
/// // Between the first two frames, 1/8 frame uncertain: 0.125 mm of z.
/// let depth = scale.depth(&FocusPeak { position_q8: 128, sigma_q8: 32, noise_q8: 9, confidence: 200 })?;
/// assert!((depth.depth_m - 0.050 * 0.0515 / 0.0015).abs() < 1e-4);
/// assert!((depth.sigma_m - 0.05 * 0.05 / (0.0015 * 0.0015) * 0.000125).abs() < 1e-4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct FocusScale<'a> {
    lens: ThinLens<f32>,
    images_m: &'a [f32],
}

/// Why positions are no scale.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum FocusScaleError {
    /// Fewer than two positions.
    TooFew,
    /// The lens has no answer for one of them.
    Position {
        /// Index of the position, from 0.
        index: usize,
        /// Why not.
        reason: LensError,
    },
    /// A position does not go on in the direction of those before it.
    Order {
        /// Index of the position, from 0.
        index: usize,
    },
}

error_text!(FocusScaleError {
    Self::TooFew => "at least two positions are needed",
    Self::Position { index, reason } => "position {}: {reason}" (index + 1),
    Self::Order { index } => "position {}: positions must rise or fall all the way" (index + 1),
});

impl<'a> FocusScale<'a> {
    /// The scale of frames that were taken with the sensor `images_m` behind the lens, one distance a frame,
    /// rising or falling all the way.
    pub fn new(lens: ThinLens<f32>, images_m: &'a [f32]) -> Result<Self, FocusScaleError> {
        for (index, &image) in images_m.iter().enumerate() {
            lens.object_distance(image).map_err(|reason| FocusScaleError::Position { index, reason })?;
        }
        let [first, second, ..] = images_m else { return Err(FocusScaleError::TooFew) };
        let order = |pair: &[f32]| matches!(pair, [a, b] if a != b && (a < b) == (first < second));
        match images_m.windows(2).position(|pair| !order(pair)) {
            Some(before) => Err(FocusScaleError::Order { index: before + 1 }),
            None => Ok(Self { lens, images_m }),
        }
    }

    /// The lens.
    pub fn lens(&self) -> ThinLens<f32> {
        self.lens
    }

    /// In which direction the frames are focused: the farther the sensor is behind the lens, the nearer.
    pub fn order(&self) -> FocusOrder {
        match self.images_m {
            [first, second, ..] if first > second => FocusOrder::NearToFar,
            _ => FocusOrder::FarToNear,
        }
    }

    /// The image distance at a frame with its fraction, counted from 0, and its change per frame there, m.
    fn image(&self, position: f32) -> Result<(f32, f32), LensError> {
        let last = self.images_m.len().saturating_sub(2);
        let whole = (finite(position)?.max(0.0) as usize).min(last);
        let Some(&[before, after]) = self.images_m.get(whole..whole + 2) else {
            return Err(LensError::NotFinite);
        };
        let step = after - before;
        Ok((before + (position - whole as f32) * step, step))
    }

    /// The depth of a peak, with what its deviation makes of it.
    pub fn depth(&self, peak: &FocusPeak) -> Result<Depth, LensError> {
        let (image, step) = self.image(peak.position())?;
        let depth_m = self.lens.object_distance(image)?;
        Ok(Depth { depth_m, sigma_m: self.lens.object_sigma(image, peak.sigma() * step.abs())? })
    }

    /// How much larger a frame is than the first one, by [`ThinLens::breathing`]; a frame that has no
    /// position is as large.
    pub fn breathing(&self, frame: usize) -> Result<Breathing, FocusLineError> {
        match (self.images_m.get(frame), self.images_m.first()) {
            (Some(&image), Some(&first)) => Breathing::new(image / first),
            _ => Ok(Breathing::NONE),
        }
    }

    /// How much larger a frame is than the one before it; `None` where one of the two has no position.
    pub fn growth(&self, frame: usize) -> Option<f32> {
        let before = self.images_m.get(frame.checked_sub(1)?)?;
        self.images_m.get(frame).map(|image| image / before)
    }
}
