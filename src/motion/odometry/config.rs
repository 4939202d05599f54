//! Configuration of the odometry and its cameras.

use super::right_error::RightError;
use crate::geometry::{
    Real,
    camera::{Camera, RectifiedRig},
    rectify::RowAlignment,
};

/// One camera, or a pair whose rows are aligned.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct OdometryRig<T: Real> {
    pub(super) camera: Camera<T>,
    /// The baseline, m, and the right camera's column of the principal point, px.
    pub(super) right: Option<(T, T)>,
    /// What the right camera is off by.
    pub(super) error: RightError<T>,
}

/// Why numbers are no rig of an odometry.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum OdometryRigError {
    /// The rig's numbers are no camera.
    Camera,
    /// The configuration can never work, see [`OdometryConfig::is_usable`].
    Config,
}

error_text!(OdometryRigError {
    Self::Camera => "the rig's numbers are no camera",
    Self::Config => "no frame can be followed with this configuration",
});

impl<T: Real> OdometryRig<T> {
    /// One camera, whose lens may distort.
    pub const fn one(camera: Camera<T>) -> Self {
        Self { camera, right: None, error: RightError::NONE }
    }

    /// Two cameras with aligned rows.
    pub fn stereo(rig: &RectifiedRig) -> Result<Self, OdometryRigError> {
        let of = |x: f32| T::of(x.into());
        let (cx, cy) = rig.principal_point();
        let camera = Camera::new(of(rig.focal_px()), of(rig.focal_px()), of(cx), of(cy));
        let camera = camera.map_err(|_| OdometryRigError::Camera)?;
        // u' = f (X - b) / Z + cx', and doffs = cx' - cx.
        let right_cx = of(cx) + of(rig.disparity_offset_px());
        Ok(Self { camera, right: Some((of(rig.baseline_m()), right_cx)), error: RightError::NONE })
    }

    /// The pair with a right camera that is turned about X and Z as its rows say. Without it partners in rows
    /// that are off by more than 1.5 px are not found.
    #[must_use]
    pub fn with_rows(mut self, rows: &RowAlignment<T>) -> Self {
        let [pitch, _, roll] = rows.rotation_rad;
        // Rows sink by `w_x (-1 - y^2)`.
        self.error = RightError { row: -pitch, roll, ..self.error };
        self
    }

    /// What has to be added to the disparity of a point that the right camera sees there, and how much lower
    /// it sees that than it should, px.
    pub(super) fn correction_px(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        let Some((_, right_cx)) = self.right else { return [0.0; 2] };
        let centred = [T::of(x.into()) - right_cx, T::of(y.into()) - self.camera.principal_point().1];
        let place = centred.map(|px| px / self.focal());
        [self.error.correction(place), self.error.row_at(place)].map(|x| (x * self.focal()).to_f64() as f32)
    }

    /// The baseline, m; zero of one camera.
    pub(super) fn baseline(&self) -> T {
        self.right.map_or(T::ZERO, |(b, _)| b)
    }

    /// The mean focal length, px.
    pub(super) fn focal(&self) -> T {
        let (fx, fy) = self.camera.focal_px();
        (fx + fy) * T::of(0.5)
    }
}

/// Configuration of the odometry.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct OdometryConfig {
    /// Radius of the search around a predicted place while the motion is not known, px.
    pub far_px: f32,
    /// How far from its predicted place a feature is looked for while the motion is known, px.
    pub near_px: f32,
    /// The largest disparity of a new point, px.
    pub most_disparity_px: u16,
    /// Standard deviation of a place found by template alignment, px.
    pub sigma_px: f32,
    /// Smallest distance of a new point from all others, px.
    pub spacing_px: f32,
    /// Largest number of RANSAC samples of the resection.
    pub most_samples: u32,
    /// Seed of the random samples.
    pub seed: u64,
    /// Whether the right camera is corrected by [`RigEstimate`](super::RigEstimate) once that is sure.
    pub corrects_rig: bool,
}

impl OdometryConfig {
    /// The configuration of an odometry that was not started: all zeros.
    pub(super) const NONE: Self = Self {
        far_px: 0.0,
        near_px: 0.0,
        most_disparity_px: 0,
        sigma_px: 0.0,
        spacing_px: 0.0,
        most_samples: 0,
        seed: 0,
        corrects_rig: false,
    };

    /// Whether frames can be followed with it: radii of the search over 0, a deviation of 0.001 to 1000 px, a
    /// distance of points that is finite and not below 0, a sample at least, and for a pair a disparity over
    /// 0. With another one no motion is ever known.
    pub fn is_usable(&self, is_pair: bool) -> bool {
        self.far_px > 0.0
            && self.near_px > 0.0
            && (0.001..=1000.0).contains(&self.sigma_px)
            && self.spacing_px.is_finite()
            && self.spacing_px >= 0.0
            && self.most_samples > 0
            && (!is_pair || self.most_disparity_px > 0)
    }

    /// For pictures of so many columns: a sixth of them as far as motion goes that is not known, a twentieth
    /// where it is, a quarter as the largest disparity, 0.3 px of noise, 7 px from point to point, 300
    /// samples, and a right camera as calibrated.
    pub const fn new(width: u16) -> Self {
        let wide = width as f32;
        Self {
            far_px: wide / 6.0,
            near_px: wide / 20.0,
            most_disparity_px: width / 4,
            sigma_px: 0.3,
            spacing_px: 7.0,
            most_samples: 300,
            seed: 0,
            corrects_rig: false,
        }
    }
}
