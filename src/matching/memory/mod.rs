//! What a method keeps from row to row, and its workspace.
//!
//! * `slices`: parts of slices, whose sizes are asserted here and nowhere else.
//! * `views`: one memory looked at as numbers of another width.
//! * `rings`: rows that are kept for a while.
//! * `record`: the winner of a pixel as another device hands it over.
//! * `winner`, `winners`: what the winner-take-all stage gives for each pixel.
//! * `notes`: flags and margins in one byte, while a row waits for its confidences.
//! * `workspace`: what a row's stages share, and its phases.
//! * `layout`: memory whose size depends on the capacity.

pub(in crate::matching) mod layout;
pub(in crate::matching) mod notes;
pub(in crate::matching) mod record;
pub(in crate::matching) mod rings;
pub(in crate::matching) mod slices;
pub(in crate::matching) mod views;
pub(in crate::matching) mod winner;
pub(in crate::matching) mod winners;
pub(in crate::matching) mod workspace;

pub use rings::Rows5;

use layout::{Aligned, Columns, OUTSIDE, WindowWorkspace};
use record::WinnerRecord;
use slices::{part, part_mut};
use views::{view, view_mut};
use winners::Winner;
use workspace::RowWorkspace;

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
    /// The confidences of the row that is out, a byte for each pixel, where its workspace has them.
    fn confidences(&self, width: usize) -> &[u8];
    /// The workspace of the row that is out.
    fn finished(&mut self, width: usize) -> RowWorkspace<'_> {
        self.parts(width).workspace
    }
}

/// The memory of a method as slices.
pub struct Parts<'a> {
    /// What the rows that are still wanted look like.
    pub codes: &'a mut [u8],
    /// Room for what is summed for every candidate of every column, where a word may stand.
    pub columns: &'a mut [u8],
    /// What the stages of a row work with.
    pub workspace: RowWorkspace<'a>,
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
    workspace: WindowWorkspace<TABLES, W, D>,
    winners: [Winner; W],
    right: [u16; W],
    lengths: [u16; W],
}

impl<const CODES: usize, const ROWS: usize, const TABLES: usize> WindowMemory<CODES, ROWS, TABLES, 0, 0> {
    /// The codes; the workspace's codes, the winner, what the right column keeps and the length.
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
        workspace: WindowWorkspace::ZERO,
        winners: [Winner::NONE; W],
        right: [0; W],
        lengths: [0; W],
    };

    fn parts(&mut self, width: usize) -> Parts<'_> {
        Parts {
            codes: part_mut(self.codes.0.as_flattened_mut().as_flattened_mut(), ..CODES * width * ROWS),
            columns: self.columns.flat(),
            workspace: RowWorkspace::of_rows(
                part_mut(&mut self.winners, ..width),
                part_mut(&mut self.right, ..width),
                part_mut(&mut self.lengths, ..width),
                self.workspace.words(),
            ),
        }
    }

    fn column_bytes(width: usize, stride: usize) -> usize {
        (width + 2 * OUTSIDE) * stride
    }

    fn confidences(&self, width: usize) -> &[u8] {
        part(view::<Winner, u8>(&self.winners), ..width)
    }
}

/// The memory of a method whose winners come from outside: a row of them, and its workspace.
pub struct RecordMemory<const W: usize, const D: usize> {
    records: Aligned<[WinnerRecord; W]>,
    workspace: WindowWorkspace<0, W, D>,
    winners: [Winner; W],
    right: [u16; W],
    lengths: [u16; W],
}

impl RecordMemory<0, 0> {
    /// The record; the workspace's numbers, what a finished row has, masks or gaps, and the length.
    pub const BYTES: Bytes = Bytes {
        fixed: 0,
        per_pixel: WinnerRecord::BYTES + 2 + 4 + 2 + 2,
        per_candidate: 0,
        per_disparity: 3,
    };
}

impl<const W: usize, const D: usize> Memory for RecordMemory<W, D> {
    const EMPTY: Self = Self {
        records: Aligned([WinnerRecord::ZERO; W]),
        workspace: WindowWorkspace::ZERO,
        winners: [Winner::NONE; W],
        right: [0; W],
        lengths: [0; W],
    };

    fn parts(&mut self, width: usize) -> Parts<'_> {
        Parts {
            codes: part_mut(view_mut::<WinnerRecord, u8>(&mut self.records.0), ..WinnerRecord::BYTES * width),
            columns: &mut [],
            workspace: RowWorkspace::of_rows(
                part_mut(&mut self.winners, ..width),
                part_mut(&mut self.right, ..width),
                part_mut(&mut self.lengths, ..width),
                self.workspace.words(),
            ),
        }
    }

    fn column_bytes(_: usize, _: usize) -> usize {
        0
    }

    fn confidences(&self, width: usize) -> &[u8] {
        part(view::<Winner, u8>(&self.winners), ..width)
    }
}
