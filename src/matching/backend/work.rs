//! What the stages hand to a target's code: slices of a row and plain numbers.

use super::loops::fill_bytes;
use crate::matching::memory::Rows5;
use crate::matching::memory::slices::{chunks_mut, part_mut};
use crate::matching::memory::winners::{Lengths, Winners};
use crate::matching::penalties::Penalties;
use crate::units::{Disparity, PixelFlags};

/// Disparities are worked on in whole groups of this many.
pub(in crate::matching) const STEP: usize = 16;

/// 256 lanes of ones, then 256 of zero: a slice of it masks the lanes before any one.
pub(in crate::matching) const MASKS: &[u8; 512] = &{
    let mut masks = [0; 512];
    let mut i = 0;
    while i < 256 {
        masks[i] = u8::MAX;
        i += 1;
    }
    masks
};

/// The lines whose codes are made.
pub(in crate::matching) struct CensusWork<'a> {
    /// The five lines around the row, in both images.
    pub lines: [&'a Rows5<'a>; 2],
    /// The smallest disparity, px.
    pub min_disparity: usize,
    pub workspace: &'a mut [u32],
    /// The codes, at most two bytes a pixel, in the form in which [`Isa::window`](super::isa::Isa::window)
    /// takes them.
    pub codes: &'a mut [u8],
}

/// A row of codes that enters the window, and the columns' costs.
///
/// Candidate `d` of column `x` is the right image's column `x - min_disparity - d`. Where that lies left of
/// the image, kernels gather the cost against its first column and do not select it.
pub(in crate::matching) struct WindowWork<'a> {
    /// Pixels in the row.
    pub width: usize,
    /// Candidates of a column: [`Isa::candidates`](super::isa::Isa::candidates).
    pub stride: usize,
    /// The smallest disparity, px.
    pub min_disparity: usize,
    /// The row of [`Isa::census`](super::isa::Isa::census) that enters the window below, while there is one.
    pub enter: Option<&'a [u8]>,
    /// The row that leaves it above, once there is one.
    pub leave: Option<&'a [u8]>,
    /// Matching costs summed over the window's height, where a word may stand: `stride` bytes for each of
    /// the image's columns, and for each of [`OUTSIDE`](crate::matching::memory::layout::OUTSIDE)
    /// columns before and after that stay zero.
    pub columns: &'a mut [u8],
    /// What a kernel works with.
    pub workspace: &'a mut [u32],
}

/// A row of both images whose pixels' costs come in.
pub(in crate::matching) struct CostWork<'a> {
    /// Whether it is the first row of a frame, which has none above it.
    pub is_first: bool,
    /// The five lines around the row, in both images.
    pub lines: [&'a Rows5<'a>; 2],
    pub workspace: &'a mut [u8],
}

/// A row's costs and the paths through it.
///
/// Candidate `d` of column `x` is the right image's column `x - min_disparity - d`, where that lies left of
/// the image its first column. Lanes beyond the disparities that are searched are closed
/// ([`Self::close`]).
pub(in crate::matching) struct PathWork<'a> {
    /// Pixels in the row.
    pub width: usize,
    /// Lanes of a column: [`Isa::candidates`](super::isa::Isa::candidates).
    pub stride: usize,
    /// Disparities searched.
    pub disparities: usize,
    /// The smallest disparity, px.
    pub min_disparity: usize,
    pub penalties: &'a Penalties,
    /// How far gradients are shifted to the right.
    pub gradient_shift: u32,
    /// Costs, paths from above, and sums of paths: each `stride` bytes for each column, where a word may
    /// stand. The paths from above have [`COLUMNS_OFF`](crate::matching::memory::layout::COLUMNS_OFF)
    /// columns more.
    pub costs: &'a mut [u8],
    pub top: &'a mut [u8],
    pub sums: &'a mut [u8],
    /// What the passes that select winners work with: two bytes for each pixel, and six for each disparity
    /// but the last eight of all.
    pub workspace: &'a mut [u32],
}

impl PathWork<'_> {
    /// Puts what stands for a cost in all lanes beyond the search, of columns of so many bytes.
    ///
    /// With the most that a cost may be no path there is ever less than at the last disparity that is
    /// searched, so that none comes from there and none wins: minima, sums and averages keep that order.
    #[inline(always)]
    pub fn close(&mut self, stride: usize, cost: u8) {
        let beyond = stride.saturating_sub(self.disparities);
        if beyond > 0 {
            for column in chunks_mut(self.costs, stride) {
                fill_bytes(part_mut(column, ..beyond), cost);
            }
        }
    }
}

/// What the passes that select winners look at besides the costs.
#[derive(Clone, Copy)]
pub(in crate::matching) struct Guide<'a> {
    /// The left image's row.
    pub here: &'a [u8],
    /// The row above, if there is one.
    pub above: Option<&'a [u8]>,
    /// Number of the row.
    pub row: usize,
}

/// What the costs of a row are averaged with, and how far.
pub(in crate::matching) struct EdgeWork<'a> {
    /// The left image's row and the two below it; one outside of the image has no pixels.
    pub guides: [&'a [u8]; 3],
    /// The average of the row's costs and those above; afterwards that of the next row. As the volumes of
    /// [`PathWork`].
    pub above: &'a mut [u8],
    /// The costs of the next row's pixels; afterwards those of the row after it.
    pub below: &'a mut [u8],
}

/// A row of winners on its way to answers.
pub(in crate::matching) struct AnswerWork<'a> {
    /// The winners; left of the smallest disparity they mean nothing.
    pub winners: Winners<'a>,
    /// Workspace for what each right column keeps.
    pub right: &'a mut [u16],
    /// Workspace of two bytes a pixel.
    pub workspace: &'a mut [u32],
    /// The first column that has a candidate.
    pub begin: usize,
    /// Of a method that compares the pixels of an offer, the row of the left image from that column on, and
    /// the right image's row: as many as there are answers.
    pub pixels: Option<[&'a [u8]; 2]>,
    /// The checks that refuse winners.
    pub rules: &'a Rules,
    /// The answers and flags from that column on.
    pub answers: &'a mut [Disparity],
    pub flags: &'a mut [PixelFlags],
}

/// The checks that refuse winners.
pub(in crate::matching) struct Rules {
    /// The smallest disparity searched, px.
    pub min_disparity: u16,
    /// The last candidate.
    pub ceiling: u8,
    /// How far from the disparity that the partner keeps, px.
    pub tolerance: u8,
    /// The flag of winners that are flat.
    pub flat: PixelFlags,
    /// The flags that refuse.
    pub refused: PixelFlags,
}

/// A row of answers that are averaged within their surfaces.
pub(in crate::matching) struct SmoothWork<'a> {
    pub answers: &'a mut [Disparity],
    /// How many answers each one's surface has along the row.
    pub lengths: Lengths<'a>,
    /// Workspace of a number for each answer and `SMOOTH_MARGIN` more.
    pub workspace: &'a mut [u16],
    /// Largest difference between two neighbours of one surface.
    pub step: Disparity,
    /// Most pairs around each answer.
    pub radius: u8,
}

/// A row of answers of which those are refused that spread from a near surface.
pub(in crate::matching) struct FatteningWork<'a> {
    pub answers: &'a mut [Disparity],
    pub flags: &'a mut [PixelFlags],
    /// Edges of the rows in each column; the bit [`REFUSED`](FatteningWork::REFUSED) is free.
    pub edges: &'a mut [u8],
    /// The bit of the row.
    pub row: u8,
    /// Largest difference of two answers of one surface for each pixel between the two.
    pub slope: Disparity,
}

impl FatteningWork<'_> {
    /// The bit of a column that marks the row's answer.
    pub const REFUSED: u8 = 0x80;
    /// How much nearer than another an answer may be in any case: 2 px.
    pub const TOLERANCE: u16 = 2 * Disparity::ONE;
}

/// A row of answers whose small gaps are closed.
pub(in crate::matching) struct FillWork<'a> {
    pub answers: &'a mut [Disparity],
    pub flags: &'a mut [PixelFlags],
    /// Workspace of a number for each answer.
    pub room: &'a mut [u16],
    /// Most pixels of a gap, at least one.
    pub most: u8,
    /// Largest difference of the answers on both sides of a gap.
    pub step: Disparity,
}

/// A row of the band, the one above it, and the row that waited for it.
pub(in crate::matching) struct SpeckleWork<'a> {
    /// The newest row of the band.
    pub here: &'a [Disparity],
    /// The row above it.
    pub above: &'a [Disparity],
    /// How far each answer's surface goes along the newest row; they are done with.
    pub lengths: Lengths<'a>,
    /// All zero when a frame begins, then in the target's own form: the support of each column.
    pub kept: &'a mut [u16],
    /// The flags of the row that waited.
    pub flags: &'a mut [PixelFlags],
    /// The row that waited; where there is none, it is in `finished`.
    pub answers: Option<&'a [Disparity]>,
    /// Where the row that waited is finished.
    pub finished: &'a mut [Disparity],
    /// Largest difference between two neighbours of one surface.
    pub step: Disparity,
    /// The least support of an answer that stays.
    pub pixels: u8,
    /// The most that a row of a surface counts for; 0 for all that it has.
    pub run: u8,
}
