//! What the stages ask of a target: one method for each stage that a target may have code of its own for.
//!
//! Every method has a portable body. A target overrides what it does better; all give the same bits.

use super::parameters::{MethodParameters, SgmParameters, WindowParameters};
use super::portable;
use super::work::{EdgeWork, Guide, PathWork, Rules, STEP, SpeckleWork, WindowWork, WinnerWork};
use crate::matching::kernel::Kernel;
use crate::matching::memory::Rows5;
use crate::matching::memory::winners::{Lengths, Select};
use crate::units::{Disparity, PixelFlags};

/// The code of a target for the stages that it may have instructions for.
pub(in crate::matching) trait Isa: Copy {
    /// The kernel's name.
    fn kernel(self) -> Kernel;

    /// How many candidates of a column the kernel works on for so many `disparities`, of which there is room
    /// for `most`, in whole [`STEP`]s.
    #[inline(always)]
    fn candidates(self, disparities: usize, most: usize) -> usize {
        if most.is_multiple_of(32) {
            // Whole words, in a form that lets the compiler see it: a firmware is linked without what cannot
            // be asked for.
            return disparities.next_multiple_of(32).min(most) & !31;
        }
        disparities.next_multiple_of(STEP).min(most) & !(STEP - 1)
    }

    /// The census row of five lines in both images, in the form in which [`Self::window`] takes it: at most
    /// two bytes a pixel.
    #[inline(always)]
    fn census<P: WindowParameters>(
        self,
        lines: [&Rows5<'_>; 2],
        min_disparity: usize,
        workspace: &mut [u32],
        out: &mut [u8],
    ) {
        portable::planes::census::<P>(lines, min_disparity, workspace, out);
    }

    /// Moves the window to the next row and selects its winners, unless the row is only gathered (`select` is
    /// `None`).
    // Inlined, so that the compiler sees which numbers of candidates can be asked for, and a firmware is
    // linked without the code for others.
    #[inline(always)]
    fn window<P: WindowParameters>(self, work: WindowWork<'_>, select: Option<Select<'_>>) {
        portable::planes::window::<P>(work, select);
    }

    /// Adds a row of both images to the costs of a method along paths, the first row of a frame to none.
    #[inline(always)]
    fn sgm_cost<P: SgmParameters>(
        self,
        work: &mut PathWork<'_>,
        is_first: bool,
        lines: [&Rows5<'_>; 2],
        workspace: &mut [u8],
    ) {
        portable::sgm::cost_in_words::<P>(work, is_first, lines, workspace);
    }

    /// Averages the costs of a row with those around it, within edges.
    #[inline(always)]
    fn sgm_within_edges(self, work: &mut PathWork<'_>, edges: EdgeWork<'_>) {
        portable::sgm::within_edges_in_words(work, edges);
    }

    /// Aggregates the costs of a row along paths and selects its winners.
    #[inline(always)]
    fn sgm_select(self, work: PathWork<'_>, guide: Guide<'_>, select: Select<'_>) {
        portable::sgm::select_in_words(work, guide, select);
    }

    /// Makes answers of a row of winners, but of those that the right image or the rules refuse. Answers and
    /// flags begin at the first column that has a candidate.
    #[inline(always)]
    fn left_right<P: MethodParameters>(
        self,
        work: WinnerWork<'_>,
        rules: &Rules,
        answers: &mut [Disparity],
        flags: &mut [PixelFlags],
    ) {
        portable::left_right::left_right::<P>(work, rules, answers, flags);
    }

    /// Averages a row of answers within their surfaces, with up to `radius` pairs around each, and counts how
    /// many answers each one's surface has along the row.
    #[inline(always)]
    fn smooth(
        self,
        answers: &mut [Disparity],
        lengths: Lengths<'_>,
        workspace: &mut [u16],
        step: Disparity,
        radius: u8,
    ) {
        portable::smooth::smooth(answers, lengths.half_words(), workspace, step, radius);
    }

    /// Makes `out` the medians of 3 x 3 answers, those of the second of three rows in the middle.
    #[inline(always)]
    fn median(self, rows: [&[Disparity]; 3], out: &mut [Disparity]) {
        portable::median::median(rows, out);
    }

    /// Counts the support of a row of answers, and drops the speckle of the row that waited for it.
    #[inline(always)]
    fn speckle(self, work: SpeckleWork<'_>) {
        portable::speckle::speckle(work);
    }

    /// Filters a row of answers by the row above it and one below.
    #[inline(always)]
    fn vertical(self, here: &mut [Disparity], above: &[Disparity], below: &[Disparity]) {
        portable::vertical::vertical(here, above, below);
    }
}
