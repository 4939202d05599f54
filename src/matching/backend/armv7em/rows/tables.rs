//! Costs from tables into columns: of the low four bits of codes they are added, of the high ones taken off.

use super::super::tables::{CODES, words};
use core::arch::asm;

/// Goes on to the next pixel's column, if its candidates are not all that the columns have: 2 instructions.
macro_rules! next {
    (all) => {
        ""
    };
    (part) => {
        "ldr r0, [sp, #4]\nadd r9, r9, r0\n"
    };
}

/// Where a loop puts the end of the columns, which `r1` is; or that and the bytes from a column's end to the
/// next one's beginning, both of which `r1` points to. Then what comes before the loop.
macro_rules! begin {
    (all, $stride:tt, $bits:ident) => {
        concat!("strd r1, r0, [sp]\n", first_halves!($stride, $bits))
    };
    (part, $stride:tt, $bits:ident) => {
        "ldrd r2, r3, [r1]\nstrd r2, r3, [sp]\n"
    };
}

/// The loop over `count` pixels, after those whose columns end where `few` does. The first of all has the
/// place before `place`.
macro_rules! add_all {
    ($bits:ident, $stride:tt, $rounds:tt, $which:ident,
     $count:ident, $sums:ident, $few:expr, $end:expr, $place:ident, $enters:ident, $leaves:ident) => {
        asm!(
            "push {{r6, r7}}",
            "sub sp, sp, #16",
            begin!($which, $stride, $bits),
            "movw r10, #0x0f0f\nmovt r10, #0x0f0f",
            if_twice!($rounds, "tst r0, #1\nbne 3f\nsub r11, r11, #1\n"),
            "2:",
            if_twice!($rounds, concat!(column!($stride, $bits, "0"), next!($which))),
            "3:",
            column!($stride, $bits, "-1"),
            next!($which),
            "ldr r0, [sp]",
            "sub r11, r11, #{rounds}",
            "cmp r9, r0",
            "bne 2b",
            "8:",
            "add sp, sp, #16",
            "pop {{r6, r7}}",
            table = const CODES * LINE, line = const LINE, rounds = const $rounds,
            inout("r0") $count => _, inout("r1") $end => _,
            out("r2") _, out("r3") _, out("r4") _, out("r5") _, out("r8") _,
            inout("r9") $sums => _,
            inout("r10") $few => _,
            inout("r11") $place => _,
            inout("r12") $enters.as_ptr() => _,
            inout("lr") $leaves.as_ptr() => _,
        )
    };
}

macro_rules! by_tables {
    ($name:ident, $of_part:ident, $bits:ident, $stride:tt, $rounds:tt) => {
        /// Adds the costs of a piece of a row to its columns, or takes them off, by the tables of the row
        /// that enters and of the one that leaves; in the first `few` columns perhaps of the first half of
        /// the candidates alone. 9 instructions a pixel, two more where a round has one, and 32 for each 32
        /// of its candidates.
        #[inline(never)]
        pub(in super::super) fn $name<const LINE: usize>(
            tables: &[u32],
            [enters, leaves]: [&[u8]; 2],
            few: usize,
            columns: &mut [[u32; $stride / 4]],
        ) {
            let count = columns.len().min(enters.len()).min(leaves.len());
            if count == 0 || count + $stride / 2 > LINE || tables.len() < 2 * words::<LINE>() {
                return;
            }
            // The first pixel has the last place.
            let place = tables.as_ptr().cast::<u8>().wrapping_add(count);
            let sums = columns.as_mut_ptr();
            let few = if $stride == 32 || $stride == 64 { few.min(count) } else { 0 };
            let rest = count - few;
            // SAFETY: the loops read a code of each of `count` pixels from either row and change as many
            // columns, which there are: one in a round; or two, but for one in the first if what is left of
            // `count` is odd. From the tables they read, for four bits, half as many bytes as there are
            // candidates of the code's line from the pixel's place on, the last of which is `count - 1`:
            // inside of the line. The stack and the two registers that no operand may be are left as they
            // were.
            unsafe {
                let (few, end) = (sums.add(few), sums.add(count));
                add_all!($bits, $stride, $rounds, all, rest, sums, few, end, place, enters, leaves);
            }
        }

        /// Adds the costs of a piece of a row, or takes them off, where columns have more candidates: they
        /// are `stride` words long, and the costs are for those from word `from` of each on. 2 instructions
        /// more a pixel than for whole columns.
        #[inline(never)]
        pub(in super::super) fn $of_part<const LINE: usize>(
            tables: &[u32],
            [enters, leaves]: [&[u8]; 2],
            (stride, from): (usize, usize),
            columns: &mut [u32],
        ) {
            let count = columns.len().checked_div(stride).unwrap_or(0).min(enters.len()).min(leaves.len());
            let is_inside = from + $stride / 4 <= stride && stride <= u8::MAX as usize;
            if count == 0 || !is_inside || count + $stride / 2 > LINE || tables.len() < 2 * words::<LINE>() {
                return;
            }
            let place = tables.as_ptr().cast::<u8>().wrapping_add(count);
            let sums = columns.as_mut_ptr().wrapping_add(from);
            let ends = [sums.wrapping_add(count * stride) as usize, 4 * stride - $stride];
            // SAFETY: of each of `count` pixels the loop reads a code from either row, which has them, and
            // from the tables what lies inside of the code's line, as the first check says. It changes words
            // of the pixel's column from `from` on, which end before the next column; `ends` lives until it
            // is done. The stack and the two registers that no operand may be are left as they were.
            unsafe {
                let end = ends.as_ptr();
                add_all!($bits, $stride, $rounds, part, count, sums, sums, end, place, enters, leaves);
            }
        }
    };
}

by_tables!(add_low_16, add_low_16_of, low, 16, 2);
by_tables!(add_low_32, add_low_32_of, low, 32, 2);
by_tables!(add_low_48, add_low_48_of, low, 48, 1);
by_tables!(add_low_64, add_low_64_of, low, 64, 2);
by_tables!(take_high_16, take_high_16_of, high, 16, 2);
by_tables!(take_high_32, take_high_32_of, high, 32, 2);
by_tables!(take_high_48, take_high_48_of, high, 48, 1);
by_tables!(take_high_64, take_high_64_of, high, 64, 1);
