//! What costs are made of: right pixels, in the order of the candidates in a column.

use crate::matching::backend::parameters::SgmParameters;
use crate::matching::backend::portable::sgm::quarters::columns::FOUR;
use crate::matching::backend::portable::sgm::quarters::others::NUMBERS;
use core::arch::asm;
use core::cell::Cell;

/// A number of a group, at so many bytes from both, with a pixel's that is in `u`. 4 instructions.
macro_rules! shift {
    ($place:literal) => {
        concat!(
            at!("lw", "t", $place, "from"),
            by!("slli", "u", "u", "24"),
            by!("srli", "t", "t", "8"),
            op!("or", "t", "t", "u"),
            at!("sw", "t", $place, "to"),
        )
    };
}

/// All five numbers of a group, so many pixels from the rows' pixels.
macro_rules! group {
    ($pixel:literal: $least:literal $most:literal $across:literal $census:literal $bright:literal) => {
        concat!(
            at!("lbu", "u", $pixel, "least"),
            by!("addi", "u", "u", "128"),
            shift!($least),
            at!("lbu", "u", $pixel, "greatest"),
            op!("sub", "u", "most", "u"),
            shift!($most),
            at!("lbu", "u", $pixel, "across"),
            shift!($across),
            at!("lbu", "u", $pixel, "census"),
            shift!($census),
            at!("lbu", "u", $pixel, "brightness"),
            shift!($bright),
        )
    };
}

/// See `others::shift_in`: 136 instructions for four groups.
#[inline(never)]
pub(in super::super) fn shift_in<S: SgmParameters>(
    (right, count): (&[u8], usize),
    column: usize,
    from: &[[Cell<u32>; NUMBERS]],
    to: &[[Cell<u32>; NUMBERS]],
) {
    // The rows of what stands in a group, in its order.
    let rows = if S::BETWEEN_PIXELS { [4, 5, 1, 2, 3] } else { [0, 0, 1, 2, 3] };
    let rows = rows.map(|row| row * count + column);
    let last = rows.into_iter().max().unwrap_or(0);
    let pixels = right.len().saturating_sub(last);
    let groups = from.len().min(to.len()).min(pixels) / FOUR * FOUR;
    if groups == 0 {
        return;
    }
    let [least, greatest, across, census, brightness] = rows.map(|place| right.as_ptr().wrapping_add(place));
    // SAFETY: there are as many groups of both, whole fours, and as many pixels of each row.
    unsafe {
        asm!(
            "2:",
            group!("0": "0" "4" "8" "12" "16"),
            group!("1": "20" "24" "28" "32" "36"),
            group!("2": "40" "44" "48" "52" "56"),
            group!("3": "60" "64" "68" "72" "76"),
            "addi {least}, {least}, 4",
            "addi {greatest}, {greatest}, 4",
            "addi {across}, {across}, 4",
            "addi {census}, {census}, 4",
            "addi {brightness}, {brightness}, 4",
            "addi {from}, {from}, 80",
            "addi {to}, {to}, 80",
            "bne {to}, {end}, 2b",
            least = inout(reg) least => _, greatest = inout(reg) greatest => _,
            across = inout(reg) across => _, census = inout(reg) census => _,
            brightness = inout(reg) brightness => _, from = inout(reg) from.as_ptr() => _,
            to = inout(reg) to.as_ptr() => _, end = in(reg) to.as_ptr().wrapping_add(groups),
            most = in(reg) 128, t = out(reg) _, u = out(reg) _, options(nostack),
        );
    }
}
