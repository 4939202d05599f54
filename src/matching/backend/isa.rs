//! What the stages ask of a target: one method for each stage that a target may have code of its own for.
//!
//! Every method has a portable body. A target overrides what it does better; all give the same bits.

use super::loops::fill_bytes;
use super::parameters::{MethodParameters, SgmParameters, WindowParameters};
use super::portable;
use super::work::{
    AnswerWork, CensusWork, CostWork, EdgeWork, FatteningWork, FillWork, Guide, PathWork, STEP, SmoothWork,
    SpeckleWork, WindowWork,
};
use crate::matching::kernel::Kernel;
use crate::matching::memory::slices::multiple_of;
use crate::matching::memory::views::Plain;
use crate::matching::memory::winners::{Lengths, Select};
use crate::units::Disparity;
use core::ops::Range;

/// The code of a target for the stages that it may have instructions for.
pub(in crate::matching) trait Isa: Copy {
    /// The kernel's name.
    fn kernel(self) -> Kernel;

    /// Whether winners stand in words, one for each pixel, and not in a row of bytes for each part.
    #[cfg(feature = "trace")]
    fn has_winners_in_words(self) -> bool {
        matches!(self.kernel(), Kernel::Planes | Kernel::Dsp | Kernel::Rvv)
    }

    /// How many candidates of a column the kernel works on for so many `disparities`, of which there is room
    /// for `most`, in whole [`STEP`]s.
    #[inline(always)]
    fn candidates(self, disparities: usize, most: usize) -> usize {
        if most.is_multiple_of(32) {
            return multiple_of::<32>(disparities).min(most) & !31;
        }
        multiple_of::<STEP>(disparities).min(most) & !(STEP - 1)
    }

    /// Makes every byte of a row's numbers the same one.
    #[inline(always)]
    fn fill_bytes<T: Plain>(self, row: &mut [T], byte: u8) {
        fill_bytes(row, byte);
    }

    /// Makes the census codes of a row of both images.
    #[inline(always)]
    fn census<P: WindowParameters>(self, work: CensusWork<'_>) {
        portable::planes::census::<P>(work);
    }

    /// Moves the window to the next row and selects its winners, unless the row is only gathered (`select` is
    /// `None`). The matcher has room for `MOST` disparities, or any number for 0: code for numbers of
    /// candidates that it never asks for is not compiled into it, here and in the other functions of a row.
    #[inline(always)]
    fn window<P: WindowParameters, const MOST: usize>(
        self,
        work: WindowWork<'_>,
        select: Option<Select<'_>>,
    ) {
        portable::planes::window::<P, MOST>(work, select);
    }

    /// Adds the costs of a row's pixels to those of a method along paths.
    #[inline(always)]
    fn sgm_cost<P: SgmParameters, const MOST: usize>(self, work: &mut PathWork<'_>, row: CostWork<'_>) {
        portable::sgm::cost_in_words::<P, MOST>(work, row);
    }

    /// Averages the costs of a row with those around it, within edges.
    #[inline(always)]
    fn sgm_within_edges<const MOST: usize>(self, work: &mut PathWork<'_>, edges: EdgeWork<'_>) {
        portable::sgm::within_edges_in_words::<MOST>(work, edges);
    }

    /// Aggregates the costs of a row along paths and selects its winners.
    #[inline(always)]
    fn sgm_select<const MOST: usize>(self, work: &mut PathWork<'_>, guide: Guide<'_>, select: Select<'_>) {
        portable::sgm::select_in_words::<MOST>(work, guide, select);
    }

    /// Makes answers of a row of winners, but of those that the right image or the rules refuse.
    #[inline(always)]
    fn left_right<P: MethodParameters>(self, work: AnswerWork<'_>) {
        portable::left_right::left_right::<P>(work);
    }

    /// Averages a row of answers within their surfaces, and counts how many answers each surface has along
    /// the row.
    #[inline(always)]
    fn smooth(self, work: SmoothWork<'_>) {
        portable::smooth::smooth(work);
    }

    /// Lets each answer in some columns count as at most `most`, 1 or more, of its surface along the row.
    #[inline(always)]
    fn limit_lengths(self, lengths: &mut Lengths<'_>, columns: Range<usize>, most: u8) {
        lengths.limit_half_words(columns, most.into());
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

    /// Moves each column's bits one row on and puts in whether the middle one of three lines has an edge
    /// there: Sobel's gradient along it of `least` eighths of a grey level per pixel.
    #[inline(always)]
    fn push_edges(self, edges: &mut [u8], lines: [&[u8]; 3], least: u16) {
        portable::edges::push(edges, lines, least);
    }

    /// Refuses the answers of a row that spread from a near surface.
    #[inline(always)]
    fn refuse_fattening(self, work: FatteningWork<'_>) {
        portable::fattening::refuse(work);
    }

    /// Closes the small gaps of a row of answers.
    #[inline(always)]
    fn fill(self, work: FillWork<'_>) {
        portable::fill::fill(work);
    }

    /// Filters a row of answers by the row above it and one below.
    #[inline(always)]
    fn vertical(self, here: &mut [Disparity], above: &[Disparity], below: &[Disparity]) {
        portable::vertical::vertical(here, above, below);
    }
}

/// The `Backend` of a target that has one kernel.
macro_rules! sole_kernel {
    ($(#[$doc:meta])* $kernel:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, Debug)]
        pub(in crate::matching) struct Backend;

        impl Backend {
            /// What a matcher is made with before it is started.
            pub(in crate::matching) const FIRST: Self = Self;

            /// The fastest code that this processor runs.
            pub(in crate::matching) fn detect() -> Self {
                Self
            }

            /// The code of a kernel, if this processor runs it.
            pub(in crate::matching) fn of(kernel: Kernel) -> Option<Self> {
                (kernel == Kernel::$kernel).then_some(Self)
            }
        }
    };
}
pub(super) use sole_kernel;
