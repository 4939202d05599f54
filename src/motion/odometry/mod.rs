//! Visual odometry: the motion of a camera, frame by frame, from what it sees.
//!
//! In: a [`Frame`], the picture with its features and, of a stereo pair, the right picture. Out: a [`Step`],
//! the motion since the frame before, with its covariance and its [`State`].
//!
//! Loop-free by design: a place that comes back is not recognised, nothing of the past is corrected, and so
//! errors add up along the way. Memory and time do not grow with it.
//!
//! 1. `track`: what is followed: a [`Template`](crate::features::Template) with a descriptor, and its
//!    `inverse_depth`.
//! 2. `tracking`: each point is looked for where the predicted motion puts it, first by its descriptor among
//!    the new features; a robust resection of three points each
//!    ([`robust_resection`](crate::geometry::robust::robust_resection)) tells which are right; then by its
//!    pixels, to a small part of a pixel, in the left picture and in the right one.
//! 3. `pose_estimate`: the pose that all observations together make likeliest, each with its point's
//!    uncertainty (`whitening`).
//! 4. `motion_test`: whether that is a motion: a camera that stands still, that only turns, or whose points
//!    are too far away to tell a step by is named.
//! 5. `inverse_depth`: what was seen makes the points surer; they move into the new camera's frame.
//! 6. `point_map`: new points where there are none, by the right picture at once, of one camera with a depth
//!    that is not known yet.
//! 7. `self_calibration`: what the right camera is off by: along columns from `two_views` of the same points
//!    at a time, and along rows from what both pictures show of them (`right_rows`); the rig is corrected by
//!    it when [`OdometryConfig::corrects_rig`] says so.
//! 8. `initialization`: of one camera, the first two views: their essential matrix, and with it the unit of
//!    length.
//! 9. `sliding_window`: who holds a [`Refinement`] beside it has the last views adjusted together with each
//!    new one, by what `observed` says.
//!
//! [`StereoOdometry`] gives metres; [`MonocularOdometry`] lengths without a unit, each an [`Unscaled`] number
//! of first baselines.

mod right_error;
mod config;
mod frame;
mod step;
mod motion_model;
mod whitening;
mod inverse_depth;
mod list;
mod track;
mod disparity;
mod pose_estimate;
mod point_map;
mod tracking;
mod right_rows;
mod two_views;
mod self_calibration;
mod initialization;
mod motion_test;
mod observed;
mod engine;
mod sliding_window;
mod scale;

pub use config::{OdometryConfig, OdometryRig, OdometryRigError};
pub use engine::{OdometryState, OdometryView};
pub use frame::{Frame, OdometryError};
pub use observed::ObservedPoint;
pub use pose_estimate::PointMatch;
pub use scale::{MonocularOdometry, StereoOdometry, Unscaled};
pub use self_calibration::RigEstimate;
pub use sliding_window::{Refinement, RefinementConfig};
pub use step::{State, Step};
pub use track::Track;
