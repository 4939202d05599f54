//! How many bytes a matcher takes.

use super::backend::STEP;
use super::memory::Bytes;
use super::memory::rings::{BAND, HISTORY};
use super::method::Method;

/// Bytes of matcher state beside the arrays: counters, the configuration, padding.
pub(super) const FIXED_BYTES: usize = 64;
/// Bytes behind rows of bytes that end with no whole word, before rows of words: three for each at most.
pub(super) const PADDING_BYTES: usize = 32;

/// Bytes of a [`Matcher`](super::Matcher) for lines of `width` and `disparities`, rounded up to what it can
/// be made for.
///
/// ```
/// use stereopsis::matching::{Block, Fast, Matcher, state_bytes};
/// assert!(size_of::<Matcher<Block, 320, 64>>() <= state_bytes::<Block>(320, 64));
/// assert!(state_bytes::<Block>(320, 64) <= 43 * 1024);
/// assert!(state_bytes::<Fast>(320, 64) <= 43 * 1024);
/// ```
pub const fn state_bytes<S: Method>(width: usize, disparities: usize) -> usize {
    let lanes = disparities.next_multiple_of(STEP);
    let width = if width < lanes { lanes } else { width };
    let padding = if width.is_multiple_of(4) { 0 } else { PADDING_BYTES };
    array_bytes::<S>(width, lanes) + FIXED_BYTES + padding
}

/// Bytes of a matcher's arrays.
pub(crate) const fn array_bytes<S: Method>(width: usize, lanes: usize) -> usize {
    let Bytes { fixed, per_pixel, per_candidate, per_disparity } = S::BYTES;
    let per_column = per_pixel + per_candidate * lanes + 2 + 1 + 1 + 1 + 2 + (2 + 1) * BAND + 2 * HISTORY;
    width * per_column + per_disparity * lanes + fixed
}
