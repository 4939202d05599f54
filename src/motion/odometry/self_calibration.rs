//! Self-calibration of a moving pair: an information filter on the right camera (Dang et al. 2009).
//!
//! A disparity that is off by o puts a point at `f b / (d + o)`. How far points move between two pictures of
//! the left camera is linear in their inverse depths: where it is not zero for those that the pair sees at
//! infinity, the pair is off. So the error is estimated beside the motion from points that both views of both
//! cameras see, with what was known of it before as a prior. A roll and another focal length move columns,
//! too, and would be taken for it; they show in rows, and are known from there.

use super::config::OdometryRig;
use super::frame::Moment;
use super::pose_estimate::PointMatch;
use super::right_error::RightError;
use super::right_rows::RightRows;
use super::track::Track;
use super::two_views::PairOfViews;
use crate::geometry::linear::{NormalEquations, inverse_information, levenberg_marquardt};
use crate::geometry::{Real, camera::Pose};
use nalgebra::Vector3;

/// Deviation of both numbers before anything is seen: of a focal length, and of a radian.
const PRIOR: f64 = 0.005;
/// What they may drift between two measurements, one deviation.
const DRIFT: f64 = 1e-5;
/// A deviation of the pair's disparity, px, from which on the estimate is sure, and the measurements that are
/// behind it at least.
const SURE_PX: f64 = 0.1;
const SURE_PAIRS: u32 = 3;
/// What is corrected is over so many px and deviations.
const LEAST_PX: f64 = 0.05;
const DEVIATIONS: f64 = 2.0;
/// Rows that are off by more in the middle are corrected, px: partners are looked for within a few.
const LEAST_ROW_PX: f64 = 0.25;
/// Two views are compared when fewer than four fifths of the points are left, or after so many frames: of a
/// longer way each point says more, of a shorter one more of them do.
const MOST_FRAMES: u8 = 16;
/// Points that two views have in common at least.
const FEWEST: usize = 24;
/// What all measurements may have in common, one deviation, px: how a template's place is biased.
const FLOOR_PX: f64 = 0.02;
/// Neighbouring measurements share a view, and so count half.
const SHARED: f64 = 2.0;
/// The least variance of the noise, in that which is configured.
const LEAST_NOISE: f64 = 0.04;
/// Steps of the descent.
const STEPS: usize = 6;
/// Measurements over which the innovations are averaged.
const MEMORY: u32 = 32;

/// What is known of the right camera beyond what is corrected already.
#[derive(Clone, Copy, Debug)]
pub(super) struct SelfCalibration<T: Real> {
    mean: RightError<T>,
    rows: RightRows<T>,
    covariance: [[T; 2]; 2],
    /// The mean square of the innovations, in what they are expected to be.
    excess: T,
    /// The motion since the view that the points are anchored in.
    since: Pose<T>,
    frames: u8,
    anchored: usize,
    pairs: u32,
    is_applied: bool,
}

/// How a pair differs from its calibration, as its points' motion and their rows show.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RigEstimate<T> {
    /// What has to be added to a disparity in the middle of the right picture, px.
    pub disparity_px: T,
    /// Standard deviation of that, px.
    pub sigma_px: T,
    /// What has to be added to the column of the right camera's principal point, px: `disparity_px` is that
    /// less the focal length times `yaw_rad`, of which a narrow picture hardly tells the parts apart.
    pub principal_px: T,
    /// How far the right camera is turned to the right, radians.
    pub yaw_rad: T,
    /// Covariance of `principal_px` and `yaw_rad`.
    pub covariance: [[T; 2]; 2],
    /// How much lower the right picture shows the middle than the left one, px, by the rows of the points.
    pub lower_px: T,
    /// How far the right camera is turned about its own axis, radians: what is on its right stands lower.
    pub roll_rad: T,
    /// How many times as large as the left picture the right one is.
    pub scale: T,
    /// Pairs of views that were compared.
    pub pairs: u32,
    /// Whether there is enough behind it, to a tenth of a pixel, to correct the pair by.
    pub is_sure: bool,
    /// Whether the pair is corrected by it.
    pub is_applied: bool,
}

impl<T: Real> RigEstimate<T> {
    /// Whether disparities in the middle are off by more than two deviations and 0.2 px.
    pub fn is_off(&self) -> bool {
        let off = self.disparity_px.abs();
        self.is_sure && off > self.sigma_px * T::of(2.0) && off > T::of(0.2)
    }
}

impl<T: Real> SelfCalibration<T> {
    /// Of no pair. All zeros.
    pub const EMPTY: Self = Self {
        mean: RightError::NONE,
        rows: RightRows::EMPTY,
        covariance: [[T::ZERO; 2]; 2],
        excess: T::ZERO,
        since: Pose::NOTHING,
        frames: 0,
        anchored: 0,
        pairs: 0,
        is_applied: false,
    };

    /// Before the first frame: no more is known than what the rig is corrected by.
    pub fn reset(&mut self, rig: &OdometryRig<T>) {
        let (p, o) = (T::of(PRIOR * PRIOR), T::ZERO);
        let is_applied = rig.error != RightError::NONE;
        *self = Self { covariance: [[p, o], [o, p]], since: Pose::identity(), is_applied, ..Self::EMPTY };
    }

    /// Before a first frame again: what is known counts a hundredth, for frames that are seen again say
    /// nothing new.
    pub fn begin_again(&mut self) {
        self.covariance = self.covariance.map(|row| row.map(|x| x * T::of(100.0)));
        (self.since, self.frames, self.anchored) = (Pose::identity(), 0, 0);
    }

    /// The estimate, with what is corrected already.
    pub fn estimate(&self, rig: &OdometryRig<T>) -> RigEstimate<T> {
        let (f, all) = (rig.focal(), rig.error.plus(&self.mean));
        let more = self.excess.max(T::ONE);
        let [[a, b], [_, d]] = self.covariance.map(|row| row.map(|x| x * more));
        let floor = T::of(FLOOR_PX * FLOOR_PX);
        let sigma_px = ((a - b - b + d).max(T::ZERO) * f * f + floor).sqrt();
        RigEstimate {
            disparity_px: all.in_middle() * f,
            sigma_px,
            principal_px: all.principal * f,
            yaw_rad: all.yaw,
            covariance: [[a * f * f, b * f], [b * f, d]],
            lower_px: all.row * f,
            roll_rad: all.roll,
            scale: T::ONE + all.scale,
            pairs: self.pairs,
            is_sure: self.pairs >= SURE_PAIRS && sigma_px < T::of(SURE_PX),
            is_applied: self.is_applied,
        }
    }

    /// Takes the `motion` of a frame into which the points have been moved, also where the frame itself is
    /// not measured.
    pub fn moved(&mut self, motion: &Pose<T>) {
        self.since = self.since.then(motion);
        self.frames = self.frames.saturating_add(1);
    }

    /// Takes a frame whose motion is known and taken. Once the estimate is sure, and if it is asked for, the
    /// rig is corrected, and the points with it.
    pub fn step(
        &mut self,
        now: &Moment<'_, T>,
        rig: &mut OdometryRig<T>,
        tracks: &mut [Track<T>],
        matches: &[PointMatch<T>],
    ) {
        if rig.right.is_none() {
            return;
        }
        self.rows.add(now, matches);
        let [row, roll, scale] = self.rows.error();
        let is = rig.error;
        self.mean =
            RightError { row: row - is.row, roll: roll - is.roll, scale: scale - is.scale, ..self.mean };
        let pair = PairOfViews {
            tracks: &*tracks,
            matches,
            baseline: rig.baseline(),
            sigma: now.sigma(),
            mean: self.mean,
            information: self.information(),
        };
        let common = pair.common().count();
        if self.frames < MOST_FRAMES && 5 * common > 4 * self.anchored {
            return;
        }
        let before = rig.error;
        if common >= FEWEST {
            self.measure(&pair);
            let found = self.estimate(rig);
            let px = |x: T| x.abs() * rig.focal();
            let (off, aside) = (px(self.mean.in_middle()), px(self.mean.aside()));
            let is_off = [
                off > T::of(LEAST_PX) && off > found.sigma_px * T::of(DEVIATIONS),
                aside > T::of(LEAST_PX) || px(self.mean.row) > T::of(LEAST_ROW_PX),
            ];
            if now.config.corrects_rig && found.is_sure {
                self.apply(rig, tracks, is_off);
            }
        }
        self.anchor(rig, &before, tracks, matches);
    }

    /// Points that this view sees in both pictures are followed from here. The disparities of the matches
    /// were corrected by `before`.
    pub fn anchor(
        &mut self,
        rig: &OdometryRig<T>,
        before: &RightError<T>,
        tracks: &mut [Track<T>],
        matches: &[PointMatch<T>],
    ) {
        tracks.iter_mut().for_each(|track| {
            // New ones have the depth that the right picture says.
            let (at, is_new) = (track.point.at, track.used && track.seen == 1 && track.missed == 0);
            track.anchor = is_new.then(|| Vector3::new(at.x, at.y, at.z * rig.baseline()));
        });
        for found in matches.iter().filter(|found| found.observation.in_right) {
            if let Some(track) = tracks.get_mut(usize::from(found.owner)).filter(|track| track.is_followed())
            {
                let at = found.observation.at;
                let place = [at.x - at.z, at.y];
                let z = at.z + rig.error.correction(place) - before.correction(place);
                track.anchor = Some(Vector3::new(at.x, at.y, z));
            }
        }
        self.anchored = tracks.iter().filter(|track| track.anchor.is_some()).count();
        (self.since, self.frames) = (Pose::identity(), 0);
    }

    /// One step of the filter.
    fn measure(&mut self, pair: &PairOfViews<'_, T>) {
        for (i, row) in self.covariance.iter_mut().enumerate() {
            row.iter_mut().skip(i).take(1).for_each(|x| *x += T::of(DRIFT * DRIFT));
        }
        let start = (self.since, self.mean);
        let Some(((pose, error), _)) = levenberg_marquardt(pair, start, STEPS) else { return };
        // What the points alone say there, in units of the noise that there is.
        let (data, kept, squares) = pair.equations_of_points(&pose, &error);
        if kept < FEWEST {
            return;
        }
        // Of each point six numbers are seen and three are found.
        let noise = squares / T::count((3 * kept).saturating_sub(8).max(1));
        let scale = T::ONE / (noise.max(T::of(LEAST_NOISE)) * T::of(SHARED));
        let mut all = NormalEquations::<T, 8>::new();
        for (to, from) in all.matrix.iter_mut().zip(&data.matrix) {
            to.iter_mut().zip(from).for_each(|(to, &from)| *to = from * scale);
        }
        all.right = data.right.map(|x| x * scale);
        pair.add_prior(&mut all, &error);
        let covariance = inverse_information(&all.matrix);
        let [.., principal, yaw] = covariance;
        let step = |row: &[T; 8]| row.iter().zip(&all.right).fold(T::ZERO, |sum, (&a, &b)| sum + a * b);
        let [by_principal, by_yaw] = [step(&principal), step(&yaw)];
        let mean = error.plus(&RightError { principal: by_principal, yaw: by_yaw, ..RightError::NONE });
        let [[.., a, b], [.., d]] = [principal, yaw];
        if !(a > T::ZERO && d > T::ZERO && mean.principal.is_finite() && mean.yaw.is_finite()) {
            return;
        }
        // The middle's innovation beside its own variance: one if all is as it is taken to be.
        let [[p, q], [_, r]] = self.covariance;
        let gained = (p - q - q + r) - (a - b - b + d);
        let moved = mean.in_middle() - self.mean.in_middle();
        if gained > T::ZERO {
            let share = T::ONE / T::count(self.pairs.saturating_add(1).min(MEMORY) as usize);
            self.excess += (moved * moved / gained - self.excess) * share;
        }
        (self.mean, self.covariance) = (mean, [[a, b], [b, d]]);
        self.pairs = self.pairs.saturating_add(1);
    }

    /// The inverse of the covariance.
    fn information(&self) -> [[T; 2]; 2] {
        let [[a, b], [_, d]] = self.covariance;
        let by = T::ONE / (a * d - b * b).max(T::of(1e-30));
        [[d * by, -b * by], [-b * by, a * by]]
    }

    /// Corrects the rig by those parts of the estimate that are off, and by those that it was corrected by
    /// before, and the points that were placed without it.
    fn apply(&mut self, rig: &mut OdometryRig<T>, tracks: &mut [Track<T>], is_off: [bool; 2]) {
        let (mut by, mut left) = (RightError::NONE, RightError::NONE);
        for ((part, before), is_off) in self.mean.parts().iter().zip(rig.error.parts()).zip(is_off) {
            let to = if is_off || before != RightError::NONE { &mut by } else { &mut left };
            *to = to.plus(part);
        }
        let baseline = rig.baseline();
        for track in tracks.iter_mut().filter(|track| track.used) {
            let at = &mut track.point.at;
            let place = [at.x - baseline * at.z, at.y];
            at.z += by.correction(place) / baseline;
        }
        rig.error = rig.error.plus(&by);
        self.mean = left;
        self.is_applied |= by != RightError::NONE;
    }
}
