//! Edges of a line, many pixels at a time.

use crate::matching::backend::portable::edges::push_at;
use crate::matching::backend::work::FatteningWork;
use core::arch::asm;

/// [`Isa::push_edges`](crate::matching::backend::Isa::push_edges) in vectors: 31 instructions for 32
/// pixels and more.
#[inline(never)]
pub(super) fn push(edges: &mut [u8], lines: [&[u8]; 3], least: u16) {
    let count = edges.len();
    let last = count.saturating_sub(1);
    if last > 1 && lines.iter().all(|line| line.len() >= count) {
        let [above, line, below] = lines.map(<[u8]>::as_ptr);
        // SAFETY: there are as many columns in all rows, and all but the two at the ends are written: each
        // round takes as many as `vsetvli` says, and reads as many and one more on both sides.
        unsafe {
            asm!(
                // The sums down the columns, the middle one twice.
                ".macro sums to, off",
                "addi {next}, {above}, \\off",
                "vle8.v v8, ({next})",
                "addi {next}, {below}, \\off",
                "vle8.v v10, ({next})",
                "vwaddu.vv \\to, v8, v10",
                "addi {next}, {line}, \\off",
                "vle8.v v8, ({next})",
                "vwmaccu.vx \\to, {two}, v8",
                ".endm",
                "2:",
                "vsetvli {at_once}, {count}, e8, m2, ta, ma",
                "sums v12, 0",
                "sums v16, 2",
                "vsetvli zero, zero, e16, m4, ta, ma",
                "vmaxu.vv v20, v12, v16",
                "vminu.vv v12, v12, v16",
                "vsub.vv v20, v20, v12",
                "vmsltu.vx v0, v20, {least}",
                "vsetvli zero, zero, e8, m2, ta, ma",
                "vle8.v v8, ({edges})",
                "vadd.vv v8, v8, v8",
                "vand.vx v8, v8, {kept}",
                "vor.vi v10, v8, 1",
                "vmerge.vvm v8, v10, v8, v0",
                "vse8.v v8, ({edges})",
                "add {above}, {above}, {at_once}",
                "add {line}, {line}, {at_once}",
                "add {below}, {below}, {at_once}",
                "add {edges}, {edges}, {at_once}",
                "sub {count}, {count}, {at_once}",
                "bnez {count}, 2b",
                ".purgem sums",
                at_once = out(reg) _, next = out(reg) _, count = inout(reg) count - 2 => _,
                above = inout(reg) above => _, line = inout(reg) line => _, below = inout(reg) below => _,
                edges = inout(reg) edges.as_mut_ptr().add(1) => _, two = in(reg) 2,
                least = in(reg) u32::from(least), kept = in(reg) u32::from(!FatteningWork::REFUSED),
                out("v0") _, out("v8") _, out("v9") _, out("v10") _, out("v11") _, out("v12") _, out("v13") _,
                out("v14") _, out("v15") _, out("v16") _, out("v17") _, out("v18") _, out("v19") _,
                out("v20") _, out("v21") _, out("v22") _, out("v23") _, options(nostack),
            );
        }
    }
    // A line of one pixel has one end.
    push_at(edges, lines, 0, least);
    if last > 0 {
        push_at(edges, lines, last, least);
    }
}
