//! Small gaps along a row closed, gap by gap.

use super::bits::{TOGETHER, bits_of, each, in_block};
use crate::matching::backend::portable::fill::close;
use crate::matching::backend::work::FillWork;
use crate::units::Disparity;

/// [`Isa::fill`](crate::matching::backend::Isa::fill).
#[inline(always)]
pub(super) fn fill(work: FillWork<'_>) {
    let FillWork { answers, flags, most, step, .. } = work;
    let (mut is_gap, mut begin) = (false, 0);
    for block in 0..answers.len().div_ceil(TOGETHER) {
        let none = bits_of(
            &in_block(answers, block, Disparity::NONE),
            #[inline(always)]
            |answer| answer.is_none(),
        );
        // A bit where gaps begin, and where they have ended.
        each(none ^ (none << 1 | u64::from(is_gap)), |place| {
            let x = block * TOGETHER + place;
            if is_gap && x - begin <= usize::from(most) {
                close(answers, flags, step, begin, x);
            }
            (is_gap, begin) = (!is_gap, x);
        });
    }
}
