//! What a pixel's cost compares, of four pixels at a time, in Arm's instructions on four bytes.

use crate::dsp::{ONE, add_even_bytes, add_odd_bytes, average, max, min, saturating_subtract_halves, select};
use crate::matching::backend::portable::sgm::features_by_four::{FourPixels, SIGNS};

/// Features in Arm's instructions on four bytes.
pub(in crate::matching::backend) struct DspRows;

impl FourPixels for DspRows {
    #[inline(always)]
    fn codes(here: u32, [a, b, c, d, e, f, g, h]: [u32; 8]) -> u32 {
        let mut codes = 0;
        let mut look = |neighbour: u32, bit: u32| codes = select(neighbour, here, codes, codes | ONE << bit);
        look(a, 0);
        look(b, 1);
        look(c, 2);
        look(d, 3);
        look(e, 4);
        look(f, 5);
        look(g, 6);
        look(h, 7);
        codes
    }

    #[inline(always)]
    fn plus_even(halves: u32, bytes: u32) -> u32 {
        add_even_bytes(halves, bytes)
    }

    #[inline(always)]
    fn plus_odd(halves: u32, bytes: u32) -> u32 {
        add_odd_bytes(halves, bytes)
    }

    #[inline(always)]
    fn cut(differences: [u32; 2], most: u32) -> u32 {
        // What the difference lacks of the greatest, 0 to the range: one saturating subtraction for each end.
        let (least, range) = (SIGNS - most, 2 * most);
        let [even, odd] =
            differences.map(|it| saturating_subtract_halves(range, saturating_subtract_halves(it, least)));
        (range | range << 8) - (even | odd << 8)
    }

    /// Of numbers of eight bits whose double is one; doubled.
    #[inline(always)]
    fn ranges([before, here, next]: [u32; 3]) -> (u32, u32) {
        let (a, b) = (average(before, here), average(here, next));
        (2 * min(here, min(a, b)), 2 * max(here, max(a, b)))
    }
}
