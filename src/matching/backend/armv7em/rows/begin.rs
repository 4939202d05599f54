//! The sums of the first windows.

use super::windows::ACROSS;
use core::arch::asm;

macro_rules! begin {
    ($name:ident, [$($digits:literal),*]) => {
        /// The sums of a window under [`ACROSS`] columns, `words` apart, of sixteen candidates; of no column
        /// they are `none`. 9 instructions a column, and 8 more where only some digits count.
        #[inline(never)]
        pub(in super::super) fn $name(none: u32, columns: &[u32], words: usize, sums: &mut [u32; 4]) {
            if columns.len() < (ACROSS - 1) * words + 4 {
                return;
            }
            let ([mut a, mut b], [mut c, mut d]) = ([none; 2], [none; 2]);
            // SAFETY: of as many columns as are counted four words are read, which there are.
            unsafe {
                asm!(
                    "2:",
                    "ldrd {s}, {t}, [{column}]",
                    "ldrd {u}, {v}, [{column}, #8]",
                    $($digits,)*
                    "uadd8 {a}, {a}, {s}",
                    "uadd8 {b}, {b}, {t}",
                    "uadd8 {c}, {c}, {u}",
                    "uadd8 {d}, {d}, {v}",
                    "add {column}, {column}, {words}, lsl #2",
                    "subs {count}, {count}, #1",
                    "bne 2b",
                    column = inout(reg) columns.as_ptr() => _, words = in(reg) words,
                    count = inout(reg) ACROSS => _,
                    a = inout(reg) a, b = inout(reg) b, c = inout(reg) c, d = inout(reg) d,
                    s = out(reg) _, t = out(reg) _, u = out(reg) _, v = out(reg) _,
                    options(nostack),
                );
            }
            *sums = [a, b, c, d];
        }
    };
}

begin!(begin_fast, []);
begin!(
    begin_block,
    [
        "lsr {s}, {s}, #2",
        "and {s}, {s}, #0x3f3f3f3f",
        "lsr {t}, {t}, #2",
        "and {t}, {t}, #0x3f3f3f3f",
        "lsr {u}, {u}, #2",
        "and {u}, {u}, #0x3f3f3f3f",
        "lsr {v}, {v}, #2",
        "and {v}, {v}, #0x3f3f3f3f"
    ]
);
