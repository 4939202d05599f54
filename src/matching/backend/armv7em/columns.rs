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

use super::tables::{self, make, make_equal};
use super::{Rows, rows};
use crate::dsp::{ONE, add};
use crate::matching::backend::work::STEP;
use crate::matching::memory::layout::OUTSIDE;
use crate::matching::memory::slices::{part, part_mut};
use crate::matching::memory::views::view;

/// Candidates that tables serve at a time, at most.
const MOST: usize = 64;
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
    let rights = reversed(row, codes.map(|codes| codes.unwrap_or(&[])), HIGH, workspace);
    let rights = rights.map(|rights| view(rights));
    // Beside the columns that windows have is what windows beyond the ends have: of them nothing differs.
    let words = row.stride / 4;
    for outside in [begin, OUTSIDE + row.width] {
        let sums = part_mut(columns, outside * words..(outside + OUTSIDE) * words);
        // They are all the same, and whole steps of them.
        let sum = add(sums.first().copied().unwrap_or(0), 4 * ONE);
        sums.as_chunks_mut().0.iter_mut().for_each(|sums| *sums = [sum; STEP / 4]);
    }
    Plane { row, begin, lefts: codes, rights }.sum::<STRIDE, LINE, false>(tables, columns);
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
    let rights = reversed(row, codes, !HIGH, workspace).map(|rights| {
        rights.iter_mut().for_each(|codes| *codes <<= 4);
        view(rights)
    });
    Plane { row, begin, lefts, rights }.sum::<STRIDE, LINE, false>(tables, columns);
    let rights = reversed(row, codes, HIGH, workspace).map(|rights| view(rights));
    Plane { row, begin, lefts, rights }.sum::<STRIDE, LINE, true>(tables, columns);
}

/// Four bits of each code, of the row that enters and of the one that leaves.
struct Plane<'a> {
    row: &'a Rows<'a>,
    /// The first column.
    begin: usize,
    /// The left codes, where there is a row: the four bits are the low ones, or the high ones.
    lefts: [Option<&'a [u8]>; 2],
    /// The right codes, reversed: the high four bits of each byte, and nothing else in it.
    rights: [&'a [u8]; 2],
}

impl Plane<'_> {
    /// Adds the costs of the low bits of codes to the columns, or takes off what those of the high bits lack.
    #[inline(always)]
    fn sum<const STRIDE: usize, const LINE: usize, const HIGH: bool>(
        &self,
        tables: &mut [u32],
        columns: &mut [u32],
    ) {
        let [enters, leaves] = self.lefts;
        let Some(any) = enters.or(leaves) else { return };
        let (of_new, of_old) = (..tables::words::<LINE>(), tables::words::<LINE>()..);
        // Nothing differs in a row that is not there.
        if enters.is_none() {
            tables::fill(part_mut(tables, of_new), if HIGH { 4 } else { 0 });
        }
        if leaves.is_none() {
            tables::fill(part_mut(tables, of_old.clone()), if HIGH { 0 } else { 4 });
        }
        let width = self.row.width;
        // Never none.
        let stride = if STRIDE > 0 { STRIDE } else { self.row.stride.max(STEP) };
        let words = stride / 4;
        let mut chunk = 0;
        while chunk < stride {
            let half = MOST.min(stride - chunk) / 2;
            let mut from = self.begin;
            while from < width {
                let piece = from..width.min(from + LINE - half);
                let first = width - piece.end + chunk;
                let [new, old] = self.rights.map(|rights| part(rights, first..));
                if enters.is_some() {
                    let make = if HIGH { make_equal::<LINE> } else { make::<LINE> };
                    make(part_mut(tables, of_new), new, half, piece.len());
                }
                if leaves.is_some() {
                    let make = if HIGH { make::<LINE> } else { make_equal::<LINE> };
                    make(part_mut(tables, of_old.clone()), old, half, piece.len());
                }
                let codes = self.lefts.map(|codes| part(codes.unwrap_or(any), piece.clone()));
                let columns = part_mut(columns, (OUTSIDE + from) * words..(OUTSIDE + piece.end) * words);
                match (STRIDE, HIGH) {
                    (16, false) => rows::add_low_16::<LINE>(tables, codes, columns.as_chunks_mut().0),
                    (32, false) => rows::add_low_32::<LINE>(tables, codes, columns.as_chunks_mut().0),
                    (48, false) => rows::add_low_48::<LINE>(tables, codes, columns.as_chunks_mut().0),
                    (64, false) => rows::add_low_64::<LINE>(tables, codes, columns.as_chunks_mut().0),
                    (16, true) => rows::take_high_16::<LINE>(tables, codes, columns.as_chunks_mut().0),
                    (32, true) => rows::take_high_32::<LINE>(tables, codes, columns.as_chunks_mut().0),
                    (48, true) => rows::take_high_48::<LINE>(tables, codes, columns.as_chunks_mut().0),
                    (64, true) => rows::take_high_64::<LINE>(tables, codes, columns.as_chunks_mut().0),
                    _ => {
                        let sum = match (half, HIGH) {
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
                from = piece.end;
            }
            chunk += MOST;
        }
    }
}

/// The right codes of both rows from the partner of the last column's first candidate back, with those of all
/// candidates of the first column; of each the bits of a mask.
fn reversed<'a>(row: &Rows<'_>, right: [&[u8]; 2], mask: u32, room: &'a mut [u32]) -> [&'a mut [u32]; 2] {
    // Tables read up to seven bytes more, and pieces begin between words.
    let words = ((row.width + row.stride).div_ceil(4) + 2).min(room.len() / 2);
    let Some((new, old)) = room.split_at_mut_checked(words) else { return Default::default() };
    let last = row.width as i32 - 1 - row.min_disparity as i32;
    let mut rows = [new, part_mut(old, ..words)];
    for (right, out) in right.into_iter().zip(&mut rows) {
        rows::reverse(right, last, mask, out);
    }
    rows
}
