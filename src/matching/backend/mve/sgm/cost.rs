//! A row's costs, averaged into those of the rows above.
#![allow(unsafe_code)]

use crate::matching::backend::mve::columns::BITS;
use crate::matching::backend::parameters::SgmParameters;
use crate::matching::backend::portable::sgm::features::Features;
use crate::matching::backend::work::PathWork;
use core::arch::asm;

/// Adds a row, or within edges puts it in their place: 20 instructions for 16 candidates (18 within edges, 19
/// where nothing is compared between pixels), and twelve for a pixel. What is compared between pixels is
/// doubled.
#[inline(never)]
pub(super) fn enter<S: SgmParameters, const STRIDE: usize>(work: &mut PathWork<'_>, features: &Features<'_>) {
    let (width, Features { left, right, count }) = (work.width, *features);
    let rows = if S::BETWEEN_PIXELS { 6 } else { 4 };
    let is_left_whole = left.rows.len() >= 3 * width && left.brightness.len() >= width;
    let is_right_whole = count >= width + STRIDE - 1 && right.len() >= rows * count;
    if width == 0 || !is_left_whole || !is_right_whole || work.costs.len() < width * STRIDE {
        return;
    }
    let right = right.as_ptr();
    // The two rows that the gradient along the line is compared with, or the one, twice.
    let [low, high] = if S::BETWEEN_PIXELS { [4, 5] } else { [0, 0] };
    // SAFETY: the lengths asked for above are what is read and written: of column `x` its number in each row
    // of the left image, `STRIDE` numbers from the same place on in each row of the right one, and as many
    // costs. A byte's entry of the table is in it. `width` is not 0.
    unsafe {
        asm!(
            "vdup.8 q4, {number}",
            "dls lr, {width}",
            "2:",
            "ldrb {number}, [{left}, {width}]",
            "vdup.8 q1, {number}",
            "ldrb {number}, [{left}, {width}, lsl #1]",
            "vdup.8 q2, {number}",
            "ldrb {number}, [{brightness}], #1",
            "lsr {number}, {number}, #1",
            "vdup.8 q3, {number}",
            "ldrb {number}, [{left}], #1",
            ".if {between}",
            "lsl {number}, {number}, #1",
            ".endif",
            "vdup.8 q0, {number}",
            ".irp at, 48, 32, 16, 0",
            ".if \\at < {stride}",
            ".if \\at",
            ".if {between}",
            "vldrb.u8 q5, [{high}, #\\at]",
            ".endif",
            "vldrb.u8 q6, [{low}, #\\at]",
            "vldrb.u8 q7, [{dark}, #\\at]",
            ".else",
            ".if {between}",
            "vldrb.u8 q5, [{high}], #1",
            ".endif",
            "vldrb.u8 q6, [{low}], #1",
            "vldrb.u8 q7, [{dark}], #1",
            ".endif",
            // Only one of the differences is not 0.
            ".if {between}",
            "vqsub.u8 q5, q0, q5",
            "vqsub.u8 q6, q6, q0",
            ".else",
            "vabd.u8 q5, q6, q0",
            "vabd.u8 q6, q6, q0",
            ".endif",
            "vadd.i8 q5, q5, q6",
            "vabd.u8 q7, q7, q3",
            "vshr.u8 q7, q7, #2",
            "vadd.i8 q5, q5, q7",
            ".if \\at",
            "vldrb.u8 q6, [{codes}, #\\at]",
            "vldrb.u8 q7, [{across}, #\\at]",
            ".else",
            "vldrb.u8 q6, [{codes}], #1",
            "vldrb.u8 q7, [{across}], #1",
            ".endif",
            "vabd.u8 q7, q7, q1",
            "vadd.i8 q5, q5, q7",
            "veor q6, q6, q2",
            "vldrb.u8 q7, [{bits}, q6]",
            "vadd.i8 q5, q5, q7",
            "vmin.u8 q5, q5, q4",
            ".if {averages}",
            "vldrb.u8 q6, [{costs}, #\\at]",
            "vrhadd.u8 q5, q5, q6",
            ".endif",
            ".if \\at",
            "vstrb.8 q5, [{costs}, #\\at]",
            ".else",
            "vstrb.8 q5, [{costs}], #{stride}",
            ".endif",
            ".endif",
            ".endr",
            "le lr, 2b",
            number = inout(reg) u32::from(work.penalties.cost) => _, width = in(reg) width,
            left = inout(reg) left.rows.as_ptr() => _, brightness = inout(reg) left.brightness.as_ptr() => _,
            low = inout(reg) right.add(low * count) => _, high = inout(reg) right.add(high * count) => _,
            across = inout(reg) right.add(count) => _, codes = inout(reg) right.add(2 * count) => _,
            dark = inout(reg) right.add(3 * count) => _, costs = inout(reg) work.costs.as_mut_ptr() => _,
            bits = in(reg) BITS.as_ptr(), stride = const STRIDE, between = const S::BETWEEN_PIXELS as u32,
            averages = const !S::WITHIN_EDGES as u32,
            out("lr") _, out("q0") _, out("q1") _, out("q2") _, out("q3") _, out("q4") _, out("q5") _,
            out("q6") _, out("q7") _, options(nostack),
        );
    }
}
