//! Answers dropped that too few others support, in a band of five rows.
//!
//! An answer's support is counted along a cross (after Zhang, Lu & Lafruit 2009): from it straight up and down as far
//! as the answers are of one surface, and from each of these along its row as far as that surface goes. Upwards every
//! row counts, downwards the [`LOOK_AHEAD`] rows that have come when the row is judged. For a small patch that is its
//! size or little less; counting a patch exactly (a union-find over the band) refuses the same answers to within a few
//! in a hundred, but its work depends on the picture. This one's does not.
//!
//! Each row adds its surfaces' lengths to the support of the row above where the two are of one surface, so that the
//! support of an answer is what the lowest row has that goes on from it.

use super::row::slot;
use crate::units::{Disparity, PixelFlags};

/// Rows that must follow before a row is judged.
pub(super) const LOOK_AHEAD: usize = 4;
/// Rows of the band: a ring, row `y` in slot `y % BAND`.
pub(super) const BAND: usize = LOOK_AHEAD + 1;

/// How many rows further down a surface goes on, by the last four bits of a column's history: their leading ones.
const ROWS_ON: [u8; 1 << LOOK_AHEAD] = [0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 3, 4];

/// Adds what row `y` has to the support from above. `support` holds the lengths of its surfaces in its own slot; each
/// column's `history` gets a bit, whether it goes on from the row above.
#[inline(never)]
pub(super) fn count(y: usize, band: &[Disparity], support: &mut [u16], history: &mut [u8], step: Disparity) {
    let width = history.len();
    if y == 0 {
        history.fill(0);
        return;
    }
    let (here, above) = (slot(band, y % BAND, width), slot(band, (y - 1) % BAND, width));
    let Some((support, before)) = two_slots(support, y % BAND, (y - 1) % BAND, width) else { return };
    let step = u32::from(step.raw());
    let rows = here.iter().zip(above).zip(support.iter_mut().zip(before)).zip(history);
    for (((here, above), (support, before)), history) in rows {
        let change = u32::from(here.raw()).wrapping_sub(u32::from(above.raw()));
        let joined = change.wrapping_add(step) <= 2 * step;
        *support = support.saturating_add(*before & 0u16.wrapping_sub(u16::from(joined)));
        *history = *history << 1 | u8::from(joined);
    }
}

/// A row below the image: no surface goes on.
pub(super) fn end(history: &mut [u8]) {
    for history in history {
        *history <<= 1;
    }
}

/// Judges row `y`, after the rows that it waits for: what is finished are the `answers` without those that have less
/// support than `pixels`.
#[inline(never)]
pub(super) fn judge(
    y: usize,
    pixels: u16,
    support: &[u16],
    history: &[u8],
    answers: &[Disparity],
    flags: &mut [PixelFlags],
    finished: &mut [Disparity],
) {
    let width = history.len();
    // Where the row is that each history ends in.
    let rows = ROWS_ON.map(|rows| (y + usize::from(rows)) % BAND * width);
    let pixels_of_row = finished.iter_mut().zip(answers).zip(flags).zip(history);
    for (x, (((finished, answer), flags), history)) in pixels_of_row.enumerate() {
        let row = rows[usize::from(*history) % rows.len()];
        let count = support.get(row + x).copied().unwrap_or(u16::MAX);
        let refused = count < pixels;
        // What has no answer is no speckle.
        *flags = flags.union(PixelFlags::SPECKLE.when(refused & answer.is_some()));
        *finished = Disparity::from_raw(answer.raw() | 0u16.wrapping_sub(u16::from(refused)));
    }
}

/// Two slots of a ring, the first to write.
fn two_slots(rows: &mut [u16], write: usize, read: usize, width: usize) -> Option<(&mut [u16], &[u16])> {
    let (low, high) = rows.split_at_mut_checked(write.max(read) * width)?;
    let low = low.get_mut(write.min(read) * width..)?.get_mut(..width)?;
    let high = high.get_mut(..width)?;
    Some(if write < read { (low, high) } else { (high, low) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_history_says_how_many_rows_go_on() {
        for (history, rows) in ROWS_ON.iter().enumerate() {
            // Bit 3 is the row below the judged one.
            assert_eq!(u32::from(*rows), (history as u8 | 0xf0).leading_ones() - 4);
        }
    }
}
