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
        pub(super) fn $name(a: u32, b: u32) -> u32 {
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
    /// The greater bytes: `sel` picks by the marks of the subtraction.
    max: "usub8 {out}, {a}, {b}", "sel {out}, {a}, {b}"
);

two_operands!(
    /// The halves of `a` and the bytes 0 and 2 of `b`.
    plus_even: "uxtab16 {out}, {a}, {b}"
);
two_operands!(
    /// The halves of `a` and the bytes 1 and 3 of `b`.
    plus_odd: "uxtab16 {out}, {a}, {b}, ror #8"
);

/// The greater bytes and the lesser ones, from one subtraction.
#[inline(always)]
fn max_min([a, b]: [u32; 2]) -> (u32, u32) {
    let (greater, lesser);
    // SAFETY: instructions on registers alone, of the extension that `--cfg stereopsis_dsp` says is there.
    unsafe {
        asm!("usub8 {greater}, {a}, {b}", "sel {greater}, {a}, {b}", "sel {lesser}, {b}, {a}",
            greater = out(reg) greater, lesser = out(reg) lesser, a = in(reg) a, b = in(reg) b,
            options(pure, nomem, nostack));
    }
    (greater, lesser)
}

/// The bytes of `chosen` where those of `a` are more than those of `least`, 0 for the others.
#[inline(always)]
pub(super) fn where_more(a: u32, least: u32, chosen: u32) -> u32 {
    let out;
    // SAFETY: instructions on registers alone, of the extension that `--cfg stereopsis_dsp` says is there.
    unsafe {
        asm!("usub8 {out}, {least}, {a}", "sel {out}, {none}, {chosen}", out = out(reg) out, a = in(reg) a,
            least = in(reg) least, none = in(reg) 0, chosen = in(reg) chosen,
            options(pure, nomem, nostack));
    }
    out
}

/// The bytes of `chosen` where those of `a` are no more than those of `most`, 0 for the others.
#[inline(always)]
fn unless_more(a: u32, most: u32, chosen: u32) -> u32 {
    let out;
    // SAFETY: instructions on registers alone, of the extension that `--cfg stereopsis_dsp` says is there.
    unsafe {
        asm!("usub8 {out}, {most}, {a}", "sel {out}, {chosen}, {none}", out = out(reg) out, a = in(reg) a,
            most = in(reg) most, none = in(reg) 0, chosen = in(reg) chosen, options(pure, nomem, nostack));
    }
    out
}

/// Which of four pixels, whose circles lie in these rows from the first column on, may have nine neighbours
/// in a row that are brighter by more than `least`: the bytes that are not 0. And which ones may have nine
/// that are darker: 255, the others 0.
#[inline(always)]
pub(super) fn brighter_and_darker(rows: &[&[u8; COLUMNS]; 7], least: u32) -> [u32; 2] {
    let centre = four(rows, (3, 3));
    // Nine of sixteen in a row hold one of every two that lie opposite to each other.
    let [(a, e), (b, f), (c, g), (d, h)] =
        [0, 4, 2, 6].map(|i| max_min([i, i + 8].map(|i| on_circle(rows, i))));
    let (brightest, darkest) = (min(min(a, b), min(c, d)), max(max(e, f), max(g, h)));
    let brighter = difference(difference(brightest, centre), least);
    [brighter, where_more(difference(centre, darkest), least, u32::MAX)]
}

/// The scores of four pixels, by how much their neighbours are brighter, or darker where all is `inverted`.
///
/// What is asked of all sixteen differences to the pixel is asked of the circle itself, and the pixel is
/// subtracted afterwards: the weakest of nine brighter ones is the least of nine.
#[inline(always)]
pub(super) fn scores_of_four(rows: &[&[u8; COLUMNS]; 7], least: u32, inverted: u32) -> u32 {
    let nine = least_of_best_nine(|i| on_circle(rows, i) ^ inverted);
    let more = difference(nine, four(rows, (3, 3)) ^ inverted);
    where_more(more, least, more)
}

/// The neighbours of four pixels at one place of the circle.
#[inline(always)]
fn on_circle(rows: &[&[u8; COLUMNS]; 7], i: usize) -> u32 {
    four(rows, CIRCLE[i & 15])
}

/// Four pixels from a row and a column on.
#[inline(always)]
fn four<const N: usize>(rows: &[&[u8; N]], (row, column): (usize, usize)) -> u32 {
    let bytes = rows.get(row).and_then(|row| row.get(column..)).and_then(|row| row.first_chunk());
    bytes.map_or(0, |bytes| u32::from_le_bytes(*bytes))
}

/// The greatest of all minima of nine in a row, around the circle.
///
/// Of the eight nines that begin at `i` to `i + 7`, the first four hold the four neighbours before `i + 7`,
/// the others the four after `i + 8`, and all hold these two.
#[inline(always)]
fn least_of_best_nine(value: impl Fn(usize) -> u32) -> u32 {
    let twos: [u32; 8] = core::array::from_fn(|i| min(value(2 * i + 1), value(2 * i + 2)));
    let two = |i: usize| twos[(i / 2) & 7];
    // Of four nines that begin at `i` to `i + 3`, what not all of them hold.
    let four = |i: usize| {
        let first = min(two(i + 1), max(value(i), value(i + 9)));
        max(first, min(two(i + 9), max(value(i + 2), value(i + 11))))
    };
    let eight = |i: usize| {
        let first = min(four(i), min(two(i + 3), two(i + 5)));
        let second = min(four(i + 4), min(two(i + 9), two(i + 11)));
        min(max(first, second), two(i + 7))
    };
    max(eight(0), eight(8))
}

/// Which of four scores are local maxima, for [`super::maxima`].
#[inline(always)]
pub(super) fn maxima_of_four(rows: [&[u8; PIXELS + 2]; 3]) -> u32 {
    let four = |row: usize, column: usize| four(&rows, (row, column));
    let here = four(1, 1);
    let before = max(max(four(0, 0), four(0, 1)), max(four(0, 2), four(1, 0)));
    let after = max(max(four(2, 0), four(2, 1)), max(four(2, 2), four(1, 2)));
    unless_more(after, here, difference(here, before))
}

/// Sums of four columns of five rows by the weights of [`super::binomial`]: those of the first and the third
/// in the halves of a word, and those of the other two.
#[inline(always)]
pub(super) fn column_sums(rows: [&[u8; PIXELS]; 5]) -> [u32; 2] {
    let [a, b, c, d, e] = rows.map(|row| u32::from_le_bytes(*row));
    let sums = |plus: fn(u32, u32) -> u32| sum(plus(plus(0, a), e), plus(plus(0, b), d), plus(0, c));
    [sums(plus_even), sums(plus_odd)]
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
    sum(a.wrapping_add(e), b.wrapping_add(d), c)
}

/// The weighted sums of the outer two, the inner two and the middle one.
#[inline(always)]
fn sum(outer: u32, inner: u32, middle: u32) -> u32 {
    outer.wrapping_add(inner.wrapping_add(middle) << 2).wrapping_add(middle << 1)
}
