//! Winners become answers with flags: the left-right check, the fraction of a pixel, and what refuses an
//! answer.
//!
//! Each column of the right image keeps the cheapest of the left pixels that chose it. A left pixel whose
//! disparity is far from what its partner kept was beaten there: it is occluded or wrong. Nothing is searched
//! a second time, and on real pairs the check refuses fewer right answers than one against the right image's
//! own winners. The work is the same for every row.

use crate::matching::backend::{Backend, Isa, MethodParameters, Rules, WinnerWork};
use crate::matching::config::Config;
use crate::matching::memory::winners::Winner;
use crate::units::{Disparity, PixelFlags};

/// A row of winners, and the workspace to make answers of them. The first two slices have the row's width.
pub(super) struct Winners<'a> {
    /// The winners.
    pub winners: &'a mut [Winner],
    /// Workspace for what each right column keeps.
    pub right: &'a mut [u16],
    /// Workspace of two bytes a pixel.
    pub workspace: &'a mut [u32],
}

/// Makes answers of the winners, none of those that the checks contradict, and says why: of `flags` those
/// stay that are set already.
pub(super) fn left_right<P: MethodParameters>(
    backend: Backend,
    config: &Config,
    row: Winners<'_>,
    answers: &mut [Disparity],
    flags: &mut [PixelFlags],
) {
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
    let (outside, answers) = answers.split_at_mut_checked(begin).unwrap_or_default();
    outside.fill(Disparity::NONE);
    let (outside, flags) = flags.split_at_mut_checked(begin).unwrap_or_default();
    outside.fill(PixelFlags::OUTSIDE);
    let Winners { winners, right, workspace } = row;
    backend.left_right::<P>(WinnerWork { winners, right, workspace, begin }, &rules, answers, flags);
}
