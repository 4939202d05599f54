//! Columns into windows, windows into winners.

use crate::matching::kernels::Winner;
use core::arch::asm;

/// Eight window sums one column on: 8 instructions, and 4 more where only some digits of the columns count.
macro_rules! slide_eight {
    (all, $d:literal) => {
        concat!(
            "ldrd {s0}, {s1}, [{sums}, #(4 + ",
            $d,
            ")]\n",
            "ldrd {v0}, {v1}, [{column}, #({across} + ",
            $d,
            ")]\n",
            "uadd8 {s0}, {s0}, {v0}\n",
            "uadd8 {s1}, {s1}, {v1}\n",
            "ldrd {v0}, {v1}, [{column}, #",
            $d,
            "]\n",
            "usub8 {s0}, {s0}, {v0}\n",
            "usub8 {s1}, {s1}, {v1}\n",
            "strd {s0}, {s1}, [{sums}, #(4 + ",
            $d,
            ")]\n",
        )
    };
    (quarters, $d:literal) => {
        concat!(
            "ldrd {s0}, {s1}, [{sums}, #(4 + ",
            $d,
            ")]\n",
            "ldrd {v0}, {v1}, [{column}, #({across} + ",
            $d,
            ")]\n",
            "and {v0}, {mask}, {v0}, lsr #2\n",
            "and {v1}, {mask}, {v1}, lsr #2\n",
            "add {s0}, {s0}, {v0}\n",
            "add {s1}, {s1}, {v1}\n",
            "ldrd {v0}, {v1}, [{column}, #",
            $d,
            "]\n",
            "and {v0}, {mask}, {v0}, lsr #2\n",
            "and {v1}, {mask}, {v1}, lsr #2\n",
            "sub {s0}, {s0}, {v0}\n",
            "sub {s1}, {s1}, {v1}\n",
            "strd {s0}, {s1}, [{sums}, #(4 + ",
            $d,
            ")]\n",
        )
    };
}

/// Eight sums of which those that are no candidate's do not win: 4 instructions.
macro_rules! mask_eight {
    (all, $d:literal) => {
        ""
    };
    (few, $d:literal) => {
        concat!(
            "ldr {v0}, [{masks}, #",
            $d,
            "]\n",
            "ldr {v1}, [{masks}, #(4 + ",
            $d,
            ")]\n",
            "orr {s0}, {s0}, {v0}\n",
            "orr {s1}, {s1}, {v1}\n",
        )
    };
}

/// Where a word's sums are less than the least, they are it, and the word their place: 4 instructions.
macro_rules! take_less {
    ($sums:literal, $place:literal) => {
        concat!(
            "usub8 {v0}, ",
            $sums,
            ", {least}\n",
            "sel {least}, {least}, ",
            $sums,
            "\n",
            "mov {v0}, #",
            $place,
            "\n",
            "sel {places}, {places}, {v0}\n",
        )
    };
}

/// The first two words: 5 instructions.
macro_rules! take_first {
    () => {
        concat!(
            "usub8 {v0}, {s1}, {s0}\n",
            "sel {least}, {s0}, {s1}\n",
            "mov {places}, #0\n",
            "mov {v0}, #0x04040404\n",
            "sel {places}, {places}, {v0}\n",
        )
    };
}

/// The lanes' own places added: an instruction, and 2 more where no register is left for them.
macro_rules! add_lanes {
    (all) => {
        "add {places}, {places}, {lanes}\n"
    };
    (few) => {
        "movw {v0}, #0x0100\nmovt {v0}, #0x0302\nadd {places}, {places}, {v0}\n"
    };
}

/// Whether the disparity under `s1` and above is at an end, and what changes from pixel to pixel.
macro_rules! compare_with_ends {
    (all) => {
        "cmp {s1}, #({stride} - 2)\n"
    };
    (few) => {
        concat!("cmp {s1}, {last}\n", "sub {masks}, {masks}, #1\n", "add {last}, {last}, #1\n")
    };
}

/// No candidate, for the most candidates, then one for each of them.
static MASKS: [u8; 128] = {
    let mut masks = [0; 128];
    let mut i = 64;
    while i < 128 {
        masks[i] = u8::MAX;
        i += 1;
    }
    masks
};

macro_rules! winners {
    ($name:ident, $digits:ident $(of $mask:literal)?, $which:ident $(with $lanes:literal)? $(from $first:ident)?, $stride:literal,
        [$(($d:literal, $even:literal, $odd:literal)),*]) => {
        /// Moves the window on from column to column, and selects the winner of each. `columns` are those that leave, one
        /// for each winner and [`ACROSS`] more that enter. The first winner has `first` candidates and each one more than
        /// the one before it; where that is not asked for all have all. 21 instructions a pixel beside 16 for eight of its
        /// candidates, 4 more where only some digits of the columns count; 4 for eight and 4 more where not all are candidates; 6
        /// more where a winner is at an end.
        #[inline(never)]
        pub(in super::super) fn $name(
            sums: &mut [u32; $stride / 4 + 2],
            columns: &[[u32; $stride / 4]],
            winners: &mut [Winner],
            $($first: usize,)?
        ) {
            if winners.is_empty() || columns.len() < winners.len() + ACROSS {
                return;
            }
            $(
                if $first < 2 || $first + winners.len() > $stride {
                    return;
                }
                let masks = MASKS.as_ptr().wrapping_add(64 - $first);
                let last = $first - 2;
            )?
            let winners = winners.as_mut_ptr_range();
            // SAFETY: the loop writes as many winners as there are. For each it reads two columns, of which there are
            // enough, and reads and writes the sums, of which the one before the first and the one after the last are
            // read as neighbours of a winner. Masks begin as many bytes before their middle as there are candidates, of
            // which there are less than half of all masks.
            unsafe {
                asm!(
                    "2:",
                    slide_eight!($digits, "0"),
                    mask_eight!($which, "0"),
                    take_first!(),
                    $(
                        slide_eight!($digits, $d),
                        mask_eight!($which, $d),
                        take_less!("{s0}", $even),
                        take_less!("{s1}", $odd),
                    )*
                    // Half-words of sum and place, two and two; the least of the four goes to the low half.
                    add_lanes!($which),
                    "uxtb16 {s0}, {places}",
                    "uxtb16 {s1}, {least}",
                    "orr {s0}, {s0}, {s1}, lsl #8",
                    "uxtb16 {s1}, {places}, ror #8",
                    "uxtb16 {v0}, {least}, ror #8",
                    "orr {s1}, {s1}, {v0}, lsl #8",
                    "usub16 {v0}, {s0}, {s1}",
                    "sel {s0}, {s1}, {s0}",
                    "ror {s1}, {s0}, #16",
                    "usub16 {v0}, {s0}, {s1}",
                    "sel {s0}, {s1}, {s0}",
                    "uxtb {s0}, {s0}",
                    // With the sums beside it.
                    "add {s1}, {sums}, {s0}",
                    "ldr {v0}, [{s1}, #3]",
                    "sub {s1}, {s0}, #1",
                    compare_with_ends!($which),
                    "bhs 4f",
                    "3:",
                    "bfi {v0}, {s0}, #24, #8",
                    "str {v0}, [{winner}], #4",
                    "add {column}, {column}, #{stride}",
                    "cmp {winner}, {end}",
                    "bne 2b",
                    "b 5f",
                    // At an end the one beside it that there is stands for both.
                    "4:",
                    "cmp {s0}, #0",
                    "ite eq",
                    "lsreq {s1}, {v0}, #16",
                    "movne {s1}, {v0}",
                    "bfi {v0}, {s1}, #0, #8",
                    "bfi {v0}, {s1}, #16, #8",
                    "b 3b",
                    "5:",
                    column = inout(reg) columns.as_ptr() => _,
                    sums = in(reg) sums.as_mut_ptr(),
                    winner = inout(reg) winners.start => _,
                    end = in(reg) winners.end,
                    $(mask = in(reg) $mask,)?
                    $(lanes = in(reg) $lanes,)?
                    $(masks = inout(reg) masks => _, last = inout(reg) { let _ = $first; last } => _,)?
                    least = out(reg) _, places = out(reg) _,
                    s0 = out(reg) _, s1 = out(reg) _, v0 = out(reg) _, v1 = out(reg) _,
                    across = const ACROSS * $stride, stride = const $stride,
                    options(nostack),
                );
            }
        }
    };
}

/// How many columns after the one that leaves a window the one is that enters it.
pub(in super::super) const ACROSS: usize = 9;

macro_rules! winners_of {
    ($stride:literal: [$fast:ident, $fast_few:ident, $block:ident, $block_few:ident], $eights:tt) => {
        winners!($fast, all, all with 0x0302_0100, $stride, $eights);
        winners!($fast_few, all, few from first, $stride, $eights);
        winners!($block, quarters of 0x3f3f_3f3fu32, all with 0x0302_0100, $stride, $eights);
        winners!($block_few, quarters of 0x3f3f_3f3fu32, few from first, $stride, $eights);
    };
}

winners_of!(16: [fast_16, fast_few_of_16, block_16, block_few_of_16],
    [("8", "0x08080808", "0x0c0c0c0c")]);
winners_of!(32: [fast_32, fast_few_of_32, block_32, block_few_of_32],
    [("8", "0x08080808", "0x0c0c0c0c"),
    ("16", "0x10101010", "0x14141414"), ("24", "0x18181818", "0x1c1c1c1c")]);
winners_of!(48: [fast_48, fast_few_of_48, block_48, block_few_of_48],
    [("8", "0x08080808", "0x0c0c0c0c"),
    ("16", "0x10101010", "0x14141414"), ("24", "0x18181818", "0x1c1c1c1c"),
    ("32", "0x20202020", "0x24242424"), ("40", "0x28282828", "0x2c2c2c2c")]);
winners_of!(64: [fast_64, fast_few_of_64, block_64, block_few_of_64],
    [("8", "0x08080808", "0x0c0c0c0c"),
    ("16", "0x10101010", "0x14141414"), ("24", "0x18181818", "0x1c1c1c1c"),
    ("32", "0x20202020", "0x24242424"), ("40", "0x28282828", "0x2c2c2c2c"),
    ("48", "0x30303030", "0x34343434"), ("56", "0x38383838", "0x3c3c3c3c")]);
