//! What a pixel's cost compares: the census in bytes, 16 pixels at a time, gradients in half-words.
#![allow(unsafe_code)]

use super::super::rows::fill;
use crate::matching::backend::portable::sgm::features::FeatureRows;
use crate::matching::backend::portable::sgm::features_by_four::near;
use crate::matching::memory::Rows5;
use crate::matching::memory::slices::{part, part_mut};
use crate::matching::memory::views::view;
use core::arch::asm;

/// Columns to each side that a code looks at.
const REACH: usize = 4;
/// Columns that [`REACH`] columns at an end of the line look at.
const NEAR: usize = 3 * REACH;

/// Features in Helium.
pub(super) struct HeliumRows;

impl FeatureRows for HeliumRows {
    #[inline(always)]
    fn fill(row: &mut [u8], number: u8) {
        fill(row, number);
    }

    /// The features of as many columns as there is a place for: [`gradients`](crate::imaging::gradients) and
    /// [`census_wide8`](crate::imaging::census_wide8).
    #[inline(always)]
    fn looks(lines: &Rows5<'_>, width: usize, gradient: u8, [along, across, census]: [&mut [u8]; 3]) {
        let count = census.len().min(width);
        let [above2, above, here, below, below2] = *lines;
        // The columns that see nothing outside the line, then those at its ends: of a short line all.
        let inner = REACH..count.min(width.saturating_sub(REACH)).max(REACH);
        codes([above2, here, below2], census.get_mut(inner.clone()).unwrap_or_default());
        let places = [&mut *along, &mut *across].map(|row| row.get_mut(inner.clone()).unwrap_or_default());
        gradients([above, here, below], gradient, places);
        let (mut x, step) = (0, if width < NEAR { REACH } else { width - REACH });
        while x < count {
            let near = lines.map(|line| near(part(line, ..width), x));
            let [above2, above, here, below, below2] = near.each_ref().map(|near| view(near));
            let places = x..count.min(x + REACH);
            codes([above2, here, below2], part_mut(census, places.clone()));
            let places = [&mut *along, &mut *across].map(|row| part_mut(row, places.clone()));
            gradients([above, here, below], gradient, places);
            x += step;
        }
    }

    /// Half of each number, of as many as both have.
    #[inline(never)]
    fn halve(numbers: &[u8], halves: &mut [u8]) {
        let count = numbers.len().min(halves.len());
        if count == 0 {
            return;
        }
        // SAFETY: `count` bytes of both are read and written: the loop is one for so many lanes of bytes.
        unsafe {
            asm!(
                "dlstp.8 lr, {count}",
                "2:",
                "vldrb.u8 q0, [{from}], #16",
                "vshr.u8 q0, q0, #1",
                "vstrb.8 q0, [{to}], #16",
                "letp lr, 2b",
                count = in(reg) count, from = inout(reg) numbers.as_ptr() => _,
                to = inout(reg) halves.as_mut_ptr() => _, out("lr") _, out("q0") _, options(nostack),
            );
        }
    }

    /// The ranges of all numbers but the two at the ends, doubled: 14 instructions for 16 numbers.
    #[inline(never)]
    fn range(numbers: &[u8], least: &mut [u8], greatest: &mut [u8]) {
        let count = numbers.len().min(least.len()).min(greatest.len()).saturating_sub(2);
        if count == 0 {
            return;
        }
        // SAFETY: the numbers between the first and the last are `count`; those are written, and read with
        // the two: the loop is one for so many lanes of bytes.
        unsafe {
            asm!(
                "dlstp.8 lr, {count}",
                "2:",
                "vldrb.u8 q1, [{numbers}, #1]",
                "vldrb.u8 q2, [{numbers}, #2]",
                "vldrb.u8 q0, [{numbers}], #16",
                "vhadd.u8 q0, q0, q1",
                "vhadd.u8 q2, q2, q1",
                "vmin.u8 q3, q0, q2",
                "vmax.u8 q0, q0, q2",
                "vmin.u8 q3, q3, q1",
                "vmax.u8 q0, q0, q1",
                "vadd.i8 q3, q3, q3",
                "vadd.i8 q0, q0, q0",
                "vstrb.8 q3, [{least}], #16",
                "vstrb.8 q0, [{greatest}], #16",
                "letp lr, 2b",
                count = in(reg) count, numbers = inout(reg) numbers.as_ptr() => _,
                least = inout(reg) least.as_mut_ptr().wrapping_add(1) => _,
                greatest = inout(reg) greatest.as_mut_ptr().wrapping_add(1) => _,
                out("lr") _, out("q0") _, out("q1") _, out("q2") _, out("q3") _, options(nostack),
            );
        }
    }
}

/// The codes of as many columns as there are places, from the rows two above, here, and two below, each from
/// [`REACH`] columns before the first on: 28 instructions for 16 pixels.
#[inline(never)]
fn codes(rows: [&[u8]; 3], out: &mut [u8]) {
    let count = out.len();
    if count == 0 || rows.iter().any(|row| row.len() < count + 2 * REACH) {
        return;
    }
    let [above, here, below] = rows.map(|row| row.as_ptr().wrapping_add(REACH));
    // SAFETY: `count` bytes are written, and of each row as many and `REACH` more on both sides are read: the
    // loop is one for so many lanes of bytes.
    unsafe {
        asm!(
            "vmov.i8 q3, #1",
            "vmov.i8 q4, #2",
            "vmov.i8 q5, #4",
            "vmov.i8 q6, #8",
            "vmov.i8 q7, #16",
            "dlstp.8 lr, {count}",
            "2:",
            "vldrb.u8 q0, [{here}]",
            "vmov.i8 q1, #0",
            ".macro compare from, bit",
            "vldrb.u8 q2, \\from",
            "vpt.u8 hi, q0, q2",
            "vaddt.i8 q1, q1, \\bit",
            ".endm",
            "compare \"[{above}, #-4]\", q3",
            "compare \"[{above}, #4]\", q5",
            "compare \"[{above}], #16\", q4",
            "compare \"[{here}, #-2]\", q6",
            "compare \"[{here}, #2]\", q7",
            "compare \"[{below}, #-4]\", {sixth}",
            "compare \"[{below}, #4]\", {eighth}",
            "compare \"[{below}], #16\", {seventh}",
            ".purgem compare",
            "add {here}, {here}, #16",
            "vstrb.8 q1, [{out}], #16",
            "letp lr, 2b",
            count = in(reg) count, above = inout(reg) above => _, here = inout(reg) here => _,
            below = inout(reg) below => _, out = inout(reg) out.as_mut_ptr() => _,
            sixth = in(reg) 32, seventh = in(reg) 64, eighth = in(reg) 128,
            out("lr") _, out("q0") _, out("q1") _, out("q2") _, out("q3") _, out("q4") _, out("q5") _,
            out("q6") _, out("q7") _, options(nostack),
        );
    }
}

/// The gradients along the line and across it, cut off at `most` to each side, plus `most`, likewise, from
/// the rows above, here and below: 29 instructions for eight pixels.
#[inline(never)]
fn gradients(rows: [&[u8]; 3], most: u8, [along, across]: [&mut [u8]; 2]) {
    /// More than any sum.
    const BIAS: u32 = 1 << 10;
    let count = along.len();
    if count == 0 || across.len() < count || rows.iter().any(|row| row.len() < count + REACH + 1) {
        return;
    }
    let [above, here, below] = rows.map(|row| row.as_ptr().wrapping_add(REACH - 1));
    let most = u32::from(most);
    // SAFETY: `count` bytes of `along` and of `across` are written, and of each row as many and one more on
    // both sides are read: the loop is one for so many lanes of half-words.
    unsafe {
        asm!(
            "vdup.16 q7, {greatest}",
            "dlstp.16 lr, {count}",
            "2:",
            "vldrb.u16 q1, [r0, #2]",
            "vldrb.u16 q5, [r0, #1]",
            "vldrb.u16 q0, [r0], #8",
            "vldrb.u16 q3, [r2, #2]",
            "vldrb.u16 q6, [r2, #1]",
            "vldrb.u16 q2, [r2], #8",
            // Across: below less above, the middle one twice.
            "vsub.i16 q6, q6, q5",
            "vsub.i16 q4, q2, q0",
            "vadd.i16 q4, q4, q6",
            "vadd.i16 q4, q4, q6",
            "vsub.i16 q5, q3, q1",
            "vadd.i16 q4, q4, q5",
            // Along: right less left, likewise.
            "vsub.i16 q1, q1, q0",
            "vsub.i16 q3, q3, q2",
            "vadd.i16 q3, q3, q1",
            "vldrb.u16 q1, [r1, #2]",
            "vldrb.u16 q0, [r1], #8",
            "vsub.i16 q1, q1, q0",
            "vadd.i16 q3, q3, q1",
            "vadd.i16 q3, q3, q1",
            "vadd.i16 q4, q4, {up}",
            "vqsub.u16 q4, q4, {bias}",
            "vmin.u16 q4, q4, q7",
            "vstrb.16 q4, [r4], #8",
            "vadd.i16 q3, q3, {up}",
            "vqsub.u16 q3, q3, {bias}",
            "vmin.u16 q3, q3, q7",
            "vstrb.16 q3, [r3], #8",
            "letp lr, 2b",
            count = in(reg) count, greatest = in(reg) 2 * most, up = in(reg) BIAS + most,
            bias = in(reg) BIAS,
            inout("r0") above => _, inout("r1") here => _, inout("r2") below => _,
            inout("r3") along.as_mut_ptr() => _, inout("r4") across.as_mut_ptr() => _,
            out("lr") _, out("q0") _, out("q1") _, out("q2") _, out("q3") _, out("q4") _, out("q5") _,
            out("q6") _, out("q7") _, options(nostack),
        );
    }
}
