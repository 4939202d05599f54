//! Lines to rows of disparity.
//!
//! That every method and kernel equals the naive twin to the bit is in `model/tests/kernels`.
//!
//! * `accuracy`, `confidence`: the answers against the true values of rendered scenes.
//! * `dump`: the rows of stages that are written. `traced`: those that the core shows. `threads`: a frame in
//!   bands.

mod accuracy;
mod confidence;
mod dump;
mod surfaces;
mod threads;
mod traced;
