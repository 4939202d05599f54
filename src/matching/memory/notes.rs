//! What is kept of a pixel while its row waits for its confidences: flags and the winner's margin in a byte.
//!
//! ```text
//! row of the band      without confidences   with confidences
//! newest, left_right   flags                 flags
//! newest .. waiting    flags                 notes
//! waiting              flags                 flags, once its confidences are made
//! ```
//!
//! What is refused has flags and what is answered has a margin, so that one byte holds both.

use crate::units::{Disparity, PixelFlags};

/// Why a pixel has no answer, or how sure its answer is by its costs. Which of the two it is, the pixel's
/// answer says.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub(in crate::matching) struct Note(pub(super) u8);

impl Note {
    /// The largest margin that is told apart: seven bits.
    pub(in crate::matching) const MOST_MARGIN: u8 = 127;
    /// The bit of [`PixelFlags::CEILING`], the one flag that stands with an answer.
    const CEILING: u8 = 0x80;

    /// Notes the margin of an answer; without an answer, the flags stay.
    #[inline(always)]
    pub(in crate::matching) fn take(&mut self, margin: u8, answer: Disparity) {
        if answer.is_some() {
            let ceiling =
                Self::CEILING * u8::from(PixelFlags::from_bits(self.0).contains(PixelFlags::CEILING));
            self.0 = margin.min(Self::MOST_MARGIN) | ceiling;
        }
    }

    /// Returns the margin that was noted of an answer, and leaves the pixel's flags.
    #[inline(always)]
    pub(in crate::matching) fn give_back(&mut self, answer: Disparity) -> u8 {
        let noted = self.0;
        if answer.is_some() {
            self.0 = PixelFlags::CEILING.when(noted & Self::CEILING != 0).bits();
        }
        noted & Self::MOST_MARGIN
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_gives_its_margin_back_and_what_is_refused_its_flags() {
        for (bits, margin) in (0..=255).flat_map(|bits| (0..=255).map(move |margin| (bits, margin))) {
            let flags = PixelFlags::from_bits(bits);
            let mut note = Note(flags.bits());
            note.take(margin, Disparity::ZERO);
            assert_eq!(note.give_back(Disparity::ZERO), margin.min(127), "{bits} {margin}");
            let ceiling = PixelFlags::CEILING.when(flags.contains(PixelFlags::CEILING));
            assert_eq!(note.0, ceiling.bits(), "{bits} {margin}");

            let mut note = Note(flags.bits());
            note.take(margin, Disparity::NONE);
            note.give_back(Disparity::NONE);
            assert_eq!(note.0, flags.bits(), "{bits} {margin}");
        }
    }
}
