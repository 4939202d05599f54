//! Hypothesis tests of the motion: lost, stationary, rotation only, or rotation and translation.

use super::config::OdometryRig;
use super::motion_model::MotionModel;
use super::point_map::PointMap;
use super::pose_estimate::{FEWEST, Free, Problem, Solved};
use super::step::State;
use super::tracking::Tracker;
use crate::geometry::linear::covariance6;
use crate::geometry::{Real, camera::Pose};

/// The hypothesis that a frame's observations support.
#[derive(Clone, Copy, Debug)]
pub(super) enum MotionTest<T: Real> {
    /// Too few agree.
    Lost,
    /// The pose, and how much of it is known.
    Known(Solved<T>, State),
}

/// Squared deviations by which a motion of six numbers, and a step of three, has to explain the
/// observations better than none does: with noise alone it is more once in 10 000 times.
const SIX: f64 = 28.0;
const THREE: f64 = 21.0;
/// The share of what was found that has to agree.
const SHARE: f64 = 0.3;
/// Deviation of a step, in baselines, from which on a step that may be none is not known.
const UNKNOWN: f64 = 0.1;
/// Deviation of a step, in baselines, up to which a camera stands whose pictures are the same.
const SHOWN: f64 = 1.0;
/// Deviation of a step, in baselines, from which on no step is known.
const OPEN: f64 = 100.0;
/// Deviation of a step, in its own length or baselines, and of a turn, radians, from which on a pose is not
/// sure.
const UNSURE_STEP: f64 = 0.1;
const UNSURE_TURN: f64 = 0.01;
/// The share of the longer of two motions that they may differ by when few points say so, and the points that
/// are not few.
const JUMP: f64 = 0.5;
const MANY: usize = 48;
/// The share of what was found that agrees with a pair that sees as it was calibrated, but for what moves by
/// itself.
const PAIR_SHARE: f64 = 0.7;
/// What the pair's disparities are taken to be off by where they disagree with all that is known, px.
const DOUBTED_PX: f64 = 1.0;

/// Decides by tests of hypotheses what the matches of a frame show of the camera's motion.
pub(super) fn test_motion<T: Real>(
    tracker: &mut Tracker<'_, T>,
    map: &mut PointMap<'_, T>,
    rig: &OdometryRig<T>,
    motion: &MotionModel<T>,
    start: Option<Pose<T>>,
) -> MotionTest<T> {
    let Some(start) = start else { return MotionTest::Lost };
    let found = tracker.matches.len();
    let is_enough =
        |solved: &Solved<T>| solved.kept >= FEWEST && T::count(solved.kept) >= T::count(found) * T::of(SHARE);
    let baseline = rig.baseline();
    let (mut all, mut is_jump) = likeliest(&tracker.problem(baseline), motion, start);
    let mut is_left_only = false;
    if rig.right.is_some() && T::count(all.kept) < T::count(found) * T::of(PAIR_SHARE) {
        // Whether it is the pair that disagrees: by the left camera alone more then agree.
        let deviation = T::of(DOUBTED_PX) / (rig.focal() * baseline);
        let doubted = Problem { doubt: deviation * deviation, ..tracker.problem(baseline) };
        let (left, jumps) = likeliest(&doubted, motion, start);
        if is_enough(&left) && 4 * left.kept >= 5 * all.kept {
            (all, is_jump, is_left_only) = (left, jumps, true);
            doubt_right(tracker, map, deviation * deviation);
        }
    }
    if !is_enough(&all) {
        return MotionTest::Lost;
    }
    if is_jump {
        return MotionTest::Known(all, State::Uncertain);
    }
    let problem = tracker.problem(baseline);
    // In units of the noise that there is.
    let scale = (all.squares / T::count(all.numbers.saturating_sub(6).max(1))).max(T::of(0.05));
    let gain = |other: &Solved<T>| (other.cost - all.cost) / scale;
    let deviation = step_deviation(&all);
    let unit = match rig.right {
        Some((baseline, _)) => baseline,
        // Of one camera the last step is as good a unit as any.
        None => motion.last_step * T::of(10.0),
    };
    let still = problem.solve(motion.reported_pose, Free::Nothing);
    // Points too far away have no slope by a step: with them alone any step costs as much as none.
    // What few points cost is bounded, so that the poses of none of them may seem as good as any.
    if deviation <= unit * T::of(SHOWN) && gain(&still) < T::of(SIX) && is_enough(&still) {
        return MotionTest::Known(still, State::Stationary);
    }
    let was_lost = motion.was_lost();
    let state = if was_lost { State::Found } else { State::Tracked };
    let turn = Pose::of_parts(*all.pose.rotation(), *motion.reported_pose.translation());
    let turned = problem.solve(turn, Free::Rotation);
    let is_none = gain(&turned) < T::of(THREE) && is_enough(&turned);
    let is_open = !(deviation <= unit * T::of(OPEN));
    if is_open && !is_enough(&turned) {
        return MotionTest::Lost;
    }
    if is_open || (is_none && deviation > unit * T::of(UNKNOWN)) {
        return MotionTest::Known(turned, State::TranslationUnknown);
    }
    if is_none && rig.right.is_none() {
        return MotionTest::Known(turned, State::RotationOnly);
    }
    let state = match state {
        _ if is_unsure(&all, rig, motion) => State::Uncertain,
        _ if is_left_only => State::LeftOnly,
        state => state,
    };
    MotionTest::Known(all, state)
}

/// The likeliest pose, and whether it is a motion that few points say and that differs much from the last one
/// that was sure. Of two such motions that points agree with the one that goes on as before is taken, for a
/// camera is heavier than what most points are on.
fn likeliest<T: Real>(
    problem: &Problem<'_, T>,
    motion: &MotionModel<T>,
    start: Pose<T>,
) -> (Solved<T>, bool) {
    let all = problem.solve(start, Free::All);
    let jumps = |solved: &Solved<T>| {
        solved.kept < MANY && motion.sure.is_some_and(|sure| differs(&sure, &step_of(solved, motion), solved))
    };
    // Where much moves by itself the start may be near a pose of that; as fast as before is another one.
    match motion.predicted().map(|pose| problem.solve(pose, Free::All)) {
        Some(other) if other.cost < all.cost => (other, jumps(&other)),
        Some(other)
            if other.kept >= FEWEST && 4 * other.kept >= all.kept && jumps(&all) && !jumps(&other) =>
        {
            (other, true)
        }
        _ => (all, jumps(&all)),
    }
}

/// The motion from the last reported pose.
fn step_of<T: Real>(solved: &Solved<T>, motion: &MotionModel<T>) -> Pose<T> {
    motion.reported_pose.inverse().then(&solved.pose)
}

/// Whether two steps differ by more than a half of the longer one and three deviations.
fn differs<T: Real>(sure: &Pose<T>, step: &Pose<T>, solved: &Solved<T>) -> bool {
    let longer = sure.translation().norm().max(step.translation().norm());
    let apart = (sure.translation() - step.translation()).norm();
    apart > longer * T::of(JUMP) + step_deviation(solved) * T::of(3.0)
}

/// Whether the covariance of a pair's pose is large beside its step, or beside what a turn may be off by.
fn is_unsure<T: Real>(solved: &Solved<T>, rig: &OdometryRig<T>, motion: &MotionModel<T>) -> bool {
    // Of one camera a step is as sure as its unit.
    let Some((baseline, _)) = rig.right else { return false };
    let c = covariance6(&solved.information) * solved.residual(6).max(T::ONE).powi(2);
    let turn = c[(0, 0)].max(c[(1, 1)]).max(c[(2, 2)]).sqrt();
    let shift = c[(3, 3)].max(c[(4, 4)]).max(c[(5, 5)]).sqrt();
    let ruler = step_of(solved, motion).translation().norm().max(baseline);
    shift > ruler * T::of(UNSURE_STEP) || turn > T::of(UNSURE_TURN)
}

/// Takes what the right camera sees out of the observations, and adds so much variance to inverse depths.
fn doubt_right<T: Real>(tracker: &mut Tracker<'_, T>, map: &mut PointMap<'_, T>, doubt: T) {
    for point_match in tracker.matches.iter_mut() {
        *point_match = point_match.doubted(doubt);
        if let Some(track) = map.tracks.get_mut(usize::from(point_match.owner)) {
            track.point = point_match.point;
        }
    }
}

/// The largest deviation of the step along an axis.
fn step_deviation<T: Real>(solved: &Solved<T>) -> T {
    let c = covariance6(&solved.information);
    c[(3, 3)].max(c[(4, 4)]).max(c[(5, 5)]).sqrt()
}
