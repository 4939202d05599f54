//! What a method keeps from row to row, and room to work in.

use super::kernels::{Aligned, Columns, OUTSIDE, Scratch, Winner, bytes_of, bytes_of_halves, read_bytes_of};

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
    /// The same to change, and what nothing needs until the next row.
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
    /// where these share the `scratch`.
    pub winners: &'a mut [Winner],
    pub right: &'a mut [u16],
    pub lengths: &'a mut [u16],
    /// Room to work in.
    pub scratch: &'a mut [u32],
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
    scratch: Scratch<TABLES, W, D>,
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
        scratch: Scratch::ZERO,
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
            scratch: self.scratch.words(),
        }
    }

    fn column_bytes(width: usize, stride: usize) -> usize {
        (width + 2 * OUTSIDE) * stride
    }

    fn after_winners(&self, width: usize) -> &[u8] {
        read_bytes_of(&self.winners).get(..width).unwrap_or(&[])
    }

    fn after_row(&mut self, width: usize) -> AfterRow<'_> {
        let masks = bytes_of_halves(first(&mut self.right, width));
        let (left, right) = masks.split_at_mut_checked(width).unwrap_or_default();
        AfterRow { confidences: first(bytes_of(&mut self.winners), width), masks: [left, right] }
    }
}

/// How many bytes before the first line of the cache in a room where `count` bytes still have their place:
/// vectors as long as a line are then read and written at once. Where processors have no such vectors, and
/// where there is no place, none.
#[cfg(target_pointer_width = "64")]
pub fn before_line(room: &[u8], count: usize) -> u8 {
    const LINE: usize = 64;
    let before = room.as_ptr().align_offset(LINE);
    if before < LINE && before + count <= room.len() { before as u8 } else { 0 }
}

/// The first `count` of a slice.
pub fn first<T>(slice: &mut [T], count: usize) -> &mut [T] {
    slice.get_mut(..count).unwrap_or_default()
}
