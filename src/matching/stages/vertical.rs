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
//! Each of the two others must be at most 1 px less than the answer and less than 1 px more; without both it
//! stays as it is. What lies between is not
//! looked at, which measured no worse.

use crate::matching::backend::Isa;
use crate::matching::memory::rings::{LOOK_AHEAD, waiting};
use crate::matching::method::{Frame, Method};

/// Filters the row that waits down the columns, with the row above it and the newest one below.
pub(super) fn filter_vertically<S: Method>(frame: &mut Frame<'_>, newest: usize) {
    // The first row has none above it, and the last have none so far below.
    let inside = LOOK_AHEAD + 1..usize::from(frame.config.height);
    if S::VERTICAL_FILTER && frame.config.checks.smoothing_radius > 0 && inside.contains(&newest) {
        let (here, above) = frame.finished.row_and_above(waiting(newest));
        frame.backend.vertical(here, above, frame.band.row(newest));
    }
}
