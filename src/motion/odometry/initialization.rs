//! Two-view initialization of monocular odometry: essential matrix or homography.

use super::config::OdometryRig;
use super::disparity::CORRELATED;
use super::frame::Moment;
use super::inverse_depth::InversePoint;
use super::list::List;
use super::motion_model::MotionModel;
use super::point_map::PointMap;
use super::pose_estimate::{FEWEST, Free, PointMatch, Problem, Solved};
use super::step::{State, Step};
use super::tracking::Tracker;
use super::whitening::PointObservation;
use crate::features::Template;
use crate::geometry::linear::covariance6;
use crate::geometry::{
    Real,
    camera::{Camera, Pose},
    robust::{RobustConfig, RobustError, robust_fundamental},
    two_view::{Correspondence, Essential, Homography},
};
use nalgebra::{Matrix6, Point2};

/// The threshold of the fundamental matrix, px.
const THRESHOLD_PX: f64 = 1.5;
/// How far points have to be off where a turn puts them, px, in the mean, before a step is looked for.
const PARALLAX_PX: f64 = 3.0;
/// The share that has to agree with the two views, and to be in front of both.
const AGREE: f64 = 0.6;
/// The most that is left of a turn's observations, squared deviations.
const MOST_SCALE: f64 = 1.4;
/// The share of the points that have to be left in view; below it the first view is another one.
const LEFT: f64 = 0.4;
/// Inverse depths that are expected, in baselines, and their deviation.
const USUAL: f64 = 0.1;

/// Takes a frame of one camera that has no unit of length yet: what is known of its motion, and the unit when
/// the two views give their relative pose.
pub(super) fn initialize<T: Real>(
    now: &Moment<'_, T>,
    map: &mut PointMap<'_, T>,
    tracker: &mut Tracker<'_, T>,
    motion: &mut MotionModel<T>,
    correspondences: &mut [Correspondence<T>],
) -> Step<T> {
    let points = map.len();
    let sigma = now.sigma();
    // Inverse depths of nothing until there is a unit: a rotation alone moves the points.
    map.used_mut().for_each(|track| track.point = track.point.at_infinity(sigma));
    let last = motion.reported_pose;
    tracker.recognise(now, map, &last, now.config.far_px);
    align(now, map, tracker);
    let found = tracker.matches.len();
    let shown = Step { points, found, ..Step::none(State::Waiting) };
    if found < 2 * FEWEST {
        return restart(now, map, motion, shown);
    }
    let problem = tracker.problem(T::ZERO);
    let rotated = problem.solve(last, Free::Rotation);
    let still = problem.solve(last, Free::Nothing);
    let scale = (rotated.squares / T::count(rotated.numbers.saturating_sub(3).max(1))).max(T::of(0.05));
    // A wall that is passed moves nearly as by a rotation: what is left has to be noise.
    let is_rotation = T::count(rotated.kept) >= T::count(found) * T::of(0.85) && scale < T::of(MOST_SCALE);
    let step = if is_rotation {
        let no_turn = (still.cost - rotated.cost) / scale < T::of(21.0);
        let state = if no_turn && scale < T::of(2.0) { State::Stationary } else { State::RotationOnly };
        report_rotation(motion, &rotated, state, shown)
    } else {
        let (matches, turn, seed) = (&tracker.matches, &rotated.pose, now.config.seed);
        if let Some(pose) = two_views(now.rig, matches, turn, seed, tracker.inliers, correspondences) {
            return set_unit(now, map, tracker, motion, &pose, shown);
        }
        shown
    };
    if T::count(found) < T::count(points) * T::of(LEFT) { restart(now, map, motion, step) } else { step }
}

/// Reports a rotation, or no motion, since the last frame.
fn report_rotation<T: Real>(
    motion: &mut MotionModel<T>,
    solved: &Solved<T>,
    state: State,
    shown: Step<T>,
) -> Step<T> {
    let pose = if state == State::Stationary { motion.reported_pose } else { solved.pose };
    let since = motion.reported_pose.inverse().then(&pose);
    motion.reported_pose = pose;
    let all = covariance6(&solved.information);
    let mut covariance = Matrix6::identity() * T::of(1e12);
    covariance.fixed_view_mut::<3, 3>(0, 0).copy_from(&all.fixed_view::<3, 3>(0, 0));
    if state == State::Stationary {
        covariance = all;
    }
    Step { motion: since, covariance, state, inliers: solved.kept, residual: solved.residual(0), ..shown }
}

/// Finds each point by its pixels: where it was recognised, or where it was seen last. Few corners of a small
/// picture are found again by their descriptors, and without a unit their places cannot be predicted.
fn align<T: Real>(now: &Moment<'_, T>, map: &mut PointMap<'_, T>, tracker: &mut Tracker<'_, T>) {
    let fine = now.sigma();
    tracker.matches.clear();
    for (owner, track) in (0_u16..).zip(map.tracks.iter_mut()).filter(|(_, track)| track.used) {
        let start = track.now.unwrap_or(track.pixel);
        let aligned = track.template.align(&now.frame.left, &Template::UPRIGHT, start, 3.0).ok();
        let aligned = aligned.filter(|found| found.correlation > CORRELATED);
        let Some(place) = aligned.map(|found| [found.x_px, found.y_px]).or(track.now) else { continue };
        (track.now, track.pixel) = (Some(place), place);
        let pixel = Point2::new(T::of(place[0].into()), T::of(place[1].into()));
        let Ok(at) = now.rig.camera.unproject(&pixel) else { continue };
        // A corner is three times as far off as what its pixels say.
        let sigma = if aligned.is_some() { fine } else { fine * T::of(3.0) };
        let observation = PointObservation { at, in_right: false, sigma };
        tracker.matches.push(PointMatch { point: track.point, observation, lower_px: 0.0, owner });
    }
}

/// Makes the way to this frame the unit of length.
fn set_unit<T: Real>(
    now: &Moment<'_, T>,
    map: &mut PointMap<'_, T>,
    tracker: &mut Tracker<'_, T>,
    motion: &mut MotionModel<T>,
    pose: &Pose<T>,
    shown: Step<T>,
) -> Step<T> {
    let matches = &mut tracker.matches;
    for point_match in matches.iter_mut() {
        let point = &mut point_match.point;
        *point = InversePoint::of_unknown_depth(&point.at, T::of(USUAL), now.sigma());
        point.covariance.m33 *= T::of(9.0);
        if let Some(track) = map.tracks.get_mut(usize::from(point_match.owner)) {
            track.point = *point;
        }
    }
    // Points that were not found have no depth.
    for (number, track) in (0_u16..).zip(map.tracks.iter_mut()) {
        track.used = track.used && matches.iter().any(|p| p.owner == number);
    }
    let since = motion.reported_pose.inverse().then(pose);
    map.update(now, matches, pose, &Matrix6::zeros());
    // The pose by the points that it has given a depth.
    for point_match in matches.iter_mut() {
        if let Some(point) = point_match.point.updated(pose, &point_match.observation, T::ZERO) {
            point_match.point = point;
        }
    }
    let solved =
        Problem { matches: &*matches, baseline: T::ZERO, doubt: T::ZERO }.solve(*pose, Free::Nothing);
    motion.begin_at_unit();
    map.add_new(now);
    let (covariance, residual) = (covariance6(&solved.information), solved.residual(0));
    Step { motion: since, covariance, state: State::Tracked, inliers: solved.kept, residual, ..shown }
}

/// Makes this view the first one.
fn restart<T: Real>(
    now: &Moment<'_, T>,
    map: &mut PointMap<'_, T>,
    motion: &mut MotionModel<T>,
    step: Step<T>,
) -> Step<T> {
    map.clear();
    motion.reported_pose = Pose::identity();
    map.add_new(now);
    let state = if step.state == State::Waiting { State::Restarted } else { step.state };
    Step { points: map.len(), state, ..step }
}

/// The pose of the second view in units of the baseline, if it is sure. There is room for two correspondences
/// of each match: one list of all, one of the inliers.
fn two_views<T: Real>(
    rig: &OdometryRig<T>,
    matches: &[PointMatch<T>],
    turn: &Pose<T>,
    seed: u64,
    inliers: &mut [bool],
    correspondences: &mut [Correspondence<T>],
) -> Option<Pose<T>> {
    let focal = rig.focal();
    let pinhole = Camera::new(focal, focal, T::ZERO, T::ZERO).ok()?;
    let half = correspondences.len() / 2;
    let (all, inlying) = correspondences.split_at_mut_checked(half)?;
    let (mut all_len, mut inlying_len) = (0, 0);
    let mut seen = List { places: all, len: &mut all_len };
    let mut off = T::ZERO;
    for point_match in matches {
        let (a, b) = (point_match.point.at * focal, point_match.observation.at * focal);
        seen.push(Correspondence::new(a.x, a.y, b.x, b.y));
        if let Some(moved) = point_match.point.moved(turn) {
            off += ((moved.at - point_match.observation.at).xy() * focal).norm().min(T::of(20.0));
        }
    }
    if off < T::count(seen.len()) * T::of(PARALLAX_PX) {
        return None;
    }
    let config = RobustConfig { seed, most_samples: 2000, ..RobustConfig::new(T::of(THRESHOLD_PX)) };
    let found = robust_fundamental(&seen, &config, inliers);
    let kept = || seen.iter().zip(inliers.iter()).filter(|&(_, &inlier)| inlier).map(|(s, _)| *s);
    let agreeing = T::count(kept().count());
    if agreeing < T::count(seen.len()) * T::of(AGREE) {
        return None;
    }
    let essential = match found {
        Ok(found) => Essential::from_fundamental(&found.fundamental, &pinhole, &pinhole).ok()?,
        Err(RobustError::Plane) => {
            let mut on_plane = List { places: inlying, len: &mut inlying_len };
            kept().for_each(|s| on_plane.push(s));
            let homography = Homography::from_correspondences(&on_plane).ok()?;
            // Two motions may have all points in front: only one that is alone is sure.
            let [(first, votes), (_, others)] =
                homography.recover_motions(kept(), &pinhole, &pinhole).ok()?;
            if votes == others {
                return None;
            }
            Essential::from_pose(&first.relative_pose()?.in_baselines()).ok()?
        }
        Err(_) => return None,
    };
    let refined = essential.refined(&seen, &pinhole, &pinhole, T::of(THRESHOLD_PX)).ok()?;
    let recovered = refined.recover_pose(kept(), &pinhole, &pinhole).ok()?;
    let front = T::count(recovered.in_front);
    (front >= T::count(recovered.voters) * T::of(0.8) && front >= agreeing * T::of(0.5))
        .then(|| recovered.pose.in_baselines())
}
