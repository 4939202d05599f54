//! How far down the rows of a frame rest on one of them.

use crate::matching::{Checks, Method};

/// Returns how many rows below a row rest on its answers through checks; `usize::MAX` for the rest of the
/// frame.
pub(super) fn reach_down<S: Method>(checks: &Checks) -> usize {
    // Answers that are smoothed down the columns rest on the row above as it came out, and so does a path;
    // what is open is so from the first row down.
    if S::VERTICAL_FILTER || checks.look_for_open() { usize::MAX } else { reach_of_checks(checks) }
}

/// Returns how many rows below a row the median and the speckle filter reach.
pub(super) fn reach_of_checks(checks: &Checks) -> usize {
    usize::from(checks.median) + usize::from(checks.speckle_pixels)
}
