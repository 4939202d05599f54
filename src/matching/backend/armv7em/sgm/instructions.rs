//! Arm's instructions on four bytes or two half-words at a time: what the compiler has no stable names for.
#![allow(unsafe_code)]

use core::arch::asm;

macro_rules! two_operands {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[inline(always)]
        pub(super) fn $name(a: u32, b: u32) -> u32 {
            let out;
            // SAFETY: one instruction on registers, of the extension that `--cfg stereopsis_dsp` says is
            // there.
            unsafe {
                asm!(concat!(stringify!($name), " {}, {}, {}"), lateout(reg) out, in(reg) a, in(reg) b,
                    options(pure, nomem, nostack, preserves_flags));
            }
            out
        }
    };
}

two_operands!(
    /// The averages of bytes, rounded down.
    uhadd8
);
two_operands!(
    /// The differences of bytes, 0 where they would be less.
    uqsub8
);
two_operands!(
    /// The differences of half-words, 0 where they would be less.
    uqsub16
);

/// A subtraction marks the bytes that do not borrow, and `sel` picks by the marks: those of the first, or of
/// the second.
macro_rules! pick {
    ($(#[$doc:meta])* $name:ident, $first:literal, $second:literal) => {
        $(#[$doc])*
        #[inline(always)]
        pub(super) fn $name(a: u32, b: u32) -> u32 {
            let out;
            // SAFETY: as above; the marks are not kept for anybody (the flags are not said to be preserved).
            unsafe {
                asm!("usub8 {out}, {a}, {b}", concat!("sel {out}, ", $first, ", ", $second),
                    out = out(reg) out, a = in(reg) a, b = in(reg) b,
                    options(pure, nomem, nostack));
            }
            out
        }
    };
}

pick!(
    /// The lesser bytes.
    min8, "{b}", "{a}"
);
pick!(
    /// The greater bytes.
    max8, "{a}", "{b}"
);

/// `bits` in the bytes in which `a` is less than `b`.
#[inline(always)]
pub(super) fn bits_where_less(a: u32, b: u32, bits: u32) -> u32 {
    let out;
    // SAFETY: as for `min8`.
    unsafe {
        asm!("usub8 {out}, {a}, {b}", "sel {out}, {none}, {bits}", out = out(reg) out, a = in(reg) a,
        b = in(reg) b,
            none = in(reg) 0, bits = in(reg) bits, options(pure, nomem, nostack));
    }
    out
}

/// `codes`, with bit `BIT` set in the bytes in which `a` is less than `b`.
#[inline(always)]
pub(super) fn with_bit_where_less<const BIT: u32>(codes: u32, a: u32, b: u32) -> u32 {
    let out;
    // SAFETY: as for `min8`.
    unsafe {
        asm!("usub8 {out}, {a}, {b}", "orr {out}, {codes}, #0x01010101 << {bit}", "sel {out}, {codes}, {out}",
            out = out(reg) out, a = in(reg) a, b = in(reg) b, codes = in(reg) codes, bit = const BIT,
            options(pure, nomem, nostack));
    }
    out
}
