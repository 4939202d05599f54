//! What a pixel's cost compares: the census and the gradients of many pixels at a time.

use crate::matching::backend::portable::sgm::features::FeatureRows;
use crate::matching::backend::portable::sgm::features_by_four::near;
use crate::matching::memory::Rows5;
use crate::matching::memory::slices::{part, part_mut};
use crate::matching::memory::views::view;
use core::arch::asm;

/// Columns to each side that a code looks at.
const REACH: usize = 4;
/// Columns that [`REACH`] columns at an end of the line look at.
const NEAR: usize = 3 * REACH;

/// Features in vectors.
pub(super) struct VectorRows;

impl FeatureRows for VectorRows {
    /// The features of as many columns as there is a place for: [`gradients`](crate::imaging::gradients) and
    /// [`census_wide8`](crate::imaging::census_wide8).
    #[inline(always)]
    fn looks(lines: &Rows5<'_>, width: usize, gradient: u8, [along, across, census]: [&mut [u8]; 3]) {
        let count = census.len().min(width);
        let [above2, above, here, below, below2] = *lines;
        // The columns that see nothing outside the line, then those at its ends: of a short line all.
        let inner = REACH..count.min(width.saturating_sub(REACH)).max(REACH);
        codes([above2, here, below2], census.get_mut(inner.clone()).unwrap_or_default());
        let places = [&mut *along, &mut *across].map(|row| row.get_mut(inner.clone()).unwrap_or_default());
        gradients([above, here, below], gradient, places);
        let (mut x, step) = (0, if width < NEAR { REACH } else { width - REACH });
        while x < count {
            let near = lines.map(|line| near(part(line, ..width), x));
            let [above2, above, here, below, below2] = near.each_ref().map(|near| view(near));
            let places = x..count.min(x + REACH);
            codes([above2, here, below2], part_mut(census, places.clone()));
            let places = [&mut *along, &mut *across].map(|row| part_mut(row, places.clone()));
            gradients([above, here, below], gradient, places);
            x += step;
        }
    }

    /// Half of each number, of as many as both have.
    #[inline(never)]
    fn halve(numbers: &[u8], halves: &mut [u8]) {
        let count = numbers.len().min(halves.len());
        if count == 0 {
            return;
        }
        // SAFETY: `count` bytes of both are read and written: each round takes as many as `vsetvli` says.
        unsafe {
            asm!(
                "2:",
                "vsetvli {at_once}, {count}, e8, m8, ta, ma",
                "vle8.v v8, ({from})",
                "add {from}, {from}, {at_once}",
                "vsrl.vi v8, v8, 1",
                "vse8.v v8, ({to})",
                "add {to}, {to}, {at_once}",
                "sub {count}, {count}, {at_once}",
                "bnez {count}, 2b",
                at_once = out(reg) _, count = inout(reg) count => _, from = inout(reg) numbers.as_ptr() => _,
                to = inout(reg) halves.as_mut_ptr() => _,
                out("v8") _, out("v9") _, out("v10") _, out("v11") _, out("v12") _, out("v13") _, out("v14") _,
                out("v15") _, options(nostack),
            );
        }
    }

    /// The ranges of all numbers but the two at the ends.
    #[inline(never)]
    fn range(numbers: &[u8], least: &mut [u8], greatest: &mut [u8]) {
        let count = numbers.len().min(least.len()).min(greatest.len()).saturating_sub(2);
        if count == 0 {
            return;
        }
        // SAFETY: the numbers between the first and the last are `count`; those are written, and read with the
        // two: each round takes as many as `vsetvli` says.
        unsafe {
            asm!(
                // Averages are rounded down.
                "csrwi vxrm, 2",
                "2:",
                "vsetvli {at_once}, {count}, e8, m4, ta, ma",
                "addi {next}, {numbers}, 1",
                "vle8.v v8, ({numbers})",
                "vle8.v v12, ({next})",
                "addi {next}, {numbers}, 2",
                "vle8.v v16, ({next})",
                "add {numbers}, {numbers}, {at_once}",
                "vaaddu.vv v8, v8, v12",
                "vaaddu.vv v16, v16, v12",
                "vminu.vv v20, v8, v16",
                "vmaxu.vv v8, v8, v16",
                "vminu.vv v20, v20, v12",
                "vmaxu.vv v8, v8, v12",
                "vse8.v v20, ({least})",
                "vse8.v v8, ({greatest})",
                "add {least}, {least}, {at_once}",
                "add {greatest}, {greatest}, {at_once}",
                "sub {count}, {count}, {at_once}",
                "bnez {count}, 2b",
                at_once = out(reg) _, next = out(reg) _, count = inout(reg) count => _,
                numbers = inout(reg) numbers.as_ptr() => _,
                least = inout(reg) least.as_mut_ptr().add(1) => _,
                greatest = inout(reg) greatest.as_mut_ptr().add(1) => _,
                out("v8") _, out("v9") _, out("v10") _, out("v11") _, out("v12") _, out("v13") _, out("v14") _,
                out("v15") _, out("v16") _, out("v17") _, out("v18") _, out("v19") _, out("v20") _,
                out("v21") _, out("v22") _, out("v23") _, options(nostack),
            );
        }
    }
}

/// The codes of as many columns as there are places, from the rows two above, here, and two below, each from
/// [`REACH`] columns before the first on: 40 instructions for 64 pixels and more.
#[inline(never)]
fn codes(rows: [&[u8]; 3], out: &mut [u8]) {
    let count = out.len();
    if count == 0 || rows.iter().any(|row| row.len() < count + 2 * REACH) {
        return;
    }
    let [above, here, below] = rows.map(<[u8]>::as_ptr);
    // SAFETY: `count` bytes are written, and of each row as many and `REACH` more on both sides are read: each
    // round takes as many as `vsetvli` says.
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
            "compare {above}, 0, 1",
            "compare {above}, 4, 2",
            "compare {above}, 8, 4",
            "compare {here}, 2, 8",
            "compare {here}, 6, 16",
            "compare {below}, 0, 32",
            "compare {below}, 4, 64",
            "compare {below}, 8, 128",
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
            out = inout(reg) out.as_mut_ptr() => _, reach = const REACH,
            out("v0") _, out("v8") _, out("v9") _, out("v10") _, out("v11") _, out("v12") _, out("v13") _,
            out("v14") _, out("v15") _, out("v16") _, out("v17") _, out("v18") _, out("v19") _,
            options(nostack),
        );
    }
}

/// The gradients along the line and across it, cut off at `most` to each side, plus `most`, likewise, from the
/// rows above, here and below: 51 instructions for 32 pixels and more.
#[inline(never)]
fn gradients(rows: [&[u8]; 3], most: u8, [along, across]: [&mut [u8]; 2]) {
    let count = along.len();
    if count == 0 || across.len() < count || rows.iter().any(|row| row.len() < count + REACH + 1) {
        return;
    }
    let [above, here, below] = rows.map(|row| row.as_ptr().wrapping_add(REACH - 1));
    let most = u32::from(most);
    // SAFETY: `count` bytes of `along` and of `across` are written, and of each row as many and one more on
    // both sides are read: each round takes as many as `vsetvli` says.
    unsafe {
        asm!(
            ".macro cut to",
            "vsetvli zero, {at_once}, e16, m4, ta, ma",
            "vadd.vv v8, v8, v12",
            "vadd.vv v8, v8, v16",
            "vadd.vv v8, v8, v16",
            "vadd.vx v8, v8, {most}",
            "vmax.vx v8, v8, zero",
            "vmin.vx v8, v8, {greatest}",
            "vsetvli zero, {at_once}, e8, m2, ta, ma",
            "vnsrl.wi v12, v8, 0",
            "vse8.v v12, (\\to)",
            "add \\to, \\to, {at_once}",
            ".endm",
            "2:",
            "vsetvli {at_once}, {count}, e8, m2, ta, ma",
            "vle8.v v2, ({above})",
            "addi {next}, {above}, 1",
            "vle8.v v4, ({next})",
            "addi {next}, {above}, 2",
            "vle8.v v6, ({next})",
            "vle8.v v20, ({below})",
            "addi {next}, {below}, 1",
            "vle8.v v22, ({next})",
            "addi {next}, {below}, 2",
            "vle8.v v24, ({next})",
            "vle8.v v26, ({here})",
            "addi {next}, {here}, 2",
            "vle8.v v28, ({next})",
            // Along: right less left, the middle one twice.
            "vwsubu.vv v8, v6, v2",
            "vwsubu.vv v12, v24, v20",
            "vwsubu.vv v16, v28, v26",
            "cut {along}",
            // Across: below less above, likewise.
            "vwsubu.vv v8, v20, v2",
            "vwsubu.vv v12, v24, v6",
            "vwsubu.vv v16, v22, v4",
            "cut {across}",
            "add {above}, {above}, {at_once}",
            "add {here}, {here}, {at_once}",
            "add {below}, {below}, {at_once}",
            "sub {count}, {count}, {at_once}",
            "bnez {count}, 2b",
            ".purgem cut",
            at_once = out(reg) _, next = out(reg) _, count = inout(reg) count => _,
            above = inout(reg) above => _, here = inout(reg) here => _, below = inout(reg) below => _,
            along = inout(reg) along.as_mut_ptr() => _, across = inout(reg) across.as_mut_ptr() => _,
            most = in(reg) most, greatest = in(reg) 2 * most,
            out("v2") _, out("v3") _, out("v4") _, out("v5") _, out("v6") _, out("v7") _, out("v8") _,
            out("v9") _, out("v10") _, out("v11") _, out("v12") _, out("v13") _, out("v14") _, out("v15") _,
            out("v16") _, out("v17") _, out("v18") _, out("v19") _, out("v20") _, out("v21") _, out("v22") _,
            out("v23") _, out("v24") _, out("v25") _, out("v26") _, out("v27") _, out("v28") _, out("v29") _,
            options(nostack),
        );
    }
}
