//! Rows of a frame that are kept for a while, in rings: row `y` stands in slot `y % rows`.

/// Five lines of an image: a row with the two above it and the two below.
pub type Rows5<'a> = [&'a [u8]; 5];

/// Rows that must follow before a row's speckle is decided.
pub(in crate::matching) const LOOK_AHEAD: usize = 4;
/// Rows of answers and flags before the speckle filter.
pub(in crate::matching) const BAND: usize = LOOK_AHEAD + 1;
/// Rows of finished answers: the last one and the four above it that the uncertainty looks at.
pub(in crate::matching) const HISTORY: usize = 5;

/// Row `slot` of a ring of rows `width` pixels wide.
// A stage asks for a row or two: once in flash it is smaller, and no slower to speak of.
#[cfg_attr(all(target_pointer_width = "32", not(stereopsis_dsp)), inline(never))]
pub(in crate::matching) fn row<T>(ring: &[T], slot: usize, width: usize) -> &[T] {
    let row = ring.get(slot * width..).and_then(|rows| rows.get(..width));
    debug_assert!(row.is_some(), "row {slot} of {width} is outside of a ring of {}", ring.len());
    row.unwrap_or(&[])
}

/// Mutable access to row `slot` of a ring of rows `width` pixels wide.
#[cfg_attr(all(target_pointer_width = "32", not(stereopsis_dsp)), inline(never))]
pub(in crate::matching) fn row_mut<T>(ring: &mut [T], slot: usize, width: usize) -> &mut [T] {
    debug_assert!(ring.len() >= (slot + 1) * width, "row {slot} of {width} is outside of a ring");
    ring.get_mut(slot * width..).and_then(|rows| rows.get_mut(..width)).unwrap_or_default()
}

/// The first `count` of a slice.
pub(in crate::matching) fn first<T>(slice: &mut [T], count: usize) -> &mut [T] {
    debug_assert!(slice.len() >= count, "{count} of {}", slice.len());
    slice.get_mut(..count).unwrap_or_default()
}
