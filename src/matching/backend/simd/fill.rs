//! Small gaps along a row closed, gap by gap.

use super::bits::{TOGETHER, bits_of, each, in_block};
use crate::matching::backend::work::FillWork;
use crate::units::{Disparity, PixelFlags};

/// [`Isa::fill`](crate::matching::backend::Isa::fill).
#[inline(always)]
pub(super) fn fill(mut work: FillWork<'_>) {
    let (mut is_gap, mut begin) = (false, 0);
    for block in 0..work.answers.len().div_ceil(TOGETHER) {
        let none = bits_of(
            &in_block(work.answers, block, Disparity::NONE),
            #[inline(always)]
            |answer| answer.is_none(),
        );
        // A bit where gaps begin, and where they have ended.
        each(none ^ (none << 1 | u64::from(is_gap)), |place| {
            let x = block * TOGETHER + place;
            if is_gap {
                close(&mut work, begin, x);
            }
            (is_gap, begin) = (!is_gap, x);
        });
    }
}

/// Closes the gap between an answer and the one before it, if it is small and they are.
#[inline(always)]
fn close(work: &mut FillWork<'_>, begin: usize, end: usize) {
    let FillWork { answers, flags, most, step, .. } = work;
    let sides = (begin.checked_sub(1).and_then(|left| answers.get(left)), answers.get(end));
    let (Some(&left), Some(&right)) = sides else { return };
    if end - begin > usize::from(*most) || left.raw().abs_diff(right.raw()) > step.raw() {
        return;
    }
    if let (Some(gap), Some(flags)) = (answers.get_mut(begin..end), flags.get_mut(begin..end)) {
        gap.fill(if left.raw() < right.raw() { left } else { right });
        flags.iter_mut().for_each(|flags| *flags = flags.union(PixelFlags::FILLED));
    }
}
