//! Bits that differ into columns, where codes have eight.

use core::arch::asm;

/// Four candidates of [`by_bits_32`]: 18 instructions for their bits, and 2 to add them.
macro_rules! four_by_bits {
    ($d:literal, $sums:literal) => {
        concat!(
            "ldr {a}, [{new}, #",
            $d,
            "]\n",
            "ldr {b}, [{old}, #",
            $d,
            "]\n",
            "eor {a}, {a}, {enters}\n",
            "eor {b}, {b}, {leaves}\n",
            // Bits of two in each two, of four in each four, of both words together; of eight in each byte.
            "bic {t}, {a}, #0x55555555\n",
            "sub {a}, {a}, {t}, lsr #1\n",
            "bic {t}, {b}, #0x55555555\n",
            "sub {b}, {b}, {t}, lsr #1\n",
            "bic {t}, {a}, #0x33333333\n",
            "and {a}, {a}, #0x33333333\n",
            "add {a}, {a}, {t}, lsr #2\n",
            "bic {t}, {b}, #0x33333333\n",
            "and {b}, {b}, #0x33333333\n",
            "add {a}, {a}, {t}, lsr #2\n",
            "add {a}, {a}, {b}\n",
            "bic {t}, {a}, #0x0f0f0f0f\n",
            "and {a}, {a}, #0x0f0f0f0f\n",
            "add {a}, {a}, {t}, lsr #4\n",
            "add ",
            $sums,
            ", ",
            $sums,
            ", {a}\n",
            "sub ",
            $sums,
            ", ",
            $sums,
            ", #0x08080808\n",
        )
    };
}

macro_rules! by_bits {
    ($name:ident, $stride:literal, [$(($even:literal, $odd:literal)),*]) => {
        /// Adds to the columns the bits in which the entering codes differ, and those in which the leaving
        /// ones are equal, but for eight: 21 instructions for four candidates, and 12 for a column. The first
        /// column has the last candidates of the reversed rows `new` and `old`.
        #[inline(never)]
        pub(in super::super) fn $name(
            [enters, leaves]: [&[u8]; 2],
            [new, old]: [&[u8]; 2],
            columns: &mut [[u32; $stride / 4]],
        ) {
            let count = columns.len();
            if count == 0 || [enters, leaves].iter().any(|codes| codes.len() < count) {
                return;
            }
            if [new, old].iter().any(|row| row.len() < count - 1 + $stride) {
                return;
            }
            // SAFETY: of `count` columns the loop reads a code of either row and changes the sums, and reads
            // `stride` codes of either reversed row from place `count - 1` on, for each column from one less.
            unsafe {
                asm!(
                    "2:",
                    // The left codes in every byte, the one that leaves turned over.
                    "ldrb {enters}, [{new_left}], #1",
                    "ldrb {leaves}, [{old_left}], #1",
                    "orr {enters}, {enters}, {enters}, lsl #8",
                    "orr {enters}, {enters}, {enters}, lsl #16",
                    "orr {leaves}, {leaves}, {leaves}, lsl #8",
                    "orr {leaves}, {leaves}, {leaves}, lsl #16",
                    "mvn {leaves}, {leaves}",
                    $(
                        concat!("ldrd {v0}, {v1}, [{sums}, #", $even, "]"),
                        four_by_bits!($even, "{v0}"),
                        four_by_bits!($odd, "{v1}"),
                        concat!("strd {v0}, {v1}, [{sums}, #", $even, "]"),
                    )*
                    "sub {new}, {new}, #1",
                    "sub {old}, {old}, #1",
                    "add {sums}, {sums}, #{stride}",
                    "cmp {sums}, {end}",
                    "bne 2b",
                    new_left = inout(reg) enters.as_ptr() => _,
                    old_left = inout(reg) leaves.as_ptr() => _,
                    new = inout(reg) new.as_ptr().add(count - 1) => _,
                    old = inout(reg) old.as_ptr().add(count - 1) => _,
                    sums = inout(reg) columns.as_mut_ptr() => _,
                    end = in(reg) columns.as_ptr().add(count),
                    stride = const $stride,
                    enters = out(reg) _, leaves = out(reg) _,
                    a = out(reg) _, b = out(reg) _, t = out(reg) _, v0 = out(reg) _, v1 = out(reg) _,
                    options(nostack),
                );
            }
        }
    };
}

by_bits!(by_bits_16, 16, [("0", "4"), ("8", "12")]);
by_bits!(by_bits_32, 32, [("0", "4"), ("8", "12"), ("16", "20"), ("24", "28")]);
by_bits!(by_bits_48, 48, [("0", "4"), ("8", "12"), ("16", "20"), ("24", "28"), ("32", "36"), ("40", "44")]);
by_bits!(
    by_bits_64,
    64,
    [
        ("0", "4"),
        ("8", "12"),
        ("16", "20"),
        ("24", "28"),
        ("32", "36"),
        ("40", "44"),
        ("48", "52"),
        ("56", "60")
    ]
);
