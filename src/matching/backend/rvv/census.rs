//! Census codes of many pixels at a time.

use crate::matching::backend::parameters::WindowParameters;
use crate::matching::backend::portable::sgm::features_by_four::near;
use crate::matching::backend::work::CensusWork;
use crate::matching::memory::Rows5;
use crate::matching::memory::slices::{part, part_mut, split_mut};
use crate::matching::memory::views::view;
use core::arch::asm;
use core::ops::Range;

/// Columns to each side that a code looks at, at most.
pub(super) const REACH: usize = 4;
/// Columns that [`REACH`] columns at an end of the line look at.
const NEAR: usize = 3 * REACH;

/// Which neighbours a pixel is compared with: see `imaging/census.rs`.
pub(super) const PLUS4: u32 = 0;
pub(super) const RING8: u32 = 1;
pub(super) const WIDE8: u32 = 2;

/// [`Isa::census`](crate::matching::backend::Isa::census) in vectors: a row of bytes for each image.
pub(super) fn census<P: WindowParameters>(work: CensusWork<'_>) {
    let width = work.codes.len() / 2;
    let (left, right) = split_mut(work.codes, width);
    for (lines, codes) in work.lines.into_iter().zip([left, right]) {
        along_line(lines, width, width, |[above, _, here, _, below], places| {
            let codes = part_mut(codes, places);
            if P::BITS <= 4 {
                self::codes::<PLUS4>([above, here, below], codes);
            } else {
                self::codes::<RING8>([above, here, below], codes);
            }
        });
    }
}

/// Does something with the first `count` columns of lines of `width` pixels, of which each sees [`REACH`] to
/// both sides: it is given lines that begin so many before the columns that it is given. Outside of the lines
/// the nearest column inside stands.
#[inline(always)]
pub(super) fn along_line(
    lines: &Rows5<'_>,
    width: usize,
    count: usize,
    mut see: impl FnMut(Rows5<'_>, Range<usize>),
) {
    // The columns that see nothing outside the line, then those at its ends: of a short line all.
    let inner = REACH..count.min(width.saturating_sub(REACH)).max(REACH);
    if inner.end <= count {
        see(*lines, inner);
    }
    let (mut x, step) = (0, if width < NEAR { REACH } else { width - REACH });
    while x < count {
        let near = lines.map(|line| near(part(line, ..width), x));
        see(near.each_ref().map(|near| view(near)), x..count.min(x + REACH));
        x += step;
    }
}

/// The codes of as many columns as there are places, from the rows two above, here, and two below, each from
/// [`REACH`] columns before the first on: 25 to 40 instructions for 64 pixels and more.
#[inline(never)]
pub(super) fn codes<const NEIGHBOURS: u32>(rows: [&[u8]; 3], out: &mut [u8]) {
    let count = out.len();
    if count == 0 || rows.iter().any(|row| row.len() < count + 2 * REACH) {
        return;
    }
    let [above, here, below] = rows.map(<[u8]>::as_ptr);
    // SAFETY: `count` bytes are written, and of each row as many and `REACH` more on both sides are read:
    // each round takes as many as `vsetvli` says.
    unsafe {
        asm!(
            ".macro compare row, column, bit",
            ".if \\column",
            "addi {beside}, \\row, \\column",
            "vle8.v v16, ({beside})",
            ".else",
            "vle8.v v16, (\\row)",
            ".endif",
            "vmsltu.vv v0, v16, v8",
            ".if \\bit < 16",
            "vadd.vi v12, v12, \\bit, v0.t",
            ".else",
            "li {beside}, \\bit",
            "vadd.vx v12, v12, {beside}, v0.t",
            ".endif",
            ".endm",
            "2:",
            // Lanes of no neighbour that is darker stay.
            "vsetvli {at_once}, {count}, e8, m4, ta, mu",
            "addi {beside}, {here}, {reach}",
            "vle8.v v8, ({beside})",
            "vmv.v.i v12, 0",
            ".if {neighbours} == 0",
            "compare {above}, 4, 1",
            "compare {here}, 2, 2",
            "compare {here}, 6, 4",
            "compare {below}, 4, 8",
            ".else",
            "compare {above}, 4 - {wide}, 1",
            "compare {above}, 4, 2",
            "compare {above}, 4 + {wide}, 4",
            "compare {here}, 2, 8",
            "compare {here}, 6, 16",
            "compare {below}, 4 - {wide}, 32",
            "compare {below}, 4, 64",
            "compare {below}, 4 + {wide}, 128",
            ".endif",
            "vse8.v v12, ({out})",
            "add {above}, {above}, {at_once}",
            "add {here}, {here}, {at_once}",
            "add {below}, {below}, {at_once}",
            "add {out}, {out}, {at_once}",
            "sub {count}, {count}, {at_once}",
            "bnez {count}, 2b",
            ".purgem compare",
            at_once = out(reg) _, beside = out(reg) _, count = inout(reg) count => _,
            above = inout(reg) above => _, here = inout(reg) here => _, below = inout(reg) below => _,
            out = inout(reg) out.as_mut_ptr() => _, reach = const REACH, neighbours = const NEIGHBOURS,
            wide = const 2 * NEIGHBOURS,
            out("v0") _, out("v8") _, out("v9") _, out("v10") _, out("v11") _, out("v12") _, out("v13") _,
            out("v14") _, out("v15") _, out("v16") _, out("v17") _, out("v18") _, out("v19") _,
            options(nostack),
        );
    }
}
