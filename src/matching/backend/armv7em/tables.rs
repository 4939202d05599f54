//! What every left code costs against the right codes of a row.
//!
//! A code of four bits is one of sixteen: so few that the costs of all of them are made once a row, in order
//! of the right pixels. The candidates of a left pixel are then a piece of its code's line. From code to
//! code, in an order in which one bit changes at a time (Gray's), every cost changes by one: an addition for
//! eight of them. A code of eight bits is two of four.
//!
//! ```text
//! place p   of the reversed row: right pixel p in the low half of a byte, p + apart in the high one
//! ```

#![allow(unsafe_code)]

use core::arch::asm;

/// Codes of four bits.
pub(super) const CODES: usize = 16;

/// A one in every half of a byte.
const ONE: u32 = 0x1111_1111;

/// Words of a table: the lines of all codes, `LINE` bytes each, half a byte a cost.
pub(super) const fn words<const LINE: usize>() -> usize {
    CODES * LINE / size_of::<u32>()
}

/// Makes all costs the same one.
pub(super) fn fill(table: &mut [u32], cost: u32) {
    table.fill(cost * ONE);
}

/// The next code in Gray's order, which has one bit more or one less: 2 instructions and a store.
macro_rules! next {
    ($change:literal, $bit:literal, $code:literal) => {
        concat!(
            $change,
            " {row}, {row}, {near_",
            $bit,
            "}\n",
            $change,
            " {all}, {all}, {far_",
            $bit,
            "}\n",
            "strd {row}, {all}, [{line}, #{length} * (",
            $code,
            " - 8)]\n",
        )
    };
}

macro_rules! make {
    ($(#[$doc:meta])* $name:ident, $differ:literal) => {
        $(#[$doc])*
        #[inline(never)]
        pub(super) fn $name<const LINE: usize>(table: &mut [u32], row: &[u8], apart: usize, pixels: usize) {
            let rounds = (pixels + apart).div_ceil(8);
            if rounds == 0 || 8 * rounds > LINE || row.len() < apart + 8 * rounds {
                return;
            }
            if table.len() < words::<LINE>() {
                return;
            }
            // SAFETY: in each of the rounds eight bytes of the row are read from its beginning on and eight
            // from `apart` on, and as many written of each line, of which there are `LINE`: `line` is in the
            // one of code 8. What the registers held for the next round is below the stack's end meanwhile.
            unsafe {
                asm!(
                    "2:",
                    "ldr {near_0}, [{row}], #4",
                    "ldr {far_0}, [{row}], #4",
                    "ldr {near_1}, [{far}], #4",
                    "ldr {far_1}, [{far}], #4",
                    // Right codes, of the near words of the row's two the first low.
                    "orr {near_3}, {near_1}, {near_0}, lsr #4",
                    "strd {row}, {far}, [sp, #-8]!",
                    "orr {far}, {far_1}, {far_0}, lsr #4",
                    // Their bits, and the sum of these: what code 0 costs.
                    concat!($differ, " {near_0}, {ones}, {near_3}"),
                    concat!($differ, " {near_1}, {ones}, {near_3}, lsr #1"),
                    concat!($differ, " {near_2}, {ones}, {near_3}, lsr #2"),
                    concat!($differ, " {near_3}, {ones}, {near_3}, lsr #3"),
                    "add {row}, {near_0}, {near_1}",
                    "add {row}, {row}, {near_2}",
                    "add {row}, {row}, {near_3}",
                    concat!($differ, " {far_0}, {ones}, {far}"),
                    concat!($differ, " {far_1}, {ones}, {far}, lsr #1"),
                    concat!($differ, " {far_2}, {ones}, {far}, lsr #2"),
                    concat!($differ, " {far}, {ones}, {far}, lsr #3"),
                    "add {all}, {far_0}, {far_1}",
                    "add {all}, {all}, {far_2}",
                    "add {all}, {all}, {far}",
                    "strd {row}, {all}, [{line}, #{length} * -8]",
                    // How much more a code costs that has the bit.
                    "sub {near_0}, {ones}, {near_0}, lsl #1",
                    "sub {near_1}, {ones}, {near_1}, lsl #1",
                    "sub {near_2}, {ones}, {near_2}, lsl #1",
                    "sub {near_3}, {ones}, {near_3}, lsl #1",
                    "sub {far_0}, {ones}, {far_0}, lsl #1",
                    "sub {far_1}, {ones}, {far_1}, lsl #1",
                    "sub {far_2}, {ones}, {far_2}, lsl #1",
                    "sub {far}, {ones}, {far}, lsl #1",
                    next!("add", "0", "1"),
                    next!("add", "1", "3"),
                    next!("sub", "0", "2"),
                    next!("add", "2", "6"),
                    next!("add", "0", "7"),
                    next!("sub", "1", "5"),
                    next!("sub", "0", "4"),
                    "add {row}, {row}, {near_3}",
                    "add {all}, {all}, {far}",
                    "strd {row}, {all}, [{line}, #{length} * (12 - 8)]",
                    next!("add", "0", "13"),
                    next!("add", "1", "15"),
                    next!("sub", "0", "14"),
                    next!("sub", "2", "10"),
                    next!("add", "0", "11"),
                    next!("sub", "1", "9"),
                    next!("sub", "0", "8"),
                    "add {line}, {line}, #8",
                    "ldrd {row}, {far}, [sp], #8",
                    "subs {rounds}, {rounds}, #1",
                    "bne 2b",
                    rounds = inout(reg) rounds => _,
                    row = inout(reg) row.as_ptr() => _, far = inout(reg) row.as_ptr().add(apart) => _,
                    line = inout(reg) table.as_mut_ptr().cast::<u8>().add(8 * LINE) => _,
                    all = out(reg) _,
                    ones = in(reg) ONE, length = const LINE,
                    near_0 = out(reg) _, near_1 = out(reg) _, near_2 = out(reg) _, near_3 = out(reg) _,
                    far_0 = out(reg) _, far_1 = out(reg) _, far_2 = out(reg) _,
                );
            }
        }
    };
}

make!(
    /// Makes the costs of so many pixels, the last one first, with candidates `apart` apart in both halves of
    /// a byte: against a reversed row whose right codes are the high halves of its bytes, with nothing in the
    /// low ones. Of the row as many bytes are read as make whole rounds of eight.
    ///
    /// 79 instructions for sixteen costs of all codes.
    make, "and"
);
make!(
    /// Tables of what the costs leave of four: how many bits are equal.
    make_equal, "bic"
);
