//! Pure maths on fixed-size nalgebra types: no pixels come in.
//!
//! In: calibrated numbers, and correspondences that somebody found. Out: types that have checked them once, so that
//! nobody after them has to.
//!
//! * [`Real`]: `f32` or `f64`. `linear`: factors and null vectors that are bounded and cannot panic.
//! * [`Camera`] with its [`Distortion`]; [`Pose`] of a second camera beside the first; [`RectifiedRig`]: two cameras whose
//!   rows are aligned, and its re-projection matrix Q.
//! * [`StereoRig`]: two cameras as they are mounted; [`Rectification`] aligns their rows, a [`Warp`] for each, with a
//!   [`RectificationReport`].
//! * [`Essential`] and [`Fundamental`]: two views, in the cameras' frames and in px, with lines, epipoles and distances.
//! * [`Correspondence`]s to [`Fundamental`]: [`eight_point()`]. To [`Homography`]: its direct linear transform. [`choose`]
//!   says which of the two it is.
//! * Correspondences of which some are wrong: [`robust_fundamental`], and [`Essential::refined`] for cameras that are known.
//! * [`Essential::recover_pose`] and [`Homography::recover_motions`]: the pose, without its scale ([`RelativePose`]).
//! * [`TwoViews`]: points from two sights, with their residual, angle and covariance.
//! * [`Projection`]: a camera in the world as one matrix, to and from its parts, and from [`Landmark`]s.
//!
//! R and t carry a point of camera 2 into camera 1, `P = R P' + t`, and `p^T F p' = 0`; what OpenCV writes the other way
//! round is converted by functions that say so.

#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "`!(a > b)` refuses what is not a number together with what is too small"
)]

mod camera;
mod correspondence;
mod degenerate;
mod distance;
mod distortion;
mod eight_point;
mod essential;
mod fundamental;
mod homography;
mod line;
mod linear;
mod model;
mod normalise;
mod plane;
mod pose;
mod projection;
mod real;
mod recover;
mod rectify;
mod relative;
mod rig;
mod robust;
mod seven_point;
mod skew;
mod stereo_rig;
mod triangulate;

pub use camera::{Camera, CameraError, ProjectionError};
pub use correspondence::Correspondence;
pub use distortion::Distortion;
pub use eight_point::{EightPointError, eight_point, eight_point_weighted};
pub use essential::{Essential, EssentialError};
pub use fundamental::{Fundamental, FundamentalError};
pub use homography::{Homography, HomographyError};
pub use line::{Epipole, Line};
pub use model::{ModelChoice, TwoViewModel, choose, gric};
pub use plane::{PlaneMotion, PlaneMotionError};
pub use pose::{Pose, PoseError};
pub use projection::{Landmark, Projection, ResectionError};
pub use real::Real;
pub use recover::{RecoverError, RecoveredPose};
pub use rectify::{Axis, Crop, Rectification, RectificationReport, RectifyError, Warp, WarpSource};
pub use relative::{RelativePose, ScaleError};
pub use rig::{RectifiedRig, RigError};
pub use robust::{RobustConfig, RobustError, RobustFundamental, Sampling, robust_fundamental};
pub use skew::skew;
pub use stereo_rig::{ImageSize, StereoRig, StereoRigError};
pub use triangulate::{Triangulated, TriangulationError, TwoViews};
