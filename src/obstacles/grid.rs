//! Rows of pixels -> cells, each with the nearer of its two largest groups of like disparities.
//!
//! Of a cell every third column counts: answers side by side share most of their windows.

use crate::imaging::chunks;
use crate::units::{Disparity, PixelFlags};

/// A group of a cell's answers, each within one px of the one before it: a slanted surface is one group.
#[derive(Clone, Copy, Default, Debug)]
pub(super) struct Cluster {
    /// Number of answers in the upper 8 bits, their sum in the others: 255 of them are below 2^24.
    total: u32,
    last: u16,
}

impl Cluster {
    const EMPTY: Self = Self { total: 0, last: 0 };

    fn is_empty(self) -> bool {
        self.total == 0
    }

    fn count(self) -> u32 {
        self.total >> 24
    }

    /// Adds an answer that belongs to the group, or begins one; returns whether it did.
    #[inline(always)]
    fn take(&mut self, d: u16) -> bool {
        if !are_near(d, self.last) && !self.is_empty() {
            return false;
        }
        *self = Self { total: self.total.wrapping_add(1 << 24 | u32::from(d)), last: d };
        true
    }

    /// The mean answer, rounded, of a group of at least `least` pixels.
    fn mean(self, least: u32) -> Option<u16> {
        let (count, sum) = (self.count(), self.total & 0xff_ffff);
        let mean = (sum + count / 2).checked_div(count)?;
        (count >= least).then_some(mean as u16)
    }
}

/// Whether two answers are within one px.
#[inline(always)]
fn are_near(a: u16, b: u16) -> bool {
    const ONE: u32 = Disparity::ONE as u32;
    (u32::from(a) + ONE).wrapping_sub(b.into()) <= 2 * ONE
}

/// The two groups of a cell that is being filled.
///
/// An answer joins the first group whose last answer is within one px. One that joins neither begins the
/// second group, if that is empty or has one answer, and is ignored else.
#[derive(Clone, Copy, Default, Debug)]
pub struct Filling([Cluster; 2]);

impl Filling {
    pub(super) const EMPTY: Self = Self([Cluster::EMPTY; 2]);

    /// Adds an answer that did not join the first group.
    // Seldom, so that the loop over pixels stays small.
    #[inline(never)]
    fn take_second(&mut self, d: u16) {
        let [_, second] = &mut self.0;
        if !second.take(d) && second.count() == 1 {
            *second = Cluster::EMPTY;
            second.take(d);
        }
    }

    /// Adds a row's pixels of the cell, as far as they count, and returns the bits of all flags.
    #[inline(always)]
    fn take(&mut self, disparities: &[Disparity], flags: &[PixelFlags]) -> u8 {
        let [mut first, _] = self.0;
        let mut all = 0;
        for flags in flags {
            all |= flags.bits();
        }
        for (d, flags) in disparities.iter().zip(flags).step_by(3) {
            if d.is_some() && !flags.intersects(LEFT_OUT) && !first.take(d.raw()) {
                self.take_second(d.raw());
            }
        }
        self.0[0] = first;
        all
    }

    /// [`Self::take`] of pixels of which one may have to be left out.
    // Seldom, so that the loop over pixels stays small.
    #[inline(never)]
    fn take_flagged(&mut self, disparities: &[Disparity; 4], flags: &[PixelFlags; 4]) {
        self.take(disparities, flags);
    }

    /// Adds the pixels that count of four without a flag that leaves them out.
    #[inline(always)]
    fn take_four(&mut self, &[a, _, _, b]: &[Disparity; 4]) {
        // What is near to less than this is an answer; a number that an instruction of Arm's can hold.
        const SOME: u16 = 0xff00;
        const { assert!(SOME < Disparity::NONE.raw() - Disparity::ONE) };
        let [first, _] = &mut self.0;
        let joins = are_near(a.raw(), first.last) || first.is_empty();
        if b.raw() < SOME && are_near(b.raw(), a.raw()) && joins {
            let both = u32::from(a.raw()) + u32::from(b.raw());
            *first = Cluster { total: first.total.wrapping_add((2 << 24) + both), last: b.raw() };
        } else {
            self.take_apart([a, b]);
        }
    }

    /// Adds pixels that do not all join the first group, or have no answer.
    // Seldom, so that the loop over pixels stays small.
    #[inline(never)]
    fn take_apart(&mut self, disparities: [Disparity; 2]) {
        for d in disparities.into_iter().filter(|d| d.is_some()) {
            if !self.0[0].take(d.raw()) {
                self.take_second(d.raw());
            }
        }
    }

    /// The nearer of the groups that hold a quarter of the `count` pixels of the cell that count.
    pub(super) fn answer(&self, count: u8) -> Disparity {
        let least = u32::from(count.div_ceil(4));
        let nearest = self.0.iter().filter_map(|group| group.mean(least)).max();
        nearest.map_or(Disparity::NONE, Disparity::from_raw)
    }
}

/// What an answer must not have, to count: what was filled in is a guess, what is damaged may be wrong.
const LEFT_OUT: PixelFlags = PixelFlags::FILLED.union(PixelFlags::DAMAGED);

/// Adds a row of pixels to cells `cell_width` px wide, and returns all flags that a pixel of it has.
/// Confidences may be empty.
pub(super) fn fill(
    cells: &mut [Filling],
    cell_width: usize,
    disparities: &[Disparity],
    flags: &[PixelFlags],
    confidences: &[u8],
    min_confidence: u8,
) -> PixelFlags {
    let width = cell_width.max(1);
    let mut all = 0;
    if !confidences.is_empty() && min_confidence > 0 {
        let pixels = chunks(disparities, width).zip(chunks(flags, width));
        for (cell, ((disparities, flags), sure)) in
            cells.iter_mut().zip(pixels.zip(chunks(confidences, width)))
        {
            for (place, ((d, flags), &confidence)) in disparities.iter().zip(flags).zip(sure).enumerate() {
                let counts = confidence >= min_confidence && place.is_multiple_of(3);
                all |= cell.take(&[if counts { *d } else { Disparity::NONE }], &[*flags]);
            }
        }
    } else if let 4 = width {
        all = fill_fours(cells, disparities, flags);
    } else {
        let pixels = chunks(disparities, width).zip(chunks(flags, width));
        for (cell, (disparities, flags)) in cells.iter_mut().zip(pixels) {
            all |= cell.take(disparities, flags);
        }
    }
    PixelFlags::from_bits(all)
}

/// [`fill`] for cells of the default width, unrolled, with four flags in a word.
// Apart, so that the loop has all registers.
#[inline(never)]
fn fill_fours(cells: &mut [Filling], disparities: &[Disparity], flags: &[PixelFlags]) -> u8 {
    // Of all four, though two count: such a number an instruction of Arm's can hold.
    const LEFT_OUT_4: u32 = 0x0101_0101 * LEFT_OUT.bits() as u32;
    let pixels = disparities.as_chunks::<4>().0.iter().zip(flags.as_chunks::<4>().0);
    let mut all = 0;
    for (cell, (disparities, flags)) in cells.iter_mut().zip(pixels) {
        let word = u32::from_le_bytes(flags.map(PixelFlags::bits));
        all |= word;
        if word & LEFT_OUT_4 == 0 {
            cell.take_four(disparities);
        } else {
            cell.take_flagged(disparities, flags);
        }
    }
    all.to_le_bytes().into_iter().fold(0, |all, bits| all | bits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cell_answers_with_its_nearer_large_group() {
        let mut cell = Filling::EMPTY;
        cell.take(
            &[320, 0, 0, 330, 0, 0, 640, 0, 0, 641, 0, 0, 900, 0, 0, 322].map(Disparity::from_raw),
            &[PixelFlags::CLEAR; 16],
        );
        // Quarters of 8 pixels: (320 + 330 + 322) / 3 and (640 + 641) / 2 rounded up.
        assert_eq!(cell.answer(8), Disparity::from_raw(641));
        assert_eq!(cell.answer(12), Disparity::from_raw(324));
        assert_eq!(cell.answer(16), Disparity::NONE);
    }
}
