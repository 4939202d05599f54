//! The loops over a pixel's words. Each works on four words at a time, for a column has whole
//! [`STEP`](super::super::STEP)s of bytes. The instructions of a word are counted with each; the loop adds
//! half of one.
#![allow(unsafe_code)]

use crate::matching::backend::parameters::SgmParameters;
use core::arch::asm;

/// Four times the lines of a word, and around again until `n` is 0.
macro_rules! four_words {
    ($($line:literal)*) => {
        concat!("2:\n", $($line, "\n",)* $($line, "\n",)* $($line, "\n",)* $($line, "\n",)*
            "subs {n}, {n}, #1\n", "bne 2b")
    };
}

/// The least of a word's four bytes, in all of them: half a word off, then a byte.
macro_rules! least_of_four {
    () => {
        "ror {a}, {least}, #16
         usub8 {b}, {least}, {a}
         sel {least}, {a}, {least}
         ror {a}, {least}, #8
         usub8 {b}, {least}, {a}
         sel {least}, {a}, {least}"
    };
}

/// The least of a column's sums and the last byte that has it. 5 instructions.
///
/// The loop finds the least of each byte of a word and the word where it is, of equal ones the last. Then the
/// least of the four goes to all bytes, and the greatest place of those that have it.
///
/// # Safety
/// `fours` times four words, 64 at the most and one at least, can be read from `sums`.
#[inline(never)]
pub(super) unsafe fn least(sums: *const u32, fours: usize) -> (u8, usize) {
    let (least, place): (u32, u32);
    // SAFETY: as the function's.
    unsafe {
        asm!(
            "mvn {least}, #0",
            "mov {place}, #0",
            four_words!(
                "ldr {a}, [{sums}], #4"
                "usub8 {b}, {least}, {a}"
                "sel {least}, {a}, {least}"
                "sel {places}, {place}, {places}"
                "add {place}, {place}, #0x01010101"
            ),
            "mov {place}, {least}",
            least_of_four!(),
            "add {places}, {lanes}, {places}, lsl #2",
            "usub8 {a}, {least}, {place}",
            "mov {b}, #0",
            "sel {places}, {places}, {b}",
            "ror {a}, {places}, #16",
            "usub8 {b}, {places}, {a}",
            "sel {places}, {places}, {a}",
            "ror {a}, {places}, #8",
            "usub8 {b}, {places}, {a}",
            "sel {places}, {places}, {a}",
            sums = inout(reg) sums => _,
            n = inout(reg) fours => _,
            lanes = in(reg) 0x0302_0100,
            least = out(reg) least,
            places = out(reg) place,
            place = out(reg) _,
            a = out(reg) _, b = out(reg) _,
            options(nostack, readonly),
        );
    }
    (least as u8, (place & 0xff) as usize)
}

/// What [`enter`] goes by, at these places of the frame in `lr`.
#[repr(C)]
struct Frame {
    /// 0 to 12: the next pixel of the left row: its gradients along the line and across it, its code, its
    /// brightness.
    left: [*const u8; 4],
    /// 16: pixels that are left.
    count: usize,
    /// 20: bytes from the end of a pixel's candidates back to the next one's first.
    back: usize,
    /// 24: a column's words, in fours.
    fours: usize,
}

/// What two words of candidates agree, in `$a`, `r9` or `r12`: `$along` puts the share of the gradient along
/// the line there. 27 instructions with the five of that.
///
/// How far apart two numbers are is the greater of their two differences, the other of which is 0; the bits
/// of a byte are counted by twos, fours and eights; masks are such as an instruction holds.
macro_rules! agreement {
    ($a:literal, $along:expr) => {
        concat!(
            $along,
            "
         ldr r10, [r1, r3, lsl #1]
         uqsub8 r11, r10, r7
         uqsub8 r10, r7, r10
         orr r10, r10, r11
         and r10, r10, #0xfcfcfcfc
         add ",
            $a,
            ", ",
            $a,
            ", r10, lsr #2
         ldr r10, [r1, r3]
         eor r10, r10, r6
         and r11, r10, #0xaaaaaaaa
         sub r10, r10, r11, lsr #1
         and r11, r10, #0xcccccccc
         and r10, r10, #0x33333333
         add r10, r10, r11, lsr #2
         add r10, r10, r10, lsr #4
         and r10, r10, #0x0f0f0f0f
         add ",
            $a,
            ", ",
            $a,
            ", r10
         ldr r10, [r1], #4
         uqsub8 r11, r10, r5
         uqsub8 r10, r5, r10
         add ",
            $a,
            ", ",
            $a,
            ", r11
         add ",
            $a,
            ", ",
            $a,
            ", r10
         uqsub8 ",
            $a,
            ", r8, ",
            $a,
            "
         "
        )
    };
}

/// The gradient along the line, doubled, between the right ones and halfway to their neighbours: how far it
/// is from the least to the greatest, which stand doubled at `r2` and a row further.
macro_rules! between_pixels {
    ($a:literal) => {
        concat!(
            "ldr r10, [r2, r3]
         ldr ",
            $a,
            ", [r2], #4
         uqsub8 r10, r4, r10
         uqsub8 ",
            $a,
            ", ",
            $a,
            ", r4
         orr ",
            $a,
            ", ",
            $a,
            ", r10"
        )
    };
}

/// The gradient along the line against the right ones themselves, which stand at `r2` and are not doubled:
/// how far it is from them, doubled.
macro_rules! at_pixels {
    ($a:literal) => {
        concat!(
            "ldr r10, [r2], #4
         uqsub8 ",
            $a,
            ", r10, r4
         uqsub8 r10, r4, r10
         orr ",
            $a,
            ", ",
            $a,
            ", r10
         lsl ",
            $a,
            ", ",
            $a,
            ", #1"
        )
    };
}

/// Averages a row's agreements into `costs`, or puts them there within edges: columns of `stride` bytes.
/// `left` are its gradients along the line and across it, its codes, its brightness; `right` begins with
/// the first candidate of the first pixel in the right features' rows, `count` bytes each. 22 instructions
/// for a pixel and 30 for four candidates.
#[inline(never)]
pub(super) fn enter<S: SgmParameters>(
    costs: &mut [u32],
    stride: usize,
    left: [&[u8]; 4],
    right: &[u8],
    count: usize,
    most: u32,
) {
    let pixels = left.iter().fold(4 * costs.len() / stride.max(1), |least, row| least.min(row.len()));
    if pixels == 0 || !stride.is_multiple_of(16) || right.len() < 5 * count + pixels - 1 + stride {
        return;
    }
    let mut frame =
        Frame { left: left.map(<[u8]>::as_ptr), count: pixels, back: stride - 1, fours: stride / 16 };
    let along = right.as_ptr().wrapping_add(if S::BETWEEN_PIXELS { 4 * count } else { 0 });
    macro_rules! enter {
        ($doubled:literal, $along:ident, $average:literal) => {
            asm!(
                // r0 costs, r1 right features across, r2 those along, r3 their rows' bytes
                "push {{r6, r7, lr}}",
                "1:",
                // The pixel's numbers four times each, along, across, the code and the brightness in r4 to r7
                "ldm lr, {{r4, r5, r6, r7}}",
                "ldrb r9, [r4], #1",
                "ldrb r10, [r5], #1",
                "ldrb r11, [r6], #1",
                "ldrb r12, [r7], #1",
                "stm lr, {{r4, r5, r6, r7}}",
                "ldr lr, [lr, #24]",
                "mov r4, #0x01010101",
                "lsr r12, r12, #1",
                $doubled,
                "mul r5, r10, r4",
                "mul r6, r11, r4",
                "mul r7, r12, r4",
                "mul r4, r9, r4",
                "2:",
                agreement!("r9", $along!("r9")),
                agreement!("r12", $along!("r12")),
                $average,
                "strd r9, r12, [r0], #8",
                agreement!("r9", $along!("r9")),
                agreement!("r12", $along!("r12")),
                $average,
                "strd r9, r12, [r0], #8",
                "subs lr, lr, #1",
                "bne 2b",
                "ldr lr, [sp, #8]",
                "ldrd r9, r10, [lr, #16]",
                "sub r1, r1, r10",
                "sub r2, r2, r10",
                "subs r9, r9, #1",
                "str r9, [lr, #16]",
                "bne 1b",
                "pop {{r6, r7, lr}}",
                inout("r0") costs.as_mut_ptr() => _,
                inout("r1") right.as_ptr().wrapping_add(count) => _,
                inout("r2") along => _,
                in("r3") count,
                in("r8") most,
                inout("lr") &raw mut frame => _,
                out("r4") _, out("r5") _, out("r9") _, out("r10") _, out("r11") _, out("r12") _,
            )
        };
    }
    // SAFETY: `pixels` bytes are read from each of the left rows; so many columns of `stride` bytes, a
    // multiple of 16, are read from six right rows, one byte further on with each, and read from `costs`
    // and written to it. `r6` and `r7`, which are the compiler's, are put back.
    unsafe {
        match (S::BETWEEN_PIXELS, S::WITHIN_EDGES) {
            (true, true) => enter!("lsl r9, r9, #1", between_pixels, ""),
            (true, false) => enter!(
                "lsl r9, r9, #1",
                between_pixels,
                "ldrd r10, r11, [r0]
                 uhadd8 r9, r9, r10
                 uhadd8 r12, r12, r11"
            ),
            (false, _) => enter!(
                "",
                at_pixels,
                "ldrd r10, r11, [r0]
                 uhadd8 r9, r9, r10
                 uhadd8 r12, r12, r11"
            ),
        }
    }
}
