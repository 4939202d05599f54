//! Calibration of a lens actuator: positions to distances in focus.

use super::{LensError, ThinLens};

/// A lens whose distance from the sensor grows in proportion to its actuator's position: `z = z0 + k p`.
///
/// ```
/// use stereopsis::focus::{FocusCalibration, ThinLens};
/// let lens = ThinLens::new(0.004)?;
/// // Targets at known distances, and the positions in which they were sharpest.
/// let calibration = FocusCalibration::fit(lens, &[(100, 2.0), (500, 0.2), (700, 0.139)])?;
/// assert!((calibration.focus_distance_m(500)? - 0.2).abs() < 0.01);
/// assert_eq!(calibration.position(calibration.focus_distance_m(321)?)?, 321);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct FocusCalibration {
    lens: ThinLens<f32>,
    /// How much farther from the sensor than its focal length the lens is in position 0, m.
    zero_m: f32,
    per_step_m: f32,
    rms_m: f32,
}

deserialize_checked! {
    FocusCalibration { lens: ThinLens<f32>, zero_m: f32, per_step_m: f32, rms_m: f32 }
    by |stored| {
        let finite = [stored.zero_m, stored.per_step_m, stored.rms_m].iter().all(|x| x.is_finite());
        if !finite {
            return Err("a number of the focus calibration is not finite");
        }
        if stored.per_step_m <= 0.0 || stored.rms_m < 0.0 {
            return Err("the focus calibration's step must be above zero, its deviation not below");
        }
        let FocusCalibration { lens, zero_m, per_step_m, rms_m } = stored;
        Ok(Self { lens, zero_m, per_step_m, rms_m })
    }
}

/// Why there is no calibration.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum FocusCalibrationError {
    /// Fewer than two different positions.
    TooFew,
    /// A distance is none that the lens can image.
    Distance {
        /// Index of the sample, from 0.
        index: usize,
        /// Why not.
        reason: LensError,
    },
    /// The lens does not move nearer focus with larger positions.
    Direction,
    /// The lens or the distances are so extreme that a number of the line is infinite or none.
    NotFinite,
}

error_text!(FocusCalibrationError {
    Self::TooFew => "at least two different positions are needed",
    Self::Distance { index, reason } => "sample {}: {reason}" (index + 1),
    Self::Direction => "larger positions must be nearer focus",
    Self::NotFinite => "a number of the focus calibration is not finite",
});

impl FocusCalibration {
    /// The line with the least squared distances from what was seen: positions, each with the distance in
    /// focus, m.
    pub fn fit(lens: ThinLens<f32>, samples: &[(u16, f32)]) -> Result<Self, FocusCalibrationError> {
        let count = samples.len() as f32;
        // Newton's form, f^2 / (Z - f): z - f without the rounding of a difference of nearly equal numbers.
        let extension = |object: f32| lens.magnification(object).map(|m| m * lens.focal());
        let (mut p, mut z) = (0.0, 0.0);
        for (index, &(position, object)) in samples.iter().enumerate() {
            z += extension(object).map_err(|reason| FocusCalibrationError::Distance { index, reason })?;
            p += f32::from(position);
        }
        let (mean_p, mean_z) = (p / count, z / count);
        let (mut pp, mut pz, mut zz) = (0.0, 0.0, 0.0);
        for &(position, object) in samples {
            let (dp, dz) = (f32::from(position) - mean_p, extension(object).unwrap_or(mean_z) - mean_z);
            (pp, pz, zz) = (pp + dp * dp, pz + dp * dz, zz + dz * dz);
        }
        if samples.len() < 2 || pp < 0.25 {
            return Err(FocusCalibrationError::TooFew);
        }
        let per_step_m = pz / pp;
        if per_step_m <= 0.0 {
            return Err(FocusCalibrationError::Direction);
        }
        let (zero_m, square) = (mean_z - per_step_m * mean_p, (zz - per_step_m * pz) / count);
        if ![per_step_m, zero_m, square].iter().all(|x| x.is_finite()) {
            return Err(FocusCalibrationError::NotFinite);
        }
        Ok(Self { lens, zero_m, per_step_m, rms_m: nalgebra::ComplexField::sqrt(square.max(0.0)) })
    }

    /// The root of the mean squared distance of the samples from the line, m of the image distance.
    pub fn rms_m(&self) -> f32 {
        self.rms_m
    }

    fn extension_m(&self, position: u16) -> f32 {
        self.zero_m + self.per_step_m * f32::from(position)
    }

    /// The distance in focus at a position, m: `f + f^2 / (z - f)`.
    pub fn focus_distance_m(&self, position: u16) -> Result<f32, LensError> {
        let (extension, focal) = (self.extension_m(position), self.lens.focal());
        if extension <= 0.0 {
            return Err(LensError::ImageWithinFocus);
        }
        super::lens::finite(focal / extension * focal + focal)
    }

    /// The deviation of that distance where the position is uncertain by `sigma` steps, m.
    pub fn focus_sigma_m(&self, position: u16, sigma: f32) -> Result<f32, LensError> {
        if super::lens::finite(sigma)? < 0.0 {
            return Err(LensError::Sigma);
        }
        let extension = self.extension_m(position);
        if extension <= 0.0 {
            return Err(LensError::ImageWithinFocus);
        }
        let ratio = self.lens.focal() / extension;
        super::lens::finite(ratio * ratio * self.per_step_m * sigma)
    }

    /// The position that is nearest to having `object_m` in focus; the nearest end where it is out of reach:
    /// the far one's for infinity, the near one's for what is within the focal length. Only what is no number
    /// is refused.
    pub fn position(&self, object_m: f32) -> Result<u16, LensError> {
        let extension = if object_m == f32::INFINITY {
            0.0
        } else if object_m <= self.lens.focal() {
            f32::INFINITY
        } else {
            self.lens.magnification(object_m)? * self.lens.focal()
        };
        // A cast of what is out of range is the nearest end.
        Ok(crate::math::round((extension - self.zero_m) / self.per_step_m) as u16)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lenses_beyond_the_numbers_and_deviations_below_zero_are_refused() {
        let fit = |focal, near, far| {
            let lens = ThinLens::new(focal).expect("a focal length");
            FocusCalibration::fit(lens, &[(0, far), (1000, near)])
        };
        // The square of the difference of two image distances overflows, and the largest of them does.
        assert_eq!(fit(1e22, 2e22, 3e22), Err(FocusCalibrationError::NotFinite));
        assert_eq!(fit(2e38, 2.1e38, 3e38), Err(FocusCalibrationError::NotFinite));
        let lens = fit(0.004, 0.2, 2.0).expect("a lens");
        assert_eq!(lens.focus_sigma_m(500, -1.0), Err(LensError::Sigma));
        assert_eq!(lens.focus_sigma_m(500, f32::NAN), Err(LensError::NotFinite));
    }
}
