//! Groups of four pixels side by side, whose features are made at a time.

/// Columns in a word.
pub(in crate::matching::backend) const COLUMNS: usize = 4;
/// Columns to each side that a code looks at.
pub(in crate::matching::backend) const REACH: usize = 4;
/// Columns that four pixels look at.
const NEAR: usize = COLUMNS + 2 * REACH;

/// A number of each pixel.
pub(in crate::matching::backend) type Group = [u8; COLUMNS];

/// How many groups, from column [`REACH`] on, see nothing outside of a line of `width` pixels and have all
/// places among `count`.
#[inline(always)]
pub(in crate::matching::backend) fn groups(width: usize, count: usize) -> usize {
    (width.saturating_sub(NEAR - COLUMNS) / COLUMNS).min(count.saturating_sub(REACH) / COLUMNS)
}

/// The columns of a line from [`REACH`] before `place` on; those outside the line are the nearest inside.
#[inline(never)]
pub(in crate::matching::backend) fn columns(line: &[u8], place: usize) -> Group {
    let end = |column: Option<&u8>| [column.copied().unwrap_or(0); COLUMNS];
    if place + COLUMNS <= REACH {
        return end(line.first());
    }
    if place >= line.len() + REACH {
        return end(line.last());
    }
    let inside = place.checked_sub(REACH).and_then(|x| line.get(x..)?.first_chunk());
    let outside = || {
        let column = |i: usize| (place + i).saturating_sub(REACH).min(line.len().saturating_sub(1));
        core::array::from_fn(|i| line.get(column(i)).copied().unwrap_or(0))
    };
    inside.copied().unwrap_or_else(outside)
}

/// Writes the numbers of a group for which the row has a place.
#[inline(always)]
pub(in crate::matching::backend) fn put(row: &mut [u8], group: Group) {
    match row.first_chunk_mut() {
        Some(four) => *four = group,
        None => row.iter_mut().zip(group).for_each(|(to, from)| *to = from),
    }
}
