//! Constant-velocity motion model, and the pose that was reported last.

use super::step::State;
use crate::geometry::{Real, camera::Pose};
use nalgebra::{Matrix6, Vector6};

/// Frames for which points are kept that are not found again. A pair knows the depths of new points at once:
/// where it sees enough of them it waits for fewer frames.
const PATIENCE: u8 = 5;
const PAIR_PATIENCE: u8 = 2;
/// Frames after which a motion that was not sure is taken for the motion.
const UNSURE: u8 = 8;

/// The motion so far, in the frame of the map.
#[derive(Debug)]
pub(super) struct MotionModel<T: Real> {
    /// The motion of the last frame, if it is known.
    pub velocity: Option<Pose<T>>,
    /// The last pose that was reported.
    pub reported_pose: Pose<T>,
    /// The motion of the last frame that was sure of it, and the frames since then that were not.
    pub sure: Option<Pose<T>>,
    unsure: u8,
    /// Frames since something was known.
    lost: u8,
    /// Whether there is a unit of length.
    pub has_unit: bool,
    /// The length of the last sure motion with a step, in the map's unit: the camera's measure while it turns
    /// or stands, when its velocity has no length.
    pub last_step: T,
}

impl<T: Real> MotionModel<T> {
    pub const fn new() -> Self {
        // The first frame sets the pose.
        let (reported_pose, last_step) = (Pose::NOTHING, T::ZERO);
        Self { velocity: None, reported_pose, sure: None, unsure: 0, lost: 0, has_unit: false, last_step }
    }

    /// Forgets the motion; a pair has a unit of length at once. The first step of one camera is its unit.
    pub fn reset(&mut self, is_pair: bool) {
        let (reported_pose, last_step) = (Pose::identity(), T::ONE);
        *self = Self { reported_pose, has_unit: is_pair, last_step, ..Self::new() };
    }

    /// The way so far has become one camera's unit of length, and its end the place of the map. What it went
    /// in the last frame alone is not known: the whole way would predict the next one many times too far.
    pub fn begin_at_unit(&mut self) {
        (self.has_unit, self.reported_pose, self.velocity) = (true, Pose::identity(), None);
    }

    /// The pose that the last velocity predicts.
    pub fn predicted(&self) -> Option<Pose<T>> {
        self.velocity.map(|velocity| self.reported_pose.then(&velocity))
    }

    /// Whether the last frame was lost.
    pub fn was_lost(&self) -> bool {
        self.lost > 0
    }

    /// Counts a frame whose pose is not known; whether there have been so many that all begins anew. A pair
    /// that `sees_enough` waits for fewer.
    pub fn lose(&mut self, sees_enough: bool) -> bool {
        self.lost = self.lost.saturating_add(1);
        self.velocity = None;
        self.lost > if sees_enough { PAIR_PATIENCE } else { PATIENCE }
    }

    /// Takes a motion and what is known of it; the velocity that predicts the next frame: that of the last
    /// motion that was sure, for as long as that is not long ago.
    pub fn velocity_after(&mut self, motion: Pose<T>, state: State) -> Pose<T> {
        let is_sure = !matches!(state, State::Uncertain | State::TranslationUnknown);
        let length = motion.translation().norm();
        if is_sure && state != State::RotationOnly && length > T::ZERO {
            self.last_step = length;
        }
        self.unsure = if is_sure { 0 } else { self.unsure.saturating_add(1) };
        match self.sure {
            Some(sure) if !is_sure && self.unsure <= UNSURE => sure,
            _ => {
                self.sure = Some(motion);
                self.unsure = 0;
                motion
            }
        }
    }

    /// What a motion that is not sure may be off by besides what its observations say: its difference from
    /// the last sure one, in every direction, as a covariance of turn and step. None of one that is sure.
    pub fn doubt(&self, motion: &Pose<T>, state: State) -> Matrix6<T> {
        let Some(sure) = self.sure.filter(|_| state == State::Uncertain) else { return Matrix6::zeros() };
        let (turn, step) =
            (sure.inverse().then(motion).angle_rad(), motion.translation() - sure.translation());
        let (turn, step) = (turn * turn, step.norm_squared());
        Matrix6::from_diagonal(&Vector6::new(turn, turn, turn, step, step, step))
    }

    /// The motion to a pose as far as the state says that it is known, which becomes the reported pose.
    pub fn report(&mut self, pose: &Pose<T>, state: State) -> Pose<T> {
        let pose = match state {
            State::Stationary => self.reported_pose,
            State::RotationOnly | State::TranslationUnknown => {
                Pose::of_parts(*pose.rotation(), *self.reported_pose.translation())
            }
            _ => *pose,
        };
        self.lost = 0;
        let motion = self.reported_pose.inverse().then(&pose);
        self.reported_pose = pose;
        motion
    }

    /// The map has moved into the frame of a camera at this pose. Motions are predicted from motions: what
    /// rounding leaves of a rotation would grow by more than three times with each.
    pub fn rebase(&mut self, pose: &Pose<T>, velocity: Pose<T>) {
        self.reported_pose = pose.inverse().then(&self.reported_pose).orthonormal();
        self.velocity = Some(velocity.orthonormal());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Vector3};

    fn step(z: f64) -> Pose<f64> {
        Pose::of_parts(Matrix3::identity(), Vector3::new(0.0, 0.0, z))
    }

    #[test]
    fn the_way_to_the_unit_predicts_no_step() {
        let mut motion = MotionModel::<f64>::new();
        motion.reset(false);
        motion.begin_at_unit();
        assert!(motion.has_unit && motion.predicted().is_none());
        let velocity = motion.velocity_after(step(0.25), State::Tracked);
        motion.rebase(&step(0.25), velocity);
        motion.reported_pose = Pose::identity();
        assert_eq!(motion.predicted(), Some(step(0.25)));
    }

    #[test]
    fn the_last_step_that_is_known_is_the_measure() {
        let mut motion = MotionModel::<f64>::new();
        motion.reset(false);
        assert_eq!(motion.last_step, 1.0);
        for (state, length, expected) in [
            (State::Tracked, 0.25, 0.25),
            (State::RotationOnly, 1e-17, 0.25),
            (State::TranslationUnknown, 0.0, 0.25),
            (State::Uncertain, 0.5, 0.25),
            (State::Found, 0.75, 0.75),
            (State::Tracked, 0.0, 0.75),
        ] {
            let _ = motion.velocity_after(step(length), state);
            assert_eq!(motion.last_step, expected, "{state:?}");
        }
    }
}
