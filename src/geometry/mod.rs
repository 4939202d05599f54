//! Pure maths on fixed-size nalgebra types: no pixels come in.
//!
//! In: calibrated numbers, and correspondences that somebody found. Out: types that have checked them once,
//! so that nobody after them has to.
//!
//! * [`Real`]: `f32` or `f64`. `linear`: factors and null vectors that are bounded and cannot panic.
//! * [`Camera`] with its [`Lens`] ([`Distortion`] or [`Fisheye`]); [`Pose`] of a second camera beside the
//!   first; [`RectifiedRig`]: two cameras whose rows are aligned, and its re-projection matrix Q.
//! * [`StereoRig`]: two cameras as they are mounted; [`Rectification`] aligns their rows, a [`Warp`] for
//!   each, with a [`RectificationReport`]; a [`RowMeter`] tells while the cameras run whether they still
//!   agree. [`StereoRig::to_record`] and [`StereoRig::from_record`]: the rig in flash.
//! * [`Essential`] and [`Fundamental`]: two views, in the cameras' frames and in px, with lines, epipoles and
//!   distances.
//! * [`Correspondence`]s to [`Fundamental`]: [`eight_point()`]. To [`Homography`]: its direct linear
//!   transform. [`choose`] says which of the two it is.
//! * Correspondences of which some are wrong: [`robust_fundamental`], and [`Essential::refined`] for cameras
//!   that are known.
//! * [`Essential::recover_pose`] and [`Homography::recover_motions`]: the pose, without its scale
//!   ([`RelativePose`]).
//! * [`TwoViews`]: points from two sights, with their residual, angle and covariance.
//! * [`Projection`]: a camera in the world as one matrix, to and from its parts, and from [`Landmark`]s.
//! * Where a camera stands among known points: [`p3p()`] of three, [`robust_resection`] of many, some of them
//!   wrong.
//! * One camera before something of known shape: [`Sighting`] of an object of known size, the poses of a
//!   [`SquareMark`], the orientation between [`Walls`].
//!
//! R and t carry a point of camera 2 into camera 1, `P = R P' + t`, and `p^T F p' = 0`; what OpenCV writes
//! the other way round is converted by functions that say so.
//!
//! # The lecture's equations
//!
//! Where the equations of Stanford's AA273, lecture 6 (Pavone 2018), are computed, in the lecture's order.
//! Each has a worked number in the tests.
//!
//! | equation | computed by |
//! | --- | --- |
//! | `p ~ M P`, `M = K [R^T \| -R^T t]` | [`Projection::new`], [`Projection::project`] |
//! | `Z = f S / s`, an object of known size | [`Sighting::of_length`] |
//! | `z = b f / (p_u - p'_u)`, sights of a rectified pair | [`RectifiedRig::depth_m`] |
//! | 6.2: least `d(p, M P)^2 + d(p', M' P)^2` | [`TwoViews::optimal`], its value [`Triangulated::residual_px`] |
//! | `p . [t x (R p')] = 0`, three vectors in the epipolar plane | [`Essential::residual`] |
//! | `[a]x b = a x b` | [`skew()`] |
//! | `E = [t]x R`, `p^T E p' = 0` | [`Essential::from_pose`], [`Essential::residual`] |
//! | `E` has the singular values `(s, s, 0)` | [`Essential::nearest`] |
//! | `F = K^-T E K'^-1`, `p^T F p' = 0` | [`Fundamental::from_essential`], [`Fundamental::residual`] |
//! | `l = F p'`, `l' = F^T p` | [`Fundamental::line_in_first`], [`Fundamental::line_in_second`] |
//! | `F^T e = 0`, `F e' = 0` | [`Fundamental::epipole_in_first`], [`Fundamental::epipole_in_second`] |
//! | least `\|W f\|` with `\|f\| = 1`, normalised | [`eight_point()`] |
//! | the nearest matrix of rank 2, `U diag(s1, s2, 0) V^T` | [`Fundamental::from_matrix`] |
//! | `E = K^T F K'` and its four poses | [`Essential::from_fundamental`], [`Essential::poses`] |
//! | rows of a rectified pair: `F ~ [0 0 0; 0 0 -1; 0 1 0]` | [`Fundamental::from_cameras`] of such a pair |
//! | disparity to a point, `P ~ Q (u v d 1)^T` | [`RectifiedRig::reproject`] |

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
mod fisheye;
mod fundamental;
mod homography;
mod landmarks;
mod lens;
mod line;
pub(crate) mod linear;
mod model;
mod normalise;
mod p3p;
mod plane;
mod pose;
mod projection;
mod real;
mod record;
mod recover;
mod rectify;
mod relative;
mod rig;
mod robust;
mod seven_point;
mod skew;
mod stereo_rig;
mod triangulate;
mod weighted;

pub use camera::{Camera, CameraError, ProjectionError};
pub use correspondence::Correspondence;
pub use distortion::Distortion;
pub use eight_point::{EightPointError, eight_point, eight_point_weighted};
pub use essential::{Essential, EssentialError};
pub use fisheye::Fisheye;
pub use fundamental::{Fundamental, FundamentalError};
pub use homography::{Homography, HomographyError};
pub use landmarks::{
    MarkPose, MarkPoses, Segment, Sighting, SightingError, SquareMark, SquareMarkError, VanishingPoint,
    VanishingPointError, Walls, WallsError,
};
pub use lens::Lens;
pub use line::{Epipole, Line};
pub use model::{ModelChoice, TwoViewModel, choose, gric};
pub use p3p::{P3pError, P3pPoses, p3p};
pub use plane::{PlaneMotion, PlaneMotionError};
pub use pose::{Pose, PoseError};
pub use projection::{Landmark, Projection, ResectionError};
pub use real::Real;
pub use record::RecordError;
pub use recover::{RecoverError, RecoveredPose};
pub use rectify::{
    Axis, Crop, Rectification, RectificationReport, RectifyError, RowAlignment, RowHealth, RowMeter,
    RowMeterError, UncalibratedError, UncalibratedRectification, Warp, WarpSource,
};
pub use relative::{RelativePose, ScaleError};
pub use rig::{RectifiedRig, RigError};
pub use robust::{
    RobustConfig, RobustError, RobustFundamental, RobustResection, RobustResectionError, Sampling,
    robust_fundamental, robust_resection,
};
pub use skew::skew;
pub(crate) use skew::turn;
pub use stereo_rig::{ImageSize, StereoRig, StereoRigError};
pub use triangulate::{Triangulated, TriangulationError, TwoViews};
