//! What a method keeps from row to row, and its workspace.
//!
//! * `rings`: rows that are kept for a while.
//! * `winner`, `winners`: what the winner-take-all stage gives for each pixel.
//! * `views`: one memory looked at as numbers of another width.
//! * `layout`: memory whose size depends on the capacity.

pub(in crate::matching) mod layout;
pub(in crate::matching) mod rings;
pub(in crate::matching) mod views;
pub(in crate::matching) mod winner;
pub(in crate::matching) mod winners;

pub use rings::Rows5;

use super::config::Config;
use layout::{Aligned, Columns, OUTSIDE, WindowWorkspace};
use rings::first;
use views::{view, view_mut};
use winners::Winner;

/// How much memory a method takes: always, and multiples of the width, of width x disparities, and of the
/// disparities.
pub struct Bytes {
    pub fixed: usize,
    pub per_pixel: usize,
    pub per_candidate: usize,
    pub per_disparity: usize,
}

/// The memory of a method, all zero when it is [`Memory::EMPTY`].
pub trait Memory {
    const EMPTY: Self;
    /// All of it, cut to a frame's width, but for the columns.
    fn parts(&mut self, width: usize) -> Parts<'_>;
    /// Bytes of the columns that a frame of this width and so many candidates takes.
    fn column_bytes(width: usize, stride: usize) -> usize;
    /// What stands where the winners of a row stood, a byte for each of its pixels, until the next row.
    fn after_winners(&self, width: usize) -> &[u8];
    /// Mutable access to these bytes, and to what nothing needs until the next row.
    fn after_row(&mut self, width: usize) -> AfterRow<'_>;
}

/// A finished row's bytes, one for each pixel.
pub struct AfterRow<'a> {
    /// [`Memory::after_winners`].
    pub confidences: &'a mut [u8],
    /// Room for two masks.
    pub masks: [&'a mut [u8]; 2],
}

/// The memory of a method as slices.
pub struct Parts<'a> {
    /// What the rows that are still wanted look like.
    pub codes: &'a mut [u8],
    /// Room for what is summed for every candidate of every column, where a word may stand.
    pub columns: &'a mut [u8],
    /// Of each column its winner, what the right one keeps, and how long its surface is along the row; empty
    /// where these share the `workspace`.
    pub winners: &'a mut [Winner],
    pub right: &'a mut [u16],
    pub lengths: &'a mut [u16],
    /// Room to work in.
    pub workspace: &'a mut [u32],
}

/// The memory of a window over `ROWS` rows of codes, with the one that leaves it: `CODES` bytes for the two
/// of a pixel. Of its room to work in, `TABLES` words are beside what grows with the frame.
pub struct WindowMemory<
    const CODES: usize,
    const ROWS: usize,
    const TABLES: usize,
    const W: usize,
    const D: usize,
> {
    codes: Aligned<[[[u8; CODES]; W]; ROWS]>,
    columns: Columns<W, D>,
    scratch: WindowWorkspace<TABLES, W, D>,
    winners: [Winner; W],
    right: [u16; W],
    lengths: [u16; W],
}

impl<const CODES: usize, const ROWS: usize, const TABLES: usize> WindowMemory<CODES, ROWS, TABLES, 0, 0> {
    /// The codes; the scratch's codes, the winner, what the right column keeps and the length.
    pub const BYTES: Bytes = Bytes {
        fixed: TABLES * size_of::<u32>(),
        per_pixel: CODES * ROWS + 2 + 4 + 2 + 2,
        per_candidate: 1,
        per_disparity: 3 + 2 * OUTSIDE,
    };
}

impl<const CODES: usize, const ROWS: usize, const TABLES: usize, const W: usize, const D: usize> Memory
    for WindowMemory<CODES, ROWS, TABLES, W, D>
{
    const EMPTY: Self = Self {
        codes: Aligned([[[0; CODES]; W]; ROWS]),
        columns: Columns::ZERO,
        scratch: WindowWorkspace::ZERO,
        winners: [Winner::NONE; W],
        right: [0; W],
        lengths: [0; W],
    };

    fn parts(&mut self, width: usize) -> Parts<'_> {
        Parts {
            codes: first(self.codes.0.as_flattened_mut().as_flattened_mut(), CODES * width * ROWS),
            columns: self.columns.flat(),
            winners: first(&mut self.winners, width),
            right: first(&mut self.right, width),
            lengths: first(&mut self.lengths, width),
            workspace: self.scratch.words(),
        }
    }

    fn column_bytes(width: usize, stride: usize) -> usize {
        (width + 2 * OUTSIDE) * stride
    }

    fn after_winners(&self, width: usize) -> &[u8] {
        view::<Winner, u8>(&self.winners).get(..width).unwrap_or(&[])
    }

    fn after_row(&mut self, width: usize) -> AfterRow<'_> {
        let masks = view_mut::<u16, u8>(first(&mut self.right, width));
        let (left, right) = masks.split_at_mut_checked(width).unwrap_or_default();
        AfterRow {
            confidences: first(view_mut::<Winner, u8>(&mut self.winners), width),
            masks: [left, right],
        }
    }
}

/// Where the margins of a row's winners stand until the lengths of its surfaces are counted: a byte for each
/// pixel. Empty where no confidences are asked for.
#[inline(always)]
pub(super) fn margins<'a>(config: &Config, lengths: &'a mut [u16]) -> &'a mut [u8] {
    if config.confidence { first(view_mut::<u16, u8>(lengths), usize::from(config.width)) } else { &mut [] }
}
