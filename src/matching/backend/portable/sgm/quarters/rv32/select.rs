//! The path from the right, and the winners of the paths' sums, of pixels that are asked for nothing else.

use super::row::{BELOW, CHANGES, JUMPS, Row};
use crate::matching::backend::portable::sgm::quarters::lanes::{NO_SUM, ONES, TOP};
use crate::matching::memory::winners::Winner;
use core::arch::asm;
use core::mem::offset_of;

/// Where the last one of the pixels has its kind of change, its columns and its winner, and where the path's
/// column is, of zeros, which is the same for all, with room for a second one behind it.
pub(super) struct Selected {
    pub kinds: *const u8,
    pub costs: *const u32,
    pub sums: *const u32,
    pub winners: *mut Winner,
    pub path: *mut u32,
    /// How many are searched.
    pub disparities: usize,
}

/// What the word is that was before, less its costs; and the least so far.
macro_rules! put_path {
    ($path:literal, $offset:literal) => {
        concat!(
            at!("lw", "t", $offset, "costs"),
            op!("sub", $path, $path, "t"),
            at!("sw", $path, $offset, "path"),
            lesser!("least", $path),
        )
    };
}

/// Makes the least of half the lanes, which is one word older, that of it and those in `t`.
macro_rules! lesser_of_older {
    ($least:literal) => {
        concat!(
            op!("add", $least, $least, "step"),
            op!("sub", "t", $least, "t"),
            op!("and", "u", "t", "bound"),
            op!("mulhu", "u", "u", "behind"),
            op!("and", "t", "t", "u"),
            op!("sub", $least, $least, "t"),
        )
    };
}

/// A word of the path and one of sums.
macro_rules! sum {
    ($offset:literal) => {
        concat!(
            at!("lw", "a", $offset, "path"),
            at!("lw", "b", $offset, "sums"),
            op!("and", "t", "a", "even"),
            op!("and", "u", "b", "even"),
            op!("add", "t", "t", "u"),
            by!("slli", "t", "t", "6"),
            lesser_of_older!("c"),
            by!("srli", "a", "a", "2"),
            by!("srli", "b", "b", "2"),
            op!("and", "a", "a", "odd"),
            op!("and", "b", "b", "odd"),
            op!("add", "t", "a", "b"),
            lesser_of_older!("d"),
        )
    };
}

/// Makes `a` the sum in `t` and `b` its lane, counted from the last one, if it is less than the sum in `a`.
macro_rules! lesser_lane {
    ($lane:literal) => {
        concat!(
            by!("andi", "u", "a", "-64"),
            "bgeu {t}, {u}, 5f\n mv {a}, {t}\n",
            concat!("li {b}, ", $lane, "\n5:\n"),
        )
    };
}

/// Makes a sum of two bytes a cost, up to 255, which is in `step`.
macro_rules! up_to_255 {
    ($sum:literal) => {
        concat!(
            op!("sub", $sum, $sum, "more"),
            concat!("bge {step}, {", $sum, "}, 6f\n mv {", $sum, "}, {step}\n6:\n"),
        )
    };
}

/// Moves from a column's end to its start; through eight words nothing has moved.
macro_rules! from_its_start {
    (fours) => {
        op!("sub", "path", "end", "size")
    };
    (eight) => {
        ""
    };
}

/// The loop over pixels, through whose columns it goes in `fours` of words or in `eight` at once.
macro_rules! select {
    ($(#[$doc:meta])* $name:ident, $words:ident) => {
        $(#[$doc])*
        #[inline(never)]
        pub(super) unsafe fn $name(row: &Row, pixels: Selected, count: usize) {
            let Selected { kinds, costs, sums, winners, path, disparities } = pixels;
            // SAFETY: as the caller says.
            unsafe {
                asm!(
                    "1:",
                    // What the change from the pixel behind costs; then that from the one before.
                    "lw {step}, {changes}({change})",
                    "lw {bound}, {jumps}({change})",
                    "lw {more}, {of_more}({row})",
                    "sub {more}, {more}, {bound}",
                    "lbu {change}, 0({kinds})",
                    "addi {kinds}, {kinds}, -1",
                    "sub {change}, {row}, {change}",
                    "lw {t}, {jumps}({change})",
                    "sub {more}, {more}, {t}",
                    "add {bound}, {bound}, {least}",
                    "srli {t}, {top}, 7",
                    "mul {bound}, {bound}, {t}",
                    "lw {b}, 0({path})",
                    "lw {c}, {far}({row})",
                    beside!("c"),
                    "li {least}, -1",
                    column!($words, "path", put_path, "costs"),
                    least_of_four!("least"),
                    from_its_start!($words),
                    "bltu {count}, {searched}, 10f",
                    // The least sums of the even and of the odd lanes.
                    "11:",
                    "li {step}, {ones_of_halves}",
                    "li {bound}, 0x80008000",
                    "li {behind}, 0xfffe0000",
                    "li {c}, {none}",
                    "mv {d}, {c}",
                    words!($words, sum, "path", "sums"),
                    // Of equal sums the last lane's is the one of the smallest disparity.
                    "li {step}, 255",
                    "li {b}, 0",
                    "srli {a}, {d}, 16",
                    concat!("srli {t}, {c}, 16\n", lesser_lane!("1")),
                    concat!("slli {t}, {d}, 16\n srli {t}, {t}, 16\n", lesser_lane!("2")),
                    concat!("slli {t}, {c}, 16\n srli {t}, {t}, 16\n", lesser_lane!("3")),
                    // Words behind it, and its cost.
                    "andi {c}, {a}, 63",
                    "srli {a}, {a}, 6",
                    "andi {a}, {a}, 0x1ff",
                    up_to_255!("a"),
                    // Behind the candidate's byte in both columns; and its disparity.
                    "slli {t}, {c}, 2",
                    "add {t}, {t}, {b}",
                    "sub {u}, {path}, {t}",
                    "sub {t}, {sums}, {t}",
                    "srli {d}, {size}, 2",
                    "mul {b}, {b}, {d}",
                    "add {b}, {b}, {c}",
                    // Above and below, which are in another lane at the ends of one.
                    "addi {d}, {d}, -1",
                    "beq {c}, {d}, 7f",
                    "beqz {c}, 8f",
                    "lbu {bound}, -5({u})",
                    "lbu {behind}, -5({t})",
                    "3:",
                    "lbu {c}, 3({u})",
                    "lbu {d}, 3({t})",
                    "4:",
                    "add {bound}, {bound}, {behind}",
                    up_to_255!("bound"),
                    "add {c}, {c}, {d}",
                    up_to_255!("c"),
                    // Where there is none on one side, the other one.
                    "addi {d}, {b}, 1",
                    "bgeu {d}, {count}, 18f",
                    "bgeu {d}, {searched}, 18f",
                    "19:",
                    "bnez {b}, 5f",
                    "mv {c}, {bound}",
                    "5:",
                    "slli {a}, {a}, 8",
                    "or {c}, {c}, {a}",
                    "slli {bound}, {bound}, 16",
                    "or {c}, {c}, {bound}",
                    "slli {b}, {b}, 24",
                    "or {c}, {c}, {b}",
                    "sw {c}, 0({winners})",
                    "addi {winners}, {winners}, -4",
                    // The columns before.
                    "bltu {count}, {searched}, 14f",
                    "15:",
                    "sub {path}, {end}, {size}",
                    "slli {t}, {size}, 1",
                    "sub {costs}, {costs}, {t}",
                    "sub {sums}, {sums}, {t}",
                    "addi {count}, {count}, -1",
                    "bnez {count}, 1b",
                    "j 9f",
                    "7:",
                    "add {behind}, {u}, {size}",
                    "lbu {bound}, -6({behind})",
                    "add {behind}, {t}, {size}",
                    "lbu {behind}, -6({behind})",
                    "j 3b",
                    "8:",
                    "lbu {bound}, -5({u})",
                    "lbu {behind}, -5({t})",
                    "sub {u}, {u}, {size}",
                    "sub {t}, {t}, {size}",
                    "lbu {c}, 4({u})",
                    "lbu {d}, 4({t})",
                    "j 4b",
                    // Of fewer candidates than are searched: the other lanes' sums are more than any.
                    "10:",
                    "sub {a}, {size}, {count}",
                    "srli {d}, {size}, 2",
                    "li {b}, 0",
                    "12:",
                    "bltu {a}, {d}, 13f",
                    "sub {a}, {a}, {d}",
                    "slli {b}, {b}, 8",
                    "ori {b}, {b}, 255",
                    "j 12b",
                    "13:",
                    "slli {c}, {b}, 8",
                    "ori {c}, {c}, 255",
                    "slli {a}, {a}, 2",
                    "add {a}, {path}, {a}",
                    "mv {step}, {end}",
                    "beq {path}, {a}, 17f",
                    "16:",
                    "lw {t}, 0({path})",
                    "lw {u}, 0({sums})",
                    "or {t}, {t}, {c}",
                    "or {u}, {u}, {c}",
                    "sw {t}, 0({step})",
                    "sw {u}, 0({sums})",
                    "addi {path}, {path}, 4",
                    "addi {sums}, {sums}, 4",
                    "addi {step}, {step}, 4",
                    "bne {path}, {a}, 16b",
                    "17:",
                    "mv {c}, {b}",
                    "mv {a}, {end}",
                    "bne {path}, {end}, 16b",
                    "mv {end}, {step}",
                    "sub {sums}, {sums}, {size}",
                    "j 11b",
                    "14:",
                    "sub {end}, {end}, {size}",
                    "j 15b",
                    // The last candidate, and the only one.
                    "18:",
                    "mv {bound}, {c}",
                    "bnez {b}, 19b",
                    "mv {bound}, {a}",
                    "j 19b",
                    "9:",
                    kinds = inout(reg) kinds => _, count = inout(reg) count => _,
                    costs = inout(reg) costs => _,
                    sums = inout(reg) sums => _, winners = inout(reg) winners => _,
                    path = inout(reg) path => _,
                    end = in(reg) path.wrapping_byte_add(row.size), change = inout(reg) row => _,
                    least = inout(reg) 0 => _, row = in(reg) row, size = in(reg) row.size,
                    even = in(reg) 0x00ff_00ff, odd = in(reg) 0x3fc0_3fc0, more = out(reg) _,
                    a = out(reg) _, b = out(reg) _, c = out(reg) _, d = out(reg) _,
                    t = out(reg) _, u = out(reg) _,
                    step = out(reg) _, bound = out(reg) _, behind = out(reg) _,
                    top = in(reg) TOP, searched = in(reg) disparities, below = in(reg) BELOW,
                    changes = const CHANGES, jumps = const JUMPS,
                    far = const offset_of!(Row, steps.far), of_more = const offset_of!(Row, more),
                    none = const NO_SUM, ones_of_halves = const ONES, options(nostack),
                );
            }
        }
    };
}

select! {
    /// Takes the path from right to left through so many pixels and selects their winners. 107 and 95
    /// instructions, and 105 for a pixel; 45 and 10 a word more where there are fewer candidates.
    ///
    /// # Safety
    /// There are so many pixels, one at least, and of each a column of the row's size of costs and of sums, a
    /// kind, and the place of a winner, which is written, as the path's column is.
    select_fours, fours
}
select! {
    /// [`select_fours`] of columns of eight words. 208 and 184 instructions in all, and 107 for a pixel.
    ///
    /// # Safety
    /// As of that; a column has eight words.
    select_eight, eight
}
