//! The median of 3 x 3 answers.

use crate::matching::backend::loops::{HAS_VECTORS, keep_loop};
use crate::units::Disparity;

/// No answer, as a number.
const NONE: u16 = Disparity::NONE.raw();

/// The medians of the second of three rows, pixel by pixel.
#[inline(never)]
pub(in crate::matching::backend) fn median([above, here, below]: [&[Disparity]; 3], out: &mut [Disparity]) {
    let columns = above.iter().zip(here).zip(below);
    let mut columns = columns.map(|((above, here), below)| [above, here, below].map(|d| i32::from(d.raw())));
    const OUTSIDE: [i32; 3] = [NONE as i32; 3];
    let (mut left, mut middle) = (OUTSIDE, columns.next().unwrap_or(OUTSIDE));
    for out in out {
        keep_loop();
        let right = columns.next().unwrap_or(OUTSIDE);
        *out = of_columns([left, middle, right]);
        (left, middle) = (middle, right);
    }
}

/// The median of three columns.
#[inline(always)]
fn of_columns(columns: [[i32; 3]; 3]) -> Disparity {
    let centre = columns[1][1];
    // 1 for no answer.
    let none = |raw: i32| (raw + 1) >> 16;
    // No choice of one or the other: some cores would branch on it.
    let differences = columns.map(|column| column.map(|raw| (raw - centre) * (1 - none(raw))));
    let median = middle_of_nine(differences, |a, b| {
        let less = a.min(b);
        // The other one, without another comparison.
        (less, a ^ b ^ less)
    });
    Disparity::from_raw(((centre + median) | -none(centre)) as u16)
}

/// The middle one of nine, which `order` puts into their order two at a time.
#[inline(always)]
fn middle_of_nine<T: Copy>(nine: [[T; 3]; 3], order: impl Fn(T, T) -> (T, T)) -> T {
    let [left, middle, right] = nine.map(|[a, b, c]| {
        let (a, b) = order(a, b);
        let (b, c) = order(b, c);
        let (a, b) = order(a, b);
        (a, b, c)
    });
    let least = |a: T, b: T| order(a, b).0;
    let most = |a: T, b: T| order(a, b).1;
    let middle_of = |a: T, b: T, c: T| {
        let (a, b) = order(a, b);
        most(a, least(b, c))
    };
    // The middle one of nine is none of those that are less than two others of their kind, nor more than two.
    let low = most(most(left.0, middle.0), right.0);
    let high = least(least(left.2, middle.2), right.2);
    middle_of(low, middle_of(left.1, middle.1, right.1), high)
}

/// Pixels worked on at a time.
const LANES: usize = if HAS_VECTORS { 8 } else { 16 };

/// The medians of a row, pixels side by side.
#[inline(always)]
pub(in crate::matching::backend) fn median_in_rows(rows: [&[Disparity]; 3], out: &mut [Disparity]) {
    let inner = out.len().saturating_sub(2);
    // The last group is moved back to end with the inner pixels.
    let last = inner.saturating_sub(LANES);
    for number in 0..if inner < LANES { 0 } else { inner.div_ceil(LANES) } {
        let begin = last.min(number * LANES);
        let around = rows.map(|row| row.get(begin..).and_then(|r| r.first_chunk::<{ LANES + 2 }>()));
        let out = out.get_mut(begin + 1..).and_then(|o| o.first_chunk_mut::<LANES>());
        if let ([Some(above), Some(here), Some(below)], Some(out)) = (around, out) {
            group([above, here, below], out);
        }
    }
    // The first and the last pixel, and all of a row that is shorter than a group.
    let grouped = if inner < LANES { 1 } else { 1 + inner };
    let mut x = 0;
    while let Some(out) = out.get_mut(x) {
        keep_loop();
        *out = of_columns([x.wrapping_sub(1), x, x + 1].map(|x| column(&rows, x)));
        x = grouped.max(x + 1);
    }
}

/// A column of three rows, no answers outside of them.
#[inline(never)]
fn column(rows: &[&[Disparity]; 3], x: usize) -> [i32; 3] {
    rows.map(|row| i32::from(row.get(x).map_or(NONE, |d| d.raw())))
}

/// The medians of the pixels in the middle.
#[inline(always)]
fn group(rows: [&[Disparity; LANES + 2]; 3], out: &mut [Disparity; LANES]) {
    let beside = |by: usize| {
        rows.map(|row| {
            row.get(by..).and_then(|row| row.first_chunk::<LANES>()).unwrap_or(&[Disparity::NONE; LANES])
        })
    };
    let ([a, b, c], [d, e, f], [g, h, k]) = (beside(0), beside(1), beside(2));
    for i in 0..LANES {
        // Not in a closure: where that is a function, it leaves a panic.
        let nine = [[a[i], b[i], c[i]], [d[i], e[i], f[i]], [g[i], h[i], k[i]]];
        let centre = e[i].raw();
        let nine = nine
            .map(|column| column.map(|answer| if answer == Disparity::NONE { centre } else { answer.raw() }));
        let median = middle_of_nine(nine, |a, b| (a.min(b), a.max(b)));
        out[i] = Disparity::from_raw(if centre == NONE { NONE } else { median });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_one_is_the_fifth() {
        // All orders of nine that differ by which are small, for every number of small ones.
        for small in 0..1 << 9 {
            let bit = |i: usize| small >> i & 1;
            let nine = [0, 1, 2].map(|c| [0, 1, 2].map(|r| bit(3 * c + r)));
            let ones = (0..9).map(bit).sum::<i32>();
            assert_eq!(
                middle_of_nine(nine, |a, b| (a.min(b), a.max(b))),
                i32::from(ones >= 5),
                "{small:09b}"
            );
        }
    }

    #[test]
    fn what_is_missing_counts_as_the_middle() {
        let row = |raws: [u16; 3]| raws.map(Disparity::from_raw);
        let (above, here, below) = (row([NONE, 330, NONE]), row([64, 65_000, NONE]), row([322, 321, 320]));
        let mut out = row([0; 3]);
        median([&above, &here, &below], &mut out);
        assert_eq!(out.map(Disparity::raw), [64, 330, NONE]);
    }
}
