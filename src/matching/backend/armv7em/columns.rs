//! The costs of a row that enters and of one that leaves, added to the columns under the window: both from
//! tables, half a byte each, so that eight candidates are one addition, and two more where they come into the
//! sums.
//!
//! ```text
//! fast    column x, d   += bits that differ in the entering codes, + bits equal in the leaving ones: every
//!                       row adds four too many, modulo 256, which windows take off again
//! block   column x, d   likewise, of the low four bits; then of the high ones
//!                       -= bits equal in the entering codes, + bits that differ in the leaving ones: four
//!                       too many as well
//! ```

use super::tables::{self, make_beside};
use super::{Rows, rows};
use crate::dsp::{ONE, add};
use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::work::STEP;
use crate::matching::memory::layout::OUTSIDE;
use crate::matching::memory::slices::{part, part_mut, split_mut};
use crate::matching::memory::views::view;

/// Candidates that tables serve at a time, at most.
const MOST: usize = 64;
/// How many columns less than half of the candidates stand before the windows of pixels that have the other
/// half: the first of these pixels takes off the column before its window.
const FEW_LESS: usize = rows::ACROSS / 2 + 1;
/// The high four bits of each byte.
const HIGH: u32 = 0xf0f0_f0f0;

/// Moves the sums of all columns from `begin` on one row down, where a pixel's two codes of four bits are a
/// byte. `STRIDE` is the number of candidates where it is a usual one; else 0. Here and below tables have
/// lines of so many bytes.
#[inline(never)]
pub(super) fn update_fours<const STRIDE: usize, const LINE: usize>(
    row: &Rows<'_>,
    begin: usize,
    workspace: &mut [u32],
    columns: &mut [u32],
) {
    let Some((tables, workspace)) = workspace.split_at_mut_checked(2 * tables::words::<LINE>()) else {
        return;
    };
    if row.enter.or(row.leave).is_none() {
        return;
    }
    // The right codes alone.
    let codes = [row.enter, row.leave];
    let rights = reversed(row, codes.map(|codes| codes.unwrap_or(&[])), (HIGH, false), workspace);
    let rights = rights.map(|rights| view(rights));
    // Beside the columns that windows have is what windows beyond the ends have.
    let words = row.stride / 4;
    for outside in [begin, OUTSIDE + row.width] {
        add_nothing(part_mut(columns, outside * words..(outside + OUTSIDE) * words));
    }
    let few = (row.stride / 2).saturating_sub(FEW_LESS);
    Plane { row, begin, few, lefts: codes, rights }.sum::<STRIDE, LINE>(false, tables, columns);
}

/// Moves columns beyond an end one row down: of them nothing differs.
#[inline(never)]
fn add_nothing(columns: &mut [u32]) {
    // They are all the same, and whole steps of them: a step of each column at a time.
    let sum = add(columns.first().copied().unwrap_or(0), 4 * ONE);
    for steps in columns.as_chunks_mut().0 {
        keep_loop();
        *steps = [sum; OUTSIDE * STEP / 4];
    }
}

/// [`update_fours`] where codes have eight bits, the left ones before the right ones.
#[inline(never)]
pub(super) fn update_eights<const STRIDE: usize, const LINE: usize>(
    row: &Rows<'_>,
    begin: usize,
    workspace: &mut [u32],
    columns: &mut [u32],
) {
    let Some((tables, workspace)) = workspace.split_at_mut_checked(2 * tables::words::<LINE>()) else {
        return;
    };
    let halves =
        [row.enter, row.leave].map(|codes| codes.and_then(|row| row.split_at_checked(row.len() / 2)));
    let lefts = halves.map(|row| row.map(|(left, _)| left));
    let codes = halves.map(|row| row.map_or(&[][..], |(_, right)| right));
    for is_high in [false, true] {
        // One piece of code for both.
        keep_loop();
        let mut rights = reversed(row, codes, (if is_high { HIGH } else { !HIGH }, is_high), workspace);
        if !is_high {
            rights.iter_mut().for_each(|rights| rights.iter_mut().for_each(|codes| *codes <<= 4));
        }
        let rights = rights.map(|rights| view(rights));
        // Their windows add and take off what does not fit into a byte.
        Plane { row, begin, few: 0, lefts, rights }.sum::<STRIDE, LINE>(is_high, tables, columns);
    }
}

/// Four bits of each code, of the row that enters and of the one that leaves.
struct Plane<'a> {
    row: &'a Rows<'a>,
    /// The first column.
    begin: usize,
    /// How many of the first columns may be left without the second half of their candidates.
    few: usize,
    /// The left codes, where there is a row: the four bits are the low ones, or the high ones.
    lefts: [Option<&'a [u8]>; 2],
    /// The right codes, reversed and one row's inverted: the high four bits of each byte, and nothing else
    /// in it.
    rights: [&'a [u8]; 2],
}

impl Plane<'_> {
    /// Adds the costs of the low bits of codes to the columns, or takes off what those of the high bits lack.
    #[inline(always)]
    fn sum<const STRIDE: usize, const LINE: usize>(
        &self,
        is_high: bool,
        tables: &mut [u32],
        columns: &mut [u32],
    ) {
        let [enters, leaves] = self.lefts;
        let Some(any) = enters.or(leaves) else { return };
        let lefts = self.lefts.map(|codes| codes.unwrap_or(any));
        let words = tables::words::<LINE>();
        let table_of = |row: usize| row * words..(row + 1) * words;
        // Nothing differs in a row that is not there.
        for (row, left) in self.lefts.iter().enumerate() {
            if left.is_none() {
                tables::fill(part_mut(tables, table_of(row)), if is_inverted(row, is_high) { 4 } else { 0 });
            }
        }
        let width = self.row.width;
        // Never none.
        let stride = if STRIDE > 0 { STRIDE } else { self.row.stride.max(STEP) };
        let words = stride / 4;
        let mut chunk = 0;
        while chunk < stride {
            let half = MOST.min(stride - chunk) / 2;
            let (mut from, mut few) = (self.begin, self.few);
            let mut next = part_mut(columns, (OUTSIDE + from) * words..);
            while from < width {
                keep_loop();
                let piece = from..width.min(from + LINE - half);
                let first = width - piece.end + chunk;
                let (places, was_beside) = ((half, piece.len()), from > self.begin);
                for (row, (left, right)) in self.lefts.iter().zip(self.rights).enumerate() {
                    if left.is_some() {
                        let table = part_mut(tables, table_of(row));
                        make_beside::<LINE>(table, part(right, first..), places, was_beside);
                    }
                }
                let codes = lefts.map(|codes| part(codes, from..));
                let columns;
                (columns, next) = split_mut(next, piece.len() * words);
                match (STRIDE, is_high) {
                    (16, false) => rows::add_low_16::<LINE>(tables, codes, few, columns.as_chunks_mut().0),
                    (32, false) => rows::add_low_32::<LINE>(tables, codes, few, columns.as_chunks_mut().0),
                    (48, false) => rows::add_low_48::<LINE>(tables, codes, few, columns.as_chunks_mut().0),
                    (64, false) => rows::add_low_64::<LINE>(tables, codes, few, columns.as_chunks_mut().0),
                    (16, true) => rows::take_high_16::<LINE>(tables, codes, few, columns.as_chunks_mut().0),
                    (32, true) => rows::take_high_32::<LINE>(tables, codes, few, columns.as_chunks_mut().0),
                    (48, true) => rows::take_high_48::<LINE>(tables, codes, few, columns.as_chunks_mut().0),
                    (64, true) => rows::take_high_64::<LINE>(tables, codes, few, columns.as_chunks_mut().0),
                    _ => {
                        let sum = match (half, is_high) {
                            (8, false) => rows::add_low_16_of::<LINE>,
                            (16, false) => rows::add_low_32_of::<LINE>,
                            (24, false) => rows::add_low_48_of::<LINE>,
                            (_, false) => rows::add_low_64_of::<LINE>,
                            (8, true) => rows::take_high_16_of::<LINE>,
                            (16, true) => rows::take_high_32_of::<LINE>,
                            (24, true) => rows::take_high_48_of::<LINE>,
                            (_, true) => rows::take_high_64_of::<LINE>,
                        };
                        sum(tables, codes, (words, chunk / 4), columns);
                    }
                }
                (from, few) = (piece.end, 0);
            }
            chunk += MOST;
        }
    }
}

/// Whether the right codes of a row, the entering one or the leaving one, are inverted, so that costs are
/// how many bits are equal.
fn is_inverted(row: usize, is_high: bool) -> bool {
    (row == 1) != is_high
}

/// The right codes of both rows from the partner of the last column's first candidate back, with those of all
/// candidates of the first column; of each the high bits or the low ones.
fn reversed<'a>(
    row: &Rows<'_>,
    right: [&[u8]; 2],
    (mask, is_high): (u32, bool),
    room: &'a mut [u32],
) -> [&'a mut [u32]; 2] {
    // Tables read up to seven bytes more, and pieces begin between words.
    let words = ((row.width + row.stride).div_ceil(4) + 2).min(room.len() / 2);
    let Some((new, old)) = room.split_at_mut_checked(words) else { return Default::default() };
    let last = row.width as i32 - 1 - row.min_disparity as i32;
    let mut rows = [new, part_mut(old, ..words)];
    for (row, (right, out)) in right.into_iter().zip(&mut rows).enumerate() {
        rows::reverse(right, last, mask, if is_inverted(row, is_high) { mask } else { 0 }, out);
    }
    rows
}
