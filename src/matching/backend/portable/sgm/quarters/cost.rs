//! The costs of a row's pixels.
//!
//! Of a cost there is the agreement, the most that it may be less what it is, and the [`margin`]: a
//! difference that ends at 0 cuts the cost off, and the average, which is rounded down, rounds the cost up.

use super::columns::{FOUR, words};
use super::lanes::{ONE, TOP, average, over, splat};
use super::others::{NUMBERS, Others, gather};
use super::steps::margin;
use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::parameters::SgmParameters;
use crate::matching::backend::portable::sgm::features::Features;
use crate::matching::backend::work::PathWork;
use crate::matching::memory::slices::{chunks_mut, part, part_mut};
use crate::matching::memory::views::view_mut;
use core::cell::Cell;

/// Adds a row. There is room for so many groups of right pixels, more than a column has words.
#[inline(never)]
pub(super) fn enter<S: SgmParameters, const WORDS: usize, const ALL: bool, const GROUPS: usize>(
    work: &mut PathWork<'_>,
    features: &Features<'_>,
) {
    let Features { left, right, count } = *features;
    let words = words::<WORDS, ALL>(work);
    let most = splat(work.penalties.cost.into());
    let margin = splat(margin(work.penalties).into());
    let mut others = [Others::default(); GROUPS];
    gather::<S>(right, count, 0, words, &mut others);
    // The first of the next pixel.
    let mut first = 0;
    let pixels = left.along.iter().zip(left.across).zip(left.census.iter().zip(left.brightness));
    let columns = chunks_mut(view_mut::<u8, u32>(work.costs), words);
    for (x, (((&along, &across), (&census, &brightness)), column)) in pixels.zip(columns).enumerate() {
        if first + words > GROUPS {
            // The last are the first ones of this pixel. One place is left out: whole fours are made.
            let all = Cell::from_mut(others.as_flattened_mut()).as_slice_of_cells().as_chunks::<NUMBERS>().0;
            for (to, from) in part(all, 1..words).iter().zip(part(all, first..)) {
                keep_loop();
                to.iter().zip(from).for_each(|(to, from)| to.set(from.get()));
            }
            gather::<S>(right, count, x + words - 1, words, part_mut(&mut others, words..));
            first = 1;
        }
        let pixel = Pixel {
            along: splat(along.into()),
            across: splat(across.into()) | TOP,
            census: splat(census.into()),
            brightness: splat((brightness >> 1).into()) | TOP,
            most: most | TOP,
        };
        let others = part(&others, first..first + words);
        let fours = others.as_chunks::<FOUR>().0;
        for (cells, others) in column.as_chunks_mut::<FOUR>().0.iter_mut().zip(fours) {
            keep_loop();
            for (cell, others) in cells.iter_mut().zip(others) {
                let agreement = pixel.agreement(others) + margin;
                *cell = if S::WITHIN_EDGES { agreement } else { average(*cell, agreement) };
            }
        }
        first += 1;
    }
}

/// What a pixel of the left image looks like, four times. What is marked is no less than what it is compared
/// with.
struct Pixel {
    along: u32,
    across: u32,
    census: u32,
    brightness: u32,
    most: u32,
}

impl Pixel {
    /// By how much four candidates cost less than the most.
    #[inline(always)]
    fn agreement(&self, others: &Others) -> u32 {
        let [least, greatest, across, census, brightness] = *others;
        // One of the two is 0: the gradient is below the least or above the greatest, or neither.
        let along = over(least.wrapping_sub(self.along)) | over(greatest.wrapping_add(self.along));
        let (across, brightness) = (apart(self.across, across), apart(self.brightness, brightness));
        let rest =
            across.wrapping_add(brightness >> 2 & 0x3f3f_3f3f).wrapping_add(ones(self.census ^ census));
        over(self.most.wrapping_sub(along << 1).wrapping_sub(rest))
    }
}

/// How far apart numbers are, the first of which is marked.
#[inline(always)]
fn apart(marked: u32, other: u32) -> u32 {
    // 128 more or less: all bits turned, and one more, where it is less, and the top bit alone where not.
    let difference = marked.wrapping_sub(other);
    let not_less = (difference & TOP) >> 7;
    (difference ^ (!TOP + not_less)).wrapping_add(ONE - not_less)
}

/// How many bits of each byte are set.
#[inline(always)]
fn ones(bits: u32) -> u32 {
    let pairs = bits - (bits >> 1 & 0x5555_5555);
    let fours = (pairs & 0x3333_3333) + (pairs >> 2 & 0x3333_3333);
    (fours + (fours >> 4)) & 0x0f0f_0f0f
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_apart_and_bits() {
        for (a, b) in (0..128u32).flat_map(|a| (0..128).map(move |b| (a, b))) {
            let (first, second) = (a << 24 | b << 16 | a << 8 | 127, b << 24 | a << 16 | a << 8 | b);
            let expected = a.abs_diff(b) << 24 | a.abs_diff(b) << 16 | (127 - b);
            assert_eq!(apart(first | TOP, second), expected, "{a} {b}");
            let expected =
                (a << 1 | 1).count_ones() << 24 | b.count_ones() << 16 | 8 << 8 | (a ^ b).count_ones();
            assert_eq!(ones((a << 1 | 1) << 24 | b << 16 | 0xff00 | a ^ b), expected, "{a} {b}");
        }
    }
}
