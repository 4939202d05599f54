//! Small gaps closed, eight pixels at a time: what `portable/fill.rs` does.
//!
//! The answers on a gap's left go to the right, and beside them those on its right to the left, each over as
//! many pixels as a gap may have. They go by steps of one, two, four and so on: each step takes what an
//! earlier one has brought as far as it is long. The answer on the right of a gap that is too long is hidden:
//! there the one on the left has not come through.
#![allow(unsafe_code)]

use crate::matching::backend::work::FillWork;
use crate::units::{Disparity, PixelFlags};
use core::arch::asm;

/// No answer.
const NONE: u32 = Disparity::NONE.raw() as u32;
/// Stands for an answer that fills nothing; more than any disparity.
const HIDDEN: u32 = NONE - 1;

/// [`Isa::fill`](crate::matching::backend::Isa::fill): eleven instructions for a pixel where gaps have up to
/// 32.
#[inline(never)]
pub(super) fn fill(work: FillWork<'_>) {
    let FillWork { answers, flags, room, most, step } = work;
    let count = answers.len();
    if count == 0 || flags.len() < count || room.len() < count {
        return;
    }
    let most = usize::from(most);
    begin(answers, flags, room);
    each_step(most, count, |by| to_right(answers, by));
    hide(answers, room);
    each_step(most, count, |by| to_left(room, by));
    end(answers, flags, room, step);
}

/// The steps by which something comes `most` places on: one, two, four and so on, and what is left, as far as
/// there are so many places.
#[inline(always)]
fn each_step(most: usize, count: usize, mut go: impl FnMut(usize)) {
    let mut done = 0;
    while done < most {
        let by = (done + 1).min(most - done);
        if by < count {
            go(by);
        }
        done += by;
    }
}

/// Keeps the answers in `room`, and flags those that there are not.
#[inline(never)]
fn begin(answers: &[Disparity], flags: &mut [PixelFlags], room: &mut [u16]) {
    let count = answers.len();
    if count == 0 || flags.len() < count || room.len() < count {
        return;
    }
    // SAFETY: of each row `count` numbers are read or written: the loop is one for so many lanes of
    // half-words.
    unsafe {
        asm!(
            "vdup.16 q2, {filled}",
            "dlstp.16 lr, {count}",
            "2:",
            "vldrh.u16 q0, [{answers}], #16",
            "vldrb.u16 q1, [r0]",
            "vstrh.16 q0, [{room}], #16",
            "vpt.i16 eq, q0, {none}",
            "vorrt q1, q1, q2",
            "vstrb.16 q1, [r0], #8",
            "letp lr, 2b",
            count = in(reg) count, none = in(reg) NONE, filled = in(reg) u32::from(PixelFlags::FILLED.bits()),
            answers = inout(reg) answers.as_ptr() => _, room = inout(reg) room.as_mut_ptr() => _,
            inout("r0") flags.as_mut_ptr() => _, out("lr") _, out("q0") _, out("q1") _, out("q2") _,
            options(nostack),
        );
    }
}

/// Takes the answer `by` places before to where there is none, all at once: from the last to the first.
#[inline(never)]
fn to_right(answers: &mut [Disparity], by: usize) {
    const LANES: usize = 8;
    let Some(count) = answers.len().checked_sub(by) else { return };
    let (groups, rest) = (count / LANES, count % LANES);
    let from = answers.as_mut_ptr();
    // SAFETY: `count` answers are read and `by` further written: `rest` lanes of the last ones, then whole
    // groups down to the first.
    unsafe {
        asm!(
            "vctp.16 {rest}",
            "vpstttt",
            "vldrht.u16 q0, [{to}]",
            "vldrht.u16 q1, [{from}]",
            "vcmpt.i16 eq, q0, {none}",
            "vstrht.16 q1, [{to}]",
            "cbz r1, 3f",
            "dls lr, r1",
            "2:",
            "vldrh.u16 q0, [{to}, #-16]!",
            "vldrh.u16 q1, [{from}, #-16]!",
            "vpt.i16 eq, q0, {none}",
            "vstrht.16 q1, [{to}]",
            "le lr, 2b",
            "3:",
            rest = in(reg) rest, inout("r1") groups => _, none = in(reg) NONE,
            from = inout(reg) from.add(count - rest) => _, to = inout(reg) from.add(by + count - rest) => _,
            out("lr") _, out("q0") _, out("q1") _, options(nostack),
        );
    }
}

/// Hides the answers in `room` behind a gap through which the one before it has not come.
#[inline(never)]
fn hide(answers: &[Disparity], room: &mut [u16]) {
    let Some(count) = answers.len().checked_sub(1).filter(|&count| count > 0 && room.len() > count) else {
        return;
    };
    // SAFETY: `count` answers are read, and so many numbers from the second on written: the loop is one for
    // so many lanes of half-words.
    unsafe {
        asm!(
            "vdup.16 q2, {hidden}",
            "dlstp.16 lr, {count}",
            "2:",
            "vldrh.u16 q0, [{before}], #16",
            "vldrh.u16 q1, [{here}]",
            "vptt.i16 eq, q0, {none}",
            "vcmpt.i16 ne, q1, {none}",
            "vstrht.16 q2, [{here}]",
            "add {here}, {here}, #16",
            "letp lr, 2b",
            count = in(reg) count, none = in(reg) NONE, hidden = in(reg) HIDDEN,
            before = inout(reg) answers.as_ptr() => _, here = inout(reg) room.as_mut_ptr().add(1) => _,
            out("lr") _, out("q0") _, out("q1") _, out("q2") _, options(nostack),
        );
    }
}

/// Takes the number `by` places on to where there is none, all at once: from the first to the last.
#[inline(never)]
fn to_left(numbers: &mut [u16], by: usize) {
    let Some(count) = numbers.len().checked_sub(by).filter(|&count| count > 0) else { return };
    let to = numbers.as_mut_ptr();
    // SAFETY: `count` numbers are written, and as many read `by` further: the loop is one for so many lanes
    // of half-words.
    unsafe {
        asm!(
            "dlstp.16 lr, {count}",
            "2:",
            "vldrh.u16 q0, [{to}], #16",
            "vldrh.u16 q1, [{from}], #16",
            "vpt.i16 eq, q0, {none}",
            "vstrht.16 q1, [{to}, #-16]",
            "letp lr, 2b",
            count = in(reg) count, none = in(reg) NONE, to = inout(reg) to => _,
            from = inout(reg) to.add(by) => _, out("lr") _, out("q0") _, out("q1") _, options(nostack),
        );
    }
}

/// Smaller answer of the two at the ends of a gap, or none.
#[inline(never)]
fn end(answers: &mut [Disparity], flags: &mut [PixelFlags], room: &[u16], step: Disparity) {
    let count = answers.len();
    if count == 0 || flags.len() < count || room.len() < count {
        return;
    }
    // SAFETY: of each row `count` numbers are read or written: the loop is one for so many lanes of
    // half-words.
    unsafe {
        asm!(
            "vdup.16 q6, {filled}",
            "dlstp.16 lr, {count}",
            "2:",
            "vldrb.u16 q2, [r0]",
            "vldrh.u16 q0, [{answers}]",
            "vldrh.u16 q1, [{room}], #16",
            "vand q5, q2, q6",
            "vmin.u16 q3, q0, q1",
            "vmax.u16 q4, q0, q1",
            "vabd.u16 q1, q0, q1",
            // Where one of them is none or is hidden, they are as far apart as can be.
            "vpt.u16 cs, q4, {hidden}",
            "vdupt.16 q1, {none}",
            "vptttt.i16 ne, q5, zr",
            "vmovt q0, q3",
            "vcmpt.u16 hi, q1, {step}",
            "vdupt.16 q0, {none}",
            "veort q2, q2, q6",
            "vstrh.16 q0, [{answers}], #16",
            "vstrb.16 q2, [r0], #8",
            "letp lr, 2b",
            count = in(reg) count, none = in(reg) NONE, hidden = in(reg) HIDDEN,
            step = in(reg) u32::from(step.raw()).min(HIDDEN),
            filled = in(reg) u32::from(PixelFlags::FILLED.bits()),
            answers = inout(reg) answers.as_mut_ptr() => _, room = inout(reg) room.as_ptr() => _,
            inout("r0") flags.as_mut_ptr() => _, out("lr") _, out("q0") _, out("q1") _, out("q2") _,
            out("q3") _, out("q4") _, out("q5") _, out("q6") _, options(nostack),
        );
    }
}
