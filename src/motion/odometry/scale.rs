//! Odometry in metres, of a pair, and without a scale, of one camera.

use super::config::{OdometryConfig, OdometryRig, OdometryRigError};
use super::engine::Odometry;
use super::frame::{Frame, OdometryError};
use super::observed::ObservedPoint;
use super::step::Step;
use crate::geometry::{
    Real,
    camera::{Camera, Pose, RectifiedRig},
};

/// A rectified pair's odometry: lengths are metres.
#[derive(Debug, Default)]
pub struct StereoOdometry<T: Real, const N: usize>(Odometry<T, N>);

/// One camera's odometry: lengths have no unit.
#[derive(Debug, Default)]
pub struct MonocularOdometry<T: Real, const N: usize>(Odometry<T, N>);

/// What has lengths whose unit is not known: as a whole it may be any times as large. Only a length from
/// elsewhere says.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Unscaled<V>(V);

impl<V> Unscaled<V> {
    /// The value in units of the first baseline: the way from the first frame to that with which the unit
    /// begins.
    pub const fn in_first_baselines(&self) -> &V {
        &self.0
    }
}

impl<T: Real> Unscaled<Step<T>> {
    /// The motion in metres, of a first baseline of so many.
    pub fn motion_m(&self, first_baseline_m: T) -> Pose<T> {
        let motion = &self.0.motion;
        Pose::of_parts(*motion.rotation(), motion.translation() * first_baseline_m)
    }
}

impl<T: Real, const N: usize> StereoOdometry<T, N> {
    /// An odometry that waits for [`Self::start`].
    pub const fn new() -> Self {
        Self(Odometry::new())
    }

    /// Begins with a rig: what was known is forgotten.
    pub fn start(&mut self, rig: &RectifiedRig, config: OdometryConfig) -> Result<(), OdometryRigError> {
        self.0.start(OdometryRig::stereo(rig)?, config);
        Ok(())
    }

    /// The next frame, as [`Odometry::step`].
    pub fn step(&mut self, frame: &Frame<'_>) -> Result<Step<T>, OdometryError> {
        self.0.step(frame)
    }

    /// What the last frame saw, as [`Odometry::observed_points`]: metres.
    pub fn observed_points(&self) -> impl Iterator<Item = ObservedPoint<T>> {
        self.0.observed_points()
    }
}

impl<T: Real, const N: usize> MonocularOdometry<T, N> {
    /// An odometry that waits for [`Self::start`].
    pub const fn new() -> Self {
        Self(Odometry::new())
    }

    /// Begins with a camera: what was known is forgotten.
    pub fn start(&mut self, camera: Camera<T>, config: OdometryConfig) {
        self.0.start(OdometryRig::one(camera), config);
    }

    /// The next frame, as [`Odometry::step`].
    pub fn step(&mut self, frame: &Frame<'_>) -> Result<Unscaled<Step<T>>, OdometryError> {
        self.0.step(frame).map(Unscaled)
    }

    /// What the last frame saw, as [`Odometry::observed_points`]: first baselines.
    pub fn observed_points(&self) -> impl Iterator<Item = ObservedPoint<T>> {
        self.0.observed_points()
    }
}
