//! What a pixel's cost compares: the census and the gradients of many pixels at a time.

use super::census::{REACH, WIDE8, along_line, codes};
use crate::matching::backend::portable::sgm::features::FeatureRows;
use crate::matching::memory::Rows5;
use crate::matching::memory::slices::part_mut;
use core::arch::asm;

/// Features in vectors.
pub(super) struct VectorRows;

impl FeatureRows for VectorRows {
    /// The features of as many columns as there is a place for: [`gradients`](crate::imaging::gradients) and
    /// [`census_wide8`](crate::imaging::census_wide8).
    #[inline(always)]
    fn looks(lines: &Rows5<'_>, width: usize, gradient: u8, [along, across, census]: [&mut [u8]; 3]) {
        let count = census.len().min(width);
        along_line(lines, width, count, |[above2, above, here, below, below2], places| {
            codes::<WIDE8>([above2, here, below2], part_mut(census, places.clone()));
            let places = [&mut *along, &mut *across].map(|row| part_mut(row, places.clone()));
            gradients([above, here, below], gradient, places);
        });
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
                out("v8") _, out("v9") _, out("v10") _, out("v11") _, out("v12") _, out("v13") _,
                out("v14") _, out("v15") _, options(nostack),
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
        // SAFETY: the numbers between the first and the last are `count`; those are written, and read with
        // the two: each round takes as many as `vsetvli` says.
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
                out("v8") _, out("v9") _, out("v10") _, out("v11") _, out("v12") _, out("v13") _,
                out("v14") _, out("v15") _, out("v16") _, out("v17") _, out("v18") _, out("v19") _,
                out("v20") _, out("v21") _, out("v22") _, out("v23") _, options(nostack),
            );
        }
    }
}

/// The gradients along the line and across it, cut off at `most` to each side, plus `most`, likewise, from
/// the rows above, here and below: 51 instructions for 32 pixels and more.
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
