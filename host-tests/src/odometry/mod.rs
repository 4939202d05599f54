//! Sequences of pictures through the core's odometry.
//!
//! * [`sequence`]: the frames of a folder, of one camera or of two.
//! * `rig`: the cameras. `prepared`: what of a frame does not depend on those before it.
//! * [`run`]: frames in, a [`trajectory`] out, with what is known of every pose. `smoother`: the last views
//!   adjusted together.
//! * [`poses`]: trajectories as KITTI's and TUM's files have them. [`truth`]: those that are true, at the
//!   frames' times. [`error`]: how far they are off. [`picture`]: drawn.

pub mod error;
pub mod picture;
pub mod poses;
mod prepared;
mod rig;
pub mod run;
pub mod sequence;
mod smoother;
pub mod trajectory;
pub mod truth;
