//! Bundle adjustment: views and points move until what was seen agrees with them best.
//!
//! In: [`View`]s and points that are roughly known, [`Sight`]s that somebody matched. Out: the same views and
//! points where half the sum of the [`Loss`] of the sights' squared residuals is least, with a
//! [`BundleReport`] of how it went.
//!
//! In running order:
//!
//! * [`CameraView`], [`RigView`], [`AlignedView`], [`RadialView`]: a calibrated camera, two of them mounted
//!   to each other, a rectified pair's left one with its disparities, or one whose focal length and radial
//!   distortion are refined too. `view`: how a pixel moves with the view and with the point.
//! * [`Problem`] with its [`Sight`]s, and the [`Workspace`] it takes; [`Window`] is both in one `static`.
//!   `problem`: indices and sizes are checked once.
//! * `track`: the equations of one point. `step`: all points are taken out of the equations (Schur's
//!   complement), what is left is solved for the views by `envelope`, then point by point. [`Gauge`]: what is
//!   held still meanwhile.
//! * [`adjust()`], or [`Adjustment`] a step at a time: Levenberg and Marquardt's damping, and the reason to
//!   [`Stop`].
//! * [`Covariances`] of views and points.
//!
//! Nothing is kept of a sight but what was seen: derivatives are computed twice a step, which takes less than
//! moving them would on a host, and a tenth of the memory. A step costs, for n sights, 2 n derivatives, for
//! every point a block product for each pair of its views, and Cholesky's factor of the views' matrix within
//! its envelope.
//!
//! In `f32` the cost comes within 1e-4 of the least; views follow with the root of that where the images
//! say little. What has hundreds of views is for `f64`.
#![allow(
    clippy::needless_range_loop,
    reason = "an element is named by its row and column, as in the equations"
)]

mod adjust;
mod aligned;
mod covariance;
mod envelope;
mod gauge;
mod loss;
mod pinhole;
mod problem;
mod radial;
mod step;
mod track;
mod view;
mod window;
mod workspace;

pub use adjust::{Adjustment, BundleConfig, BundleReport, Stop, adjust};
pub use aligned::AlignedView;
pub use covariance::{CovarianceError, Covariances};
pub use gauge::Gauge;
pub use loss::Loss;
pub use pinhole::{CameraView, RigView};
pub(crate) use problem::tracks;
pub use problem::{BundleError, Need, Problem, Sight};
pub use radial::RadialView;
pub use view::{Slope, View};
pub use window::{Window, WindowError};
pub use workspace::{Slot, Term, Workspace};
