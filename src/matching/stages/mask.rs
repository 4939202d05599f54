//! Answers taken away where a camera did not see: outside of the valid area of a rectified image, or where a
//! line was lost.

use crate::units::{Disparity, PixelFlags};

/// Row `index`, which is out. All slices have its width, but where no confidences were asked for.
pub(in crate::matching) struct Masked<'a> {
    pub index: u16,
    pub answers: &'a mut [Disparity],
    pub flags: &'a mut [PixelFlags],
    pub confidences: &'a mut [u8],
    /// The answers that were [withheld](super::withhold), which the rows below look at; empty where none are.
    pub withheld: &'a mut [u16],
}

impl Masked<'_> {
    /// Flags the row as one that rests on a lost line, and takes its answers away unless `keeps_answers`.
    pub(in crate::matching) fn mark_damaged(self, keeps_answers: bool) {
        for flags in self.flags {
            let others = if keeps_answers { *flags } else { flags.without(PixelFlags::FILLED) };
            *flags = others.union(PixelFlags::DAMAGED);
        }
        if !keeps_answers {
            self.answers.fill(Disparity::NONE);
            self.confidences.fill(0);
            self.withheld.fill(Disparity::NONE.raw());
        }
    }

    /// Takes away what the masks say was not seen. In the right image an answer's partner is the nearest
    /// pixel; one left of it was not seen. A withheld answer is judged as one that is there: the rows below
    /// would be given it back. Of the flags, [`PixelFlags::DAMAGED`] stays.
    pub(in crate::matching) fn take_away(self, left: &[u8], right: &[u8]) {
        const HALF: u32 = Disparity::ONE as u32 / 2;
        let (mut confidences, mut withheld) = (self.confidences.iter_mut(), self.withheld.iter());
        let row = self.answers.iter_mut().zip(self.flags).zip(left).enumerate();
        for (x, ((answer, flags), &seen)) in row {
            let confidence = confidences.next();
            // No answer is the largest number.
            let found = answer.raw().min(withheld.next().copied().unwrap_or(Disparity::NONE.raw()));
            let away = (u32::from(found) + HALF) >> Disparity::FRACTION_BITS;
            let partner = x.checked_sub(away as usize).and_then(|partner| right.get(partner));
            let is_found = found != Disparity::NONE.raw();
            let is_lost = seen == 0 || (is_found && partner.is_none_or(|&seen| seen == 0));
            if is_lost {
                let damaged = PixelFlags::DAMAGED.when(flags.contains(PixelFlags::DAMAGED));
                (*answer, *flags) = (Disparity::NONE, PixelFlags::OUTSIDE.union(damaged));
                if let Some(confidence) = confidence {
                    *confidence = 0;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ends_of_an_answer_have_to_be_seen() {
        const NONE: Disparity = Disparity::NONE;
        let d = Disparity::from_raw;
        // Partners: -, 1, 0 (1.5 px, rounded up), 1 (1.47 px, rounded down), left of the image.
        let mut answers = [NONE, d(0), d(48), d(47), d(160)];
        let mut flags = [
            PixelFlags::SPECKLE,
            PixelFlags::CLEAR,
            PixelFlags::FILLED,
            PixelFlags::CEILING,
            PixelFlags::DAMAGED,
        ];
        let mut confidences = [0, 9, 9, 9, 9];
        let row = Masked {
            index: 0,
            answers: &mut answers,
            flags: &mut flags,
            confidences: &mut confidences,
            withheld: &mut [],
        };
        row.take_away(&[1, 1, 1, 1, 1], &[1, 0, 1, 1, 1]);
        let outside = PixelFlags::OUTSIDE;
        assert_eq!(answers, [NONE, NONE, d(48), d(47), NONE]);
        let damaged = outside.union(PixelFlags::DAMAGED);
        assert_eq!(flags, [PixelFlags::SPECKLE, outside, PixelFlags::FILLED, PixelFlags::CEILING, damaged]);
        assert_eq!(confidences, [0, 0, 9, 9, 0]);
        let row = Masked {
            index: 0,
            answers: &mut answers,
            flags: &mut flags,
            confidences: &mut [],
            withheld: &mut [],
        };
        row.take_away(&[0, 1, 1, 0, 1], &[1; 5]);
        assert_eq!(answers, [NONE, NONE, d(48), NONE, NONE]);
        assert_eq!(flags, [outside, outside, PixelFlags::FILLED, outside, damaged]);
        // Withheld: 1.5 px, rounded up to the pixel that was not seen, and 1.47 px.
        let (mut answers, unsure) = ([NONE; 5], PixelFlags::AMBIGUOUS);
        let mut flags = [unsure; 5];
        let none = NONE.raw();
        let row = Masked {
            index: 0,
            answers: &mut answers,
            flags: &mut flags,
            confidences: &mut [0; 5],
            withheld: &mut [none, none, 48, 47, none],
        };
        row.take_away(&[1; 5], &[0, 1, 1, 1, 1]);
        assert_eq!((answers, flags), ([NONE; 5], [unsure, unsure, outside, unsure, unsure]));
    }
}
