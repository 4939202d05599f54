//! Scores of FAST-9 and smoothing for four pixels at a time, in Arm's instructions on four bytes of a word
//! and on its halves (`--cfg stereopsis_dsp`: Cortex-M4, M7, and M33 that have them).
#![allow(unsafe_code)]

use super::circle::CIRCLE;
use core::arch::asm;

/// Pixels at a time.
pub(super) const PIXELS: usize = 4;
/// Columns that their circles lie in.
pub(super) const COLUMNS: usize = PIXELS + 6;

macro_rules! two_operands {
    ($(#[$doc:meta])* $name:ident: $($instruction:literal),*) => {
        $(#[$doc])*
        #[inline(always)]
        fn $name(a: u32, b: u32) -> u32 {
            let out;
            // SAFETY: instructions on registers alone, of the extension that `--cfg stereopsis_dsp` says is
            // there. The marks of lanes are not said to be preserved.
            unsafe {
                asm!($($instruction),*, out = out(reg) out, a = in(reg) a, b = in(reg) b,
                    options(pure, nomem, nostack));
            }
            out
        }
    };
}

two_operands!(
    /// The differences of bytes, 0 where `b` is more.
    difference: "uqsub8 {out}, {a}, {b}"
);
two_operands!(
    /// The lesser bytes: the subtraction marks the lanes that do not borrow, and `sel` picks by the marks.
    min: "usub8 {out}, {a}, {b}", "sel {out}, {b}, {a}"
);
two_operands!(
    /// The greater bytes, likewise.
    max: "usub8 {out}, {a}, {b}", "sel {out}, {a}, {b}"
);

/// The bytes of `a` that are more than those of `least`, 0 for the others.
#[inline(always)]
fn over(a: u32, least: u32) -> u32 {
    let out;
    // SAFETY: as above.
    unsafe {
        asm!("usub8 {out}, {least}, {a}", "sel {out}, {none}, {a}", out = out(reg) out, a = in(reg) a,
            least = in(reg) least, none = in(reg) 0, options(pure, nomem, nostack));
    }
    out
}

/// The scores of four pixels whose circles lie in these rows, from the first column on.
///
/// What is asked of all sixteen differences to the pixel is asked of the circle itself, and the pixel is
/// subtracted afterwards: the weakest of nine brighter ones is the least of nine.
#[inline(always)]
pub(super) fn scores_of_four(rows: &[&[u8; COLUMNS]; 7], threshold: u8) -> [u8; PIXELS] {
    let four = |row: usize, column: usize| {
        let bytes = rows.get(row).and_then(|row| row.get(column..)).and_then(|row| row.first_chunk());
        bytes.map_or(0, |bytes| u32::from_le_bytes(*bytes))
    };
    let on_circle = |i: usize| {
        let (row, column) = CIRCLE[i & 15];
        four(row, column)
    };
    let (centre, least) = (four(3, 3), u32::from(threshold) * 0x0101_0101);
    // Nine of sixteen in a row hold one of every two that lie opposite to each other.
    let [up, right, down, left] = [0, 4, 8, 12].map(on_circle);
    let brightest = min(max(up, down), max(left, right));
    let darkest = max(min(up, down), min(left, right));
    let is_none = |differences: u32| difference(differences, least) == 0;
    let (none_brighter, none_darker) =
        (is_none(difference(brightest, centre)), is_none(difference(centre, darkest)));
    if none_brighter && none_darker {
        return [0; PIXELS];
    }
    let circle: [u32; 16] = core::array::from_fn(on_circle);
    let mut scores = 0;
    if !none_brighter {
        scores = over(difference(best_of_nine(&circle, min, max), centre), least);
    }
    if !none_darker {
        scores = max(scores, over(difference(centre, best_of_nine(&circle, max, min)), least));
    }
    scores.to_le_bytes()
}

/// The best of all `worst` of nine in a row, around the circle, as [`super::fast`] says it.
#[inline(always)]
fn best_of_nine(circle: &[u32; 16], worst: fn(u32, u32) -> u32, best: fn(u32, u32) -> u32) -> u32 {
    let value = |i: usize| circle[i & 15];
    let twos: [u32; 8] = core::array::from_fn(|i| worst(value(2 * i + 1), value(2 * i + 2)));
    let fours: [u32; 8] = core::array::from_fn(|i| worst(twos[i & 7], twos[(i + 1) & 7]));
    let nine = |i: usize| {
        let eight = worst(fours[i & 7], fours[(i + 2) & 7]);
        worst(eight, best(value(2 * i), value(2 * i + 9)))
    };
    (1..8).fold(nine(0), |all, i| best(all, nine(i)))
}

/// Sums of four columns of five rows by the weights of [`super::binomial`]: those of the first and the third
/// in the halves of a word, and those of the other two.
#[inline(always)]
pub(super) fn column_sums(rows: [&[u8; PIXELS]; 5]) -> [u32; 2] {
    let words = rows.map(|row| u32::from_le_bytes(*row));
    [0, 8].map(|shift| weighted(words.map(|word| word >> shift & 0x00ff_00ff)))
}

/// Four smoothed pixels, from the sums of their columns and of the two on either side.
#[inline(always)]
pub(super) fn smooth_four([[a, b], [c, d]]: [[u32; 2]; 2]) -> [u8; PIXELS] {
    // Columns 2 and 4, 3 and 5: those in `a` are 0 and 2, in `b` 1 and 3, in `c` 4 and 6, in `d` 5 and 7.
    let (even, odd) = (a >> 16 | c << 16, b >> 16 | d << 16);
    let (first, second) = (weighted([a, b, even, odd, c]), weighted([b, even, odd, c, d]));
    let [first, second] = [first, second].map(|sums| sums.wrapping_add(0x0080_0080));
    (first >> 8 & 0x00ff_00ff | second & 0xff00_ff00).to_le_bytes()
}

/// The weighted sums in the halves of words, at most 65280.
#[inline(always)]
fn weighted([a, b, c, d, e]: [u32; 5]) -> u32 {
    let outer = a.wrapping_add(e).wrapping_add(b.wrapping_add(d) << 2);
    outer.wrapping_add(c << 1).wrapping_add(c << 2)
}
