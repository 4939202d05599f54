//! One camera and a known shape: distance, pose and orientation.
//!
//! In: pixels of one camera. Out: distances in metres and orientations, for a known shape fixes the scale.
//!
//! * [`Sighting`]: distance and bearing of an object of known size.
//! * [`SquareMark`]: the pose of a flat square of known side, with the second pose that its picture may have.
//! * [`VanishingPoint`]: where the picture of parallel lines converges. [`ManhattanFrame`]: the camera's
//!   orientation in a building, from lines along its three orthogonal directions, and the focal length where
//!   that is not known.

mod known_size;
mod tilts;
mod square;
mod pencil;
mod vanishing;
mod manhattan;

pub use known_size::{Sighting, SightingError};
pub use manhattan::{ManhattanFrame, ManhattanFrameError};
pub use pencil::{LineSegment, VanishingPointError};
pub use square::{MarkPose, MarkPoses, SquareMark, SquareMarkError};
pub use vanishing::VanishingPoint;
