//! The dense path in plain Rust.
//!
//! * `planes`: census and windows in bit planes, for cores without vectors.
//! * `group`: bytes side by side, which the code along paths and under windows in vectors is written for;
//!   `words`: four bytes in a word; `candidates`: those of a pixel, from pixel to pixel.
//! * `sgm`: costs along paths.
//! * `left_right`, `consistency`, `subpixel`: winners into answers; `left_right_rows`: pixels side by side.
//! * `smooth`, `median`, `speckle`, `vertical`: the filters of answers; `edges`, `fattening`: those refused
//!   that spread; `fill`: small gaps closed.

pub(super) mod candidates;
pub(super) mod census;
pub(super) mod consistency;
pub(super) mod edges;
pub(super) mod fattening;
pub(super) mod fill;
pub(super) mod group;
pub(super) mod left_right;
pub(super) mod left_right_rows;
pub(super) mod median;
pub(super) mod planes;
pub(super) mod sgm;
pub(super) mod smooth;
pub(super) mod speckle;
mod subpixel;
pub(super) mod vertical;
pub(super) mod words;
