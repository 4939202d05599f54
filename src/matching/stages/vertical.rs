//! Answers smoothed down the columns, within their surface.
//!
//! What is left of the errors of answers that were averaged along the row changes little from column to
//! column, but from row to row. There are four rows below that are known already, and those above have come
//! out. With x an answer of row y as it is before, and v as it comes out,
//!
//! `v(y) = x(y) + (4 (v(y - 1) - x(y)) + (x(y + 4) - x(y))) 5 / 32`
//!
//! A recursive filter: each row has 5/8 of what came out above it, and so all rows above have a share that
//! dies away. The row four below has 5/32, a quarter of that at four times the distance: what is linear down
//! the column, as the disparity of a plane is, keeps its value. Of independent errors it would leave as much
//! as an average over 7 rows.
//!
//! Both others must be within 1 px of the answer; one without both stays as it is. What lies between is not
//! looked at, which measured no worse.

use crate::matching::backend::{Backend, Isa};
use crate::matching::memory::rings::{HISTORY, row};
use crate::units::Disparity;

/// Filters the row in slot `y % HISTORY` of the `finished` ones by the one above it, that has come out, and
/// the row `below` it by the speckle filter's look-ahead.
pub(super) fn vertical(backend: Backend, y: usize, finished: &mut [Disparity], below: &[Disparity]) {
    let width = below.len();
    let (before, rest) = finished.split_at_mut_checked(y % HISTORY * width).unwrap_or_default();
    let (here, after) = rest.split_at_mut_checked(width).unwrap_or_default();
    let above = match (y % HISTORY).checked_sub(1) {
        Some(above) => row(before, above, width),
        None => row(after, HISTORY - 2, width),
    };
    backend.vertical(here, above, below);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_stay_and_what_is_not_joined_stays() {
        const NONE: u16 = u16::MAX;
        // above, here, four rows below
        let rows = [
            ([320, 323, 335], 323),
            ([320, 328, 328], 323),
            ([328, 328, 359], 333),
            ([320, 352, 352], 332),
            ([320, 353, 353], 353),
            ([320, 320, 351], 325),
            ([320, 320, 352], 320),
            ([320, 320, 288], 315),
            ([NONE, 3, 3], 3),
            ([3, 3, NONE], 3),
            ([NONE, NONE, NONE], NONE),
        ];
        let raw = Disparity::from_raw;
        for ([above, here, below], smoothed) in rows {
            for y in 0..HISTORY {
                let mut finished = [raw(9999); HISTORY];
                finished[(y + HISTORY - 1) % HISTORY] = raw(above);
                finished[y] = raw(here);
                vertical(Backend::FIRST, y, &mut finished, &[raw(below)]);
                assert_eq!(finished[y].raw(), smoothed, "{above} {here} {below}");
            }
        }
    }
}
