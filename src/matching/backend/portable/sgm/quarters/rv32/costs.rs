//! The costs of pixels.

use super::row::{BELOW, has_eight};
use crate::matching::backend::parameters::SgmParameters;
use crate::matching::backend::portable::sgm::quarters::columns::FOUR;
use crate::matching::backend::portable::sgm::quarters::lanes::{ONE, TOP};
use crate::matching::backend::portable::sgm::quarters::others::{Costs, NUMBERS, Others};
use core::arch::asm;

/// A number, at so many bytes, of the five that go with a word of a column.
macro_rules! number {
    ($number:literal, $place:literal, $offset:literal) => {
        concat!("lw {", $number, "}, 5*", $place, "+", $offset, "({others})\n")
    };
}

/// The agreement of a pixel with the four whose word stands at so many bytes from `columns`, with the margin,
/// in `v`. 48 instructions.
macro_rules! agreement_of {
    ($place:literal) => {
        concat!(
            number!("v", $place, "0"),
            number!("w", $place, "4"),
            op!("sub", "v", "v", "along"),
            op!("add", "w", "w", "along"),
            cut!("v"),
            cut!("w"),
            op!("or", "v", "v", "w"),
            number!("w", $place, "8"),
            op!("sub", "w", "across", "w"),
            op!("and", "t", "w", "top"),
            op!("mulhu", "t", "t", "below"),
            op!("and", "t", "t", "w"),
            op!("add", "v", "v", "t"),
            by!("slli", "v", "v", "1"),
            op!("sub", "v", "most", "v"),
            op!("add", "v", "v", "w"),
            // Bits of the census.
            number!("w", $place, "12"),
            op!("xor", "w", "w", "census"),
            by!("srli", "t", "w", "1"),
            op!("and", "t", "t", "twos"),
            op!("sub", "w", "w", "t"),
            op!("and", "t", "w", "fours"),
            by!("srli", "w", "w", "2"),
            op!("and", "w", "w", "fours"),
            op!("add", "w", "w", "t"),
            by!("srli", "t", "w", "4"),
            op!("add", "w", "w", "t"),
            op!("and", "w", "w", "eights"),
            op!("sub", "v", "v", "w"),
            // A quarter of the brightness.
            number!("w", $place, "16"),
            op!("sub", "w", "brightness", "w"),
            op!("and", "t", "w", "top"),
            op!("mulhu", "t", "t", "below"),
            op!("and", "t", "t", "w"),
            by!("slli", "t", "t", "1"),
            op!("sub", "t", "t", "w"),
            op!("add", "t", "t", "top"),
            by!("srli", "t", "t", "2"),
            op!("and", "t", "t", "quarters"),
            op!("sub", "v", "v", "t"),
            cut!("v"),
            op!("add", "v", "v", "margin"),
        )
    };
}

/// Makes a difference that is marked what it is over 128, or 0. 3 instructions.
macro_rules! cut {
    ($difference:literal) => {
        concat!(
            op!("and", "t", $difference, "top"),
            op!("mulhu", "t", "t", "below"),
            op!("and", $difference, $difference, "t"),
        )
    };
}

/// The loops over pixels and the words of their columns, `fours` in a round or `eight` in all, of which
/// `$put` makes and writes each.
macro_rules! costs {
    ($(#[$doc:meta])* $name:ident, $words:ident, $put:ident $(, $name_of_mask:ident = $mask:expr)?) => {
        $(#[$doc])*
        #[inline(never)]
        unsafe fn $name(row: &Pixels, most: u32, margin: u32, columns: *mut u32) {
            // SAFETY: as the caller says.
            unsafe {
                asm!(
                    "1:",
                    // What the pixel looks like, four times.
                    "lbu {along}, 0({looks})",
                    "add {t}, {looks}, {width}",
                    "lbu {across}, 0({t})",
                    "add {t}, {t}, {width}",
                    "lbu {census}, 0({t})",
                    "lbu {brightness}, 0({bright})",
                    "addi {looks}, {looks}, 1",
                    "addi {bright}, {bright}, 1",
                    "srli {brightness}, {brightness}, 1",
                    "mul {along}, {along}, {ones}",
                    "mul {across}, {across}, {ones}",
                    "mul {census}, {census}, {ones}",
                    "mul {brightness}, {brightness}, {ones}",
                    "or {across}, {across}, {top}",
                    "or {brightness}, {brightness}, {top}",
                    // Five numbers for each word of a column.
                    "mv {others}, {first}",
                    "addi {first}, {first}, {group}",
                    "add {end}, {columns}, {size}",
                    words!($words, $put, "columns"; "addi {others}, {others}, 80\n"),
                    "addi {count}, {count}, -1",
                    "bnez {count}, 1b",
                    first = inout(reg) row.others => _, looks = inout(reg) row.looks => _,
                    bright = inout(reg) row.brightness => _, width = in(reg) row.width,
                    count = inout(reg) row.count => _, size = in(reg) row.size,
                    columns = inout(reg) columns => _, end = out(reg) _, others = out(reg) _,
                    along = out(reg) _, across = out(reg) _, census = out(reg) _, brightness = out(reg) _,
                    t = out(reg) _, v = out(reg) _, w = out(reg) _, most = in(reg) most,
                    margin = in(reg) margin, $($name_of_mask = in(reg) $mask,)?
                    top = in(reg) TOP, ones = in(reg) ONE, below = in(reg) BELOW,
                    twos = in(reg) 0x5555_5555, fours = in(reg) 0x3333_3333, eights = in(reg) 0x0f0f_0f0f,
                    quarters = in(reg) 0x3f3f_3f3f, group = const NUMBERS * size_of::<u32>(),
                    options(nostack),
                );
            }
        }
    };
}

/// Writes the agreement that belongs at so many bytes from `columns`. 49 instructions.
macro_rules! put_word {
    ($place:literal) => {
        concat!(agreement_of!($place), at!("sw", "v", $place, "columns"))
    };
}

/// Writes the average of that agreement and what stands there. 53 instructions.
macro_rules! average {
    ($place:literal) => {
        concat!(
            agreement_of!($place),
            at!("lw", "t", $place, "columns"),
            op!("add", "v", "v", "t"),
            by!("srli", "v", "v", "1"),
            op!("and", "v", "v", "low"),
            at!("sw", "v", $place, "columns"),
        )
    };
}

/// What assembly takes of a row's pixels.
struct Pixels {
    others: *const Others,
    /// The left image's features of three kinds, one `width` behind the other, and its brightness.
    looks: *const u8,
    brightness: *const u8,
    width: usize,
    count: usize,
    /// Bytes of a column.
    size: usize,
}

costs! {
    /// Puts a row's agreements. 195 instructions, and 20 for a pixel.
    ///
    /// # Safety
    /// What `row` says is there, and columns of its pixels, which are not 0, of its size.
    put_fours, fours, put_word
}
costs! {
    /// Averages a row's agreements into its columns. 215 instructions, and 20 for a pixel.
    ///
    /// # Safety
    /// As of [`put_fours`].
    average_fours, fours, average, low = !TOP
}
costs! {
    /// [`put_fours`] in columns of eight words. 384 instructions in all, and 21 for a pixel.
    ///
    /// # Safety
    /// As of that; a column has eight words.
    put_eight, eight, put_word
}
costs! {
    /// [`average_fours`] in columns of eight words. 424 instructions in all, and 21 for a pixel.
    ///
    /// # Safety
    /// As of [`put_eight`].
    average_eight, eight, average, low = !TOP
}

/// See `rounds::plain`.
#[inline(always)]
pub(in super::super) fn enter<S: SgmParameters, const WORDS: usize, const ALL: bool>(
    costs: &Costs<'_>,
    x: usize,
    others: &[Others],
    columns: &mut [u32],
) {
    let Costs { left, rounds, most, margin } = *costs;
    let (words, width) = (FOUR * rounds, left.brightness.len());
    let count = columns.len() / words.max(1);
    let is_there = x + count <= width && 3 * width <= left.rows.len() && count + words <= others.len() + 1;
    if words == 0 || count == 0 || !is_there {
        return;
    }
    let looks = left.rows.as_ptr().wrapping_add(x);
    let brightness = left.brightness.as_ptr().wrapping_add(x);
    let row = Pixels { others: others.as_ptr(), looks, brightness, width, count, size: 4 * words };
    // SAFETY: so many pixels from `x` on have all they look like; the last one's others are there, as all
    // pixels' columns.
    unsafe {
        match (S::WITHIN_EDGES, has_eight::<WORDS, ALL>()) {
            (true, false) => put_fours(&row, most, margin, columns.as_mut_ptr()),
            (true, true) => put_eight(&row, most, margin, columns.as_mut_ptr()),
            (false, false) => average_fours(&row, most, margin, columns.as_mut_ptr()),
            (false, true) => average_eight(&row, most, margin, columns.as_mut_ptr()),
        }
    }
}
