//! Winners become answers with flags: the left-right check, the fraction of a pixel, and what refuses an
//! answer.
//!
//! Each column of the right image keeps the cheapest of the left pixels that chose it. A left pixel whose
//! disparity is far from what its partner kept was beaten there: it is occluded or wrong. Nothing is searched
//! a second time, and on real pairs the check refuses fewer right answers than one against the right image's
//! own winners. The work is the same for every row.

use crate::matching::backend::{AnswerWork, Isa, Rules, answer_records};
use crate::matching::memory::slices::{part, split_mut};
use crate::matching::memory::views::view;
use crate::matching::memory::workspace::ForAnswers;
use crate::matching::method::{Frame, Method};
use crate::units::{Disparity, PixelFlags};

/// Turns the winners of `newest` into answers, none of those that the checks contradict, and says why: flags
/// that are set already stay.
pub(super) fn make_answers<S: Method>(frame: &mut Frame<'_>, newest: usize) {
    let (answers, flags) = (frame.band.row_mut(newest), frame.flags.row_mut(newest));
    let config = frame.config;
    let checks = &config.checks;
    let rules = Rules {
        min_disparity: config.min_disparity,
        ceiling: (config.disparities - 1) as u8,
        // Where nothing is checked, nothing is over the tolerance.
        tolerance: checks.left_right_px.unwrap_or(u8::MAX),
        flat: PixelFlags::UNTEXTURED.when(checks.refuse_flat),
        refused: PixelFlags::UNTEXTURED
            .union(PixelFlags::AMBIGUOUS)
            .union(PixelFlags::MISMATCH)
            .union(PixelFlags::CEILING.when(checks.refuse_ceiling)),
    };
    // Left of here no pixel has a candidate.
    let width = answers.len();
    let begin = usize::from(config.min_disparity).min(width);
    let (outside, answers) = split_mut(answers, begin);
    outside.fill(Disparity::NONE);
    let (outside, flags) = split_mut(flags, begin);
    outside.fill(PixelFlags::OUTSIDE);
    let rules = &rules;
    if S::EXTERNAL_WINNERS {
        return answer_records::<S>(part(view(frame.codes), begin..), rules, answers, flags);
    }
    let ForAnswers { winners, right, workspace } = frame.workspace.for_answers();
    frame.backend.left_right::<S>(AnswerWork { winners, right, workspace, begin, rules, answers, flags });
}
