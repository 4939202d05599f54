//! Hypothesis tests of the motion: lost, stationary, rotation only, or rotation and translation.

use super::config::OdometryRig;
use super::motion_model::MotionModel;
use super::pose_estimate::{FEWEST, Free, Solved};
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
/// Deviation of a step, in baselines, from which on no step is known.
const OPEN: f64 = 100.0;

/// Decides by tests of hypotheses what the matches of a frame show of the camera's motion.
pub(super) fn test_motion<T: Real>(
    tracker: &Tracker<'_, T>,
    rig: &OdometryRig<T>,
    motion: &MotionModel<T>,
    start: Option<Pose<T>>,
) -> MotionTest<T> {
    let problem = tracker.problem(rig.baseline());
    let Some(start) = start else { return MotionTest::Lost };
    let all = problem.solve(start, Free::All);
    // Where much moves by itself the start may be near a pose of that; as fast as before is another one.
    let all = match motion.predicted().map(|pose| problem.solve(pose, Free::All)) {
        Some(other) if other.cost < all.cost => other,
        _ => all,
    };
    let found = tracker.matches.len();
    if all.kept < FEWEST || T::count(all.kept) < T::count(found) * T::of(SHARE) {
        return MotionTest::Lost;
    }
    // In units of the noise that there is.
    let scale = (all.squares / T::count(all.numbers.saturating_sub(6).max(1))).max(T::of(0.05));
    let gain = |other: &Solved<T>| (other.cost - all.cost) / scale;
    let still = problem.solve(motion.reported_pose, Free::Nothing);
    if gain(&still) < T::of(SIX) {
        return MotionTest::Known(still, State::Stationary);
    }
    let was_lost = motion.was_lost();
    let state = if was_lost { State::Found } else { State::Tracked };
    let turn = Pose::of_parts(*all.pose.rotation(), *motion.reported_pose.translation());
    let turned = problem.solve(turn, Free::Rotation);
    let deviation = step_deviation(&all);
    let unit = match rig.right {
        Some((baseline, _)) => baseline,
        // Of one camera the last step is as good a unit as any.
        None => motion.velocity.map_or(T::ONE, |v| v.translation().norm()) * T::of(10.0),
    };
    let is_none = gain(&turned) < T::of(THREE);
    if deviation > unit * T::of(OPEN) || (is_none && deviation > unit * T::of(UNKNOWN)) {
        return MotionTest::Known(turned, State::TranslationUnknown);
    }
    if is_none && rig.right.is_none() {
        return MotionTest::Known(turned, State::RotationOnly);
    }
    MotionTest::Known(all, state)
}

/// The largest deviation of the step along an axis.
fn step_deviation<T: Real>(solved: &Solved<T>) -> T {
    let c = covariance6(&solved.information);
    c[(3, 3)].max(c[(4, 4)]).max(c[(5, 5)]).sqrt()
}
