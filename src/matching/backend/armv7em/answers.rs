//! Winners become answers: the second half of what `portable::left_right` does.
//!
//! Answers are made two at a time, in the halves of a word, the first one in the low half. With the rises `a`
//! below the winner and `b` above it, `e = max(a - b, 0)` and what a slant costs, `s`:
//!
//! ```text
//! steepest   b + e                    lesser   a - e
//! divisor    steepest - min(s, lesser), at least 1
//! sum        divisor + a - b
//! fraction   (16 sum + half) / divisor - 16,   half = divisor / 2, rounded down, of one less where a < b
//! ```
//!
//! which is not below 0 before the 16 are taken off: it is rounded as the quotient of the difference alone.
#![allow(unsafe_code)]

use crate::matching::backend::parameters::MethodParameters;
use crate::matching::backend::work::Rules;
use crate::matching::memory::winners::Winner;
use crate::units::{Disparity, PixelFlags};
use core::arch::asm;
use core::slice::from_mut;

/// Of the winners `r0` and `r1` the rises below in `r1`, those above in `r3`, and the disparities in `r0`: 8
/// instructions.
macro_rules! unpack {
    () => {
        "pkhbt r2, r0, r1, lsl #16
         pkhtb r0, r1, r0, asr #16
         uxtb16 r1, r2
         uxtb16 r2, r2, ror #8
         uxtb16 r3, r0
         uxtb16 r0, r0, ror #8
         sub r1, r1, r2
         sub r3, r3, r2
         "
    };
}

/// From rises to the divisor in `r3`, which may be 0 yet, and the sum in `r1`, where a slant costs nothing.
/// The bit above the low byte of a half says in `r5` that nothing rises there, in `r2` that the divisor is 0;
/// other bits of `r5` say nothing. 5 instructions.
macro_rules! upright_fraction {
    () => {
        "uqsub16 r2, r1, r3
         add r3, r3, r2
         add r1, r1, r2
         rsb r5, r3, #0x01000100
         and r2, r5, #0x01000100
         "
    };
}

/// [`upright_fraction`] where a slant costs `r12`. 10 instructions.
macro_rules! slanted_fraction {
    () => {
        "uqsub16 r2, r1, r3
         add r3, r3, r2
         rsb r5, r3, #0x01000100
         sub r1, r1, r2
         sub r3, r3, r1
         uqsub16 r1, r1, r12
         add r3, r3, r1
         add r1, r1, r2, lsl #1
         rsb r2, r3, #0x01000100
         and r2, r2, #0x01000100
         "
    };
}

/// The fractions and 16 in `r1`, of the divisors and sums. 12 instructions.
macro_rules! quotients {
    () => {
        "orr r3, r3, r2, lsr #8
         orr r1, r1, r2, lsr #8
         usub16 r2, r1, r3
         sel r2, r7, lr
         shadd16 r2, r3, r2
         add r1, r2, r1, lsl #4
         uxth r2, r3
         sub r3, r3, r2
         udiv r3, r1, r3
         uxth r1, r1
         udiv r1, r1, r2
         pkhbt r1, r1, r3, lsl #16
         "
    };
}

/// How far the disparities `r0` are from what their partners keep, in the high byte of each half; the
/// disparity stays in the low one. Columns go on by two. 11 instructions.
macro_rules! apart {
    () => {
        "uqsub16 r2, r4, r0
         add r4, r4, #0x00020002
         uxth r3, r2
         ldrb r3, [r9, r3, lsl #1]
         lsr r2, r2, #16
         ldrb r2, [r9, r2, lsl #1]
         orr r2, r3, r2, lsl #16
         uqsub8 r3, r2, r0
         uqsub8 r2, r0, r2
         orr r2, r2, r3
         orr r0, r0, r2, lsl #8
         "
    };
}

/// Writes the flags, by `r0` and `r5`, and the answers `r1`, none where a flag refuses it. 17 instructions.
macro_rules! flags {
    () => {
        "ldrd r2, r3, [sp]
         usub8 r2, r2, r0
         sel r0, r7, r3
         orr r0, r0, r0, lsr #8
         ldrd r2, r3, [sp, #8]
         and r5, r3, r5, lsr #6
         orr r0, r0, r5
         ldrh r3, [r11]
         orr r3, r3, r3, lsl #8
         orr r0, r0, r3
         uxtb16 r0, r0
         and r3, r0, r6
         uadd16 r3, r3, lr
         sel r1, lr, r1
         str r1, [r10], #4
         orr r0, r0, r0, lsr #8
         strh r0, [r11], #2
         "
    };
}

/// A number in both halves of a word.
fn halves(number: u8) -> u32 {
    u32::from(number) * 0x1_0001
}

/// The answers and flags of winners that were offered to the `right`, whose columns without the disparity are
/// `columns` of the first two and two more of each two after them. 58 instructions for two pixels, 64 where a
/// part of the steeper rise is not counted.
#[inline(never)]
fn answer_twos<P: MethodParameters>(
    winners: &[[Winner; 2]],
    right: &[u16],
    rules: &Rules,
    columns: [u16; 2],
    answers: &mut [[Disparity; 2]],
    flags: &mut [[PixelFlags; 2]],
) {
    let twos = winners.len();
    let is_inside = usize::from(columns[0].max(columns[1])) + 2 * twos <= right.len() + 1;
    if twos == 0 || answers.len() < twos || flags.len() < twos || !is_inside {
        return;
    }
    const { assert!(Disparity::ONE == 1 << 5) };
    const { assert!(PixelFlags::UNTEXTURED.bits() == 1 << (8 - 6)) };
    let [low, high] = columns.map(u32::from);
    let flags = flags.as_mut_ptr();
    // A disparity beyond the first, or so far apart as beyond the second, has the flag below it.
    let most = halves(rules.ceiling.saturating_sub(1)) | halves(rules.tolerance) << 8;
    let flagged = halves(PixelFlags::CEILING.bits()) | halves(PixelFlags::MISMATCH.bits()) << 8;
    // Fractions have 16 too many.
    let least = (u32::from(rules.min_disparity) << 5).wrapping_sub(16) & 0xffff;
    macro_rules! answers {
        ($fraction:ident, $begin:literal, $add:literal $(, $slant:ident = const $value:expr)?) => {
            asm!(
                "push {{r0, r1, r2, r3, r6, r7, r12}}",
                "mov r6, r5",
                "mov r7, #0",
                $begin,
                "2:",
                "ldrd r0, r1, [r8], #8",
                unpack!(),
                $fraction!(),
                quotients!(),
                "add r1, r1, r0, lsl #5",
                $add,
                apart!(),
                flags!(),
                "cmp r11, r2",
                "bne 2b",
                "pop {{r0, r1, r2, r3, r6, r7, r12}}",
                inout("r0") most => _, inout("r1") flagged => _,
                inout("r2") flags.add(twos) => _, inout("r3") halves(rules.flat.bits()) => _,
                inout("r4") high << 16 | low => _,
                inout("r5") halves(rules.refused.bits()) => _,
                inout("r8") winners.as_ptr() => _,
                in("r9") right.as_ptr(),
                inout("r10") answers.as_mut_ptr() => _,
                inout("r11") flags => _,
                inout("r12") least * 0x1_0001 => _,
                in("lr") u32::MAX,
                $($slant = const $value,)?
            )
        };
    }
    // SAFETY: of `twos` pairs the loop reads the winners, changes the flags and writes the answers, which
    // all three slices have. It reads what the right column `x - disparity` keeps, or the first one if that
    // is less than 0: no more than `right` has by `is_inside`. Divisors are not 0. The stack and the two
    // registers that no operand may be are left as they were.
    unsafe {
        if P::SLANT_COST == 0 {
            answers!(upright_fraction, "", "uadd16 r1, r1, r12");
        } else {
            answers!(
                slanted_fraction,
                "mov r12, #{slant} * 0x00010001",
                "ldr r2, [sp, #24]
                 uadd16 r1, r1, r2",
                slant = const P::SLANT_COST
            );
        }
    }
}

/// The answers and flags of winners that were offered to the `right`.
pub(super) fn answer<P: MethodParameters>(
    winners: &[Winner],
    right: &[u16],
    rules: &Rules,
    answers: &mut [Disparity],
    flags: &mut [PixelFlags],
) {
    let (twos, last) = winners.as_chunks();
    let (answers, last_answer) = answers.as_chunks_mut();
    let (flags, last_flags) = flags.as_chunks_mut();
    answer_twos::<P>(twos, right, rules, [0, 1], answers, flags);
    if let ([winner], [answer], [flags]) = (last, last_answer, last_flags) {
        // Both of two are the last one.
        let (mut answers, mut both) = ([Disparity::NONE; 2], [*flags; 2]);
        let column = 2 * twos.len() as u16;
        let (winners, columns) = ([*winner; 2], [column; 2]);
        answer_twos::<P>(&[winners], right, rules, columns, from_mut(&mut answers), from_mut(&mut both));
        [*answer, _] = answers;
        [*flags, _] = both;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::backend::portable::left_right::answer as plain;
    use crate::matching::method::{Fast, Sgm};
    extern crate std;
    use std::vec;
    use std::vec::Vec;

    /// Numbers that look like chance, the next one from the last one's highest bits.
    fn random() -> impl FnMut(u32) -> u32 {
        let mut state = 1u64;
        move |below| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % u64::from(below)) as u32
        }
    }

    /// Compares the answers of a row, behind flags that are there already.
    fn compare<P: MethodParameters>(winners: &[Winner], random: &mut impl FnMut(u32) -> u32) {
        let mut number = |below: u32| random(below);
        let right: Vec<u16> = winners.iter().map(|_| number(1 << 16) as u16).collect();
        let farthest = winners.iter().map(|winner| winner.disparity()).fold(15, u32::max);
        let rules = Rules {
            min_disparity: number(1800) as u16,
            ceiling: (farthest + number(256 - farthest)) as u8,
            tolerance: [0, 1, 2, 254, 255][number(5) as usize],
            flat: PixelFlags::UNTEXTURED.when(number(2) == 1),
            refused: PixelFlags::from_bits(number(256) as u8),
        };
        let before: Vec<_> = winners.iter().map(|_| PixelFlags::from_bits(number(256) as u8)).collect();
        let answers_of = |answer: fn(&[Winner], &[u16], &Rules, &mut [Disparity], &mut [PixelFlags])| {
            let (mut answers, mut flags) = (vec![Disparity::ZERO; winners.len()], before.clone());
            answer(winners, &right, &rules, &mut answers, &mut flags);
            answers.into_iter().zip(flags).collect::<Vec<_>>()
        };
        let (found, expected) = (answers_of(answer::<P>), answers_of(plain::<P>));
        for (x, (found, expected)) in found.iter().zip(&expected).enumerate() {
            assert_eq!(found, expected, "column {x} of {}: {:?}", winners.len(), winners[x]);
        }
    }

    #[test]
    fn rows_of_any_length_are_as_in_plain_rust() {
        let mut random = random();
        for count in (0..12).cycle().take(4000).chain([319, 320]) {
            let winners: Vec<_> = (0..count)
                .map(|x| {
                    let cost = random(256);
                    let beside = [0, 1].map(|_| (cost + random(256 - cost)) as u8);
                    Winner::new(cost as u8, random(x.min(255) + 1) as u8, (beside[0], beside[1]))
                })
                .collect();
            compare::<Fast>(&winners, &mut random);
            compare::<Sgm>(&winners, &mut random);
        }
    }

    #[test]
    fn any_rises_have_the_fraction_of_plain_rust() {
        let mut random = random();
        for below in 0..=u8::MAX {
            for cost in [0, 1, 100, below] {
                let winners: Vec<_> =
                    (cost..=u8::MAX).map(|above| Winner::new(cost, 0, (below.max(cost), above))).collect();
                compare::<Fast>(&winners, &mut random);
                compare::<Sgm>(&winners, &mut random);
            }
        }
    }
}
