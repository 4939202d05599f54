//! A pixel's column of `super::tables`: the costs of its two codes, and its sums.
//!
//! ```text
//! r0-r3   costs, in halves of bytes      r9         where the column's sums are
//! r4, r8  where the codes' costs are     r10        the low halves of a word's bytes
//! r4-r7   sums                           r11        the place of the pixel in a line of costs
//! sp      what ends the loop; 8 bytes on, where the codes' costs are
//! ```

/// Four of a code's bits.
macro_rules! of_code {
    (low, $code:literal) => {
        concat!("and ", $code, ", ", $code, ", #15\n")
    };
    (high, $code:literal) => {
        concat!("lsr ", $code, ", ", $code, ", #4\n")
    };
}

/// Adds four costs, or takes them off.
macro_rules! sum {
    (low) => {
        "uadd8 "
    };
    (high) => {
        "usub8 "
    };
}

/// Where the costs of a pixel's codes are, the entering one's and the leaving one's, in `r4` and `r8`: 7
/// instructions.
macro_rules! lines_of_codes {
    ($bits:ident) => {
        concat!(
            "ldrb r4, [r12], #1\n",
            "ldrb r8, [lr], #1\n",
            of_code!($bits, "r4"),
            of_code!($bits, "r8"),
            "mov r5, #{line}\n",
            "mla r4, r4, r5, r11\n",
            "mla r8, r8, r5, r11\n",
        )
    };
}

/// Sums of costs, in halves of bytes, into `r0` and the next: 3 instructions a word.
macro_rules! costs {
    (2, $($d:literal),*) => {
        concat!(
            "ldr r0, [r4, #(", $($d,)* ")]\n",
            "ldr r1, [r4, #(4 + ", $($d,)* ")]\n",
            "ldr r6, [r8, #({table} + ", $($d,)* ")]\n",
            "ldr r7, [r8, #({table} + 4 + ", $($d,)* ")]\n",
            "add r0, r0, r6\n",
            "add r1, r1, r7\n",
        )
    };
    (4, $($d:literal),*) => {
        concat!(
            costs!(2, $($d),*),
            "ldr r2, [r4, #(8 + ", $($d,)* ")]\n",
            "ldr r3, [r4, #(12 + ", $($d,)* ")]\n",
            "ldr r6, [r8, #({table} + 8 + ", $($d,)* ")]\n",
            "ldr r7, [r8, #({table} + 12 + ", $($d,)* ")]\n",
            "add r2, r2, r6\n",
            "add r3, r3, r7\n",
        )
    };
}

/// The low halves of a word's bytes added, or the high ones: 2 instructions.
macro_rules! add {
    ($bits:ident, near, $costs:literal, $sums:literal) => {
        concat!("and r8, ", $costs, ", #0x0f0f0f0f\n", sum!($bits), $sums, ", ", $sums, ", r8\n")
    };
    ($bits:ident, far, $costs:literal, $sums:literal) => {
        concat!("and r8, r10, ", $costs, ", lsr #4\n", sum!($bits), $sums, ", ", $sums, ", r8\n")
    };
}

/// Four words of sums; `$from` and `$to` say where: 10 instructions.
macro_rules! add_four {
    ($bits:ident, $which:ident, $from:literal, $to:literal) => {
        concat!(
            $from,
            ", {{r4-r7}}\n",
            add!($bits, $which, "r0", "r4"),
            add!($bits, $which, "r1", "r5"),
            add!($bits, $which, "r2", "r6"),
            add!($bits, $which, "r3", "r7"),
            $to,
            ", {{r4-r7}}\n",
        )
    };
}

/// Two words of sums: 6 instructions.
macro_rules! add_two {
    ($bits:ident, $which:ident, $at:literal) => {
        concat!(
            "ldrd r4, r5, [r9, #",
            $at,
            "]\n",
            add!($bits, $which, "r0", "r4"),
            add!($bits, $which, "r1", "r5"),
            "strd r4, r5, [r9, #",
            $at,
            "]\n",
        )
    };
}

/// A pixel's column, by costs as many bytes from where `r11` says.
macro_rules! column {
    (16, $bits:ident, $d:literal) => {
        concat!(
            lines_of_codes!($bits),
            costs!(2, $d),
            "ldmia r9, {{r4-r7}}\n",
            add!($bits, near, "r0", "r4"),
            add!($bits, near, "r1", "r5"),
            add!($bits, far, "r0", "r6"),
            add!($bits, far, "r1", "r7"),
            "stmia r9!, {{r4-r7}}\n",
        )
    };
    (32, $bits:ident, $d:literal) => {
        concat!(
            lines_of_codes!($bits),
            costs!(4, $d),
            add_four!($bits, near, "ldmia r9", "stmia r9!"),
            add_four!($bits, far, "ldmia r9", "stmia r9!"),
        )
    };
    (48, $bits:ident, $d:literal) => {
        concat!(
            lines_of_codes!($bits),
            "strd r4, r8, [sp, #8]\n",
            costs!(4, $d),
            add_four!($bits, near, "ldmia r9", "stmia r9"),
            "add r9, r9, #24\n",
            add_four!($bits, far, "ldmia r9", "stmia r9"),
            "ldrd r4, r8, [sp, #8]\n",
            costs!(2, "16 + ", $d),
            add_two!($bits, near, "-8"),
            add_two!($bits, far, "16"),
            "add r9, r9, #24\n",
        )
    };
    (64, $bits:ident, $d:literal) => {
        concat!(
            lines_of_codes!($bits),
            "strd r4, r8, [sp, #8]\n",
            costs!(4, $d),
            add_four!($bits, near, "ldmia r9", "stmia r9"),
            "add r9, r9, #32\n",
            add_four!($bits, far, "ldmia r9", "stmia r9"),
            "ldrd r4, r8, [sp, #8]\n",
            costs!(4, "16 + ", $d),
            add_four!($bits, near, "ldmdb r9", "stmdb r9"),
            "add r9, r9, #16\n",
            add_four!($bits, far, "ldmia r9", "stmia r9!"),
        )
    };
}

/// The first pixels, of whose columns only the first half of the candidates matters, as far as `r10` says: 33
/// instructions a pixel at 32 candidates, 56 at 64. Elsewhere there are none.
macro_rules! first_halves {
    (32, $bits:ident) => {
        first_halves!(
            lines_of_codes!($bits),
            costs!(4, "-1"),
            add_four!($bits, near, "ldmia r9", "stmia r9"),
            "add r9, r9, #32\n",
        )
    };
    (64, $bits:ident) => {
        first_halves!(
            lines_of_codes!($bits),
            "strd r4, r8, [sp, #8]\n",
            costs!(4, "-1"),
            add_four!($bits, near, "ldmia r9", "stmia r9!"),
            "ldrd r4, r8, [sp, #8]\n",
            costs!(4, "15"),
            add_four!($bits, near, "ldmia r9", "stmia r9"),
            "add r9, r9, #48\n",
        )
    };
    ($stride:tt, $bits:ident) => {
        ""
    };
    ($($pixel:expr,)*) => {
        concat!(
            "cmp r9, r10\nbeq 6f\n5:\n",
            $($pixel,)*
            "sub r11, r11, #1\ncmp r9, r10\nbne 5b\n",
            "6:\nldr r0, [sp, #4]\ncmp r0, #0\nbeq 8f\n",
        )
    };
}
