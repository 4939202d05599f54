//! Small gaps along a row closed.
//!
//! What the right camera does not see lies behind what hides it: a gap between two answers gets the smaller
//! disparity of the two. Gaps at the row's ends, which have an answer on one side only, stay.
//!
//! A filled answer is a guess and says so: it keeps the flags of what was refused there, gets
//! [`PixelFlags::FILLED`], and no other answer's uncertainty looks at it: [`undo`] takes it out of the
//! row once the row has been seen.

use crate::matching::backend::loops::{HAS_VECTORS, keep_loop, keep_scalar_loop};
use crate::matching::backend::{FillWork, Isa};
use crate::matching::memory::rings::waiting;
use crate::matching::method::Frame;
use crate::units::{Disparity, PixelFlags};

/// Takes what was filled out of the row that came out last: the history keeps it as it was decided.
pub(super) fn undo_fill(frame: &mut Frame<'_>, newest: usize) {
    if frame.config.checks.fill_pixels > 0 {
        // Its slots are those of the newest row.
        undo(frame.finished.row_mut(newest), frame.flags.row(newest));
    }
}

/// Closes the small gaps of the row that waits.
pub(super) fn fill_gaps(frame: &mut Frame<'_>, newest: usize) {
    let checks = &frame.config.checks;
    if checks.fill_pixels > 0 {
        let here = waiting(newest);
        let (answers, flags) = (frame.finished.row_mut(here), frame.flags.row_mut(here));
        let (most, step) = (checks.fill_pixels, checks.fill_step);
        frame.backend.fill(FillWork { answers, flags, room: frame.workspace.scratch(), most, step });
    }
}

/// Takes out what was filled: no answer again. The flags stay as they are.
#[inline(never)]
fn undo(answers: &mut [Disparity], flags: &[PixelFlags]) {
    if HAS_VECTORS {
        return undo_each(answers, flags);
    }
    /// The flag in each byte.
    const FILLED: u64 = u64::MAX / 255 * PixelFlags::FILLED.bits() as u64;
    let (groups, rest) = answers.as_chunks_mut::<8>();
    let (flags, flags_rest) = flags.as_chunks();
    for (answers, flags) in groups.iter_mut().zip(flags) {
        keep_loop();
        // Mostly none of them is.
        if u64::from_le_bytes(flags.map(PixelFlags::bits)) & FILLED != 0 {
            for (answer, flags) in answers.iter_mut().zip(flags) {
                keep_loop();
                if flags.contains(PixelFlags::FILLED) {
                    *answer = Disparity::NONE;
                }
            }
        }
    }
    undo_each(rest, flags_rest);
}

/// Where there are vectors, pixels side by side.
#[inline(never)]
fn undo_each(answers: &mut [Disparity], flags: &[PixelFlags]) {
    const BIT: u32 = PixelFlags::FILLED.bits().trailing_zeros();
    for (answer, flags) in answers.iter_mut().zip(flags) {
        keep_scalar_loop();
        // All ones for a flag, nothing without.
        let filled = 0u16.wrapping_sub(u16::from(flags.bits() >> BIT & 1));
        *answer = Disparity::from_raw(answer.raw() | filled);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::backend::Backend;

    const NONE: u16 = Disparity::NONE.raw();

    #[test]
    fn gaps_between_answers_get_the_farther_one() {
        let row = [NONE, 320, NONE, NONE, 64, NONE, 96, NONE, NONE, NONE, 96, NONE];
        let mut answers = row.map(Disparity::from_raw);
        let mut flags = row.map(|raw| PixelFlags::MISMATCH.when(raw == NONE));
        let before = flags;
        let mut room = [0; 12];
        Backend::detect().fill(FillWork {
            answers: &mut answers,
            flags: &mut flags,
            room: &mut room,
            most: 2,
            step: Disparity::NONE,
        });
        assert_eq!(answers.map(Disparity::raw), [NONE, 320, 64, 64, 64, 64, 96, NONE, NONE, NONE, 96, NONE]);
        for (x, (after, before)) in flags.into_iter().zip(before).enumerate() {
            assert_eq!(after, before.union(PixelFlags::FILLED.when([2, 3, 5].contains(&x))), "{x}");
        }
        undo(&mut answers, &flags);
        assert_eq!(answers.map(Disparity::raw), row);
    }
}
