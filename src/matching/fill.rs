//! Small gaps along a row closed.
//!
//! What the right camera does not see lies behind what hides it: a gap between two answers gets the smaller disparity of
//! the two. Gaps at the row's ends, which have an answer on one side only, stay.
//!
//! A filled answer is a guess and says so: it keeps the flags of what was refused there, gets
//! [`PixelFlags::FILLED`], and no other answer's uncertainty looks at it: [`take_back`] takes it out of the row once the
//! row has been seen.
//!
//! Two passes.

use crate::units::{Disparity, PixelFlags};

/// Fills the gaps of up to `most` pixels whose sides differ by up to `step`.
#[inline(never)]
pub(super) fn fill(answers: &mut [Disparity], flags: &mut [PixelFlags], most: u8, step: Disparity) {
    // To the right: what is in a gap gets the answer on its left, as far as the gap may reach, and the flag.
    let (mut left, mut length) = (u32::from(Disparity::NONE.raw()), 0u32);
    for (answers, flags) in answers.chunks_mut(GROUP).zip(flags.chunks_mut(GROUP)) {
        if let Some(last) = whole(answers) {
            (left, length) = (last, 0);
            continue;
        }
        for (answer, flags) in answers.iter_mut().zip(flags) {
            let here = u32::from(answer.raw());
            let gap = if_none(here);
            length = (length + 1) & gap;
            left ^= (left ^ here) & !gap;
            *answer = Disparity::from_raw((left | if_more(length, u32::from(most))) as u16);
            *flags = PixelFlags::from_bits(flags.bits() | PixelFlags::FILLED.bits() & gap as u8);
        }
    }
    // And back: the answer on its right, if that is less. What the pass before left out is at the gap's right end, and
    // so none of the gap is filled.
    let (mut right, mut refused) = (0, u32::MAX);
    for (answers, flags) in answers.chunks_mut(GROUP).zip(flags.chunks_mut(GROUP)).rev() {
        if let (Some(_), Some(first)) = (unfilled(flags), answers.first()) {
            (right, refused) = (u32::from(first.raw()), 0);
            continue;
        }
        for (answer, flags) in answers.iter_mut().zip(flags).rev() {
            let here = u32::from(answer.raw());
            let gap = if_filled(*flags);
            let apart = here.abs_diff(right);
            refused = (refused | if_none(here) | if_more(apart, u32::from(step.raw()))) & gap;
            right ^= (right ^ here) & !gap;
            let lesser = right ^ (right ^ here) & if_more(right, here);
            *answer = Disparity::from_raw((lesser | refused) as u16);
            *flags = PixelFlags::from_bits(flags.bits() & !(PixelFlags::FILLED.bits() & refused as u8));
        }
    }
}

/// Pixels of which one look tells that they have no gap, where that is done at all.
const GROUP: usize = 16;
/// Whether groups without a gap are passed over: on processors with vectors. On small cores the work is the same for every picture.
const PASSES_OVER: bool = cfg!(target_pointer_width = "64");

/// The last number of a group that has no gap.
#[inline(always)]
fn whole(answers: &[Disparity]) -> Option<u32> {
    let group = answers.first_chunk::<GROUP>().filter(|_| PASSES_OVER)?;
    let greatest = group.iter().fold(0, |most, answer| most.max(answer.raw()));
    (greatest < Disparity::NONE.raw()).then_some(u32::from(group[GROUP - 1].raw()))
}

/// Whether nothing is filled in a group.
#[inline(always)]
fn unfilled(flags: &[PixelFlags]) -> Option<()> {
    let group = flags.first_chunk::<GROUP>().filter(|_| PASSES_OVER)?;
    let any = group.iter().fold(0, |any, flags| any | flags.bits());
    (any & PixelFlags::FILLED.bits() == 0).then_some(())
}

/// Takes out what was filled: no answer again. The flags stay as they are.
#[inline(never)]
pub(super) fn take_back(answers: &mut [Disparity], flags: &[PixelFlags]) {
    for (answer, flags) in answers.iter_mut().zip(flags) {
        *answer = Disparity::from_raw(answer.raw() | if_filled(*flags) as u16);
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

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: u16 = Disparity::NONE.raw();

    #[test]
    fn gaps_between_answers_get_the_farther_one() {
        let row = [NONE, 320, NONE, NONE, 64, NONE, 96, NONE, NONE, NONE, 96, NONE];
        let mut answers = row.map(Disparity::from_raw);
        let mut flags = row.map(|raw| PixelFlags::MISMATCH.when(raw == NONE));
        let before = flags;
        fill(&mut answers, &mut flags, 2, Disparity::NONE);
        assert_eq!(answers.map(Disparity::raw), [NONE, 320, 64, 64, 64, 64, 96, NONE, NONE, NONE, 96, NONE]);
        for (x, (after, before)) in flags.into_iter().zip(before).enumerate() {
            assert_eq!(after, before.union(PixelFlags::FILLED.when([2, 3, 5].contains(&x))), "{x}");
        }
        take_back(&mut answers, &flags);
        assert_eq!(answers.map(Disparity::raw), row);
    }
}
