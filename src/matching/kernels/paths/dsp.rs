//! Arm's instructions on four bytes at a time: what the compiler has no stable names for.
#![allow(unsafe_code)]

use core::arch::asm;

macro_rules! two_operands {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[inline(always)]
        pub(super) fn $name(a: u32, b: u32) -> u32 {
            let out;
            // SAFETY: one instruction on registers, of the extension that `--cfg stereopsis_dsp` says is there.
            unsafe {
                asm!(concat!(stringify!($name), " {}, {}, {}"), lateout(reg) out, in(reg) a, in(reg) b,
                    options(pure, nomem, nostack, preserves_flags));
            }
            out
        }
    };
}

two_operands!(
    /// The sums, 255 where they would be more.
    uqadd8
);
two_operands!(
    /// The differences, 0 where they would be less.
    uqsub8
);

/// The lesser numbers, in two instructions: a subtraction marks the lanes that do not borrow, and `sel` picks by the marks.
#[inline(always)]
pub(super) fn min8(a: u32, b: u32) -> u32 {
    let out;
    // SAFETY: as above; the marks are not kept for anybody (the flags are not said to be preserved).
    unsafe {
        asm!("usub8 {out}, {a}, {b}", "sel {out}, {b}, {a}", out = out(reg) out, a = in(reg) a, b = in(reg) b,
            options(pure, nomem, nostack));
    }
    out
}

/// The greater numbers, likewise.
#[inline(always)]
pub(super) fn max8(a: u32, b: u32) -> u32 {
    let out;
    // SAFETY: as for `min8`.
    unsafe {
        asm!("usub8 {out}, {a}, {b}", "sel {out}, {a}, {b}", out = out(reg) out, a = in(reg) a, b = in(reg) b,
            options(pure, nomem, nostack));
    }
    out
}

/// In lanes where `new` is not more than `least`: `new` and `place`; in the others `least` and `places`. Three instructions.
#[inline(always)]
pub(super) fn not_more(new: u32, least: u32, place: u32, places: u32) -> (u32, u32) {
    let (mut least, mut places) = (least, places);
    // SAFETY: as for `min8`.
    unsafe {
        asm!("usub8 {t}, {least}, {new}", "sel {least}, {new}, {least}", "sel {places}, {place}, {places}",
            t = out(reg) _, least = inout(reg) least, new = in(reg) new, places = inout(reg) places,
            place = in(reg) place, options(pure, nomem, nostack));
    }
    (least, places)
}
