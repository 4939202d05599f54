//! Two views, or a view of known points, when some of the correspondences are wrong.
//!
//! In: correspondences, a threshold and a seed. Out: [`RobustFundamental`], and which correspondences agree
//! with it.
//!
//! * `config`: what is asked. `random`, `pool`: samples of seven, uniform or the likely ones first.
//! * `plane`, `parallax`: samples that cannot be, and what to do about those that lie on a plane.
//! * `loss`: what a distance is worth. `verdict`: whether an estimate is worth anything, from a few
//!   correspondences.
//! * `frame`, `factored`, `refine`: the estimate whose geometric error is least, also of an essential matrix.
//! * `search`: the loop over samples. `fundamental`: its beginning and end. `essential`: the refinement when
//!   the cameras are known. `resection`: a camera's pose from [`Landmark`](super::absolute::Landmark)s, by
//!   samples of three.
//!
//! Every loop is bounded, nothing is allocated; what is held besides the caller's slices is a few hundred
//! bytes.

mod config;

mod random;

mod prosac;

mod ransac;

mod loss;

mod sprt;

mod plane;

mod frame;

mod factored;

mod refine;

mod search;

mod parallax;

mod fundamental;

mod essential;

mod resection;

pub use config::{RobustConfig, Sampling};
pub use fundamental::{RobustError, RobustFundamental, robust_fundamental};
pub use resection::{RobustResection, RobustResectionError, robust_resection};
