//! Depth of field and the hyperfocal distance.

use super::lens::finite;
use super::{LensError, ThinLens};
use crate::geometry::Real;

/// The far end of the depth of field.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum FarLimit<T> {
    /// At that distance.
    At(T),
    /// Everything behind the near end is sharp enough: the lens is focused at the hyperfocal distance or
    /// beyond.
    Infinity,
}

/// The distances between which the blur is no larger than what counts as sharp.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DepthOfField<T> {
    /// The nearest distance.
    pub near: T,
    /// The farthest.
    pub far: FarLimit<T>,
}

impl<T: Real> ThinLens<T> {
    /// The nearest distance to focus at with which infinity is sharp: `H = f^2 / (N c) + f`, for the f-number
    /// `N = f / A` and the largest circle of confusion `c` that counts as sharp.
    pub fn hyperfocal(&self, f_number: T, blur: T) -> Result<T, LensError> {
        if finite(f_number)? <= T::ZERO {
            return Err(LensError::Aperture);
        }
        if finite(blur)? <= T::ZERO {
            return Err(LensError::Blur);
        }
        finite(self.focal() / f_number * (self.focal() / blur) + self.focal())
    }

    /// What is sharp enough with the lens focused at `focused`: `Zf (H - f) / (H + Zf - 2 f)` to `Zf (H - f)
    /// / (H - Zf)`, where [`Self::circle_of_confusion`] is `blur`.
    ///
    /// ```
    /// use stereopsis::focus::{FarLimit, ThinLens};
    /// let lens = ThinLens::new(0.05_f64)?;
    /// let field = lens.depth_of_field(2.0, 5.0, 25e-6)?;
    /// let FarLimit::At(far) = field.far else { panic!("infinity is not sharp") };
    /// for edge in [field.near, far] {
    ///     assert!((lens.circle_of_confusion(0.025, 5.0, edge)? - 25e-6).abs() < 1e-9);
    /// }
    /// # Ok::<(), stereopsis::focus::LensError>(())
    /// ```
    pub fn depth_of_field(&self, f_number: T, focused: T, blur: T) -> Result<DepthOfField<T>, LensError> {
        let hyperfocal = self.hyperfocal(f_number, blur)?;
        if finite(focused)? <= self.focal() {
            return Err(LensError::ObjectWithinFocus);
        }
        let over = hyperfocal - self.focal();
        let near = finite(over / (over + (focused - self.focal())) * focused)?;
        let far = if focused < hyperfocal {
            FarLimit::At(finite(over / (hyperfocal - focused) * focused)?)
        } else {
            FarLimit::Infinity
        };
        Ok(DepthOfField { near, far })
    }
}
