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
//!   the cameras are known. `resection`: a camera's pose from [`Landmark`](super::Landmark)s, by samples of
//!   three.
//!
//! Every loop is bounded, nothing is allocated; what is held besides the caller's slices is a few hundred
//! bytes.

mod config;
mod essential;
mod factored;
mod frame;
mod fundamental;
mod loss;
mod parallax;
mod plane;
mod pool;
mod random;
mod refine;
mod resection;
mod search;
mod verdict;

pub use config::{RobustConfig, Sampling};
pub use fundamental::{RobustError, RobustFundamental, robust_fundamental};
pub use resection::{RobustResection, RobustResectionError, robust_resection};

/// Correspondences of a sample.
const MINIMUM: usize = 7;

/// Places of a sample's correspondences.
type Sample = [usize; MINIMUM];
