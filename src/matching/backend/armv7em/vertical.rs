//! Answers smoothed down the columns, two at a time: what `portable::vertical` does.

use crate::dsp::{add_halves, halved_difference, select_halves, subtract_halves};
use crate::matching::backend::portable;
use crate::matching::backend::portable::vertical::{REACH, ROUNDED, SHARE, SHIFT};
use crate::matching::memory::rings::LOOK_AHEAD;
use crate::units::Disparity;

/// A one in both halves of a word.
const ONES: u32 = 0x0001_0001;
/// The bits of a difference within reach, and of what an answer is moved by.
const WITHIN: u32 = (2 * REACH - 1) * ONES;
const _: () = assert!(REACH.is_power_of_two() && REACH > 1);
const _: () = assert!((2 * REACH - 1) * (LOOK_AHEAD as u32 + 1) * SHARE + ROUNDED < 2 * REACH << SHIFT);

/// Filters the answers `here` by those above, which have come out, and those [`LOOK_AHEAD`] rows below. 10
/// instructions a pixel.
pub(super) fn vertical(here: &mut [Disparity], above: &[Disparity], below: &[Disparity]) {
    let (twos, rest) = here.as_chunks_mut::<2>();
    let ((above, above_rest), (below, below_rest)) = (above.as_chunks(), below.as_chunks());
    for (here, (above, below)) in twos.iter_mut().zip(above.iter().zip(below)) {
        let x = word(here);
        let least = subtract_halves(x, REACH * ONES);
        let [above, below] = [above, below].map(word);
        let [up, down] = [above, below].map(|other| subtract_halves(other, least));
        // No answer is not near to the smallest ones, from which a half wraps round to it: half of a
        // difference has its sign, and is below 0 where the difference is.
        let from_least = |other| add_halves(halved_difference(other, x), REACH / 2 * ONES);
        let is_beyond = from_least(above) | from_least(below);
        // What is beyond reach carries into the other answer, if it is not cut off.
        let differences = (up & WITHIN) * LOOK_AHEAD as u32 + (down & WITHIN);
        let moved = add_halves(least, (differences * SHARE + ROUNDED * ONES) >> SHIFT & WITHIN);
        let out = select_halves(is_beyond, REACH * ONES, x, moved);
        *here = [out, out >> 16].map(|half| Disparity::from_raw(half as u16));
    }
    portable::vertical::vertical(rest, above_rest, below_rest);
}

/// Two answers in the halves of a word.
#[inline(always)]
fn word(two: &[Disparity; 2]) -> u32 {
    u32::from(two[0].raw()) | u32::from(two[1].raw()) << 16
}
