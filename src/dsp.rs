//! Arm's instructions on the four bytes or two half-words of a word, which the compiler has no stable names
//! for (`--cfg stereopsis_dsp`: Cortex-M4, M7, and M33 that have them; `--cfg stereopsis_vectors`: M55).
#![allow(unsafe_code)]

use core::arch::asm;

/// A one in every byte.
pub(crate) const ONE: u32 = 0x0101_0101;

macro_rules! one_instruction {
    ($(#[$doc:meta])* $name:ident: $instruction:literal $(, $option:ident)?) => {
        $(#[$doc])*
        #[inline(always)]
        pub(crate) fn $name(a: u32, b: u32) -> u32 {
            let out;
            // SAFETY: one instruction on registers alone, of the extension that either condition says is
            // there. Where it marks lanes, the marks are not said to be preserved.
            unsafe {
                asm!($instruction, out = lateout(reg) out, a = in(reg) a, b = in(reg) b,
                    options(pure, nomem, nostack $(, $option)?));
            }
            out
        }
    };
}

one_instruction!(
    /// The sums of bytes, modulo 256.
    add: "uadd8 {out}, {a}, {b}"
);
one_instruction!(
    /// The averages of bytes, rounded down.
    average: "uhadd8 {out}, {a}, {b}", preserves_flags
);
one_instruction!(
    /// The differences of bytes, 0 where `b` is more.
    saturating_subtract: "uqsub8 {out}, {a}, {b}", preserves_flags
);
one_instruction!(
    /// The sums of half-words, modulo 65536.
    add_halves: "uadd16 {out}, {a}, {b}"
);
one_instruction!(
    /// The differences of half-words, modulo 65536.
    subtract_halves: "usub16 {out}, {a}, {b}"
);
one_instruction!(
    /// The differences of half-words, 0 where `b` is more.
    saturating_subtract_halves: "uqsub16 {out}, {a}, {b}", preserves_flags
);
one_instruction!(
    /// Half of the differences of half-words, rounded down, with their signs.
    halved_difference: "uhsub16 {out}, {a}, {b}", preserves_flags
);
one_instruction!(
    /// The sums of the half-words of `a` and the bytes 0 and 2 of `b`.
    add_even_bytes: "uxtab16 {out}, {a}, {b}", preserves_flags
);
one_instruction!(
    /// The sums of the half-words of `a` and the bytes 1 and 3 of `b`.
    add_odd_bytes: "uxtab16 {out}, {a}, {b}, ror #8", preserves_flags
);

macro_rules! select {
    ($(#[$doc:meta])* $name:ident: $subtraction:literal) => {
        $(#[$doc])*
        #[inline(always)]
        pub(crate) fn $name(a: u32, b: u32, yes: u32, no: u32) -> u32 {
            let out;
            // SAFETY: instructions on registers alone, of the extension that either condition says is
            // there: the subtraction marks the lanes that do not borrow, and `sel` picks by the marks, which
            // are not said to be preserved.
            unsafe {
                asm!($subtraction, "sel {out}, {yes}, {no}", out = out(reg) out, a = in(reg) a,
                    b = in(reg) b, yes = in(reg) yes, no = in(reg) no, options(pure, nomem, nostack));
            }
            out
        }
    };
}

select!(
    /// The bytes of `yes` where those of `a` are not less than those of `b`, and those of `no` elsewhere.
    select: "usub8 {out}, {a}, {b}"
);
select!(
    /// The half-words of `yes` where those of `a` are not less than those of `b`, those of `no` elsewhere.
    select_halves: "usub16 {out}, {a}, {b}"
);

macro_rules! pick {
    ($(#[$doc:meta])* $name:ident: $subtraction:literal, $pick:literal) => {
        $(#[$doc])*
        #[inline(always)]
        pub(crate) fn $name(a: u32, b: u32) -> u32 {
            let out;
            // SAFETY: as for `select`, which takes a register more where `yes` and `no` are `a` and `b`.
            unsafe {
                asm!($subtraction, $pick, out = out(reg) out, a = in(reg) a, b = in(reg) b,
                    options(pure, nomem, nostack));
            }
            out
        }
    };
}

pick!(
    /// The lesser bytes.
    min: "usub8 {out}, {a}, {b}", "sel {out}, {b}, {a}"
);
pick!(
    /// The greater bytes.
    max: "usub8 {out}, {a}, {b}", "sel {out}, {a}, {b}"
);
pick!(
    /// The lesser half-words.
    min_halves: "usub16 {out}, {a}, {b}", "sel {out}, {b}, {a}"
);

/// The greater bytes and the lesser ones, from one subtraction.
#[inline(always)]
pub(crate) fn max_min([a, b]: [u32; 2]) -> (u32, u32) {
    let (greater, lesser);
    // SAFETY: as for `select`.
    unsafe {
        asm!("usub8 {greater}, {a}, {b}", "sel {greater}, {a}, {b}", "sel {lesser}, {b}, {a}",
            greater = out(reg) greater, lesser = out(reg) lesser, a = in(reg) a, b = in(reg) b,
            options(pure, nomem, nostack));
    }
    (greater, lesser)
}

/// In bytes where `new` is less than `least`: `new` and `place`; in the others `least` and `places`. Three
/// instructions.
#[inline(always)]
pub(crate) fn take_less(least: &mut u32, places: &mut u32, new: u32, place: u32) {
    // SAFETY: as for `select`.
    unsafe {
        asm!("usub8 {t}, {new}, {least}", "sel {least}, {least}, {new}", "sel {places}, {places}, {place}",
            t = out(reg) _, least = inout(reg) *least, places = inout(reg) *places, new = in(reg) new,
            place = in(reg) place, options(pure, nomem, nostack));
    }
}
