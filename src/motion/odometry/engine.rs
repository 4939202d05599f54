//! Visual odometry, frame by frame: the list of what happens to a frame.

use super::config::{OdometryConfig, OdometryRig};
use super::frame::{Frame, Moment, OdometryError};
use super::initialization::initialize;
use super::motion_model::MotionModel;
use super::motion_test::{MotionTest, test_motion};
use super::point_map::PointMap;
use super::step::{State, Step};
use super::tracking::Tracker;
use crate::geometry::linear::covariance6;
use crate::geometry::{Real, camera::Pose};
use heapless::Vec;
use nalgebra::Matrix6;

/// Follows up to `N` points from frame to frame, of one camera or of a rectified pair.
///
/// [`StereoOdometry`](super::StereoOdometry) and [`MonocularOdometry`](super::MonocularOdometry) say in their
/// types what the unit of length is.
#[derive(Debug)]
pub struct Odometry<T: Real, const N: usize> {
    /// The rig, when there is one. An `Option` of it would not be all zeros.
    rig: Vec<OdometryRig<T>, 1>,
    config: OdometryConfig,
    size: (usize, usize),
    frames: u32,
    pub(super) map: PointMap<T, N>,
    pub(super) tracker: Tracker<T, N>,
    motion: MotionModel<T>,
}

impl<T: Real, const N: usize> Odometry<T, N> {
    /// An odometry that waits for [`Self::start`].
    pub const fn new() -> Self {
        const { assert!(N < u16::MAX as usize && N >= 16, "points are numbered in 16 bits") };
        Self {
            rig: Vec::new(),
            config: OdometryConfig::NONE,
            size: (0, 0),
            frames: 0,
            map: PointMap::new(),
            tracker: Tracker::new(),
            motion: MotionModel::new(),
        }
    }

    /// Begins with a rig: what was known is forgotten.
    pub fn start(&mut self, rig: OdometryRig<T>, config: OdometryConfig) {
        self.rig.clear();
        let _ = self.rig.push(rig);
        self.config = config;
        self.frames = 0;
        self.forget();
    }

    /// Forgets all points and the motion.
    fn forget(&mut self) {
        self.map.clear();
        self.motion.reset(self.rig.first().is_some_and(|rig| rig.right.is_some()));
    }

    /// The next frame.
    ///
    /// The work is bounded: N points times the features that are looked at, [`OdometryConfig::most_samples`]
    /// samples, some twenty passes over the points, ten steps of alignment for each in each picture, and
    /// one search along the row for each new one.
    pub fn step(&mut self, frame: &Frame<'_>) -> Result<Step<T>, OdometryError> {
        let rig = *self.rig.first().ok_or(OdometryError::NotStarted)?;
        self.check_size(&rig, frame)?;
        self.frames = self.frames.saturating_add(1);
        let config = self.config;
        let now = Moment { rig: &rig, config: &config, frame, number: self.frames };
        if self.frames == 1 {
            return Ok(self.first(&now));
        }
        if !self.motion.has_unit {
            return Ok(initialize(&now, &mut self.map, &mut self.tracker, &mut self.motion));
        }
        let start = self.tracker.track(&now, &mut self.map, &self.motion);
        Ok(match test_motion(&self.tracker, &rig, &self.motion, start) {
            MotionTest::Lost => self.lose(&now),
            MotionTest::Known(solved, state) => {
                let (points, found) = (self.map.len(), self.tracker.matches.len());
                let residual = solved.residual(6);
                // The noise may be more than was configured, and is then all over.
                let covariance = covariance6(&solved.information) * (residual * residual).max(T::ONE);
                let motion = self.motion.report(&solved.pose, state);
                if state == State::Stationary {
                    // The points stay where they are: a motion too small to be seen adds up until it is seen.
                    self.map.used_mut().for_each(|track| track.now = None);
                    self.motion.velocity = Some(Pose::identity());
                } else {
                    self.map.update(&now, &self.tracker.matches, &solved.pose, &covariance);
                    self.motion.rebase(&solved.pose, motion);
                    self.map.add_new(&now);
                }
                Step { motion, covariance, state, points, found, inliers: solved.kept, residual }
            }
        })
    }

    /// Refuses a frame without its right picture, or of another size than those before.
    fn check_size(&mut self, rig: &OdometryRig<T>, frame: &Frame<'_>) -> Result<(), OdometryError> {
        let size = (frame.left.width(), frame.left.height());
        match frame.right {
            None if rig.right.is_some() => return Err(OdometryError::NoRight),
            Some(right) if (right.width(), right.height()) != size => return Err(OdometryError::Size),
            _ => {}
        }
        if self.frames > 0 && self.size != size {
            return Err(OdometryError::Size);
        }
        self.size = size;
        Ok(())
    }

    /// The first frame: its points are the map.
    fn first(&mut self, now: &Moment<'_, T>) -> Step<T> {
        self.forget();
        self.map.add_new(now);
        Step { covariance: Matrix6::zeros(), points: self.map.len(), ..Step::none(State::First) }
    }

    /// A frame whose pose is not known; after a few of them all begins anew.
    fn lose(&mut self, now: &Moment<'_, T>) -> Step<T> {
        let mut state = State::Lost;
        if self.motion.lose() {
            self.forget();
            self.map.add_new(now);
            state = State::Restarted;
        }
        Step { points: self.map.len(), found: self.tracker.matches.len(), ..Step::none(state) }
    }

    /// The rig, if there is one.
    pub(super) fn rig(&self) -> Option<&OdometryRig<T>> {
        self.rig.first()
    }

    /// How many points are followed.
    pub fn points(&self) -> usize {
        self.map.len()
    }
}

impl<T: Real, const N: usize> Default for Odometry<T, N> {
    fn default() -> Self {
        Self::new()
    }
}
