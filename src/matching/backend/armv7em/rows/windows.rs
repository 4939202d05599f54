//! Columns into windows, windows into winners: the loops. What is in which register `super::pixel` says.

use crate::matching::memory::winners::Winner;
use core::arch::asm;

/// How many columns after the one that leaves a window the one is that enters it.
pub(in super::super) const ACROSS: usize = 9;

/// The lane numbers.
pub(in super::super) const LANES: u32 = 0x0302_0100;

/// Sixteens of candidates, at most.
const BLOCKS: usize = 4;

/// Sixteen candidates, and sixteen that are none.
static MASKS: [u8; 32] = {
    let mut masks = [0; 32];
    let mut i = 16;
    while i < 32 {
        masks[i] = u8::MAX;
        i += 1;
    }
    masks
};

/// The loop for all candidates: how many bytes after the first sum `r12` stands before a pixel, and how many
/// once its sums are read; what makes up for what the pointers moved otherwise than they should; where the
/// places of later blocks stand; and the blocks.
macro_rules! winners {
    ($name:ident, $rounds:tt, $digits:ident, $stride:literal $ends:ident,
        ($before:literal, $after:literal, $back:literal), [$($at:literal),*],
        $blocks:tt) => {
        /// Moves the window on from column to column, and selects the winner of each, with all candidates.
        /// `columns` are those that leave, one for each winner and [`ACROSS`] more that enter. 18
        /// instructions a pixel, two more where a round has one, 26 for every sixteen of its candidates less
        /// 3 for the first, and what `slide` says more; 7 more where a winner is at an end.
        #[inline(never)]
        pub(in super::super) fn $name(
            sums: &mut [u32; $stride / 4 + 2],
            columns: &[[u32; $stride / 4]],
            winners: &mut [Winner],
        ) {
            if winners.is_empty() || columns.len() < winners.len() + ACROSS {
                return;
            }
            let count = winners.len();
            let winners = winners.as_mut_ptr_range();
            // SAFETY: the loop writes as many winners as there are, one in a round; or two, but for one in
            // the first if their number is odd. For each it reads two columns, of which there are enough, and
            // reads and writes the sums, of which the word before the first and the one after the last are
            // read as neighbours of a winner. The stack and the two registers that no operand may be are left
            // as they were.
            unsafe {
                asm!(
                    enter!($digits),
                    places!($($at),*),
                    if_twice!($rounds, "tst r0, #1\nbne 3f\n"),
                    "2:",
                    if_twice!($rounds, pixel!($digits, "4", "5", $back, $blocks $ends)),
                    "3:",
                    pixel!($digits, "6", "7", $back, $blocks $ends),
                    compare_with_last!($digits),
                    "bne 2b",
                    "b 8f",
                    if_twice!($rounds, concat!("4:\n", at_an_end!(), "b 5b\n")),
                    "6:",
                    at_an_end!(),
                    "b 7b",
                    "8:",
                    leave!(),
                    ends = const $stride - 2, beside = const -1 - $after,
                    inout("r0") count => _, inout("r1") winners.end => _,
                    out("r2") _, out("r3") _, inout("r4") LANES => _, out("r5") _, out("r8") _, out("r9") _,
                    inout("r10") columns.as_ptr().add(ACROSS) => _,
                    inout("r11") columns.as_ptr() => _,
                    inout("r12") sums.as_mut_ptr().cast::<u8>().add(4 + $before) => _,
                    inout("lr") winners.start => _,
                );
            }
        }
    };
}

/// The loop for the first pixels, which have fewer candidates, whatever the number of all of them is.
macro_rules! few_winners {
    ($name:ident, $digits:ident) => {
        /// Moves the window on where the first winner has `first` candidates and each one more than the one
        /// before it, in columns of so many words. There are sums of all sixteens of candidates of which the
        /// first winner has one, and the last winner has no more. 41 instructions a pixel, 26 for every
        /// sixteen of its candidates, and what `slide` says more.
        #[inline(never)]
        pub(in super::super) fn $name(
            sums: &mut [u32],
            columns: &[u32],
            words: usize,
            winners: &mut [Winner],
            first: usize,
        ) {
            if first < 2 || winners.is_empty() {
                return;
            }
            // Sixteens before the last one.
            let before = (first - 1) / 16;
            let most = 16 * (before + 1);
            if before >= BLOCKS || first + winners.len() > most + 1 || sums.len() < most / 4 + 2 {
                return;
            }
            if 4 * words < most || columns.len() < (winners.len() + ACROSS) * words {
                return;
            }
            let skipped = BLOCKS - 1 - before;
            let winners = winners.as_mut_ptr_range();
            let sums = sums.as_mut_ptr().wrapping_add(1);
            let more = [4 * words - most, sums as usize, skipped, LANES as usize];
            // SAFETY: the loop writes as many winners as there are, one in a round. For each it reads two
            // columns, of which there are enough, as far as there are sums, and reads and writes the sums, of
            // which the word before the first and the one after the last are read as neighbours of a winner.
            // Masks begin as many bytes before their middle as the last sixteen has candidates. `more` lives
            // until it is done. The stack and the two registers that no operand may be are left as they were.
            unsafe {
                asm!(
                    enter!($digits),
                    "strd r2, r3, [sp, #40]",
                    "ldmia r5, {{r2, r3, r5, r6}}",
                    "strd r2, r3, [sp, #48]",
                    "strd r5, r6, [sp, #56]",
                    places!("8", "16", "24"),
                    "2:",
                    "mvn r8, #0",
                    "ldrd r4, r9, [sp, #56]",
                    // The last sixteens of four.
                    "tbb [pc, r4]",
                    "10:",
                    ".byte (11f - 10b) / 2, (12f - 10b) / 2, (13f - 10b) / 2, (14f - 10b) / 2",
                    "11:",
                    slide!($digits, "ldmia r12", "stmia r12!"),
                    take_less!("0"),
                    "12:",
                    slide!($digits, "ldmia r12", "stmia r12!"),
                    take_less!("16"),
                    "13:",
                    slide!($digits, "ldmia r12", "stmia r12!"),
                    take_less!("32"),
                    "14:",
                    slide!($digits, "ldmia r12", "stmia r12"),
                    mask!(),
                    take_less!("48"),
                    of_lanes!(),
                    beside_few!(),
                    store!($digits),
                    compare_with_last!($digits),
                    "bne 2b",
                    "b 8f",
                    "4:",
                    at_an_end!(),
                    "b 5b",
                    "8:",
                    leave!(),
                    out("r0") _, inout("r1") winners.end => _,
                    inout("r2") first - 2 => _,
                    inout("r3") MASKS.as_ptr().wrapping_add(most - first) => _,
                    // The places of sixteens that are left out are no places.
                    inout("r4") LANES.wrapping_sub(skipped as u32 * 0x1010_1010) => _,
                    inout("r5") more.as_ptr() => _,
                    out("r8") _, out("r9") _,
                    inout("r10") columns.as_ptr().add(ACROSS * words) => _,
                    inout("r11") columns.as_ptr() => _,
                    inout("r12") sums => _,
                    inout("lr") winners.start => _,
                );
            }
        }
    };
}

/// [`winners`] for so many candidates.
macro_rules! all_of {
    (16, $digits:ident: $name:ident) => {
        winners!($name, 2, $digits, 16 power, (0, 0, ""), [], ["ldmia r12" "stmia r12"]);
    };
    (32, $digits:ident: $name:ident) => {
        winners!($name, 2, $digits, 32 power, (16, 16, ""), ["8"],
            ["ldmdb r12" "stmdb r12", "16" "ldmia r12" "stmia r12"]);
    };
    (48, $digits:ident: $name:ident) => {
        winners!($name, 1, $digits, 48 other, (16, 32, "sub r12, r12, #16\n"), ["8", "16"],
            ["ldmdb r12" "stmdb r12", "16" "ldmia r12" "stmia r12!", "32" "ldmia r12" "stmia r12"]);
    };
    (64, $rounds:tt, $digits:ident: $name:ident) => {
        winners!($name, $rounds, $digits, 64 power, (16, 48, "sub r12, r12, #32\n"), ["8", "16", "24"],
            ["ldmdb r12" "stmdb r12", "16" "ldmia r12" "stmia r12!", "32" "ldmia r12" "stmia r12!",
            "48" "ldmia r12" "stmia r12"]);
    };
}

all_of!(16, all: fast_16);
all_of!(32, all: fast_32);
all_of!(48, all: fast_48);
all_of!(64, 2, all: fast_64);
few_winners!(fast_few, all);
all_of!(16, quarters: block_16);
all_of!(32, quarters: block_32);
all_of!(48, quarters: block_48);
all_of!(64, 1, quarters: block_64);
few_winners!(block_few, quarters);
