//! Small gaps along a row closed, gap by gap.

use crate::matching::backend::loops::{keep_loop, once_without_vectors};
use crate::matching::backend::work::FillWork;
use crate::units::PixelFlags;

/// Fills the gaps of up to `most` pixels whose sides differ by up to `step`: some ten instructions for a
/// pixel, and as many more for one that is filled.
#[inline(never)]
pub(in crate::matching::backend) fn fill(mut work: FillWork<'_>) {
    // The column behind the last answer.
    let mut begin = 0;
    for x in 0..work.answers.len() {
        keep_loop();
        if work.answers.get(x).is_some_and(|answer| answer.is_some()) {
            if begin < x {
                close(&mut work, begin, x);
            }
            begin = x + 1;
        }
    }
}

once_without_vectors! {
    /// Closes the gap between an answer and the one before it, if it is small and they are about the same.
    pub(in crate::matching::backend) fn close(work: &mut FillWork<'_>, begin: usize, end: usize) {
        let FillWork { answers, flags, most, step, .. } = work;
        let sides = (begin.checked_sub(1).and_then(|left| answers.get(left)), answers.get(end));
        let (Some(&left), Some(&right)) = sides else { return };
        if end - begin > usize::from(*most) || left.raw().abs_diff(right.raw()) > step.raw() {
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
}
