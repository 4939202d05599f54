//! What the core is held to: each stage again, naively, and scenes whose depth is known.
//!
//! Nothing here reads a file and few packages stand below it, so that it is built for every processor on
//! which the kernels are held to the twins.
//!
//! * [`twin`]: each stage of the core, written for clarity.
//! * [`scene`]: a ray-traced scene as a camera, with its true depth, disparity and occlusion.
//! * [`held`]: the pipeline beside its twin.
//! * [`interpolate`]: poses between two known ones.

pub mod held;
pub mod interpolate;
pub mod scene;
pub mod twin;
