//! Cameras: pinhole and lens, the pose of one beside another, and pairs of them.
//!
//! * [`Camera`] with its [`Lens`]: [`Distortion`] (Brown & Conrady) or [`Fisheye`] (Kannala & Brandt).
//! * [`Pose`]: where a second camera stands beside the first.
//! * [`RectifiedRig`]: two cameras whose rows are aligned, and its re-projection matrix Q.
//! * [`StereoRig`]: two cameras as they are mounted. [`StereoRig::to_record`] and [`StereoRig::from_record`]:
//!   the rig in flash.

mod distortion;
mod fisheye;
mod lens;
mod pinhole;
mod pose;
mod rectified_rig;
mod stereo_rig;
mod record;

pub use distortion::Distortion;
pub use fisheye::Fisheye;
pub use lens::Lens;
pub use pinhole::{Camera, CameraModelError, ProjectionError};
pub use pose::{Pose, PoseError};
pub use record::RecordError;
pub use rectified_rig::{RectifiedRig, RigError};
pub use stereo_rig::{ImageSize, StereoRig, StereoRigError};
