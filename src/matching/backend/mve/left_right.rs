//! The left-right check's work along a row: `portable/consistency.rs` says what it is.
#![allow(unsafe_code)]

use crate::matching::memory::winners::WinnerRows;
use core::arch::asm;

/// Offers every winner, by its cost above its disparity, to its partner among the columns `right`, which keep
/// the least; then gives in `kept` the disparity that each one's partner keeps.
#[inline(never)]
pub(super) fn keep(winners: &WinnerRows<'_>, pixels: Option<[&[u8]; 2]>, right: &mut [u16], kept: &mut [u8]) {
    let (costs, disparities) = (&*winners.costs, &*winners.disparities);
    let count = disparities.len().min(costs.len()).min(right.len()).min(kept.len());
    let (Some(costs), Some(disparities)) = (costs.get(..count), disparities.get(..count)) else { return };
    let (Some(right), Some(kept)) = (right.get_mut(..count), kept.get_mut(..count)) else { return };
    if count == 0 {
        return;
    }
    match pixels.map(|pixels| pixels.map(|row| row.get(..count))) {
        Some([Some(left), Some(of_right)]) => {
            compare(costs, disparities, [left, of_right], kept);
            offer(kept, disparities, right);
        }
        _ => offer(costs, disparities, right),
    }
    look(disparities, right, kept);
}

/// The costs of offers whose pixels are compared, for slices of one length: thirteen instructions for
/// eight pixels.
fn compare(costs: &[u8], disparities: &[u8], [left, of_right]: [&[u8]; 2], offers: &mut [u8]) {
    // SAFETY: as for `offer`; the pixel of `of_right` that is read has the number of the partner.
    unsafe {
        asm!(
            "vmov.i16 q3, #255",
            "dlstp.16 lr, {count}",
            "2:",
            "vldrb.u16 q0, [r0], #8",
            "vidup.u16 q1, r4, #1",
            "vmin.u16 q0, q0, q1",
            "vsub.i16 q1, q1, q0",
            "vldrb.u16 q0, [{of_right}, q1]",
            "vldrb.u16 q1, [r1], #8",
            "vabd.u16 q0, q0, q1",
            "vshl.i16 q0, q0, #2",
            "vldrb.u16 q1, [r2], #8",
            "vadd.i16 q0, q0, q1",
            "vmin.u16 q0, q0, q3",
            "vstrb.16 q0, [r3], #8",
            "letp lr, 2b",
            count = in(reg) offers.len(), of_right = in(reg) of_right.as_ptr(),
            inout("r0") disparities.as_ptr() => _, inout("r1") left.as_ptr() => _,
            inout("r2") costs.as_ptr() => _, inout("r3") offers.as_mut_ptr() => _, inout("r4") 0 => _,
            out("lr") _, out("q0") _, out("q1") _, out("q3") _, options(nostack),
        );
    }
}

/// The first half, for slices of one length: eighteen instructions for eight pixels.
///
/// Of several pixels among eight that have one partner, a store leaves any one's offer there: what the
/// partners keep is read again, and pixels that offer less store once more, in seven instructions. As each
/// store leaves less, eight do for all; two are rarely needed, at the left end of a near surface.
fn offer(costs: &[u8], disparities: &[u8], right: &mut [u16]) {
    // SAFETY: the loops are ones for so many lanes of half-words, and the three slices have as many. The
    // number of `right` that is read and written for pixel `x` is `x` less its disparity, or the first.
    unsafe {
        asm!(
            "vmov.i8 q0, #255",
            "dlstp.16 lr, {count}",
            "2:",
            "vstrh.16 q0, [{filled}], #16",
            "letp lr, 2b",
            "dlstp.16 lr, {count}",
            "2:",
            "vldrb.u16 q0, [r0], #8",
            "vldrb.u16 q1, [r1], #8",
            "vidup.u16 q2, r4, #1",
            // No partner lies left of the first column.
            "vmin.u16 q0, q0, q2",
            "vsub.i16 q2, q2, q0",
            "vsli.16 q0, q1, #8",
            "vldrh.u16 q1, [{right}, q2, uxtw #1]",
            "vcmp.u16 hi, q1, q0",
            "3:",
            "vpst",
            "vstrht.16 q0, [{right}, q2, uxtw #1]",
            "vldrh.u16 q1, [{right}, q2, uxtw #1]",
            "vcmp.u16 hi, q1, q0",
            "vmrs {beaten}, p0",
            "cmp {beaten}, #0",
            "bne 3b",
            "letp lr, 2b",
            count = in(reg) right.len(), right = in(reg) right.as_mut_ptr(),
            filled = inout(reg) right.as_mut_ptr() => _, beaten = out(reg) _,
            inout("r0") disparities.as_ptr() => _, inout("r1") costs.as_ptr() => _, inout("r4") 0 => _,
            out("lr") _, out("q0") _, out("q1") _, out("q2") _, options(nostack),
        );
    }
}

/// The second half, for slices of one length: seven instructions for eight pixels.
fn look(disparities: &[u8], right: &[u16], kept: &mut [u8]) {
    // SAFETY: as for `offer`.
    unsafe {
        asm!(
            "dlstp.16 lr, {count}",
            "2:",
            "vldrb.u16 q0, [r0], #8",
            "vidup.u16 q1, r4, #1",
            "vmin.u16 q0, q0, q1",
            "vsub.i16 q1, q1, q0",
            "vldrh.u16 q0, [{right}, q1, uxtw #1]",
            "vstrb.16 q0, [r1], #8",
            "letp lr, 2b",
            count = in(reg) kept.len(), right = in(reg) right.as_ptr(),
            inout("r0") disparities.as_ptr() => _, inout("r1") kept.as_mut_ptr() => _, inout("r4") 0 => _,
            out("lr") _, out("q0") _, out("q1") _, options(nostack),
        );
    }
}
