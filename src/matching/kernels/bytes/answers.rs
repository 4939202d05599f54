//! Winners become answers: what `answers::pixels` does, of methods whose costs rise for nothing but the disparity ([`Scheme::STEP`](crate::matching::Scheme::STEP) is 0).
#![allow(unsafe_code)]

use crate::matching::kernels::Winner;
use crate::units::{Disparity, PixelFlags};
use core::arch::asm;

/// Which winners are refused, and the smallest disparity.
pub struct Refused {
    pub min_disparity: u16,
    /// The last candidate.
    pub ceiling: u8,
    /// How far from the disparity that the partner keeps, px.
    pub tolerance: u8,
    /// The flag of winners that are flat.
    pub flat: PixelFlags,
    /// The flags that refuse.
    pub flags: PixelFlags,
}

/// One winner of [`offer`]: 11 instructions.
macro_rules! offer_one {
    () => {
        concat!(
            "ldr {w}, [{winners}], #4\n",
            "lsr {d}, {w}, #24\n",
            "sub {c}, {x}, {d}\n",
            "usat {c}, #16, {c}\n",
            "and {w}, {w}, #0xff00\n",
            "orr {w}, {w}, {d}\n",
            // Of one partner, those who come later are farther away: their disparity is larger.
            "ldrh {d}, [{right}, {c}, lsl #1]\n",
            "cmp {w}, {d}\n",
            "it lo\n",
            "strhlo {w}, [{right}, {c}, lsl #1]\n",
            "add {x}, {x}, #1\n",
        )
    };
}

/// Offers every winner to its partner: see `answers::consistency`. 12 instructions a pixel.
#[inline(never)]
pub fn offer(winners: &[Winner], right: &mut [u16]) {
    right.fill(u16::MAX);
    let count = winners.len().min(right.len());
    if count == 0 {
        return;
    }
    // SAFETY: the loop counts `x` up to `count`, by two but for one in the first round if `count` is odd. It reads winner `x`, of which there are so many, and reads and writes the right
    // column `x - disparity`, or the first one if that is less than 0: one before `count`.
    unsafe {
        asm!(
            "tst {count}, #1",
            "bne 3f",
            "2:",
            offer_one!(),
            "3:",
            offer_one!(),
            "cmp {x}, {count}",
            "bne 2b",
            x = inout(reg) 0 => _,
            count = in(reg) count,
            winners = inout(reg) winners.as_ptr() => _,
            right = in(reg) right.as_mut_ptr(),
            w = out(reg) _, d = out(reg) _, c = out(reg) _,
            options(nostack),
        );
    }
}

/// One winner of [`answer`]: 37 instructions.
macro_rules! answer_one {
    () => {
        concat!(
            "ldr {w}, [{winners}, {x}, lsl #2]\n",
            "lsr {d}, {w}, #24\n",
            // How far from what the partner keeps.
            "sub {c}, {x}, {d}\n",
            "usat {c}, #16, {c}\n",
            "ldrb {c}, [{right}, {c}, lsl #1]\n",
            "ldrb {f}, [{flags}, {x}]\n",
            "usad8 {c}, {c}, {d}\n",
            "cmp {c}, {q}, lsr #16\n",
            "it hi\n",
            "orrhi {f}, {f}, #16\n",
            "cmp {d}, {p}, lsr #24\n",
            "it eq\n",
            "orreq {f}, {f}, #2\n",
            // The rises to the disparities below and above, of which the winner costs least; 16 times their difference, and half
            // of the steeper one more.
            "uxtb {c}, {w}, ror #8\n",
            "orr {c}, {c}, {c}, lsl #16\n",
            "sub {w}, {w}, {c}\n",
            "uxtb16 {w}, {w}\n",
            "uxth {a}, {w}\n",
            "subs {c}, {a}, {w}, lsr #16\n",
            "lsl {c}, {c}, #4\n",
            "itte lo\n",
            "lsrlo {a}, {w}, #16\n",
            "sublo {c}, {c}, {a}, lsr #1\n",
            "addhs {c}, {c}, {a}, lsr #1\n",
            "cmp {a}, #0\n",
            "itt eq\n",
            "orreq {f}, {f}, {p}, lsr #8\n",
            "moveq {a}, #1\n",
            "sdiv {c}, {c}, {a}\n",
            "add {c}, {c}, {d}, lsl #5\n",
            "add {c}, {c}, {q}\n",
            "tst {f}, {p}\n",
            "it ne\n",
            "movne {c}, #-1\n",
            "strb {f}, [{flags}, {x}]\n",
            "strh {c}, [{answers}, {x}, lsl #1]\n",
            "add {x}, {x}, #1\n",
        )
    };
}

/// The answers and flags of winners that were offered to the `right`. 38 instructions a pixel.
#[inline(never)]
pub fn answer(
    winners: &[Winner],
    right: &[u16],
    refused: &Refused,
    answers: &mut [Disparity],
    flags: &mut [PixelFlags],
) {
    let count = winners.len().min(answers.len()).min(flags.len()).min(right.len());
    if count == 0 {
        return;
    }
    const { assert!(Disparity::ONE == 1 << 5) };
    const { assert!(PixelFlags::MISMATCH.bits() == 16 && PixelFlags::CEILING.bits() == 2) };
    // A flag is or-ed in with what stands above it: these bits are in no other flag's place.
    let flags_and_ceiling =
        u32::from(refused.flags.bits()) | u32::from(refused.flat.bits()) << 8 | u32::from(refused.ceiling) << 24;
    let least_and_tolerance = u32::from(refused.min_disparity) << 5 & 0xffff | u32::from(refused.tolerance) << 16;
    // SAFETY: the loop counts `x` up to `count`, which all four slices have, as above: it reads winner `x`, what the right column
    // `x - disparity` keeps, or the first one if that is less than 0, and changes flag and answer `x`. The divisor is not 0.
    unsafe {
        asm!(
            "tst {count}, #1",
            "bne 3f",
            "2:",
            answer_one!(),
            "3:",
            answer_one!(),
            "cmp {x}, {count}",
            "bne 2b",
            x = inout(reg) 0 => _,
            count = in(reg) count,
            winners = in(reg) winners.as_ptr(),
            right = in(reg) right.as_ptr(),
            answers = in(reg) answers.as_mut_ptr(),
            flags = in(reg) flags.as_mut_ptr(),
            p = in(reg) flags_and_ceiling,
            q = in(reg) least_and_tolerance,
            w = out(reg) _, d = out(reg) _, a = out(reg) _, c = out(reg) _, f = out(reg) _,
            options(nostack),
        );
    }
}
