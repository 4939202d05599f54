//! Rows filled and copied, two instructions and the loop's own for a vector.
#![allow(unsafe_code)]

use crate::matching::memory::views::{Plain, view, view_mut};
use crate::units::Disparity;
use core::arch::asm;

/// Fills a row with a number of a byte or two.
#[inline(always)]
pub(super) fn fill<T: Plain>(row: &mut [T], number: T) {
    if let Some(&two) = view::<T, u8>(&[number; 2]).first_chunk() {
        write_all(view_mut(row), two);
    }
}

/// Fills a row with two bytes in turns.
#[inline(never)]
fn write_all(row: &mut [u8], two: [u8; 2]) {
    // SAFETY: as many bytes are written as there are: the loop is one for so many lanes of them.
    unsafe {
        asm!(
            "vdup.16 q0, {two}",
            "wlstp.8 lr, {count}, 3f",
            "2:",
            "vstrb.8 q0, [{row}], #16",
            "letp lr, 2b",
            "3:",
            two = in(reg) u32::from(u16::from_le_bytes(two)), count = in(reg) row.len(),
            row = inout(reg) row.as_mut_ptr() => _, out("lr") _, out("q0") _, options(nostack),
        );
    }
}

/// Copies the answers, as many as there is place for.
pub(super) fn copy(answers: &[Disparity], to: &mut [u16]) {
    let count = answers.len().min(to.len());
    // SAFETY: `count` half-words are read and written; the loop is one for so many lanes of them.
    unsafe {
        asm!(
            "wlstp.16 lr, {count}, 3f",
            "2:",
            "vldrh.u16 q0, [{answers}], #16",
            "vstrh.16 q0, [{to}], #16",
            "letp lr, 2b",
            "3:",
            count = in(reg) count, answers = inout(reg) answers.as_ptr() => _,
            to = inout(reg) to.as_mut_ptr() => _, out("lr") _, out("q0") _, options(nostack),
        );
    }
}
