//! Odometry in metres, of a pair, and without a scale, of one camera.

use super::config::{OdometryConfig, OdometryRig, OdometryRigError};
use super::engine::{OdometryMemory, OdometryView};
use super::frame::{Frame, OdometryError};
use super::observed::ObservedPoint;
use super::self_calibration::RigEstimate;
use super::step::Step;
use crate::geometry::{
    Real,
    camera::{Camera, Pose, RectifiedRig},
    two_view::{Correspondence, ScaleError, scaled},
};
use nalgebra::Point2;

/// The odometry of a rectified pair, which follows up to `N` points: lengths are metres.
#[derive(Debug)]
pub struct StereoOdometry<T: Real, const N: usize> {
    memory: OdometryMemory<T, N>,
}

/// The odometry of one camera, which follows up to `N` points: lengths have no unit.
#[derive(Debug)]
pub struct MonocularOdometry<T: Real, const N: usize> {
    memory: OdometryMemory<T, N>,
    correspondences: [[Correspondence<T>; 2]; N],
}

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
    pub fn motion_m(&self, first_baseline_m: T) -> Result<Pose<T>, ScaleError> {
        let motion = &self.0.motion;
        scaled(*motion.rotation(), *motion.translation(), first_baseline_m)
    }
}

impl<T: Real, const N: usize> StereoOdometry<T, N> {
    /// An odometry that waits for [`Self::start`]. All zeros.
    pub const fn new() -> Self {
        Self { memory: OdometryMemory::EMPTY }
    }

    /// The odometry without its capacity.
    pub fn as_mut_view(&mut self) -> OdometryView<'_, T> {
        self.memory.view(&mut [])
    }

    /// Begins with a rig: what was known is forgotten.
    pub fn start(&mut self, rig: &RectifiedRig, config: OdometryConfig) -> Result<(), OdometryRigError> {
        let rig = OdometryRig::stereo(rig)?;
        if !config.is_usable(true) {
            return Err(OdometryRigError::Config);
        }
        self.as_mut_view().begin(rig, config);
        Ok(())
    }

    /// The next frame, see [`OdometryView::step`].
    pub fn step(&mut self, frame: &Frame<'_>) -> Result<Step<T>, OdometryError> {
        self.as_mut_view().step(frame)
    }

    /// Begins once more with the rig as it is corrected by now, see [`OdometryView::begin_again`].
    pub fn begin_again(&mut self) {
        self.as_mut_view().begin_again();
    }

    /// How the pair differs from its calibration, see [`OdometryView::rig_estimate`].
    pub fn rig_estimate(&mut self) -> Option<RigEstimate<T>> {
        self.as_mut_view().rig_estimate()
    }

    /// What the last frame saw, see [`OdometryView::observed_points`]: metres.
    pub fn observed_points(&self) -> impl Iterator<Item = ObservedPoint<T>> {
        self.memory.observed_points()
    }
}

impl<T: Real, const N: usize> Default for StereoOdometry<T, N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Real, const N: usize> MonocularOdometry<T, N> {
    /// An odometry that waits for [`Self::start`]. All zeros.
    pub const fn new() -> Self {
        let zero = Point2::new(T::ZERO, T::ZERO);
        let correspondences = [[Correspondence { first: zero, second: zero }; 2]; N];
        Self { memory: OdometryMemory::EMPTY, correspondences }
    }

    /// The odometry without its capacity.
    pub fn as_mut_view(&mut self) -> OdometryView<'_, T> {
        self.memory.view(self.correspondences.as_flattened_mut())
    }

    /// Begins with a camera: what was known is forgotten. With a configuration that is none to be used
    /// ([`OdometryConfig::is_usable`]) no motion is ever known.
    pub fn start(&mut self, camera: Camera<T>, config: OdometryConfig) {
        self.as_mut_view().begin(OdometryRig::one(camera), config);
    }

    /// The next frame, see [`OdometryView::step`].
    pub fn step(&mut self, frame: &Frame<'_>) -> Result<Unscaled<Step<T>>, OdometryError> {
        self.as_mut_view().step(frame).map(Unscaled)
    }

    /// What the last frame saw, see [`OdometryView::observed_points`]: first baselines.
    pub fn observed_points(&self) -> impl Iterator<Item = ObservedPoint<T>> {
        self.memory.observed_points()
    }
}

impl<T: Real, const N: usize> Default for MonocularOdometry<T, N> {
    fn default() -> Self {
        Self::new()
    }
}
