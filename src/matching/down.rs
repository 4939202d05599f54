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

use super::kernels::Kernel;
use super::row::{HISTORY, slot};
use super::speckle::LOOK_AHEAD;
use crate::units::Disparity;
use core::hint::select_unpredictable;

/// Of the sum of the differences so much is taken.
const SHARE: u32 = 5;
const SHIFT: u32 = 5;
/// The differences reach from 1 px less up to, and not to, 1 px more.
const REACH: u32 = Disparity::ONE as u32;
/// Half a step, and what the differences are too much by, less what they are counted from is too little by.
const ROUNDED: u32 = (1 << (SHIFT - 1)) + (REACH << SHIFT) - SHARE * (LOOK_AHEAD as u32 + 1) * REACH;

/// Smoothes the row in slot `y % HISTORY` of the `finished` ones by the one above it, that has come out, and
/// row [`LOOK_AHEAD`] `below` it.
pub(super) fn smooth(kernel: Kernel, y: usize, finished: &mut [Disparity], below: &[Disparity]) {
    let width = below.len();
    let (before, rest) = finished.split_at_mut_checked(y % HISTORY * width).unwrap_or_default();
    let (here, after) = rest.split_at_mut_checked(width).unwrap_or_default();
    let above = match (y % HISTORY).checked_sub(1) {
        Some(above) => slot(before, above, width),
        None => slot(after, HISTORY - 2, width),
    };
    #[cfg(target_pointer_width = "64")]
    if kernel.has_vectors() {
        return kernel.in_vectors(
            #[inline(always)]
            || row(here, above, below),
        );
    }
    let _ = kernel;
    row(here, above, below);
}

/// The same, with the three rows.
#[inline(always)]
fn row(here: &mut [Disparity], above: &[Disparity], below: &[Disparity]) {
    for (here, (above, below)) in here.iter_mut().zip(above.iter().zip(below)) {
        // From what is 1 px less, differences within reach are no less than 0, and all of their bits are
        // below that of 2 px.
        let x = u32::from(here.raw());
        let least = x.wrapping_sub(REACH);
        let [up, down] = [above, below].map(|other| u32::from(other.raw()).wrapping_sub(least));
        let differences = up.wrapping_mul(LOOK_AHEAD as u32).wrapping_add(down);
        let moved = least.wrapping_add(differences.wrapping_mul(SHARE).wrapping_add(ROUNDED) >> SHIFT);
        // No branch: pictures decide nothing about the work.
        *here = Disparity::from_raw(select_unpredictable((up | down) < 2 * REACH, moved, x) as u16);
    }
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
                smooth(Kernel::FIRST, y, &mut finished, &[raw(below)]);
                assert_eq!(finished[y].raw(), smoothed, "{above} {here} {below}");
            }
        }
    }
}
