//! Columns into windows, windows into winners: the loops. What is in which register `super::pixel` says.

use crate::matching::memory::winners::Winner;
use core::arch::asm;

/// How many columns after the one that leaves a window the one is that enters it.
pub(in super::super) const ACROSS: usize = 9;

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

/// [`winners_of`] for all candidates.
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
                    "add sp, sp, #48",
                    "pop {{r6, r7}}",
                    ends = const $stride - 2, beside = const -1 - $after,
                    inout("r0") count => _, inout("r1") winners.end => _,
                    out("r2") _, out("r3") _, out("r4") _, out("r5") _, out("r8") _, out("r9") _,
                    inout("r10") columns.as_ptr().add(ACROSS) => _,
                    inout("r11") columns.as_ptr() => _,
                    inout("r12") sums.as_mut_ptr().cast::<u8>().add(4 + $before) => _,
                    inout("lr") winners.start => _,
                );
            }
        }
    };
}

/// [`winners_of`] for the first pixels, which have fewer candidates.
macro_rules! few_winners {
    ($name:ident, $digits:ident, $stride:literal, $most:literal, ($before:literal, $after:literal,
    $back:literal),
        [$($at:literal),*], $blocks:tt) => {
        /// Moves the window on where the first winner has `first` candidates and each one more than the one
        /// before it.
        #[doc = concat!("There are at most `", stringify!($most), "`.")]
        /// Only these have sums. It takes 14 instructions a pixel more, and 9 for every sixteen that may be
        /// none.
        #[inline(never)]
        pub(in super::super) fn $name(
            sums: &mut [u32; $stride / 4 + 2],
            columns: &[[u32; $stride / 4]],
            winners: &mut [Winner],
            first: usize,
        ) {
            if winners.is_empty() || columns.len() < winners.len() + ACROSS {
                return;
            }
            if first < 2 || first + winners.len() > $most + 1 {
                return;
            }
            let winners = winners.as_mut_ptr_range();
            // SAFETY: as above, but for a winner in every round. Masks begin as many bytes before their
            // middle as there are candidates: fewer than half of all masks, which are more than sums that are
            // read.
            unsafe {
                asm!(
                    enter!($digits),
                    "strd r2, r3, [sp, #40]",
                    places!($($at),*),
                    "2:",
                    pixel!($digits, "4", "5", $back, $blocks few),
                    compare_with_last!($digits),
                    "bne 2b",
                    "b 8f",
                    "4:",
                    at_an_end!(),
                    "b 5b",
                    "8:",
                    "add sp, sp, #48",
                    "pop {{r6, r7}}",
                    beside = const -1 - $after,
                    out("r0") _, inout("r1") winners.end => _,
                    inout("r2") first - 2 => _, inout("r3") MASKS.as_ptr().wrapping_add(64 - first) => _,
                    out("r4") _, out("r5") _, out("r8") _, out("r9") _,
                    inout("r10") columns.as_ptr().add(ACROSS) => _,
                    inout("r11") columns.as_ptr() => _,
                    inout("r12") sums.as_mut_ptr().cast::<u8>().add(4 + $before) => _,
                    inout("lr") winners.start => _,
                );
            }
        }
    };
}

/// The loops for so many candidates: for all of them, and for the first pixels. For each of them: how many
/// bytes after the first sum `r12` stands before a pixel, and how many once its sums are read; what makes up
/// for what the pointers moved otherwise than they should; where the places of later blocks stand; and the
/// blocks.
macro_rules! winners_of {
    (16, $digits:ident: $all:ident, $few:ident) => {
        winners!($all, 2, $digits, 16 power, (0, 0, ""), [], [all "ldmia r12" "stmia r12"]);
        few_winners!($few, $digits, 16, 16, (0, 0, ""), [], [few "ldmia r12" "stmia r12"]);
    };
    (32, $digits:ident: $all:ident, $fewest:ident, $few:ident) => {
        winners!($all, 2, $digits, 32 power, (16, 16, ""), ["8"],
            [all "ldmdb r12" "stmdb r12", all "16" "ldmia r12" "stmia r12"]);
        few_winners!($fewest, $digits, 32, 16, (0, 0, "add r10, r10, #16\nadd r11, r11, #16\n"), [],
            [few "ldmia r12" "stmia r12"]);
        few_winners!($few, $digits, 32, 32, (16, 16, ""), ["8"],
            [all "ldmdb r12" "stmdb r12", few "16" "ldmia r12" "stmia r12"]);
    };
    (48, $digits:ident: $all:ident, $fewest:ident, $few:ident) => {
        winners!($all, 1, $digits, 48 other, (16, 32, "sub r12, r12, #16\n"), ["8", "16"],
            [all "ldmdb r12" "stmdb r12", all "16" "ldmia r12" "stmia r12!",
            all "32" "ldmia r12" "stmia r12"]);
        few_winners!($fewest, $digits, 48, 16, (0, 0, "add r10, r10, #32\nadd r11, r11, #32\n"), [],
            [few "ldmia r12" "stmia r12"]);
        few_winners!($few, $digits, 48, 48, (16, 32, "sub r12, r12, #16\n"), ["8", "16"],
            [all "ldmdb r12" "stmdb r12", few "16" "ldmia r12" "stmia r12!",
            few "32" "ldmia r12" "stmia r12"]);
    };
    (64, $digits:ident: $all:ident, $fewest:ident, $few:ident) => {
        winners!($all, 1, $digits, 64 power, (16, 48, "sub r12, r12, #32\n"), ["8", "16", "24"],
            [all "ldmdb r12" "stmdb r12", all "16" "ldmia r12" "stmia r12!",
            all "32" "ldmia r12" "stmia r12!",
            all "48" "ldmia r12" "stmia r12"]);
        few_winners!($fewest, $digits, 64, 32, (16, 16, "add r10, r10, #32\nadd r11, r11, #32\n"), ["8"],
            [few "ldmdb r12" "stmdb r12", few "16" "ldmia r12" "stmia r12"]);
        few_winners!($few, $digits, 64, 64, (16, 48, "sub r12, r12, #32\n"), ["8", "16", "24"],
            [all "ldmdb r12" "stmdb r12", all "16" "ldmia r12" "stmia r12!",
            few "32" "ldmia r12" "stmia r12!",
            few "48" "ldmia r12" "stmia r12"]);
    };
}

winners_of!(16, all: fast_16, fast_few_of_16);
winners_of!(32, all: fast_32, fast_fewest_of_32, fast_few_of_32);
winners_of!(48, all: fast_48, fast_fewest_of_48, fast_few_of_48);
winners_of!(64, all: fast_64, fast_fewest_of_64, fast_few_of_64);
winners_of!(16, quarters: block_16, block_few_of_16);
winners_of!(32, quarters: block_32, block_fewest_of_32, block_few_of_32);
winners_of!(48, quarters: block_48, block_fewest_of_48, block_few_of_48);
winners_of!(64, quarters: block_64, block_fewest_of_64, block_few_of_64);
