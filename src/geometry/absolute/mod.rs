//! Absolute pose: where a camera stands among points of known position.
//!
//! * [`p3p()`]: the poses of a calibrated camera from three points.
//! * [`Projection`]: a camera in the world as one matrix, to and from its parts, and from six [`Landmark`]s
//!   or more by the direct linear transform (DLT).
//!
//! Of many landmarks of which some are wrong: [`robust_resection`](super::robust::robust_resection) (PnP).

mod plane_pair;
mod p3p;
mod projection;

pub use p3p::{P3pError, P3pPoses, p3p};
pub use projection::{Landmark, Projection, ResectionError};
