//! Frame in, motion out.

use super::config::{OdometryConfig, OdometryRig};
use super::frame::{Frame, OdometryError};
use super::inverse_depth::InversePoint;
use super::motion_test::MotionTest;
use super::pose_estimate::{PointMatch, Problem, Solved, WIDTH};
use super::step::{State, Step};
use super::track::{Track, UPRIGHT};
use crate::features::Template;
use crate::geometry::linear::covariance6;
use crate::geometry::{Real, absolute::Landmark, camera::Pose};
use heapless::Vec;
use nalgebra::{Matrix3, Matrix6, Point3, Vector3};

/// Follows up to `N` points from frame to frame, of one camera or of a rectified pair.
///
/// [`StereoOdometry`](super::StereoOdometry) and [`MonocularOdometry`](super::MonocularOdometry) say in their
/// types what the unit of length is.
#[derive(Debug)]
pub struct Odometry<T: Real, const N: usize> {
    /// The rig, when there is one. An `Option` of it would not be all zeros.
    rig: Vec<OdometryRig<T>, 1>,
    pub(super) config: OdometryConfig,
    pub(super) size: (usize, usize),
    pub(super) tracks: [Track<T>; N],
    pub(super) matches: Vec<PointMatch<T>, N>,
    pub(super) landmarks: Vec<Landmark<T>, N>,
    pub(super) inliers: [bool; N],
    /// The track that each feature is most like, and by how many bits it differs.
    pub(super) partners: [(u16, u16); N],
    /// The motion of the last frame, if it is known.
    pub(super) velocity: Option<Pose<T>>,
    /// The last pose that was told, in the frame of the points.
    pub(super) reported_pose: Pose<T>,
    /// Frames since something was known.
    pub(super) lost: u8,
    /// Whether there is a unit of length.
    pub(super) begun: bool,
    pub(super) frames: u32,
}

/// Frames for which points are kept that are not found again.
const PATIENCE: u8 = 5;
/// Agreeing points that make a pose, at least.
pub(super) const FEWEST: usize = 8;
/// Frames in which a point is missed, or disagrees, before it is dropped.
const MISSED: u8 = 4;
const WRONG: u8 = 2;
/// Templates are cut anew when they look so much larger or smaller, or so little like they did.
const GROWN: [f32; 2] = [0.6, 1.6];
const ALIKE: f32 = 0.9;
/// The share of a step's covariance that each point's own is widened by: errors of the pose are in all of
/// them.
const DOUBT: f64 = 1.0;

impl<T: Real, const N: usize> Odometry<T, N> {
    /// An odometry that waits for [`Self::start`].
    pub const fn new() -> Self {
        const { assert!(N < u16::MAX as usize && N >= 16, "points are numbered in 16 bits") };
        Self {
            rig: Vec::new(),
            config: OdometryConfig::NONE,
            size: (0, 0),
            tracks: [Track::EMPTY; N],
            matches: Vec::new(),
            landmarks: Vec::new(),
            inliers: [false; N],
            partners: [(0, 0); N],
            velocity: None,
            // The first frame sets it.
            reported_pose: Pose::NOTHING,
            lost: 0,
            begun: false,
            frames: 0,
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
        self.tracks.iter_mut().for_each(|track| track.used = false);
        self.velocity = None;
        self.reported_pose = Pose::identity();
        self.lost = 0;
        self.begun = self.rig.first().is_some_and(|rig| rig.right.is_some());
    }

    /// The next frame.
    ///
    /// The work is bounded: N points times the features that are looked at, [`OdometryConfig::most_samples`]
    /// samples, some twenty passes over the points, ten steps of alignment for each in each picture, and
    /// one search along the row for each new one.
    pub fn step(&mut self, frame: &Frame<'_>) -> Result<Step<T>, OdometryError> {
        let rig = *self.rig.first().ok_or(OdometryError::NotStarted)?;
        let size = (frame.left.width(), frame.left.height());
        match frame.right {
            None if rig.right.is_some() => return Err(OdometryError::NoRight),
            Some(right) if (right.width(), right.height()) != size => return Err(OdometryError::Size),
            _ => {}
        }
        if self.frames == 0 {
            self.size = size;
        } else if self.size != size {
            return Err(OdometryError::Size);
        }
        let is_first = self.frames == 0;
        self.frames = self.frames.saturating_add(1);
        if is_first {
            self.forget();
            self.add_new_points(&rig, frame);
            let nothing_moved = Step { covariance: Matrix6::zeros(), ..Step::none(State::First) };
            return Ok(Step { points: self.points(), ..nothing_moved });
        }
        if !self.begun {
            return Ok(self.initialize(&rig, frame));
        }
        Ok(self.track_frame(&rig, frame))
    }

    /// The rig, if there is one.
    pub(super) fn rig(&self) -> Option<&OdometryRig<T>> {
        self.rig.first()
    }

    /// How many points are followed.
    pub fn points(&self) -> usize {
        self.tracks.iter().filter(|track| track.used).count()
    }

    fn track_frame(&mut self, rig: &OdometryRig<T>, frame: &Frame<'_>) -> Step<T> {
        let start = self.track(rig, frame);
        let test_motion = self.test_motion(rig, start);
        let found = self.matches.len();
        let (solved, state) = match test_motion {
            MotionTest::Lost => return self.report_lost(rig, frame, found),
            MotionTest::Known(solved, state) => (solved, state),
        };
        let points = self.points();
        let residual = (solved.squares / T::count(solved.numbers.saturating_sub(6).max(1))).sqrt();
        // The noise may be more than was configured, and is then all over.
        let covariance = covariance6(&solved.information) * (residual * residual).max(T::ONE);
        let reported = self.reported(&solved.pose, state);
        let motion = self.reported_pose.inverse().then(&reported);
        self.reported_pose = reported;
        if state == State::Stationary {
            // The points stay where they are: a motion that is too small to be seen adds up until it is seen.
            self.tracks.iter_mut().filter(|track| track.used).for_each(|track| track.now = None);
            self.velocity = Some(Pose::identity());
        } else {
            self.carry(rig, frame, &solved, &covariance);
            self.reported_pose = solved.pose.inverse().then(&self.reported_pose);
            self.velocity = Some(motion);
            self.add_new_points(rig, frame);
        }
        self.lost = 0;
        Step { motion, covariance, state, points, found, inliers: solved.kept, residual }
    }

    /// The pose that is reported_pose: what is not known is none.
    fn reported(&self, pose: &Pose<T>, state: State) -> Pose<T> {
        match state {
            State::Stationary => self.reported_pose,
            State::RotationOnly | State::TranslationUnknown => {
                Pose::of_parts(*pose.rotation(), *self.reported_pose.translation())
            }
            _ => *pose,
        }
    }

    fn report_lost(&mut self, rig: &OdometryRig<T>, frame: &Frame<'_>, found: usize) -> Step<T> {
        self.lost = self.lost.saturating_add(1);
        self.velocity = None;
        let mut state = State::Lost;
        if self.lost > PATIENCE {
            self.forget();
            self.add_new_points(rig, frame);
            state = State::Restarted;
        }
        Step { points: self.points(), found, ..Step::none(state) }
    }

    /// What was seen makes the points surer, and they move into the new camera's frame.
    pub(super) fn carry(
        &mut self,
        rig: &OdometryRig<T>,
        frame: &Frame<'_>,
        solved: &Solved<T>,
        of_pose: &Matrix6<T>,
    ) {
        let pose = &solved.pose;
        let most = T::of(WIDTH * WIDTH);
        let baseline = rig.baseline();
        for point_match in &self.matches {
            let Some(track) = self.tracks.get_mut(usize::from(point_match.owner)) else { continue };
            let squared = Problem { matches: &[], baseline }.squared(pose, point_match);
            match squared
                .filter(|&d| d < most)
                .and_then(|_| track.point.updated(pose, &point_match.observation, baseline))
            {
                Some(point) => {
                    track.point = point;
                    track.wrong = 0;
                }
                None => {
                    track.wrong += 1;
                    track.now = None;
                }
            }
        }
        let doubt = of_pose * T::of(DOUBT);
        let (fx, fy) = rig.camera.focal_px();
        let ratio = (fx / fy).to_f64() as f32;
        for track in self.tracks.iter_mut().filter(|track| track.used) {
            let Some(moved) = track.point.moved(pose) else {
                track.used = false;
                continue;
            };
            let Some(point) = track.point.carried(pose, &doubt) else { continue };
            track.point = point;
            let of = |x: T| x.to_f64() as f32;
            let by = &moved.by_point;
            let step = [[of(by.m11), of(by.m12) * ratio], [of(by.m21) / ratio, of(by.m22)]];
            track.warp = product(&step, &track.warp);
            match track.now.take() {
                Some(pixel) => {
                    track.pixel = pixel;
                    track.seen = track.seen.saturating_add(1);
                    track.missed = 0;
                    let [[a, b], [c, d]] = track.warp;
                    let grown = (a * d - b * c).abs();
                    let fits = grown > GROWN[0] && grown < GROWN[1] && track.correlation > ALIKE;
                    if !fits && let Ok(template) = Template::cut(&frame.left, pixel[0], pixel[1]) {
                        track.template = template;
                        track.warp = UPRIGHT;
                    }
                }
                None => {
                    track.missed += 1;
                    if let Ok(pixel) = rig.camera.project(&Point3::new(point.at.x, point.at.y, T::ONE)) {
                        track.pixel = [of(pixel.x), of(pixel.y)];
                    }
                }
            }
            let [x, y] = track.pixel;
            let outside = !(x > 0.0 && y > 0.0 && x < self.size.0 as f32 && y < self.size.1 as f32);
            if track.missed > MISSED || track.wrong > WRONG || outside {
                track.used = false;
            }
        }
    }

    /// The median of the inverse depths that are known.
    pub(super) fn usual_depth(&self) -> Option<T> {
        // By halves of a range, for there is nowhere to sort.
        let deep = || {
            self.tracks.iter().filter(|track| track.used && track.is_deep(0.3)).map(|track| track.point.at.z)
        };
        let count = deep().count();
        if count < 4 {
            return None;
        }
        let below = |limit: T| deep().filter(|&r| r < limit).count();
        let (mut least, mut most) = (T::ZERO, deep().fold(T::ZERO, |most, r| most.max(r)));
        for _ in 0..24 {
            let middle = (least + most) * T::of(0.5);
            if 2 * below(middle) < count {
                least = middle;
            } else {
                most = middle;
            }
        }
        Some(most)
    }
}

/// A point whose depth is not known.
pub(super) fn unknown<T: Real>(observation: Vector3<T>, usual: T, sigma: T) -> InversePoint<T> {
    let variance = sigma * sigma;
    let covariance = Matrix3::from_diagonal(&Vector3::new(variance, variance, usual * usual));
    InversePoint { at: Vector3::new(observation.x, observation.y, usual), covariance }
}

/// The point as if it were at infinity.
pub(super) fn at_infinity<T: Real>(point: &InversePoint<T>, sigma: T) -> InversePoint<T> {
    let variance = sigma * sigma;
    let covariance = Matrix3::from_diagonal(&Vector3::new(variance, variance, T::ZERO));
    InversePoint { at: Vector3::new(point.at.x, point.at.y, T::ZERO), covariance }
}

/// The product of two small matrices.
pub(super) fn product(a: &[[f32; 2]; 2], b: &[[f32; 2]; 2]) -> [[f32; 2]; 2] {
    let row = |[x, y]: [f32; 2]| [x * b[0][0] + y * b[1][0], x * b[0][1] + y * b[1][1]];
    [row(a[0]), row(a[1])]
}

impl<T: Real, const N: usize> Default for Odometry<T, N> {
    fn default() -> Self {
        Self::new()
    }
}
