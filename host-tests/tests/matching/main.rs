//! Lines to rows of disparity.
//!
//! That every method and kernel equals the naive twin to the bit is in `model/tests/kernels`.
//!
//! * `accuracy`, `confidence`: the answers against the true values of rendered scenes.
//! * `threads`: a frame in bands.

mod accuracy;
mod confidence;
mod surfaces;
mod threads;
