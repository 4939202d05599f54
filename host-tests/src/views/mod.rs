//! Pictures of one camera from several places through the core's structure from motion.
//!
//! * [`link`]: which corner of which picture is which point. [`solve`]: where the views stand, and the
//!   points.

mod link;
mod solve;

pub use link::{Links, link};
pub use solve::{Found, Length, SolveError, solve};
