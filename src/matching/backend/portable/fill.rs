//! Small gaps along a row closed, gap by gap.

use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::work::FillWork;
use crate::units::{Disparity, PixelFlags};

/// Fills the gaps of up to `most` pixels whose sides differ by up to `step`: some six instructions for a
/// pixel, and as many more for one that is filled.
#[inline(never)]
pub(in crate::matching::backend) fn fill(work: FillWork<'_>) {
    let FillWork { answers, flags, most, step, .. } = work;
    let most = usize::from(most);
    let mut end = 0;
    loop {
        let begin = next(answers, end, Disparity::is_none);
        end = next(answers, begin, Disparity::is_some);
        if end >= answers.len() {
            return;
        }
        if end - begin <= most {
            close(answers, flags, step, begin, end);
        }
    }
}

/// The first column from one on that is as asked, or how many there are.
#[inline(always)]
fn next(answers: &[Disparity], mut x: usize, is_asked: impl Fn(Disparity) -> bool) -> usize {
    while let Some(&answer) = answers.get(x)
        && !is_asked(answer)
    {
        keep_loop();
        x += 1;
    }
    x
}

/// Closes the gap between an answer and the one before it, if they are about the same.
#[inline(always)]
pub(in crate::matching::backend) fn close(
    answers: &mut [Disparity],
    flags: &mut [PixelFlags],
    step: Disparity,
    begin: usize,
    end: usize,
) {
    let sides = (begin.checked_sub(1).and_then(|left| answers.get(left)), answers.get(end));
    let (Some(&left), Some(&right)) = sides else { return };
    if left.raw().abs_diff(right.raw()) > step.raw() {
        return;
    }
    let lesser = if left.raw() < right.raw() { left } else { right };
    if let (Some(gap), Some(flags)) = (answers.get_mut(begin..end), flags.get_mut(begin..end)) {
        for (answer, flags) in gap.iter_mut().zip(flags) {
            keep_loop();
            (*answer, *flags) = (lesser, flags.union(PixelFlags::FILLED));
        }
    }
}
