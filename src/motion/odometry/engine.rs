//! Visual odometry, frame by frame: the list of what happens to a frame.

use super::config::{OdometryConfig, OdometryRig};
use super::frame::{Frame, Moment, OdometryError};
use super::initialization::initialize;
use super::list::List;
use super::motion_model::MotionModel;
use super::motion_test::{MotionTest, test_motion};
use super::observed::{ObservedPoint, observed_points};
use super::point_map::PointMap;
use super::pose_estimate::{FEWEST as LEAST_INLIERS, PointMatch};
use super::self_calibration::{RigEstimate, SelfCalibration};
use super::step::{State, Step};
use super::track::Track;
use super::tracking::Tracker;
use crate::geometry::linear::covariance6;
use crate::geometry::{Real, absolute::Landmark, camera::Pose, two_view::Correspondence};
use heapless::Vec;
use nalgebra::{Matrix6, Point2, Point3};

/// How far an odometry is with its frames.
#[derive(Debug)]
pub struct OdometryState<T: Real> {
    progress: Progress<T>,
    /// Points that the last frame sees.
    found: usize,
}

#[derive(Debug)]
struct Progress<T: Real> {
    /// The rig, when there is one. An `Option` of it would not be all zeros.
    rig: Vec<OdometryRig<T>, 1>,
    config: OdometryConfig,
    size: (usize, usize),
    frames: u32,
    motion: MotionModel<T>,
    calibration: SelfCalibration<T>,
}

/// Follows points from frame to frame, of one camera or of a rectified pair, in borrowed memory: a
/// [`StereoOdometry`](super::StereoOdometry) or [`MonocularOdometry`](super::MonocularOdometry) of any size.
#[derive(Debug)]
pub struct OdometryView<'a, T: Real> {
    progress: &'a mut Progress<T>,
    map: PointMap<'a, T>,
    tracker: Tracker<'a, T>,
    /// Two for each point, which one camera takes for its first two views.
    correspondences: &'a mut [Correspondence<T>],
}

/// The memory of an odometry that follows up to `N` points.
#[derive(Debug)]
pub(super) struct OdometryMemory<T: Real, const N: usize> {
    state: OdometryState<T>,
    tracks: [Track<T>; N],
    matches: [PointMatch<T>; N],
    landmarks: [Landmark<T>; N],
    inliers: [bool; N],
    partners: [(u16, u16); N],
}

impl<T: Real, const N: usize> OdometryMemory<T, N> {
    /// Memory that is not in use. All zeros.
    pub const EMPTY: Self = {
        assert!(N <= MOST && N >= FEWEST, "points are numbered in 16 bits");
        let (world, pixel) = (Point3::new(T::ZERO, T::ZERO, T::ZERO), Point2::new(T::ZERO, T::ZERO));
        Self {
            state: OdometryState::new(),
            tracks: [Track::EMPTY; N],
            matches: [PointMatch::EMPTY; N],
            landmarks: [Landmark { world, pixel }; N],
            inliers: [false; N],
            partners: [(0, 0); N],
        }
    };

    /// The odometry without its capacity.
    pub fn view<'a>(&'a mut self, correspondences: &'a mut [Correspondence<T>]) -> OdometryView<'a, T> {
        let Self { state, tracks, matches, landmarks, inliers, partners } = self;
        let OdometryState { progress, found } = state;
        let matches = List { places: matches, len: found };
        let tracker = Tracker { matches, landmarks, inliers, partners };
        OdometryView { progress, map: PointMap { tracks }, tracker, correspondences }
    }

    /// What the last frame saw.
    pub fn observed_points(&self) -> impl Iterator<Item = ObservedPoint<T>> {
        let matches = self.matches.get(..self.state.found).unwrap_or_default();
        observed_points(self.state.progress.rig.first(), &self.tracks, matches)
    }
}

impl<T: Real> OdometryState<T> {
    /// The state of an odometry that waits for a start. All zeros.
    pub const fn new() -> Self {
        let progress = Progress {
            rig: Vec::new(),
            config: OdometryConfig::NONE,
            size: (0, 0),
            frames: 0,
            motion: MotionModel::new(),
            calibration: SelfCalibration::EMPTY,
        };
        Self { progress, found: 0 }
    }
}

impl<T: Real> Default for OdometryState<T> {
    fn default() -> Self {
        Self::new()
    }
}

/// The fewest and the most points that can be followed.
const FEWEST: usize = 16;
const MOST: usize = u16::MAX as usize - 1;

impl<'a, T: Real> OdometryView<'a, T> {
    /// An odometry in the caller's memory, which follows as many points as there are tracks, 16 to 65534.
    /// Everything else is as long, `correspondences` twice as long, or empty for a pair. It does not matter
    /// what is in them before [`Self::start`]; a view of a run under way needs what the last one left there.
    pub fn new(
        state: &'a mut OdometryState<T>,
        tracks: &'a mut [Track<T>],
        matches: &'a mut [PointMatch<T>],
        landmarks: &'a mut [Landmark<T>],
        inliers: &'a mut [bool],
        partners: &'a mut [(u16, u16)],
        correspondences: &'a mut [Correspondence<T>],
    ) -> Result<Self, OdometryError> {
        let needed = tracks.len().clamp(FEWEST, MOST);
        let lengths = [tracks.len(), matches.len(), landmarks.len(), inliers.len(), partners.len()];
        if lengths.iter().any(|&len| len != needed) {
            return Err(OdometryError::Memory { needed });
        }
        let OdometryState { progress, found } = state;
        let matches = List { places: matches, len: found };
        let tracker = Tracker { matches, landmarks, inliers, partners };
        let view = Self { progress, map: PointMap { tracks }, tracker, correspondences };
        match view.progress.rig.first() {
            Some(rig) => view.check(rig).map(|()| view),
            None => Ok(view),
        }
    }

    /// Refuses a single camera without room for its first two views.
    fn check(&self, rig: &OdometryRig<T>) -> Result<(), OdometryError> {
        let needed = 2 * self.map.tracks.len();
        let is_enough = rig.right.is_some() || self.correspondences.len() >= needed;
        if is_enough { Ok(()) } else { Err(OdometryError::Memory { needed }) }
    }

    /// Begins with a rig: what was known is forgotten. A configuration that can never work is refused.
    pub fn start(&mut self, rig: OdometryRig<T>, config: OdometryConfig) -> Result<(), OdometryError> {
        self.check(&rig)?;
        config.is_usable(rig.right.is_some()).then_some(()).ok_or(OdometryError::Config)?;
        self.begin(rig, config);
        Ok(())
    }

    /// Begins with a rig that the memory is enough for.
    pub(super) fn begin(&mut self, rig: OdometryRig<T>, config: OdometryConfig) {
        self.progress.rig.clear();
        let _ = self.progress.rig.push(rig);
        self.progress.config = config;
        self.progress.frames = 0;
        self.progress.calibration.reset(&rig);
        self.forget();
    }

    /// Begins once more with the rig as it is corrected by now: points and motion are forgotten. So may
    /// frames that came before the correction be gone through again.
    pub fn begin_again(&mut self) {
        self.progress.frames = 0;
        self.progress.calibration.begin_again();
        self.forget();
    }

    /// Forgets all points and the motion.
    fn forget(&mut self) {
        self.map.clear();
        self.progress.motion.reset(self.progress.rig.first().is_some_and(|rig| rig.right.is_some()));
    }

    /// The next frame.
    ///
    /// The work is bounded: the points times the features looked at, [`OdometryConfig::most_samples`]
    /// samples, some twenty passes over the points, ten steps of alignment for each in each picture, and
    /// one search along the row for each new one.
    pub fn step(&mut self, frame: &Frame<'_>) -> Result<Step<T>, OdometryError> {
        let rig = *self.progress.rig.first().ok_or(OdometryError::NotStarted)?;
        self.check_size(&rig, frame)?;
        self.progress.frames = self.progress.frames.saturating_add(1);
        let config = self.progress.config;
        let now = Moment { rig: &rig, config: &config, frame, number: self.progress.frames };
        if self.progress.frames == 1 {
            return Ok(self.first(&now));
        }
        if !self.progress.motion.has_unit {
            return Ok(initialize(
                &now,
                &mut self.map,
                &mut self.tracker,
                &mut self.progress.motion,
                self.correspondences,
            ));
        }
        let start = self.tracker.track(&now, &mut self.map, &self.progress.motion);
        Ok(match test_motion(&mut self.tracker, &mut self.map, &rig, &self.progress.motion, start) {
            MotionTest::Lost => self.lose(&now),
            MotionTest::Known(solved, state) => {
                let (points, found) = (self.map.len(), self.tracker.matches.len());
                let residual = solved.residual(6);
                // The noise may be more than was configured, and is then all over.
                let covariance = covariance6(&solved.information) * (residual * residual).max(T::ONE);
                let motion = self.progress.motion.report(&solved.pose, state);
                // For who reads it: points with so much doubt would be of no use to the next frame.
                let doubt = self.progress.motion.doubt(&motion, state);
                if state == State::Stationary {
                    // The points stay where they are: a motion too small to be seen adds up until it is seen.
                    self.map.used_mut().for_each(|track| track.now = None);
                    self.progress.motion.velocity = Some(Pose::identity());
                } else {
                    self.map.update(&now, &self.tracker.matches, &solved.pose, &covariance);
                    let velocity = self.progress.motion.velocity_after(motion, state);
                    self.progress.motion.rebase(&solved.pose, velocity);
                    // A right camera that disagrees with all that is known gives no depth.
                    if state != State::LeftOnly {
                        self.map.add_new(&now);
                    }
                    self.progress.calibration.moved(&motion);
                    if !matches!(state, State::Uncertain | State::LeftOnly) {
                        self.calibrate(&now);
                    }
                }
                let covariance = covariance + doubt;
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
        if self.progress.frames > 0 && self.progress.size != size {
            return Err(OdometryError::Size);
        }
        self.progress.size = size;
        Ok(())
    }

    /// The first frame: its points are the map.
    fn first(&mut self, now: &Moment<'_, T>) -> Step<T> {
        self.forget();
        self.map.add_new(now);
        self.anchor();
        Step { covariance: Matrix6::zeros(), points: self.map.len(), ..Step::none(State::First) }
    }

    /// A frame whose pose is not known; after a few of them all begins anew.
    fn lose(&mut self, now: &Moment<'_, T>) -> Step<T> {
        let mut state = State::Lost;
        let sees_enough = now.rig.right.is_some() && now.frame.features.len() >= 2 * LEAST_INLIERS;
        if self.progress.motion.lose(sees_enough) {
            self.forget();
            self.map.add_new(now);
            self.anchor();
            state = State::Restarted;
        }
        Step { points: self.map.len(), found: self.tracker.matches.len(), ..Step::none(state) }
    }

    /// Compares this view with the one that its points are anchored in.
    fn calibrate(&mut self, now: &Moment<'_, T>) {
        let Some(rig) = self.progress.rig.first_mut() else { return };
        self.progress.calibration.step(now, rig, self.map.tracks, &self.tracker.matches);
    }

    /// All points are new.
    fn anchor(&mut self) {
        let Some(rig) = self.progress.rig.first().filter(|rig| rig.right.is_some()) else { return };
        self.progress.calibration.anchor(rig, &rig.error, self.map.tracks, &[]);
    }

    /// How the pair differs from its calibration; `None` of one camera.
    pub fn rig_estimate(&self) -> Option<RigEstimate<T>> {
        let rig = self.progress.rig.first().filter(|rig| rig.right.is_some())?;
        Some(self.progress.calibration.estimate(rig))
    }

    /// The points that the last frame saw and that agree with its pose, then its new ones.
    pub fn observed_points(&self) -> impl Iterator<Item = ObservedPoint<T>> {
        observed_points(self.progress.rig.first(), self.map.tracks, &self.tracker.matches)
    }
}
