//! A pixel of `super::windows`: its sums, and the least of them.
//!
//! Sums and columns go through registers by sixteen candidates, which one instruction loads and one stores.
//! Of four words the least are found two and two, which needs fewer places named than one after the other.
//!
//! ```text
//! r0-r3   sums, then the least of them      r8, r9     of every lane the least so far, and its place
//! r4-r7   columns, then places              r10, r11   the next column that enters, and that leaves
//! r12     where sums are                    lr         the next winner; or the mask of a column's digits
//! sp      eight bytes for every block: the places of its first word and of its second; then what ends the
//!         loop, and the next winner; in the loop for few candidates also the disparity before the last one,
//!         masks of those that are none, the bytes of a column's others, where sums begin, which sixteens are
//!         left out, and the lane numbers
//! ```

/// Sixteen window sums one column on: 12 instructions, and 8 more where only some digits of the columns
/// count. `$from` and `$to` say where the sums are.
macro_rules! slide {
    (all, $from:literal, $to:literal) => {
        concat!(
            $from,
            ", {{r0-r3}}\n",
            "ldmia r10!, {{r4-r7}}\n",
            "uadd8 r0, r0, r4\n",
            "uadd8 r1, r1, r5\n",
            "uadd8 r2, r2, r6\n",
            "uadd8 r3, r3, r7\n",
            "ldmia r11!, {{r4-r7}}\n",
            "usub8 r0, r0, r4\n",
            "usub8 r1, r1, r5\n",
            "usub8 r2, r2, r6\n",
            "usub8 r3, r3, r7\n",
            $to,
            ", {{r0-r3}}\n",
        )
    };
    (quarters, $from:literal, $to:literal) => {
        concat!(
            $from,
            ", {{r0-r3}}\n",
            "ldmia r10!, {{r4-r7}}\n",
            "and r4, lr, r4, lsr #2\n",
            "and r5, lr, r5, lsr #2\n",
            "and r6, lr, r6, lsr #2\n",
            "and r7, lr, r7, lsr #2\n",
            "add r0, r0, r4\n",
            "add r1, r1, r5\n",
            "add r2, r2, r6\n",
            "add r3, r3, r7\n",
            "ldmia r11!, {{r4-r7}}\n",
            "and r4, lr, r4, lsr #2\n",
            "and r5, lr, r5, lsr #2\n",
            "and r6, lr, r6, lsr #2\n",
            "and r7, lr, r7, lsr #2\n",
            "sub r0, r0, r4\n",
            "sub r1, r1, r5\n",
            "sub r2, r2, r6\n",
            "sub r3, r3, r7\n",
            $to,
            ", {{r0-r3}}\n",
        )
    };
}

/// Sixteen sums of which those that are no candidate's do not win: 9 instructions.
macro_rules! mask {
    () => {
        concat!(
            "ldr r4, [sp, #44]\n",
            "ldr r5, [r4]\n",
            "ldr r6, [r4, #4]\n",
            "ldr r7, [r4, #8]\n",
            "ldr r4, [r4, #12]\n",
            "orr r0, r0, r5\n",
            "orr r1, r1, r6\n",
            "orr r2, r2, r7\n",
            "orr r3, r3, r4\n",
        )
    };
}

/// The least of two words and of two, and their places: 8 instructions.
macro_rules! least_of_two_and_two {
    ($d:literal) => {
        concat!(
            "ldrd r4, r5, [sp, #(",
            $d,
            " / 2)]\n",
            "usub8 r6, r1, r0\n",
            "sel r0, r0, r1\n",
            "sel r6, r4, r5\n",
            "usub8 r7, r3, r2\n",
            "sel r2, r2, r3\n",
            "sel r7, r4, r5\n",
            "add r7, r7, #0x08080808\n",
        )
    };
}

/// The least of the first four words: 11 instructions.
macro_rules! take_first {
    () => {
        concat!(least_of_two_and_two!("0"), "usub8 r1, r2, r0\n", "sel r8, r0, r2\n", "sel r9, r6, r7\n")
    };
}

/// Where the next four words' sums are less than the least, they are it: 14 instructions.
macro_rules! take_less {
    ($d:literal) => {
        concat!(
            least_of_two_and_two!($d),
            "usub8 r1, r2, r0\n",
            "sel r0, r0, r2\n",
            "sel r6, r6, r7\n",
            "usub8 r1, r0, r8\n",
            "sel r8, r8, r0\n",
            "sel r9, r9, r6\n",
        )
    };
}

/// The least of the four lanes, and of equal ones the one with the first place: 10 instructions. Above its
/// place in `r0` is more.
macro_rules! of_lanes {
    () => {
        concat!(
            // Half-words of sum and place, two and two; the least of the four goes to the low half.
            "uxtb16 r0, r9\n",
            "uxtb16 r1, r8\n",
            "orr r0, r0, r1, lsl #8\n",
            "bic r1, r8, #0x00ff00ff\n",
            "uxtab16 r1, r1, r9, ror #8\n",
            "usub16 r2, r0, r1\n",
            "sel r0, r1, r0\n",
            "ror r1, r0, #16\n",
            "usub16 r2, r0, r1\n",
            "sel r0, r1, r0\n",
        )
    };
}

/// The sums beside it, and whether it is at an end; what changes from pixel to pixel. 5 instructions, one
/// more where the candidates are no power of two.
macro_rules! beside {
    (power, $back:literal) => {
        concat!(
            "uxtab r1, r12, r0\nldr r2, [r1, #{beside}]\n",
            $back,
            "add r1, r0, #1\ntst r1, #{ends}\nbeq "
        )
    };
    (other, $back:literal) => {
        concat!(
            "uxtab r1, r12, r0\nldr r2, [r1, #{beside}]\n",
            $back,
            "uxtb r1, r0\nsub r1, r1, #1\ncmp r1, #{ends}\nbhs "
        )
    };
}

/// [`beside`] where the last candidate changes from pixel to pixel: 13 instructions.
macro_rules! beside_few {
    () => {
        concat!(
            "ldrd r3, r12, [sp, #48]\n",
            "uxtab r1, r12, r0\n",
            "ldr r2, [r1, #-1]\n",
            "add r10, r10, r3\n",
            "add r11, r11, r3\n",
            "uxtb r1, r0\n",
            "sub r1, r1, #1\n",
            "ldrd r3, r4, [sp, #40]\n",
            "cmp r1, r3\n",
            "add r3, r3, #1\n",
            "sub r4, r4, #1\n",
            "strd r3, r4, [sp, #40]\n",
            "bhs 4f\n5:\n",
        )
    };
}

/// The winner goes where it belongs: 2 instructions; 4 where the register is a mask.
macro_rules! store {
    (all) => {
        "bfi r2, r0, #24, #8\nstr r2, [lr], #4\n"
    };
    (quarters) => {
        "bfi r2, r0, #24, #8\nldr r0, [sp, #36]\nstr r2, [r0], #4\nstr r0, [sp, #36]\n"
    };
}

/// Whether there are more winners to come: 2 instructions and the branch.
macro_rules! compare_with_last {
    (all) => {
        "ldr r0, [sp, #32]\ncmp lr, r0\n"
    };
    (quarters) => {
        "ldr r1, [sp, #32]\ncmp r0, r1\n"
    };
}

/// At an end the one beside it that there is stands for both: 6 instructions more.
macro_rules! at_an_end {
    () => {
        concat!(
            "tst r0, #0xff\n",
            "ite eq\n",
            "lsreq r1, r2, #16\n",
            "movne r1, r2\n",
            "bfi r2, r1, #0, #8\n",
            "bfi r2, r1, #16, #8\n"
        )
    };
}

/// A pixel with all candidates; `$rest` puts the pointers back that moved too far, or not far enough.
macro_rules! pixel {
    ($digits:ident, $end:literal, $back:literal, $rest:literal,
        [$first_from:literal $first_to:literal $(, $d:literal $from:literal $to:literal)*]
        $ends:ident) => {
        concat!(
            slide!($digits, $first_from, $first_to),
            take_first!(),
            $(
                slide!($digits, $from, $to),
                take_less!($d),
            )*
            of_lanes!(),
            beside!($ends, $rest),
            $end,
            "f\n",
            $back,
            ":\n",
            store!($digits),
        )
    };
}

/// What is below the stack's end while a loop runs, but for the places of all blocks.
macro_rules! enter {
    (all) => {
        "push {{r6, r7}}\nsub sp, sp, #64\nstr r1, [sp, #32]\n"
    };
    (quarters) => {
        concat!(enter!(all), "str lr, [sp, #36]\nmovw lr, #0x3f3f\nmovt lr, #0x3f3f\n")
    };
}

/// Undoes [`enter`].
macro_rules! leave {
    () => {
        "add sp, sp, #64\npop {{r6, r7}}"
    };
}

/// The places of a block's first word and its second: those of the first word of the first block are in `r4`.
macro_rules! places {
    ($($at:literal),*) => {
        concat!(
            "add r5, r4, #0x04040404\nstrd r4, r5, [sp, #0]\n",
            $("add r4, r4, #0x10101010\nadd r5, r5, #0x10101010\nstrd r4, r5, [sp, #", $at, "]\n",)*
        )
    };
}
