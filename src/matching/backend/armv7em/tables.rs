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

use crate::matching::backend::loops::fill_bytes;
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
pub(super) fn fill(table: &mut [u32], cost: u8) {
    fill_bytes(table, cost * 0x11);
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

/// Makes the costs at so many places, with candidates `apart` apart in both halves of a byte: against a
/// reversed row whose right codes are the high halves of its bytes, with nothing in the low ones. Of the row
/// as many bytes are read as make whole rounds of eight.
///
/// 79 instructions for sixteen costs of all codes.
#[inline(never)]
fn make<const LINE: usize>(table: &mut [u32], row: &[u8], apart: usize, places: usize) {
    let rounds = places.div_ceil(8);
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
            "and {near_0}, {ones}, {near_3}",
            "and {near_1}, {ones}, {near_3}, lsr #1",
            "and {near_2}, {ones}, {near_3}, lsr #2",
            "and {near_3}, {ones}, {near_3}, lsr #3",
            "add {row}, {near_0}, {near_1}",
            "add {row}, {row}, {near_2}",
            "add {row}, {row}, {near_3}",
            "and {far_0}, {ones}, {far}",
            "and {far_1}, {ones}, {far}, lsr #1",
            "and {far_2}, {ones}, {far}, lsr #2",
            "and {far}, {ones}, {far}, lsr #3",
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

macro_rules! move_places {
    ($(#[$doc:meta])* $name:ident, $bytes:literal, $registers:literal) => {
        $(#[$doc])*
        #[inline(never)]
        fn $name<const LINE: usize>(table: &mut [u32], by: usize) {
            if !by.is_multiple_of(4) || by + $bytes > LINE || table.len() < words::<LINE>() {
                return;
            }
            let table = table.as_mut_ptr().cast::<u8>();
            // SAFETY: of each of the lines the loop reads the first bytes and writes as many from `by` on,
            // which lie in the line, both at whole words.
            unsafe {
                asm!(
                    "2:",
                    concat!("ldmia r10, ", $registers),
                    "add r10, r10, #{line}",
                    concat!("stmia r11, ", $registers),
                    "add r11, r11, #{line}",
                    concat!("ldmia r10, ", $registers),
                    "add r10, r10, #{line}",
                    concat!("stmia r11, ", $registers),
                    "add r11, r11, #{line}",
                    "cmp r10, r12",
                    "bne 2b",
                    line = const LINE,
                    inout("r10") table => _,
                    inout("r11") table.add(by) => _,
                    in("r12") table.add(CODES * LINE),
                    out("r0") _, out("r1") _, out("r2") _, out("r3") _,
                    out("r4") _, out("r5") _, out("r8") _, out("r9") _,
                    options(nostack),
                );
            }
        }
    };
}

move_places!(
    /// Moves the costs at the first 16 places of all lines so many places on, a multiple of four: 5
    /// instructions a line.
    move_16, 16, "{{r0-r3}}"
);
move_places!(
    /// [`move_16`] of 32 places.
    move_32, 32, "{{r0-r5, r8, r9}}"
);

/// Makes the costs at `places` and `apart` more. The last of these are what the first ones of the
/// table were before, if it `was_beside`: these are moved, where that takes fewer instructions.
#[inline(always)]
pub(super) fn make_beside<const LINE: usize>(
    table: &mut [u32],
    row: &[u8],
    (apart, places): (usize, usize),
    was_beside: bool,
) {
    let move_places = match apart {
        16 => move_16::<LINE>,
        32 => move_32::<LINE>,
        _ => return make::<LINE>(table, row, apart, places + apart),
    };
    if was_beside && places.is_multiple_of(4) {
        move_places(table, places);
        make::<LINE>(table, row, apart, places);
    } else {
        make::<LINE>(table, row, apart, places + apart);
    }
}
