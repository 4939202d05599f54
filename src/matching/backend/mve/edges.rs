//! Edges of a line, eight pixels at a time.
#![allow(unsafe_code)]

use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::portable::edges::push_at;
use crate::matching::backend::work::FatteningWork;
use core::arch::asm;

/// [`Isa::push_edges`](crate::matching::backend::Isa::push_edges).
#[inline(never)]
pub(super) fn push(edges: &mut [u8], lines: [&[u8]; 3], least: u16) {
    push_inner(edges, &lines, least);
    // A line of one pixel has one end.
    for x in [0, edges.len().wrapping_sub(1)].into_iter().take(edges.len()) {
        keep_loop();
        push_at(edges, lines, x, least);
    }
}

/// All but the columns at the ends: 20 instructions for eight pixels.
#[inline(never)]
fn push_inner(edges: &mut [u8], [above, line, below]: &[&[u8]; 3], least: u16) {
    let count = edges.len().saturating_sub(2);
    if count == 0 || [above, line, below].iter().any(|line| line.len() < edges.len()) {
        return;
    }
    // SAFETY: `count` edges from the second on are read and written, and of each line the columns before and
    // after them are read: the loop is one for so many lanes of half-words.
    unsafe {
        asm!(
            "dlstp.16 lr, {count}",
            "2:",
            "vldrb.u16 q0, [r0, #2]",
            "vldrb.u16 q1, [r1, #2]",
            "vldrb.u16 q2, [r2, #2]",
            "vadd.i16 q0, q0, q1",
            "vadd.i16 q1, q1, q2",
            "vadd.i16 q0, q0, q1",
            "vldrb.u16 q1, [r0], #8",
            "vldrb.u16 q2, [r1], #8",
            "vldrb.u16 q3, [r2], #8",
            "vadd.i16 q1, q1, q2",
            "vadd.i16 q2, q2, q3",
            "vadd.i16 q1, q1, q2",
            "vabd.u16 q0, q0, q1",
            "vldrb.u16 q1, [r3]",
            "vshl.i16 q1, q1, #1",
            "vbic.i16 q1, #{refused}",
            "vpt.u16 cs, q0, {least}",
            "vorrt.i16 q1, #1",
            "vstrb.16 q1, [r3], #8",
            "letp lr, 2b",
            count = in(reg) count, least = in(reg) u32::from(least),
            refused = const FatteningWork::REFUSED,
            inout("r0") above.as_ptr() => _, inout("r1") line.as_ptr() => _, inout("r2") below.as_ptr() => _,
            inout("r3") edges.as_mut_ptr().add(1) => _,
            out("lr") _, out("q0") _, out("q1") _, out("q2") _, out("q3") _, options(nostack),
        );
    }
}
