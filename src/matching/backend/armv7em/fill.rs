//! Small gaps closed, as `portable/fill.rs` does: the first pass puts what is on a gap's left beside the
//! answers, the second one takes what is less of that and of what is on the right.
#![allow(unsafe_code)]

use crate::matching::backend::work::FillWork;
use crate::units::{Disparity, PixelFlags};
use core::arch::asm;

/// [`Isa::fill`](crate::matching::backend::Isa::fill): 38 instructions for a pixel.
#[inline(never)]
pub(super) fn fill(work: FillWork<'_>) {
    let FillWork { answers, flags, room, most, step } = work;
    let count = answers.len();
    if count == 0 || flags.len() < count || room.len() < count {
        return;
    }
    let none = u32::from(Disparity::NONE.raw());
    let answers = answers.as_mut_ptr_range();
    // SAFETY: `count` answers are read, and as many places in `room` written.
    unsafe {
        asm!(
            "2:",
            "ldrh {here}, [{from}], #2",
            "add {length}, {length}, #1",
            "cmp {here}, {none}",
            "itt ne",
            "movne {left}, {here}",
            "movne {length}, #0",
            "cmp {length}, {most}",
            "ite ls",
            "strhls {left}, [{to}], #2",
            "strhhi {none}, [{to}], #2",
            "cmp {from}, {end}",
            "bne 2b",
            from = inout(reg) answers.start => _, end = in(reg) answers.end,
            to = inout(reg) room.as_mut_ptr() => _, none = in(reg) none, most = in(reg) u32::from(most),
            left = inout(reg) none => _, length = inout(reg) 0 => _, here = out(reg) _,
            options(nostack),
        );
    }
    // SAFETY: from the last on, `count` answers and flags are read and written, and as many places of
    // `room` read.
    unsafe {
        asm!(
            "2:",
            "ldrh {here}, [{answers}, #-2]!",
            "ldrh {left}, [{room}, #-2]!",
            "ldrb {flag}, [{flags}, #-1]!",
            // In a gap that is too long or between sides that differ nothing is filled, from there to its
            // left end.
            "subs {apart}, {left}, {right}",
            "it lo",
            "rsblo {apart}, {apart}, #0",
            "cmp {left}, {none}",
            "it lo",
            "cmplo {apart}, {limit}",
            "it hs",
            "movhs {refused}, {none}",
            "cmp {here}, {none}",
            "itte ne",
            "movne {right}, {here}",
            "movne {refused}, #0",
            "cmpeq {refused}, #0",
            "it eq",
            "orreq {flag}, {flag}, #{filled}",
            "cmp {left}, {right}",
            "it hi",
            "movhi {left}, {right}",
            "orr {left}, {left}, {refused}",
            "strh {left}, [{answers}]",
            "strb {flag}, [{flags}]",
            "subs {count}, {count}, #1",
            "bne 2b",
            answers = inout(reg) answers.end => _,
            room = inout(reg) room.as_ptr().add(count) => _,
            flags = inout(reg) flags.as_mut_ptr().add(count) => _,
            count = inout(reg) count => _,
            none = in(reg) none, limit = in(reg) u32::from(step.raw()) + 1,
            right = inout(reg) 0 => _, refused = inout(reg) none => _,
            here = out(reg) _, left = out(reg) _, flag = out(reg) _, apart = out(reg) _,
            filled = const PixelFlags::FILLED.bits(),
            options(nostack),
        );
    }
}
