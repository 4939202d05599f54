//! Support counted and speckle dropped, answer by answer.

use super::smooth::of_one;
use crate::matching::backend::loops::{copy_row, keep_loop, once_without_vectors};
use crate::matching::backend::work::SpeckleWork;
use crate::matching::memory::rings::LOOK_AHEAD;
use crate::units::{Disparity, PixelFlags};

/// Bits of rows that go on, and then of rows that have enough.
pub(in crate::matching::backend) const ROWS: usize = LOOK_AHEAD;

/// What the numbers are worked on in: where there are vectors, half-words, of which they hold more.
#[cfg(stereopsis_simd)]
type Word = u16;
#[cfg(not(stereopsis_simd))]
type Word = u32;

/// Counts the support of the newest row, and drops the answers of the row that waited which have less than
/// is asked for. What is kept of a column is, from the lowest bit up: whether each of the last four rows goes
/// on from the one above it, the newest row first; whether each of them has enough; the support counted so
/// far, as far as a byte holds it.
#[inline(always)]
pub(in crate::matching::backend) fn speckle(work: SpeckleWork<'_>) {
    let SpeckleWork { here, above, lengths, kept, flags, answers, finished, step, pixels, run } = work;
    let pixels = (pixels, if run == 0 { u16::MAX } else { run.into() });
    let columns = here.iter().zip(above).zip(lengths.half_words().iter().zip(kept));
    if let Some(answers) = answers {
        copy_row(answers, finished);
    }
    drop_speckle(columns, flags.iter_mut().zip(finished), step, pixels);
}

/// An answer of the newest row with the one above it, its surface's length and what its column keeps.
type Column<'a> = ((&'a Disparity, &'a Disparity), (&'a u16, &'a mut u16));

once_without_vectors! {
    #[allow(clippy::unnecessary_cast, reason = "a word is a half-word on some cores only")]
    fn drop_speckle<'a>(
        columns: impl Iterator<Item = Column<'a>>,
        out: impl Iterator<Item = (&'a mut PixelFlags, &'a mut Disparity)>,
        step: Disparity,
        (pixels, run): (u8, u16),
    ) {
        let pixels = Word::from(pixels);
        for (((here, above), (&length, kept)), (flags, answer)) in columns.zip(out) {
            keep_loop();
            let joined = Word::from(of_one(here.raw(), above.raw(), step));
            let before = Word::from(*kept);
            let support = before >> (2 * ROWS) & Word::MIN.wrapping_sub(joined);
            let count = Word::from(length.min(run)).saturating_add(support).min(0xff);
            // Each bit stands for the row before now; the highest of both halves goes.
            let mut rows = (before << 1 & 0b1_1110_1110) | joined;
            // This row, and those above as far as they are joined.
            let reached = rows ^ (rows + 1);
            rows |= reached << ROWS & Word::MIN.wrapping_sub(Word::from(count >= pixels));
            *kept = (count << (2 * ROWS) | rows & 0xff) as u16;
            let refused = rows & 1 << (ROWS + LOOK_AHEAD) == 0;
            let decided = Disparity::from_raw(answer.raw() | 0u16.wrapping_sub(u16::from(refused)));
            // What has no answer is no speckle.
            *flags = flags.union(PixelFlags::SPECKLE.when(decided != *answer));
            *answer = decided;
        }
    }
}
