//! Constant-velocity motion model, and the pose that was reported last.

use super::step::State;
use crate::geometry::{Real, camera::Pose};

/// Frames for which points are kept that are not found again.
const PATIENCE: u8 = 5;

/// The motion so far, in the frame of the map.
#[derive(Debug)]
pub(super) struct MotionModel<T: Real> {
    /// The motion of the last frame, if it is known.
    pub velocity: Option<Pose<T>>,
    /// The last pose that was reported.
    pub reported_pose: Pose<T>,
    /// Frames since something was known.
    lost: u8,
    /// Whether there is a unit of length.
    pub has_unit: bool,
}

impl<T: Real> MotionModel<T> {
    pub const fn new() -> Self {
        // The first frame sets the pose.
        Self { velocity: None, reported_pose: Pose::NOTHING, lost: 0, has_unit: false }
    }

    /// Forgets the motion; a pair has a unit of length at once.
    pub fn reset(&mut self, is_pair: bool) {
        *self = Self { velocity: None, reported_pose: Pose::identity(), lost: 0, has_unit: is_pair };
    }

    /// The pose that the last velocity predicts.
    pub fn predicted(&self) -> Option<Pose<T>> {
        self.velocity.map(|velocity| self.reported_pose.then(&velocity))
    }

    /// Whether the last frame was lost.
    pub fn was_lost(&self) -> bool {
        self.lost > 0
    }

    /// Counts a frame whose pose is not known; whether there have been so many that all begins anew.
    pub fn lose(&mut self) -> bool {
        self.lost = self.lost.saturating_add(1);
        self.velocity = None;
        self.lost > PATIENCE
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

    /// The map has moved into the frame of a camera at this pose.
    pub fn rebase(&mut self, pose: &Pose<T>, velocity: Pose<T>) {
        self.reported_pose = pose.inverse().then(&self.reported_pose);
        self.velocity = Some(velocity);
    }
}
