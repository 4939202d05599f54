//! Four bytes or two half-words in a 32-bit word, in Arm's instructions for them.
#![allow(unsafe_code)]

use core::arch::asm;

/// A one in every byte.
pub(super) const ONE: u32 = 0x0101_0101;

macro_rules! two_operands {
        ($(#[$doc:meta])* $name:ident: $($instruction:literal),*) => {
            $(#[$doc])*
            #[inline(always)]
            pub(super) fn $name(a: u32, b: u32) -> u32 {
                let out;
                // SAFETY: instructions on registers alone, of the extension that `--cfg stereopsis_dsp` says
                // is there. The marks of lanes are not said to be preserved.
                unsafe {
                    asm!($($instruction),*, out = out(reg) out, a = in(reg) a, b = in(reg) b,
                        options(pure, nomem, nostack));
                }
                out
            }
        };
    }

two_operands!(
    /// The sums of bytes, modulo 256.
    add: "uadd8 {out}, {a}, {b}"
);
two_operands!(
    /// The lesser bytes: the subtraction marks the lanes that do not borrow, and `sel` picks by the marks.
    min: "usub8 {out}, {a}, {b}", "sel {out}, {b}, {a}"
);
two_operands!(
    /// The lesser half-words, likewise.
    min_halves: "usub16 {out}, {a}, {b}", "sel {out}, {b}, {a}"
);
two_operands!(
    /// The sums of half-words, modulo 65536.
    add_halves: "uadd16 {out}, {a}, {b}"
);
two_operands!(
    /// The differences of half-words, modulo 65536.
    subtract_halves: "usub16 {out}, {a}, {b}"
);
two_operands!(
    /// Half of the differences of half-words, rounded down, with their signs.
    halved_difference: "uhsub16 {out}, {a}, {b}"
);

/// The half-words of `yes` where those of `a` are not less than those of `b`, and those of `no` elsewhere.
#[inline(always)]
pub(super) fn half_or(a: u32, b: u32, yes: u32, no: u32) -> u32 {
    let out;
    // SAFETY: as above.
    unsafe {
        asm!("usub16 {out}, {a}, {b}", "sel {out}, {yes}, {no}", out = out(reg) out, a = in(reg) a,
        b = in(reg) b, yes = in(reg) yes, no = in(reg) no, options(pure, nomem, nostack));
    }
    out
}

/// The highest bit of every byte in which `a` is not less than `b`, and no other.
#[inline(always)]
pub(in super::super) fn not_less(a: u32, b: u32) -> u32 {
    let out;
    // SAFETY: as above.
    unsafe {
        asm!("usub8 {out}, {a}, {b}", "sel {out}, {top}, {none}", out = out(reg) out, a = in(reg) a,
        b = in(reg) b,
                top = in(reg) 0x8080_8080u32, none = in(reg) 0, options(pure, nomem, nostack));
    }
    out
}

/// In bytes where `new` is less than `least`: `new` and `place`; in the others `least` and `places`. Three
/// instructions.
#[inline(always)]
pub(super) fn take_less(least: &mut u32, places: &mut u32, new: u32, place: u32) {
    // SAFETY: as above.
    unsafe {
        asm!("usub8 {t}, {new}, {least}", "sel {least}, {least}, {new}", "sel {places}, {places}, {place}",
                t = out(reg) _, least = inout(reg) *least, places = inout(reg) *places, new = in(reg) new,
                place = in(reg) place, options(pure, nomem, nostack));
    }
}
