//! Small gaps along a row closed, pixel by pixel.
//!
//! Two passes.

use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::work::FillWork;
use crate::units::{Disparity, PixelFlags};

/// Fills the gaps of up to `most` pixels whose sides differ by up to `step`.
#[inline(never)]
pub(in crate::matching::backend) fn fill(work: FillWork<'_>) {
    let FillWork { answers, flags, most, step, .. } = work;
    // On small cores the work is the same for every picture. Larger processors see at one look that a group
    // has no gap.
    if cfg!(stereopsis_simd) {
        gaps(answers, flags, most, step);
    } else {
        let mut right = ToRight { left: u32::from(Disparity::NONE.raw()), length: 0, most: u32::from(most) };
        let mut left = ToLeft { right: 0, refused: u32::MAX, step: u32::from(step.raw()) };
        right.through(answers, flags);
        left.through(answers, flags);
    }
}

/// Gap by gap.
fn gaps(answers: &mut [Disparity], flags: &mut [PixelFlags], most: u8, step: Disparity) {
    let mut end = 0;
    while let Some(rest) = answers.get(end..) {
        let whole = GROUP * rest.chunks(GROUP).take_while(|group| is_whole(group)).count();
        let Some(more) = rest.iter().skip(whole).position(|answer| answer.is_none()) else { return };
        let Some(length) = rest.iter().skip(whole + more).position(|answer| !answer.is_none()) else {
            return;
        };
        let begin = end + whole + more;
        end = begin + length;
        let sides = (begin.checked_sub(1).and_then(|left| answers.get(left)), answers.get(end));
        let (Some(&left), Some(&right)) = sides else { continue };
        if length > usize::from(most) || left.raw().abs_diff(right.raw()) > step.raw() {
            continue;
        }
        if let (Some(gap), Some(flags)) = (answers.get_mut(begin..end), flags.get_mut(begin..end)) {
            gap.fill(if left.raw() < right.raw() { left } else { right });
            flags.iter_mut().for_each(|flags| *flags = flags.union(PixelFlags::FILLED));
        }
    }
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

/// Pixels that are looked at together.
const GROUP: usize = 16;

/// Whether all of a group have an answer.
#[inline(always)]
fn is_whole(answers: &[Disparity]) -> bool {
    answers.iter().fold(0, |most, answer| most.max(answer.raw())) < Disparity::NONE.raw()
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
