//! Answers smoothed down the columns.

use crate::matching::backend::loops::keep_scalar_loop;
use crate::matching::memory::rings::LOOK_AHEAD;
use crate::units::Disparity;
use core::hint::select_unpredictable;

/// Share of the summed differences that is taken: `SHARE` of `1 << SHIFT`.
pub(in crate::matching::backend) const SHARE: u32 = 5;
pub(in crate::matching::backend) const SHIFT: u32 = 5;
/// The differences reach from 1 px less up to, and not to, 1 px more.
pub(in crate::matching::backend) const REACH: u32 = Disparity::ONE as u32;
/// Half a step, and what the differences are too much by, less what they are counted from is too little by.
pub(in crate::matching::backend) const ROUNDED: u32 =
    (1 << (SHIFT - 1)) + (REACH << SHIFT) - SHARE * (LOOK_AHEAD as u32 + 1) * REACH;

/// Filters the answers `here` by those above, which have come out, and those [`LOOK_AHEAD`] rows below.
#[inline(always)]
pub(in crate::matching::backend) fn vertical(
    here: &mut [Disparity],
    above: &[Disparity],
    below: &[Disparity],
) {
    for (here, (above, below)) in here.iter_mut().zip(above.iter().zip(below)) {
        keep_scalar_loop();
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
            let mut row = [raw(here)];
            vertical(&mut row, &[raw(above)], &[raw(below)]);
            assert_eq!(row[0].raw(), smoothed, "{above} {here} {below}");
        }
    }
}
