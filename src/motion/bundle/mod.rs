//! Bundle adjustment: the views and points of least re-projection error (Triggs et al. 2000).
//!
//! In: [`View`]s and points that are roughly known, [`Observation`]s that somebody matched. Out: the same
//! views and points where half the sum of the [`Loss`] of the observations' squared residuals is least, with
//! a [`BundleReport`] of how it went.
//!
//! In running order:
//!
//! * [`CameraView`], [`RigView`], [`RectifiedView`], [`RadialView`]: a calibrated camera, two of them mounted
//!   to each other, a rectified pair's left one with its disparities, or one whose focal length and radial
//!   distortion are refined too. `view`: how a pixel moves with the view and with the point.
//! * [`Problem`] with its [`Observation`]s, and the [`BundleWorkspaceView`] it takes; [`Window`] is both in
//!   one `static`. `problem`: indices and sizes are checked once.
//! * `point_equations`: the equations of one point. `schur`: all points are taken out of the equations
//!   (Schur's complement), what is left is solved for the views by `envelope`, then point by point.
//!   [`Gauge`]: what is held still meanwhile.
//! * [`adjust()`], or [`Adjustment`] a step at a time: Levenberg and Marquardt's damping, and the reason to
//!   [`StopReason`].
//! * [`Covariances`] of views and points.
//!
//! Nothing is kept of an observation but what was seen: derivatives are computed twice a step, which takes
//! less than moving them would on a host, and a tenth of the memory. A step costs, for n observations, 2 n
//! derivatives, for every point a block product for each pair of its views, and Cholesky's factor of the
//! views' matrix within its envelope.
//!
//! In `f32` the cost comes within 1e-4 of the least; views follow with the root of that where the images
//! say little. What has hundreds of views is for `f64`.
#![allow(
    clippy::needless_range_loop,
    reason = "an element is named by its row and column, as in the equations"
)]

mod gauge;
mod loss;
mod view;
mod camera_view;
mod radial_view;
mod rectified_view;
mod workspace;
mod envelope;
mod problem;
mod point_equations;
mod schur;
mod adjust;
mod covariance;
mod window;

pub use adjust::{Adjustment, BundleConfig, BundleReport, StopReason, adjust};
pub use camera_view::{CameraView, RigView};
pub use covariance::{CovarianceError, Covariances};
pub use gauge::Gauge;
pub use loss::Loss;
pub(crate) use problem::tracks;
pub use problem::{BundleError, Observation, Problem, WorkspaceSize};
pub use radial_view::RadialView;
pub use rectified_view::RectifiedView;
pub use view::{ProjectionJacobian, View};
pub use window::{Window, WindowError};
pub use workspace::{BundleWorkspace, BundleWorkspaceView, CrossBlock, ViewSlot};
