//! The costs of a row that enters and of one that leaves, added to the columns under the window.
//!
//! ```text
//! fast    column x, d   += cost of the entering codes, + 4 - cost of the leaving ones, both from tables:
//!                       half a byte each, so that eight candidates are one addition, and two more where
//!                       they come into the sums. So every row adds four too many, modulo 256, which windows
//!                       take off again
//! block   column x, d   += bits that differ in the entering codes, + bits equal in the leaving ones, - 8
//! ```

use super::tables::{self, LINE, Table};
use super::word::{ONE, add};
use super::{Rows, rows};
use crate::matching::backend::parameters::WindowParameters;
use crate::matching::backend::work::STEP;
use crate::matching::memory::layout::OUTSIDE;
use crate::matching::memory::slices::{chunks_mut, part, part_mut};
use crate::matching::memory::views::view;

/// Candidates that tables serve at a time, at most.
const MOST: usize = 64;

/// Moves the sums of all columns from `begin` on one row down, by tables. `STRIDE` is the number of
/// candidates where it is a usual one; else 0.
#[inline(never)]
pub(super) fn update_by_tables<const STRIDE: usize>(
    row: &Rows<'_>,
    begin: usize,
    workspace: &mut [u32],
    columns: &mut [u32],
) {
    let Some((tables, workspace)) =
        workspace.split_at_mut_checked(size_of::<[Table; 2]>() / size_of::<u32>())
    else {
        return;
    };
    let tables = tables.as_chunks_mut().0.as_chunks_mut().0.first_chunk_mut::<2>();
    let (Some(tables), Some(any)) = (tables, row.enter.or(row.leave)) else { return };
    // The right codes alone.
    let [new, old] =
        reversed(row, [row.enter, row.leave].map(|codes| codes.unwrap_or(&[])), 0xf0f0_f0f0, workspace);
    // Nothing differs in a row that is not there.
    if row.enter.is_none() {
        tables::fill(&mut tables[0], 0);
    }
    if row.leave.is_none() {
        tables::fill(&mut tables[1], 4);
    }
    // Never none.
    let stride = if STRIDE > 0 { STRIDE } else { row.stride.max(STEP) };
    let words = stride / 4;
    // Beside the columns that windows have is what windows beyond the ends have: of them nothing differs.
    for outside in [begin, OUTSIDE + row.width] {
        let sums = part_mut(columns, outside * words..(outside + OUTSIDE) * words);
        // They are all the same, and whole steps of them.
        let sum = add(sums.first().copied().unwrap_or(0), 4 * ONE);
        sums.as_chunks_mut().0.iter_mut().for_each(|sums| *sums = [sum; STEP / 4]);
    }
    let mut chunk = 0;
    while chunk < stride {
        let half = MOST.min(stride - chunk) / 2;
        let mut from = begin;
        while from < row.width {
            let piece = from..row.width.min(from + LINE - half);
            let first = row.width - piece.end + chunk;
            if row.enter.is_some() {
                tables::make(&mut tables[0], part(new, first..), half, piece.len());
            }
            if row.leave.is_some() {
                tables::make_equal(&mut tables[1], part(old, first..), half, piece.len());
            }
            let codes = [row.enter, row.leave].map(|codes| part(codes.unwrap_or(any), piece.clone()));
            let columns = part_mut(columns, (OUTSIDE + from) * words..(OUTSIDE + piece.end) * words);
            match STRIDE {
                16 => rows::by_tables_16(tables, codes, columns.as_chunks_mut().0),
                32 => rows::by_tables_32(tables, codes, columns.as_chunks_mut().0),
                48 => rows::by_tables_48(tables, codes, columns.as_chunks_mut().0),
                64 => rows::by_tables_64(tables, codes, columns.as_chunks_mut().0),
                _ => add_costs(tables, codes, half, (words, chunk / 4), columns),
            }
            from = piece.end;
        }
        chunk += MOST;
    }
}

/// Adds the costs of a piece of a row to so many words of its columns, from a word on.
fn add_costs(
    [new, old]: &[Table; 2],
    [enters, leaves]: [&[u8]; 2],
    half: usize,
    (words, from): (usize, usize),
    columns: &mut [u32],
) {
    let places = (0..enters.len()).rev();
    for (((sums, place), enters), leaves) in chunks_mut(columns, words).zip(places).zip(enters).zip(leaves) {
        let costs =
            [(new, enters), (old, leaves)].map(|(table, code)| tables::costs(table, code & 15, place, half));
        let Some((near, far)) = sums.get_mut(from..).and_then(|s| s.split_at_mut_checked(half / 4)) else {
            return;
        };
        let costs = costs[0].as_chunks::<4>().0.iter().zip(costs[1].as_chunks::<4>().0);
        for ((near, far), (&new, &old)) in near.iter_mut().zip(far).zip(costs) {
            let costs = u32::from_le_bytes(new) + u32::from_le_bytes(old);
            *near = add(*near, costs & 0x0f0f_0f0f);
            *far = add(*far, costs >> 4 & 0x0f0f_0f0f);
        }
    }
}

/// Moves the sums of all columns from `begin` on one row down, bit by bit. `STRIDE` is the number of
/// candidates where that is known when the crate is compiled; 0 where it is not.
#[inline(never)]
pub(super) fn update<S: WindowParameters, const STRIDE: usize>(
    row: &Rows<'_>,
    begin: usize,
    workspace: &mut [u32],
    columns: &mut [u32],
) {
    // Never none.
    let stride = if STRIDE > 0 { STRIDE } else { row.stride.max(STEP) };
    let halves =
        [row.enter, row.leave].map(|codes| codes.and_then(|row| row.split_at_checked(row.len() / 2)));
    let [new, old] =
        reversed(row, halves.map(|row| row.map_or(&[][..], |(_, right)| right)), u32::MAX, workspace);
    // The codes of a row that is not there are 0 on both sides.
    let lefts = [halves[0].map_or(new, |(left, _)| left), halves[1].map_or(old, |(left, _)| left)];
    let [enters, leaves] = lefts.map(|left| part(left, begin..));
    let words = stride / 4;
    let columns = part_mut(columns, (OUTSIDE + begin) * words..(OUTSIDE + row.width) * words);
    match STRIDE {
        16 => rows::by_bits_16([enters, leaves], [new, old], columns.as_chunks_mut().0),
        32 => rows::by_bits_32([enters, leaves], [new, old], columns.as_chunks_mut().0),
        48 => rows::by_bits_48([enters, leaves], [new, old], columns.as_chunks_mut().0),
        64 => rows::by_bits_64([enters, leaves], [new, old], columns.as_chunks_mut().0),
        _ => rows::by_bits([enters, leaves], [new, old], stride, columns),
    }
}

/// The right codes of both rows from the partner of the last column's first candidate back, with those of all
/// candidates of the first column; of each the bits of a mask.
fn reversed<'a>(row: &Rows<'_>, right: [&[u8]; 2], mask: u32, room: &'a mut [u32]) -> [&'a [u8]; 2] {
    // Tables read up to seven bytes more, and pieces begin between words.
    let words = ((row.width + row.stride).div_ceil(4) + 2).min(room.len() / 2);
    let Some((new, old)) = room.split_at_mut_checked(words) else { return [&[]; 2] };
    let last = row.width as i32 - 1 - row.min_disparity as i32;
    for (right, out) in right.into_iter().zip([&mut *new, part_mut(old, ..words)]) {
        rows::reverse(right, last, mask, out);
    }
    [view::<u32, u8>(new), view::<u32, u8>(old)]
}
