//! Pure maths on fixed-size nalgebra types: no pixels come in.
//!
//! In: calibrated numbers. Out: types that have checked them once, so that nobody after them has to.
//!
//! * [`RectifiedRig`]: two cameras whose rows are aligned; its re-projection matrix Q.

mod rig;

pub use rig::{RectifiedRig, RigError};
