//! Rows of bytes, as many at a time as a group of registers holds.

use crate::matching::memory::slices::{part_mut, split_mut};
use core::arch::asm;

/// Makes every byte of a row the same one.
#[inline(never)]
pub(super) fn fill(row: &mut [u8], byte: u8) {
    // SAFETY: it writes the row: each round as many bytes as `vsetvli` says, none if the row has none.
    unsafe {
        asm!(
            "vsetvli {at_once}, {count}, e8, m8, ta, ma",
            "vmv.v.x v8, {byte}",
            "j 3f",
            "2:",
            "vsetvli {at_once}, {count}, e8, m8, ta, ma",
            "vse8.v v8, ({row})",
            "add {row}, {row}, {at_once}",
            "sub {count}, {count}, {at_once}",
            "3:",
            "bnez {count}, 2b",
            at_once = out(reg) _, count = inout(reg) row.len() => _, row = inout(reg) row.as_mut_ptr() => _,
            byte = in(reg) u32::from(byte),
            out("v8") _, out("v9") _, out("v10") _, out("v11") _, out("v12") _, out("v13") _, out("v14") _,
            out("v15") _, options(nostack),
        );
    }
}

/// Copies as many bytes as both rows have.
#[inline(never)]
pub(super) fn copy(from: &[u8], to: &mut [u8]) {
    let count = from.len().min(to.len());
    // SAFETY: `count` bytes are read and written: each round takes as many as `vsetvli` says.
    unsafe {
        asm!(
            "j 3f",
            "2:",
            "vsetvli {at_once}, {count}, e8, m8, ta, ma",
            "vle8.v v8, ({from})",
            "vse8.v v8, ({to})",
            "add {from}, {from}, {at_once}",
            "add {to}, {to}, {at_once}",
            "sub {count}, {count}, {at_once}",
            "3:",
            "bnez {count}, 2b",
            at_once = out(reg) _, count = inout(reg) count => _, from = inout(reg) from.as_ptr() => _,
            to = inout(reg) to.as_mut_ptr() => _,
            out("v8") _, out("v9") _, out("v10") _, out("v11") _, out("v12") _, out("v13") _, out("v14") _,
            out("v15") _, options(nostack),
        );
    }
}

/// Codes of a row with more before them: column x is compared with `stride` of them from x on. The first
/// one is repeated for those that lie left of the image.
pub(super) fn with_more_before<'a>(
    codes: &[u8],
    min_disparity: usize,
    stride: usize,
    room: &'a mut [u8],
) -> &'a [u8] {
    let room = part_mut(room, ..codes.len() + stride - 1);
    let (before, inside) = split_mut(room, stride - 1 + min_disparity);
    fill(before, codes.first().copied().unwrap_or(0));
    copy(codes, inside);
    room
}
