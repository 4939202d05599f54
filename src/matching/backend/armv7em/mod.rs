//! The kernel in bytes, for cores with Arm's instructions on four bytes in a word (Cortex-M4, M7, M33): a
//! word is four candidates of a column, the smallest disparity lowest.
//!
//! In running order:
//!
//! * `census`: the codes of a row.
//! * `tables`: what every left code of four bits costs against a row's right codes.
//! * `columns`: costs into the columns under the window.
//! * `windows`: columns into windows, windows into winners.
//! * `rows`: the right codes from right to left, and the loops of both over the pixels of a row, in assembly
//!   for the usual numbers of candidates.
//! * `left_right`, `answers`: winners into answers; `fattening`: those refused that spread; `smooth`: these
//!   averaged; `speckle`: their support counted, which all methods share; `vertical`: answers averaged down
//!   the columns.
//! * `sgm`: costs along paths.
//!
//! The compiler has no instructions on four bytes, and keeps too little in registers: the loops over pixels
//! are in assembly. A loop over two pixels in a round is entered in its middle where their number is odd.
//! Each loop is a function that stands alone (`inline(never)`). Where a loop needs more registers than
//! operands may be, or such that one instruction loads, all of them are named, and the two that are not the
//! assembly's (r6, r7) are kept on the stack.
//!
//! The work is the same for every picture, but for a few instructions where a winner is at an end of the
//! search and where a gap is filled.

mod answers;
mod census;
mod columns;
mod fattening;
mod left_right;
mod rows;
pub(super) mod sgm;
mod smooth;
mod speckle;
mod tables;
mod vertical;
mod windows;

use super::isa::{Isa, sole_kernel};
use super::loops::keep_scalar_loop;
use super::parameters::{MethodParameters, SgmParameters, WindowParameters};
use super::work::{
    AnswerWork, CensusWork, CostWork, EdgeWork, FatteningWork, Guide, PathWork, STEP, SmoothWork,
    SpeckleWork, WindowWork,
};
use super::{TABLE_WORDS, TABLE_WORDS_OF_EIGHT};
use crate::matching::kernel::Kernel;
use crate::matching::memory::Rows5;
use crate::matching::memory::slices::{multiple_of, part, split_mut};
use crate::matching::memory::views::view_mut;
use crate::matching::memory::winners::{Lengths, Select};
use crate::units::Disparity;
use core::ops::Range;

#[allow(unused_imports, reason = "on a Cortex-M55 vectors do the most of it")]
pub(in crate::matching) use super::plain::{BY_CAPACITY, columns_begin};

/// Whether the two codes of a pixel share a byte where codes have up to four bits.
pub(in crate::matching) const CODES_SHARE_A_BYTE: bool = true;

sole_kernel! {
    /// Arm's instructions on four bytes, which the core has by what the compiler was given.
    Dsp
}

impl Isa for Backend {
    #[inline(always)]
    fn kernel(self) -> Kernel {
        Kernel::Dsp
    }

    #[inline(always)]
    fn candidates(self, disparities: usize, most: usize) -> usize {
        candidates(disparities, most)
    }

    #[inline(always)]
    fn census<P: WindowParameters>(self, work: CensusWork<'_>) {
        codes_of::<P>(work.lines, work.codes);
    }

    #[inline(always)]
    fn window<P: WindowParameters, const MOST: usize>(
        self,
        work: WindowWork<'_>,
        select: Option<Select<'_>>,
    ) {
        row::<P, MOST>(work, select);
    }

    #[inline(always)]
    fn sgm_cost<P: SgmParameters, const MOST: usize>(self, work: &mut PathWork<'_>, row: CostWork<'_>) {
        sgm::cost::<P, MOST>(work, row);
    }

    #[inline(always)]
    fn sgm_within_edges<const MOST: usize>(self, work: &mut PathWork<'_>, edges: EdgeWork<'_>) {
        sgm::within_edges::<MOST>(work, edges);
    }

    #[inline(always)]
    fn sgm_select<const MOST: usize>(self, work: &mut PathWork<'_>, guide: Guide<'_>, select: Select<'_>) {
        sgm::select::<false, MOST>(work, guide, select);
    }

    #[inline(always)]
    fn left_right<P: MethodParameters>(self, work: AnswerWork<'_>) {
        let AnswerWork { winners, right, begin, pixels, rules, answers, flags, .. } = work;
        let winners = part(winners.words(), begin..);
        left_right::offer(winners, pixels, right);
        answers::answer::<P>(winners, right, rules, answers, flags);
    }

    #[inline(always)]
    fn smooth(self, work: SmoothWork<'_>) {
        let SmoothWork { answers, lengths, workspace, step, radius } = work;
        smooth::smooth(answers, lengths.bytes(), workspace, step, radius);
    }

    #[inline(always)]
    fn limit_lengths(self, lengths: &mut Lengths<'_>, columns: Range<usize>, most: u8) {
        // Lengths are less by the answer itself.
        limit(lengths.bytes_of(columns), most.wrapping_sub(1));
    }

    #[inline(always)]
    fn speckle(self, work: SpeckleWork<'_>) {
        speckle::speckle(work);
    }

    #[inline(always)]
    fn refuse_fattening(self, work: FatteningWork<'_>) {
        fattening::refuse(work);
    }

    #[inline(always)]
    fn vertical(self, here: &mut [Disparity], above: &[Disparity], below: &[Disparity]) {
        vertical::vertical(here, above, below);
    }
}

/// Lets none of the numbers be over `most`.
#[inline(always)]
pub(super) fn limit(numbers: &mut [u8], most: u8) {
    for number in numbers {
        keep_scalar_loop();
        *number = most.min(*number);
    }
}

/// Number of candidates that a block of assembly takes: as many as there is assembly for, at least one.
#[inline(always)]
pub(super) fn candidates(disparities: usize, most: usize) -> usize {
    if most.is_multiple_of(64) {
        return (multiple_of::<64>(disparities).min(most) & !63).max(64);
    }
    if most.is_multiple_of(32) {
        return (multiple_of::<32>(disparities).min(most) & !31).max(32);
    }
    multiple_of::<STEP>(disparities).min(most) & !(STEP - 1)
}

/// Bytes of a code's line in the tables of codes of four bits, and of eight.
const LINE: usize = 96;
const LINE_OF_EIGHT: usize = 88;
const _: () = assert!(TABLE_WORDS == 2 * tables::words::<LINE>() + 4);
const _: () = assert!(TABLE_WORDS_OF_EIGHT == 2 * tables::words::<LINE_OF_EIGHT>());

/// A row's columns and what enters and leaves them.
struct Rows<'a> {
    width: usize,
    stride: usize,
    min_disparity: usize,
    enter: Option<&'a [u8]>,
    leave: Option<&'a [u8]>,
}

/// The codes of a row: where codes have four bits a pixel's two are one byte, the left one
/// low; else the left ones are before the right ones.
#[inline]
fn codes_of<S: WindowParameters>([left, right]: [&Rows5<'_>; 2], out: &mut [u8]) {
    if S::BITS > 4 {
        let (of_left, of_right) = split_mut(out, out.len() / 2);
        census::census::<S>(left, false, of_left);
        census::census::<S>(right, false, of_right);
        return;
    }
    census::census::<S>(left, false, out);
    census::census::<S>(right, true, out);
}

/// [`Isa::window`] for the usual numbers of candidates, and any other.
#[inline(always)]
fn row<S: WindowParameters, const MOST: usize>(work: WindowWork<'_>, select: Option<Select<'_>>) {
    // The usual numbers of candidates, then any number of them.
    match work.stride {
        16 if MOST == 0 || MOST == 16 => row_of::<S, 16>(work, select),
        32 if MOST == 0 || MOST == 32 => row_of::<S, 32>(work, select),
        48 if MOST == 0 => row_of::<S, 48>(work, select),
        64 if MOST == 0 || MOST == 64 => row_of::<S, 64>(work, select),
        _ if MOST == 0 => row_of::<S, 0>(work, select),
        _ => {}
    }
}

#[inline(always)]
fn row_of<S: WindowParameters, const STRIDE: usize>(work: WindowWork<'_>, select: Option<Select<'_>>) {
    let WindowWork { width, stride, min_disparity, enter, leave, columns, workspace } = work;
    let rows = Rows { width, stride, min_disparity, enter, leave };
    let columns = view_mut::<u8, u32>(columns);
    // The first column that a window with a candidate has.
    let begin = min_disparity.min(width).saturating_sub(S::RADIUS_X);
    if S::BITS > 4 {
        columns::update_eights::<STRIDE, LINE_OF_EIGHT>(&rows, begin, workspace, columns);
    } else {
        columns::update_fours::<STRIDE, LINE>(&rows, begin, workspace, columns);
    }
    if let Some(select) = select {
        windows::select::<S, STRIDE>(&rows, workspace, columns, select);
    }
}
