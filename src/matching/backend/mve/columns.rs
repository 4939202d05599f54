//! The costs of a row, added to the columns under the window, and those of the row that leaves it subtracted.
#![allow(unsafe_code)]

use super::LANES;
use super::rows::fill;
use crate::matching::memory::slices::{part, part_mut, split_mut};
use core::arch::asm;

/// For each byte, the set bits of its lower half less those of its upper half, modulo 2^8.
static LESS: [u8; 256] = table::<4>();
/// How many bits are set.
pub(super) static BITS: [u8; 256] = table::<8>();

/// The bits that are set among the lowest so many, less those above.
const fn table<const LOWEST: u32>() -> [u8; 256] {
    let mut table = [0; 256];
    let mut byte = 0;
    while byte < 256u32 {
        let upper = byte >> LOWEST;
        table[byte as usize] =
            ((byte ^ upper << LOWEST).count_ones() as u8).wrapping_sub(upper.count_ones() as u8);
        byte += 1;
    }
    table
}

/// Codes: of the left image, and of the right one with more before, so that column x is compared with those
/// from x on.
struct Codes<'a> {
    left: &'a [u8],
    right: &'a [u8],
}

/// Moves the sums of the `columns` of `stride` candidates one row down, for codes of up to four bits: `rows`
/// are the row that enters below and the one that leaves above. `room` holds two bytes a column, and a
/// column. `STRIDE` is the number of candidates where there is a loop for it alone, else 0.
#[inline(never)]
pub(super) fn of_four_bits<const STRIDE: usize>(
    rows: [Option<&[u8]>; 2],
    min_disparity: usize,
    stride: usize,
    room: &mut [u8],
    columns: &mut [u8],
) {
    let [enter, leave] = rows;
    let Some(either) = enter.or(leave) else { return };
    let keep = (0x0f * u8::from(enter.is_some()), 0xf0 * u8::from(leave.is_some()));
    let (new, old) = (enter.unwrap_or(either), leave.unwrap_or(either));
    let width = either.len() / 2;
    let (left, right) = split_mut(room, width);
    pack(new, old, keep, left);
    let (new, old) = (part(new, width..), part(old, width..));
    let right = with_more_before(width, min_disparity, stride, right, |right| pack(new, old, keep, right));
    move_packed::<STRIDE>(Codes { left, right }, stride, columns);
}

/// The codes of two rows in the halves of a byte, of each what is to be kept, as many as there is place for.
/// Six instructions for 16.
#[inline(never)]
fn pack(new: &[u8], old: &[u8], keep: (u8, u8), out: &mut [u8]) {
    let count = out.len().min(new.len()).min(old.len());
    if count == 0 {
        return;
    }
    // SAFETY: `count` bytes are read of two rows and written of the third: the loop is one for so many lanes.
    unsafe {
        asm!(
            "vdup.8 q2, {keep}",
            "dlstp.8 lr, {count}",
            "2:",
            "vldrb.u8 q0, [{new}], #16",
            "vldrb.u8 q1, [{old}], #16",
            "vsli.8 q0, q1, #4",
            "vand q0, q0, q2",
            "vstrb.8 q0, [{out}], #16",
            "letp lr, 2b",
            count = in(reg) count, keep = in(reg) u32::from(keep.0 | keep.1),
            new = inout(reg) new.as_ptr() => _, old = inout(reg) old.as_ptr() => _,
            out = inout(reg) out.as_mut_ptr() => _,
            out("lr") _, out("q0") _, out("q1") _, out("q2") _, options(nostack),
        );
    }
}

/// [`of_four_bits`] for codes of up to eight bits.
#[inline(never)]
pub(super) fn of_eight_bits<const STRIDE: usize>(
    rows: [Option<&[u8]>; 2],
    min_disparity: usize,
    stride: usize,
    room: &mut [u8],
    columns: &mut [u8],
) {
    let width = columns.len().checked_div(stride).unwrap_or(0);
    let [enter, leave] = rows;
    let (new, old) = split_mut(room, width + stride - 1);
    let codes = |row, room| codes(row, width, min_disparity, stride, room);
    move_rows::<STRIDE>(codes(enter, new), codes(leave, old), stride, columns);
}

/// The codes of a row; of none, codes that do not differ.
#[inline(never)]
fn codes<'a>(
    row: Option<&'a [u8]>,
    width: usize,
    min_disparity: usize,
    stride: usize,
    room: &'a mut [u8],
) -> Codes<'a> {
    let Some((left, from)) = row.and_then(|row| row.split_at_checked(width)) else {
        fill(room, 0);
        return Codes { left: room, right: room };
    };
    let right = with_more_before(width, min_disparity, stride, room, |right| {
        for (right, &from) in right.iter_mut().zip(from) {
            *right = from;
        }
    });
    Codes { left, right }
}

/// The right codes, which `put` makes, with so many before that every column finds `stride`: the first one is
/// repeated for those that lie left of the image.
#[inline(always)]
fn with_more_before(
    width: usize,
    min_disparity: usize,
    stride: usize,
    room: &mut [u8],
    put: impl FnOnce(&mut [u8]),
) -> &[u8] {
    let room = part_mut(room, ..width + stride - 1);
    let outside = room.len().min(stride - 1 + min_disparity);
    // One more is put, and repeated.
    put(part_mut(room, outside..));
    let first = room.get(outside).copied().unwrap_or(0);
    fill(part_mut(room, ..outside), first);
    room
}

/// [`of_four_bits`] of codes that hold both rows: six instructions for 16 candidates, and three for a column;
/// of any number of candidates one more for 16, and four.
#[inline(never)]
fn move_packed<const STRIDE: usize>(codes: Codes<'_>, stride: usize, columns: &mut [u8]) {
    let Codes { left, right } = codes;
    let (count, groups) = (left.len(), stride / LANES);
    let is_whole = right.len() >= count + stride - 1 && columns.len() >= count * stride;
    if count == 0 || groups == 0 || !is_whole || STRIDE > 0 && STRIDE != stride {
        return;
    }
    // SAFETY: the lengths asked for above are what is read and written: of column `x` `left[x]`, `right[x..x
    // + stride]` and `columns[x * stride..][..stride]`, in whole vectors. A byte's entry of the table is in
    // it. `count` is not 0.
    unsafe {
        asm!(
            ".if {stride}",
            "dls lr, {count}",
            "2:",
            "ldrb {code}, [{left}], #1",
            "vdup.8 q2, {code}",
            ".irp at, 48, 32, 16, 0",
            ".if \\at < {stride}",
            ".if \\at",
            "vldrb.u8 q0, [{right}, #\\at]",
            ".else",
            "vldrb.u8 q0, [{right}], #1",
            ".endif",
            "veor q0, q0, q2",
            "vldrb.u8 q1, [{less}, q0]",
            "vldrb.u8 q0, [{columns}, #\\at]",
            "vadd.i8 q0, q0, q1",
            ".if \\at",
            "vstrb.8 q0, [{columns}, #\\at]",
            ".else",
            "vstrb.8 q0, [{columns}], #{stride}",
            ".endif",
            ".endif",
            ".endr",
            "le lr, 2b",
            ".else",
            "2:",
            "ldrb {code}, [{left}], #1",
            "vdup.8 q2, {code}",
            "mov {code}, {right}",
            "add {right}, {right}, #1",
            "dls lr, {groups}",
            "3:",
            "vldrb.u8 q0, [{code}], #16",
            "veor q0, q0, q2",
            "vldrb.u8 q1, [{less}, q0]",
            "vldrb.u8 q0, [{columns}]",
            "vadd.i8 q0, q0, q1",
            "vstrb.8 q0, [{columns}], #16",
            "le lr, 3b",
            "subs {count}, {count}, #1",
            "bne 2b",
            ".endif",
            count = inout(reg) count => _, code = out(reg) _, left = inout(reg) left.as_ptr() => _,
            right = inout(reg) right.as_ptr() => _, columns = inout(reg) columns.as_mut_ptr() => _,
            groups = in(reg) groups, less = in(reg) LESS.as_ptr(), stride = const STRIDE,
            out("lr") _, out("q0") _, out("q1") _, out("q2") _, options(nostack),
        );
    }
}

/// [`of_eight_bits`] of both rows: ten instructions for 16 candidates, and five for a column; of any number
/// of candidates one more for 16, and four.
#[inline(never)]
fn move_rows<const STRIDE: usize>(enter: Codes<'_>, leave: Codes<'_>, stride: usize, columns: &mut [u8]) {
    let (count, groups) = (columns.len() / stride.max(1), stride / LANES);
    let is_whole = |codes: &Codes<'_>| codes.left.len() >= count && codes.right.len() >= count + stride - 1;
    if count == 0 || groups == 0 || !is_whole(&enter) || !is_whole(&leave) || STRIDE > 0 && STRIDE != stride {
        return;
    }
    // SAFETY: as for `move_packed`, of two rows.
    unsafe {
        asm!(
            ".if {stride}",
            "dls lr, {count}",
            "2:",
            "ldrb {code}, [{left}], #1",
            "vdup.8 q2, {code}",
            "ldrb {code}, [{old_left}], #1",
            "vdup.8 q3, {code}",
            ".irp at, 48, 32, 16, 0",
            ".if \\at && \\at < {stride}",
            "vldrb.u8 q0, [{right}, #\\at]",
            "veor q0, q0, q2",
            "vldrb.u8 q1, [{bits}, q0]",
            "vldrb.u8 q0, [{columns}, #\\at]",
            "vadd.i8 q1, q1, q0",
            "vldrb.u8 q0, [{old_right}, #\\at]",
            "veor q0, q0, q3",
            "vldrb.u8 q4, [{bits}, q0]",
            "vsub.i8 q1, q1, q4",
            "vstrb.8 q1, [{columns}, #\\at]",
            ".elseif \\at < {stride}",
            // The same, and on to the next column.
            "vldrb.u8 q0, [{right}], #1",
            "veor q0, q0, q2",
            "vldrb.u8 q1, [{bits}, q0]",
            "vldrb.u8 q0, [{columns}]",
            "vadd.i8 q1, q1, q0",
            "vldrb.u8 q0, [{old_right}], #1",
            "veor q0, q0, q3",
            "vldrb.u8 q4, [{bits}, q0]",
            "vsub.i8 q1, q1, q4",
            "vstrb.8 q1, [{columns}], #{stride}",
            ".endif",
            ".endr",
            "le lr, 2b",
            ".else",
            "2:",
            "ldrb {code}, [{left}], #1",
            "vdup.8 q2, {code}",
            "ldrb {code}, [{old_left}], #1",
            "vdup.8 q3, {code}",
            "mov {code}, {right}",
            "mov {old_code}, {old_right}",
            "add {right}, {right}, #1",
            "add {old_right}, {old_right}, #1",
            "dls lr, {groups}",
            "3:",
            "vldrb.u8 q0, [{code}], #16",
            "veor q0, q0, q2",
            "vldrb.u8 q1, [{bits}, q0]",
            "vldrb.u8 q0, [{columns}]",
            "vadd.i8 q1, q1, q0",
            "vldrb.u8 q0, [{old_code}], #16",
            "veor q0, q0, q3",
            "vldrb.u8 q4, [{bits}, q0]",
            "vsub.i8 q1, q1, q4",
            "vstrb.8 q1, [{columns}], #16",
            "le lr, 3b",
            "subs {count}, {count}, #1",
            "bne 2b",
            ".endif",
            count = inout(reg) count => _, groups = in(reg) groups, code = out(reg) _, old_code = out(reg) _,
            left = inout(reg) enter.left.as_ptr() => _,
            right = inout(reg) enter.right.as_ptr() => _, old_left = inout(reg) leave.left.as_ptr() => _,
            old_right = inout(reg) leave.right.as_ptr() => _, columns = inout(reg) columns.as_mut_ptr() => _,
            bits = in(reg) BITS.as_ptr(), stride = const STRIDE,
            out("lr") _, out("q0") _, out("q1") _, out("q2") _, out("q3") _, out("q4") _, options(nostack),
        );
    }
}
