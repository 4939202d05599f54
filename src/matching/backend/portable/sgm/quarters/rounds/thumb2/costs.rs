//! The costs of pixels.
#![allow(unsafe_code)]

use crate::matching::backend::parameters::SgmParameters;
use crate::matching::backend::portable::sgm::quarters::columns::FOUR;
use crate::matching::backend::portable::sgm::quarters::others::{Costs, NUMBERS, Others};
use core::arch::asm;

/// What assembly takes of the costs, in this order.
#[repr(C)]
struct Row {
    margin: u32,
    others: *const Others,
    rounds: usize,
    most: u32,
    /// The left image's features of three kinds, one `width` behind the other, and its brightness.
    looks: *const u8,
    brightness: *const u8,
    width: usize,
    pixels: usize,
}

/// See `plain`.
#[inline(always)]
pub fn enter<S: SgmParameters, const WORDS: usize, const ALL: bool>(
    costs: &Costs<'_>,
    x: usize,
    others: &[Others],
    columns: &mut [u32],
) {
    let Costs { left, rounds, most, margin } = *costs;
    let (words, width) = (FOUR * rounds, left.brightness.len());
    let pixels = columns.len() / words.max(1);
    let is_there = x + pixels <= width && 3 * width <= left.rows.len() && pixels + words <= others.len() + 1;
    if words == 0 || pixels == 0 || !is_there {
        return;
    }
    let looks = left.rows.as_ptr().wrapping_add(x);
    let brightness = left.brightness.as_ptr().wrapping_add(x);
    let others = others.as_ptr();
    let mut row = Row { margin, others, rounds, most, looks, brightness, width, pixels };
    // SAFETY: so many pixels from `x` on have all they look like; the last one's others are there, as all
    // pixels' columns.
    unsafe {
        if S::WITHIN_EDGES {
            put_agreements(&mut row, columns.as_mut_ptr());
        } else {
            average_agreements(&mut row, columns.as_mut_ptr());
        }
    }
}

/// The agreement of a pixel with the four at `r1`, with the margin, in `r9`. 39 instructions.
macro_rules! agreement {
    () => {
        concat!(
            // Least and greatest gradient, that across, census.
            "ldm r1!, {{r9, r10, r11, r12}}\n",
            op!("sub", "r9", "r9", "r4"),
            over!("lr", "r9"),
            op!("add", "r10", "r10", "r4"),
            over!("r9", "r10"),
            op!("orr", "r9", "r9", "lr"),
            op!("sub", "r11", "r5", "r11"),
            over!("lr", "r11"),
            op!("add", "r9", "r9", "lr"),
            op!("sub", "r9", "r8", "r9", "lsl #1"),
            op!("add", "r9", "r9", "r11"),
            // Bits of the census.
            op!("eor", "r12", "r12", "r6"),
            op!("and", "lr", "r12", "#0xaaaaaaaa"),
            op!("sub", "r12", "r12", "lr", "lsr #1"),
            op!("and", "lr", "r12", "#0xcccccccc"),
            op!("and", "r12", "r12", "#0x33333333"),
            op!("add", "r12", "r12", "lr", "lsr #2"),
            op!("add", "r12", "r12", "r12", "lsr #4"),
            op!("and", "r12", "r12", "#0x0f0f0f0f"),
            op!("sub", "r9", "r9", "r12"),
            // A quarter of the brightness.
            op!("ldr", "r10", "[r1], #4"),
            op!("sub", "r10", "r7", "r10"),
            over!("lr", "r10"),
            op!("rsb", "r10", "r10", "lr", "lsl #1"),
            op!("add", "r10", "r10", "#0x80808080"),
            op!("and", "r10", "r10", "#0xfcfcfcfc"),
            op!("sub", "r10", "r9", "r10", "lsr #2"),
            over!("r9", "r10"),
            op!("add", "r9", "r9", "r0"),
        )
    };
}

/// The loops over pixels and the words of their columns, which `$put` an agreement that is in `r9` in their
/// place at `r2`.
macro_rules! agreements {
    ($(#[$doc:meta])* $name:ident, $put:literal) => {
        $(#[$doc])*
        #[inline(never)]
        unsafe fn $name(row: &mut Row, columns: *mut u32) {
            // SAFETY: as the caller says; what is kept on the stack is taken back.
            unsafe {
                asm!(
                    "push {{r0, r6, r7}}",
                    "1:",
                    // The pixel's margin, others, rounds and most, and what it looks like, four times.
                    "ldr lr, [sp]",
                    "ldm lr, {{r0, r1, r3, r8, r9, r10, r11}}",
                    "ldrb r4, [r9]",
                    "ldrb r5, [r9, r11]",
                    "add r12, r9, r11",
                    "ldrb r6, [r12, r11]",
                    "add r9, r9, #1",
                    "ldrb r7, [r10], #1",
                    "strd r9, r10, [lr, #16]",
                    "add r9, r1, #{group}",
                    "str r9, [lr, #4]",
                    "lsr r7, r7, #1",
                    concat!(splat!("r4"), splat!("r5"), splat!("r6"), splat!("r7")),
                    "orr r5, r5, #0x80808080",
                    "orr r7, r7, #0x80808080",
                    "2:",
                    concat!(agreement!(), $put, agreement!(), $put, agreement!(), $put, agreement!(), $put),
                    "subs r3, r3, #1",
                    "bne 2b",
                    "ldr lr, [sp]",
                    "ldr r0, [lr, #28]",
                    "subs r0, r0, #1",
                    "str r0, [lr, #28]",
                    "bne 1b",
                    "pop {{r0, r6, r7}}",
                    inout("r0") row => _, out("r1") _, inout("r2") columns => _, out("r3") _, out("r4") _,
                    out("r5") _, out("r8") _, out("r9") _, out("r10") _, out("r11") _, out("r12") _,
                    out("lr") _, group = const NUMBERS * size_of::<u32>(),
                );
            }
        }
    };
}

agreements! {
    /// Puts a row's agreements. 162 instructions, and 27 for a pixel.
    ///
    /// # Safety
    /// What `row` says is there, and columns of its pixels, which are not 0, as its rounds.
    put_agreements, "str r9, [r2], #4\n"
}
agreements! {
    /// Averages a row's agreements into its columns. 178 instructions, and 27 for a pixel.
    ///
    /// # Safety
    /// As of [`put_agreements`].
    average_agreements,
    "ldr lr, [r2]\n add r9, r9, lr\n and r9, r9, #0xfefefefe\n lsr r9, r9, #1\n str r9, [r2], #4\n"
}
