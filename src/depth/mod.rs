//! Disparity to depth, with its uncertainty.
//!
//! In: disparities and a rectified rig. Out: millimetres without a floating-point unit, metres, points in the left
//! camera's frame.
//!
//! * [`DepthScale`]: `Z = f b / (d + doffs)` and `sigma_Z = Z^2 / (f b) sigma_d`.
//! * [`DepthRange`]: the nearest and the farthest depth that a search range can tell, and the error there.
//! * [`DepthTable`]: depths looked up, for cores that cannot divide.

mod range;
mod scale;
mod table;

pub use range::DepthRange;
pub use scale::{DepthError, DepthScale};
pub use table::{DepthTable, TableError};
