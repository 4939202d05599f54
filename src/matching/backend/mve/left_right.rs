//! The left-right check's work along a row: `portable/consistency.rs` says what it is.
#![allow(unsafe_code)]

use core::arch::asm;

/// Pixels in a turn of the loop that offers.
const ROUND: usize = 4;

/// Offers every winner, by its cost above its disparity, to its partner among the columns `right`, which keep
/// the least; then gives in `kept` the disparity that each one's partner keeps.
#[inline(never)]
pub(super) fn keep(costs: &[u8], disparities: &[u8], right: &mut [u16], kept: &mut [u8]) {
    let count = disparities.len().min(costs.len()).min(right.len()).min(kept.len());
    let (Some(costs), Some(kept)) = (costs.get(..count), kept.get_mut(..count)) else { return };
    right.fill(u16::MAX);
    // No partner lies left of the first column. That is so of winners, but the assembly has to be able to
    // rely on it.
    for (x, (kept, &disparity)) in (0u16..).zip(kept.iter_mut().zip(disparities)) {
        *kept = disparity.min(x.min(255) as u8);
    }
    offer(costs, kept, right);
    look(kept, right);
}

/// The first half: 34 instructions for four pixels. None of `disparities` is over its index.
fn offer(costs: &[u8], disparities: &[u8], right: &mut [u16]) {
    let rounds = costs.len() / ROUND;
    if rounds > 0 {
        offer_rounds(rounds, costs, disparities, right);
    }
    for (x, (&cost, &disparity)) in costs.iter().zip(disparities).enumerate().skip(rounds * ROUND) {
        if let Some(kept) = right.get_mut(x.wrapping_sub(usize::from(disparity))) {
            *kept = (*kept).min(u16::from(cost) << 8 | u16::from(disparity));
        }
    }
}

#[inline(never)]
fn offer_rounds(rounds: usize, costs: &[u8], disparities: &[u8], right: &mut [u16]) {
    let pixels = rounds * ROUND;
    if rounds == 0 || costs.len() < pixels || disparities.len() < pixels || right.len() < pixels {
        return;
    }
    // SAFETY: the lengths asked for above are what is read; the number of `right` that is read and written
    // for pixel `x` is `x - disparities[x]`, which is none before the first (`keep`). `rounds` is not 0.
    unsafe {
        asm!(
            "dls lr, {rounds}",
            "2:",
            ".irp at, 0, 2, 4, 6",
            "ldrb {disparity}, [{disparities}], #1",
            "ldrb {cost}, [{costs}], #1",
            "sub {to}, {right}, {disparity}, lsl #1",
            "orr {disparity}, {disparity}, {cost}, lsl #8",
            "ldrh {cost}, [{to}, #\\at]",
            "cmp {disparity}, {cost}",
            "it lo",
            "strhlo {disparity}, [{to}, #\\at]",
            ".endr",
            "add {right}, {right}, #8",
            "le lr, 2b",
            rounds = in(reg) rounds, disparities = inout(reg) disparities.as_ptr() => _,
            costs = inout(reg) costs.as_ptr() => _, right = inout(reg) right.as_mut_ptr() => _,
            disparity = out(reg) _, cost = out(reg) _, to = out(reg) _, out("lr") _, options(nostack),
        );
    }
}

/// The second half: six instructions for eight pixels. Of none is `disparities` over its index; what is kept
/// takes its place.
#[inline(never)]
fn look(disparities: &mut [u8], right: &[u16]) {
    let count = disparities.len();
    if count == 0 || right.len() < count {
        return;
    }
    // SAFETY: `count` bytes are read and written; the number of `right` that is read for pixel `x` is `x -
    // disparities[x]`, which is none before the first (`keep`). The loop is one for so many lanes of
    // half-words.
    unsafe {
        asm!(
            "dlstp.16 lr, {count}",
            "2:",
            "vldrb.u16 q0, [r0]",
            "vidup.u16 q1, r4, #1",
            "vsub.i16 q1, q1, q0",
            "vldrh.u16 q0, [{right}, q1, uxtw #1]",
            "vstrb.16 q0, [r0], #8",
            "letp lr, 2b",
            count = in(reg) count, right = in(reg) right.as_ptr(),
            inout("r0") disparities.as_mut_ptr() => _, inout("r4") 0 => _, out("lr") _, out("q0") _,
            out("q1") _,
            options(nostack),
        );
    }
}
