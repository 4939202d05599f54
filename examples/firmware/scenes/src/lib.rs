//! What the firmware's programs see, and their work on it. Nothing here knows hardware: the host runs the
//! same and compares every bit.
//!
//! * [`any_frames`]: frames of any size, with all that can be asked of them.
//! * [`drive`]: a robot that drives towards a board, and what its motors are given.
//! * [`scene`]: a scene that is computed line by line. [`pgm`]: the header of a picture.
//! * [`raw_pair`]: raw lines, rectified, and depth from them.
//! * [`soak`]: frames of a camera with faults, and what became of each row.
//! * [`two_pictures`]: features of two cameras' lines, and their matches.
//! * [`two_views`]: matches of a known world, and the pose and points that they give. [`window`]: two views
//!   and their points, adjusted.
//! * [`walk`]: a view that moves, and the motion from frame to frame.
//! * [`sweep`]: frames of a lens that moves, and where each tile is in focus.
#![no_std]

pub mod any_frames;
pub mod drive;
pub mod pgm;
pub mod raw_pair;
pub mod scene;
pub mod soak;
pub mod sweep;
pub mod two_pictures;
pub mod two_views;
pub mod walk;
pub mod window;
