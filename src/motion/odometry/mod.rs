//! Visual odometry: how a camera moves, frame by frame, from what it sees.
//!
//! In: a [`Frame`], the picture with its features and, of a stereo pair, the right picture. Out: a [`Step`],
//! the motion since the frame before, with its covariance and its [`State`].
//!
//! Loop-free by design: a place that comes back is not recognised, nothing of the past is corrected, and so
//! errors add up along the way. Memory and time do not grow with it.
//!
//! 1. `track`: what is followed: a [`Template`](crate::features::Template) with a descriptor, and its
//!    `point`.
//! 2. `follow`: each point is looked for where the predicted motion puts it, first by its descriptor among
//!    the new features; a robust resection of three points each
//!    ([`robust_resection`](crate::geometry::robust::robust_resection)) tells which are right; then by its
//!    pixels, to a small part of a pixel, in the left picture and in the right one.
//! 3. `solve`: the pose that all sights together make likeliest, each with its point's uncertainty
//!    (`whiten`).
//! 4. `verdict`: whether that is a motion: a camera that stands still, that only turns, or whose points are
//!    too far away to tell a step by is named.
//! 5. `point`: what was seen makes the points surer; they move into the new camera's frame.
//! 6. `renew`: new points where there are none, by the right picture at once, of one camera with a depth that
//!    is not known yet.
//! 7. `begin`: of one camera, the first two views: their essential matrix, and with it the unit of length.
//! 8. `refine`: who holds a [`Refinement`] beside it has the last views adjusted together with each new one,
//!    by what `seen` says.
//!
//! [`StereoOdometry`] gives metres; [`MonocularOdometry`] lengths without a unit, each an [`Unscaled`] number
//! of first baselines.

mod begin;
mod config;
mod engine;
mod follow;
mod frame;
mod point;
mod refine;
mod renew;
mod scale;
mod seen;
mod solve;
mod step;
mod track;
mod verdict;
mod whiten;

pub use config::{OdometryConfig, OdometryRig, OdometryRigError};
pub use engine::Odometry;
pub use frame::{Frame, OdometryError};
pub use refine::{Refinement, RefinementConfig};
pub use scale::{MonocularOdometry, StereoOdometry, Unscaled};
pub use seen::SeenPoint;
pub use step::{State, Step};
