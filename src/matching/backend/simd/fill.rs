//! Small gaps along a row closed, gap by gap: at one look a group of pixels has none.

use crate::matching::backend::work::FillWork;
use crate::units::{Disparity, PixelFlags};

/// Pixels that are looked at together.
const GROUP: usize = 16;

/// Whether all of a group have an answer.
#[inline(always)]
fn is_whole(answers: &[Disparity]) -> bool {
    answers.iter().fold(0, |most, answer| most.max(answer.raw())) < Disparity::NONE.raw()
}

/// [`Isa::fill`](crate::matching::backend::Isa::fill).
#[inline(always)]
pub(super) fn fill(work: FillWork<'_>) {
    let FillWork { answers, flags, most, step, .. } = work;
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
