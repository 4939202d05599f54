//! The row in Helium, the vectors of a Cortex-M55, in assembly, and the stages before and after it. Lanes
//! run over the disparities of one pixel, the largest first: so a pixel's candidates stand in memory as they
//! do in the right image.
//!
//! * [`census`]: the codes of `fast` and of `block`.
//! * [`columns`]: costs of a row added to the columns under the window, and others subtracted.
//! * [`windows`]: sums along the row, and the winner of each pixel.
//! * [`sgm`]: costs along paths.
//! * [`mod@sides`]: what is beside winners. [`mod@fractions`]: where between whole pixels they are.
//! * [`left_right`]: the left-right check. [`answers`]: winners made answers.
//! * [`mod@smooth`]: answers averaged within their surface, and its length.
//! * [`mod@edges`], [`mod@fattening`]: answers refused that spread.
//! * [`mod@speckle`]: support counted. [`mod@fill`]: small gaps closed.
//! * [`rows`]: rows filled and copied.
//!
//! Of safe Rust over fixed lanes the compiler makes two or three instructions where one is needed: it counts
//! bits in nine instructions, and looks for the winner in a loop of its own. Here
//!
//! * the window's sums of 32, 48 and 64 candidates stay in registers along the row, those of any other number
//!   are loaded and stored 16 at a time;
//! * how many bits differ is looked up, by one load that takes a place for each of 16 lanes (one instruction,
//!   though a core may spend a cycle on each place). The codes of `fast` have four bits: a byte holds those
//!   of the row that enters and of the one that leaves, and the table has the difference;
//! * a loop ends with `le`, which counts and jumps, or with `letp`, which leaves out the lanes that are too
//!   many as well.
//!
//! Vectors are no operands of `asm!`: it names them, and says that they are overwritten. Of their predicate
//! the compiler cannot be told. So every function with assembly stands alone (`inline(never)`), as no
//! predicate outlives a call. Addresses of loads that widen and of stores that narrow have to be in one of
//! the first registers, which are named too.

mod answers;
mod census;
mod columns;
mod edges;
mod fattening;
mod fill;
mod fractions;
mod left_right;
mod rows;
mod sgm;
mod sides;
mod smooth;
mod speckle;
mod windows;

use super::armv7em;
use super::isa::{Isa, sole_kernel};
use super::parameters::{MethodParameters, SgmParameters, WindowParameters};
use super::portable;
use super::work::{
    AnswerWork, CensusWork, CostWork, EdgeWork, FatteningWork, FillWork, Guide, MASKS, PathWork, STEP,
    SmoothWork, SpeckleWork, WindowWork,
};
use crate::matching::kernel::Kernel;
use crate::matching::memory::layout::OUTSIDE;
use crate::matching::memory::slices::{chunks, part, split_mut};
use crate::matching::memory::views::{Plain, view_mut};
use crate::matching::memory::winners::{Lengths, Select};
use crate::units::Disparity;
use core::ops::Range;
use rows::fill;
use sides::{complete, spread};
use windows::{BESIDE_SUMS, Windows, best_of_the_rest};

pub(in crate::matching) use super::plain::{BY_CAPACITY, CODES_SHARE_A_BYTE, columns_begin};

sole_kernel! {
    /// The vectors of a Cortex-M55, which the core has by what the compiler was given.
    Helium
}

impl Isa for Backend {
    #[inline(always)]
    fn kernel(self) -> Kernel {
        Kernel::Helium
    }

    #[inline(always)]
    fn candidates(self, disparities: usize, most: usize) -> usize {
        armv7em::candidates(disparities, most)
    }

    #[inline(always)]
    fn fill_bytes<T: Plain>(self, row: &mut [T], byte: u8) {
        fill(view_mut::<T, u8>(row), byte);
    }

    #[inline]
    fn census<P: WindowParameters>(self, work: CensusWork<'_>) {
        let (left, right) = split_mut(work.codes, work.codes.len() / 2);
        for (lines, codes) in work.lines.into_iter().zip([left, right]) {
            if P::BITS <= 4 {
                census::census_plus4(lines, view_mut::<u32, u8>(work.workspace), codes);
            } else {
                census::census_ring8(lines, codes);
            }
        }
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
        sgm::within_edges(work, edges);
    }

    #[inline(always)]
    fn sgm_select<const MOST: usize>(self, work: &mut PathWork<'_>, guide: Guide<'_>, select: Select<'_>) {
        sgm::select::<MOST>(work, guide, select);
    }

    #[inline(always)]
    fn left_right<P: MethodParameters>(self, work: AnswerWork<'_>) {
        let AnswerWork { winners, right, workspace, begin, pixels, rules, answers, flags } = work;
        let width = winners.width();
        let winners = winners.rows(begin);
        let (kept, fractions) = split_mut(view_mut::<u32, u8>(workspace), width);
        left_right::keep(&winners, pixels, right, kept);
        answers::answer::<P>(&winners, kept, rules, fractions, answers, flags);
    }

    #[inline(always)]
    fn smooth(self, work: SmoothWork<'_>) {
        let SmoothWork { answers, lengths, workspace, step, radius } = work;
        smooth::smooth(answers, lengths.bytes(), workspace, step, radius);
    }

    #[inline(always)]
    fn median(self, rows: [&[Disparity]; 3], out: &mut [Disparity]) {
        median(rows, out);
    }

    #[inline(always)]
    fn push_edges(self, edges: &mut [u8], lines: [&[u8]; 3], least: u16) {
        edges::push(edges, lines, least);
    }

    #[inline(always)]
    fn refuse_fattening(self, work: FatteningWork<'_>) {
        fattening::refuse(work);
    }

    #[inline(always)]
    fn fill(self, work: FillWork<'_>) {
        fill::fill(work);
    }

    #[inline(always)]
    fn limit_lengths(self, lengths: &mut Lengths<'_>, columns: Range<usize>, most: u8) {
        armv7em::limit(lengths.bytes_of(columns), most);
    }

    #[inline(always)]
    fn speckle(self, work: SpeckleWork<'_>) {
        speckle::speckle(work);
    }
}

#[inline(never)]
fn median(rows: [&[Disparity]; 3], out: &mut [Disparity]) {
    portable::median::median_in_rows(rows, out);
}

/// Bytes in a vector.
const LANES: usize = 16;

/// [`Isa::window`] in Helium.
#[inline(always)]
fn row<S: WindowParameters, const MOST: usize>(work: WindowWork<'_>, select: Option<Select<'_>>) {
    // The usual numbers of candidates, then any number of them.
    match work.stride {
        32 if MOST == 0 || MOST == 32 => row_of::<S, 32>(work, select),
        64 if MOST == 0 || MOST == 64 => row_of::<S, 64>(work, select),
        48 if MOST == 0 => row_of::<S, 48>(work, select),
        _ if MOST == 0 || MOST == 16 => row_of::<S, 0>(work, select),
        _ => {}
    }
}

#[inline(always)]
fn row_of<S: WindowParameters, const STRIDE: usize>(work: WindowWork<'_>, select: Option<Select<'_>>) {
    const { assert!(S::RADIUS_X < OUTSIDE && STEP == LANES) };
    let WindowWork { width, stride, min_disparity, enter, leave, columns, workspace } = work;
    // At least one vector, for the compiler to see that no column is empty.
    let stride = if STRIDE > 0 { STRIDE } else { stride.max(LANES) };
    let room = view_mut::<u32, u8>(workspace);
    if let Some(inside) = columns.get_mut(OUTSIDE * stride..(OUTSIDE + width) * stride) {
        if S::BITS <= 4 {
            columns::of_four_bits::<STRIDE>([enter, leave], min_disparity, stride, room, inside);
        } else {
            columns::of_eight_bits::<STRIDE>([enter, leave], min_disparity, stride, room, inside);
        }
    }
    if let Some(select) = select.filter(|_| room.len() > stride + BESIDE_SUMS) {
        let begin = min_disparity.min(width);
        winners::<S, STRIDE>(columns, stride, begin, width, room, select);
    }
}

/// The winners from column `begin` on. The `room` is for the window's sums and for records of winners.
#[inline(never)]
fn winners<S: WindowParameters, const STRIDE: usize>(
    columns: &[u8],
    stride: usize,
    begin: usize,
    width: usize,
    room: &mut [u8],
    select: Select<'_>,
) {
    let stride = if STRIDE > 0 { STRIDE } else { stride };
    let Select { disparities, winners, unique } = select;
    let mut rows = winners.rows(begin);
    // The column that leaves at the first pixel is among them.
    let from = |column: usize| part(columns, (column * stride).min(columns.len())..);
    let (leaves, enters) = (from(OUTSIDE + begin - S::RADIUS_X - 1), from(OUTSIDE + begin + S::RADIUS_X));
    let columns = chunks(leaves, stride).take(2 * S::RADIUS_X + 1);
    let mut windows = Windows::<STRIDE>::new(stride, leaves, enters, room);
    let inside = windows.sums();
    if STRIDE == 0 {
        fill(inside, 0);
        for column in columns {
            for (sum, column) in inside.iter_mut().zip(column) {
                *sum = sum.wrapping_add(column >> S::COLUMN_SHIFT);
            }
        }
    } else if let Some(sums) = inside.first_chunk_mut::<STRIDE>() {
        let mut first = [0u8; STRIDE];
        for column in columns.filter_map(|column| column.first_chunk::<STRIDE>()) {
            for lane in 0..STRIDE {
                first[lane] = first[lane].wrapping_add(column[lane] >> S::COLUMN_SHIFT);
            }
        }
        *sums = first;
    }
    let is_checked = unique.is_asked();
    let mut check = unique.checks_from(begin);
    // The first pixels have fewer candidates than the others.
    let few = (disparities - 1).min(width - begin);
    let mut done = 0;
    while done < width - begin {
        let alike = if done < few { few - done } else { width - begin - done };
        let count = if is_checked { 1 } else { alike.min(windows.at_once) };
        let candidates = (done + 1).min(disparities);
        let mask = part(MASKS, 256 - (stride - candidates)..);
        if STRIDE == 0 || candidates < stride {
            windows.select::<S, true>(count, mask, usize::from(done < few));
        } else {
            windows.select::<S, false>(count, mask, 0);
        }
        if is_checked {
            let (cost, disparity) = windows.only();
            check(cost, &mut || best_of_the_rest(disparity.into(), part(mask, ..stride), windows.sums()));
        }
        spread(windows.room, &mut rows, done..done + count, disparities);
        done += count;
    }
}
