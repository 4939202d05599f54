//! Answers that are less sure than asked for, refused.
//!
//! Last of all stages: what other rows make of an answer does not depend on it. A refused answer is kept
//! beside the confidences until the next row comes, and then goes back into the history, which has it as it
//! was decided.

use crate::matching::backend::loops::keep_loop;
use crate::matching::memory::rings::{BAND, waiting};
use crate::matching::method::Frame;
use crate::units::{Disparity, PixelFlags};

/// Refuses the answers of the row that waits that are under [`Config::min_confidence`].
///
/// [`Config::min_confidence`]: crate::matching::Config::min_confidence
#[inline(never)]
pub(super) fn refuse_unsure(frame: &mut Frame<'_>, newest: usize) {
    let least = frame.config.min_confidence;
    if least > 0 {
        let here = waiting(newest);
        let (confidences, withheld) = frame.workspace.confidences_and_withheld();
        let row = Row { answers: frame.finished.row_mut(here), flags: frame.flags.row_mut(here), withheld };
        row.refuse(confidences, least);
    }
}

/// Gives the row that came out last the answers back that [`refuse_unsure`] took, but where it was masked
/// since. A row that a lost line took the answers of has none to give back; one that is flagged for such a
/// line and keeps its answers is looked at by rows that have no flag.
#[inline(never)]
pub(super) fn restore_unsure(frame: &mut Frame<'_>, newest: usize) {
    if frame.config.min_confidence > 0 && newest >= BAND {
        let withheld = frame.workspace.withheld_before(frame.width);
        // Its slots are those of the newest row.
        let row =
            Row { answers: frame.finished.row_mut(newest), flags: frame.flags.row_mut(newest), withheld };
        row.restore();
    }
}

/// A finished row, and place for the answers that it loses.
struct Row<'a> {
    answers: &'a mut [Disparity],
    flags: &'a mut [PixelFlags],
    withheld: &'a mut [u16],
}

impl Row<'_> {
    #[inline(never)]
    fn refuse(self, confidences: &mut [u8], least: u8) {
        let pixels = self.answers.iter_mut().zip(self.flags).zip(self.withheld).zip(confidences);
        for (((answer, flags), withheld), confidence) in pixels {
            keep_loop();
            *withheld = Disparity::NONE.raw();
            if answer.is_some() && *confidence < least {
                // The history never has what was filled in.
                let answer = core::mem::take(answer);
                *withheld = if flags.contains(PixelFlags::FILLED) { Disparity::NONE } else { answer }.raw();
                *flags = flags.without(PixelFlags::FILLED).union(PixelFlags::AMBIGUOUS);
                *confidence = 0;
            }
        }
    }

    #[inline(never)]
    fn restore(self) {
        for ((answer, flags), withheld) in self.answers.iter_mut().zip(self.flags).zip(self.withheld) {
            keep_loop();
            if answer.is_none() && flags.without(PixelFlags::OUTSIDE) == *flags {
                *answer = Disparity::from_raw(*withheld);
            }
        }
    }
}
