//! Bundle adjustment.
#![allow(clippy::needless_range_loop, reason = "an element is named by its row and column, as in the equations")]

mod adjust;
mod envelope;
mod gauge;
mod loss;
mod pinhole;
mod problem;
mod radial;
mod step;
mod track;
mod view;
mod workspace;

pub use adjust::{Adjustment, BundleConfig, BundleReport, Stop, adjust};
pub use gauge::Gauge;
pub use loss::Loss;
pub use pinhole::{CameraView, RigView};
pub use problem::{BundleError, Need, Problem, Sight};
pub use radial::RadialView;
pub use view::{Slope, View};
pub use workspace::{Slot, Term, Workspace};
