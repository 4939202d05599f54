//! Robust estimation of F, E and a camera's pose from observations with outliers: RANSAC.
//!
//! In: correspondences or [`Landmark`](super::absolute::Landmark)s, a threshold and a seed. Out: the
//! estimate, and which observations are its inliers.
//!
//! * `config`: what is asked. `random`, `prosac`: samples, uniform or the likely observations first.
//! * `ransac`: the loop over samples, for any estimator. `sprt`: the test that drops a bad estimate early.
//! * `loss`: the weight and the gain of a residual (Tukey's biweight).
//! * `frame`, `factored`, `refine`: F or E with the least robust loss, by Levenberg-Marquardt.
//! * `plane`, `off_plane`, `search`, `parallax`: the search for F in scenes with a dominant plane (DEGENSAC).
//! * `fundamental`, `essential`: F by samples of seven, and E of known cameras by samples of five.
//! * `reprojection`, `resection`: the pose from landmarks (PnP).
//!
//! Every loop is bounded, nothing is allocated; what is held besides the caller's slices is some kilobytes of
//! stack.

mod config;
mod random;
mod prosac;
mod ransac;
mod loss;
mod sprt;
mod frame;
mod plane;
mod factored;
mod refine;
mod off_plane;
mod search;
mod parallax;
mod fundamental;
mod essential;
mod reprojection;
mod resection;

pub use config::{RobustConfig, Sampling};
pub use essential::{RobustEssential, robust_essential};
pub use fundamental::{RobustError, RobustFundamental, robust_fundamental};
pub(crate) use loss::weight_and_gain;
pub use resection::{RobustResection, RobustResectionError, robust_resection};
pub(crate) use search::stride;
