//! Small gaps along a row closed, pixel by pixel, in two passes.

use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::work::FillWork;
use crate::units::{Disparity, PixelFlags};

/// Fills the gaps of up to `most` pixels whose sides differ by up to `step`: the work is the same for every
/// picture.
#[inline(never)]
pub(in crate::matching::backend) fn fill(work: FillWork<'_>) {
    let FillWork { answers, flags, most, step, .. } = work;
    let mut right = ToRight { left: u32::from(Disparity::NONE.raw()), length: 0, most: u32::from(most) };
    let mut left = ToLeft { right: 0, refused: u32::MAX, step: u32::from(step.raw()) };
    right.through(answers, flags);
    left.through(answers, flags);
}

/// To the right: what is in a gap gets the answer on its left, as far as the gap may reach, and the flag.
struct ToRight {
    left: u32,
    length: u32,
    most: u32,
}

impl ToRight {
    #[inline(always)]
    fn through(&mut self, answers: &mut [Disparity], flags: &mut [PixelFlags]) {
        for (answer, flags) in answers.iter_mut().zip(flags) {
            keep_loop();
            let here = u32::from(answer.raw());
            let gap = if_none(here);
            self.length = (self.length + 1) & gap;
            self.left ^= (self.left ^ here) & !gap;
            *answer = Disparity::from_raw((self.left | if_more(self.length, self.most)) as u16);
            *flags = PixelFlags::from_bits(flags.bits() | PixelFlags::FILLED.bits() & gap as u8);
        }
    }
}

/// Second pass, from the right: the answer on its right, if that is less. What the pass before left out is at
/// the gap's right end, and so none of the gap is filled.
struct ToLeft {
    right: u32,
    refused: u32,
    step: u32,
}

impl ToLeft {
    #[inline(always)]
    fn through(&mut self, answers: &mut [Disparity], flags: &mut [PixelFlags]) {
        for (answer, flags) in answers.iter_mut().zip(flags).rev() {
            keep_loop();
            let here = u32::from(answer.raw());
            let gap = if_filled(*flags);
            let apart = here.abs_diff(self.right);
            self.refused = (self.refused | if_none(here) | if_more(apart, self.step)) & gap;
            self.right ^= (self.right ^ here) & !gap;
            let lesser = self.right ^ (self.right ^ here) & if_more(self.right, here);
            *answer = Disparity::from_raw((lesser | self.refused) as u16);
            *flags = PixelFlags::from_bits(flags.bits() & !(PixelFlags::FILLED.bits() & self.refused as u8));
        }
    }
}

/// All ones for the number of [`Disparity::NONE`], nothing for a smaller one.
#[inline(always)]
fn if_none(raw: u32) -> u32 {
    0u32.wrapping_sub((raw + 1) >> 16)
}

/// All ones for a flag, nothing without.
#[inline(always)]
fn if_filled(flags: PixelFlags) -> u32 {
    const BIT: u32 = PixelFlags::FILLED.bits().trailing_zeros();
    0u32.wrapping_sub(u32::from(flags.bits() >> BIT & 1))
}

/// All ones where `a` is more than `b`, both far under 2^31.
#[inline(always)]
fn if_more(a: u32, b: u32) -> u32 {
    (b.wrapping_sub(a) as i32 >> 31) as u32
}
