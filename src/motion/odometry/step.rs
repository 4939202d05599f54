//! The result of a frame: motion, covariance and state.

use crate::geometry::{Real, camera::Pose};
use nalgebra::Matrix6;

/// What is known of a frame's pose.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum State {
    /// The first frame: the others stand beside it.
    First,
    /// One camera has no unit of length yet: what it saw is more than a rotation, but two views give no sure
    /// relative pose. The motion is not known, and is none; the next frame that is [`State::Tracked`] has the
    /// whole motion since.
    Waiting,
    /// The pose is measured.
    Tracked,
    /// The pose is an estimate that is not sure: its covariance is large beside the motion, or the motion
    /// differs from the one before by more than a half and few points say so.
    Uncertain,
    /// The pose is measured by the left camera alone, with depths that the pair is no longer trusted for:
    /// what the right camera sees disagrees with all that was known.
    LeftOnly,
    /// The pictures are the same to their noise, and what they show is near enough to tell a step by: the
    /// motion is none.
    Stationary,
    /// The rotation is measured. A step is too small to be measured: of one camera it has no direction. The
    /// motion has none.
    RotationOnly,
    /// The rotation is measured, the translation is not: what is seen is too far away, or there is too little
    /// of it. The motion has no translation. A camera that stands still before a distant scene is in this
    /// state.
    TranslationUnknown,
    /// Too little was found again: the motion is not known, and is none. The next frame that is
    /// [`State::Found`] has the whole motion since.
    Lost,
    /// Found again, by points that were known before.
    Found,
    /// Begun anew, for what was known before did not come back: the motion since the last pose that was known
    /// is not known, and is none.
    Restarted,
}

impl State {
    /// Whether turn and step are known.
    pub const fn is_known(self) -> bool {
        matches!(self, Self::First | Self::Tracked | Self::LeftOnly | Self::Stationary | Self::Found)
    }
}

/// The motion from the frame before to this one.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Step<T: Real> {
    /// Carries a point of this camera into the one before, `P = R P' + t`: t is where this one stands.
    pub motion: Pose<T>,
    /// The covariance of the motion: a turn (radians) and a step (the unit of the motion), both along this
    /// camera's axes, `P = R exp([w]x) (P' + d) + t`. Very large where nothing is known.
    pub covariance: Matrix6<T>,
    /// What is known.
    pub state: State,
    /// Points that are followed.
    pub points: usize,
    /// Number of points that were found in this frame.
    pub found: usize,
    /// Number of points that agree with the pose.
    pub inliers: usize,
    /// The root mean square of what is left of their observations, in units of what was expected: 1 where
    /// the noise is as configured.
    pub residual: T,
}

impl<T: Real> Step<T> {
    /// Nothing moved, and nothing is known of it.
    pub(super) fn none(state: State) -> Self {
        Self {
            motion: Pose::identity(),
            covariance: Matrix6::identity() * T::of(1e12),
            state,
            points: 0,
            found: 0,
            inliers: 0,
            residual: T::ZERO,
        }
    }
}
