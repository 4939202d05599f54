//! Lines to rows of disparity.
//!
//! * `twin`: every method and kernel against the naive twin, to the bit.
//! * `accuracy`, `confidence`: the answers against the true values of rendered scenes.
//! * `threads`: a frame in bands.

mod accuracy;
mod confidence;
mod surfaces;
mod threads;
mod twin;
