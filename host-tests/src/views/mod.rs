//! Pictures of one camera from several places through the core's structure from motion.
//!
//! * [`link`]: which corner of which picture is which point. [`solve`]: where the views stand, and the
//!   points. [`look_again`]: those points in every view that shows them, under the `surface` around each.
//! * [`colmap`]: the result as COLMAP's text model.

pub mod colmap;
mod link;
mod look_again;
mod solve;
mod surface;

pub use link::{Links, link};
pub use look_again::look_again;
pub use solve::{Found, Length, SolveError, solve};
