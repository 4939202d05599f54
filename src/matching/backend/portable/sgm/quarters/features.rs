//! What a pixel's cost compares, of four pixels at a time: gradients in half-words, of the even and the odd
//! pixels; all else in bytes.

use super::lanes::{TOP, average, over};
use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::portable::sgm::features::FeatureRows;
use crate::matching::backend::portable::sgm::features_by_four::{
    COLUMNS, Group, REACH, columns, groups, put,
};
use crate::matching::memory::Rows5;
use crate::matching::memory::slices::{part, part_mut};

/// Features in plain Rust, four bytes or two half-words in a word.
pub(in crate::matching::backend) struct WordRows;

impl FeatureRows for WordRows {
    /// The features of as many columns as there is a place for: [`gradients`](crate::imaging::gradients) and
    /// [`census_wide8`](crate::imaging::census_wide8). Behind the line it goes on.
    fn looks(lines: &Rows5<'_>, gradient: u8, [along, across, census]: [&mut [u8]; 3]) {
        let width = lines.iter().fold(usize::MAX, |width, line| width.min(line.len()));
        let count = along.len().min(across.len()).min(census.len());
        let groups = groups(width, count);
        let [above2, above, here, below, below2] = *lines;
        codes([above2, here, below2], places(census, groups));
        gradients([above, here, below], gradient, [places(along, groups), places(across, groups)]);
        let after = REACH + groups * COLUMNS;
        let behind = count.min(width).saturating_sub(after).div_ceil(COLUMNS);
        for x in core::iter::once(0).chain((0..behind).map(|group| after + group * COLUMNS)) {
            let near =
                lines.map(|line| [0, 1, 2].map(|word| columns(part(line, ..width), x + word * COLUMNS)));
            let [above2, above, here, below, below2] = near.each_ref().map(|near| near.as_flattened());
            let [mut code, mut one, mut other] = [[[0; COLUMNS]]; 3];
            codes([above2, here, below2], &mut code);
            gradients([above, here, below], gradient, [&mut one, &mut other]);
            for (row, [four]) in [(&mut *along, one), (&mut *across, other), (&mut *census, code)] {
                put(part_mut(row, x..), four);
            }
        }
    }

    /// Half of each number.
    fn halve(numbers: &[u8], halves: &mut [u8]) {
        let count = numbers.len().min(halves.len());
        let (groups, rest) = part(numbers, ..count).as_chunks::<COLUMNS>();
        let (of_groups, of_rest) = part_mut(halves, ..count).as_chunks_mut::<COLUMNS>();
        for (to, &from) in of_groups.iter_mut().zip(groups) {
            keep_loop();
            *to = (u32::from_le_bytes(from) >> 1 & !TOP).to_le_bytes();
        }
        for (to, from) in of_rest.iter_mut().zip(rest) {
            keep_loop();
            *to = from >> 1;
        }
    }

    /// The ranges of all numbers but the two at the ends.
    #[inline(never)]
    fn range(numbers: &[u8], least: &mut [u8], greatest: &mut [u8]) {
        let count = numbers.len().saturating_sub(2);
        let [before, here, next] =
            [0, 1, 2].map(|from| part(numbers, from..from + count).as_chunks::<COLUMNS>());
        let [(low, low_rest), (high, high_rest)] =
            [least, greatest].map(|row| part_mut(row, 1..=count).as_chunks_mut::<COLUMNS>());
        let fours = before.0.iter().zip(here.0).zip(next.0);
        for ((low, high), ((before, here), next)) in low.iter_mut().zip(high).zip(fours) {
            keep_loop();
            let (least, greatest) = ranges([before, here, next].map(|four| u32::from_le_bytes(*four)));
            (*low, *high) = (least.to_le_bytes(), greatest.to_le_bytes());
        }
        let ones = before.1.iter().zip(here.1).zip(next.1);
        for ((low, high), ((&before, &here), &next)) in low_rest.iter_mut().zip(high_rest).zip(ones) {
            keep_loop();
            (*low, *high) = WordRows::between(before, here, next);
        }
    }

    #[inline(always)]
    fn between(before: u8, here: u8, next: u8) -> (u8, u8) {
        let (least, greatest) = ranges([before, here, next].map(u32::from));
        (least as u8, greatest as u8)
    }
}

/// The places of so many groups from [`REACH`] on.
#[inline(always)]
fn places(row: &mut [u8], groups: usize) -> &mut [Group] {
    let first = REACH.min(row.len());
    part_mut(part_mut(row, first..).as_chunks_mut().0, ..groups)
}

/// The words of a row from a column on.
#[inline(always)]
fn words(row: &[u8], column: usize) -> impl Iterator<Item = u32> {
    part(row, column.min(row.len())..).as_chunks::<COLUMNS>().0.iter().map(|four| u32::from_le_bytes(*four))
}

/// The codes of groups of four pixels, from the rows two above, here, and two below: each group sees twelve
/// columns of a row, which are four further with each.
#[inline(never)]
fn codes([above, middle, below]: [&[u8]; 3], out: &mut [Group]) {
    let (mut aboves, mut belows, mut sides) = (words(above, 0), words(below, 0), words(middle, REACH / 2));
    let mut next = || Some((aboves.next()?, belows.next()?));
    let (Some(mut first), Some(mut second), Some(mut left)) = (next(), next(), sides.next()) else { return };
    for ((out, here), right) in out.iter_mut().zip(words(middle, REACH)).zip(sides) {
        keep_loop();
        let Some(third) = next() else { return };
        let (low, turned) = (here & !TOP, !here);
        // The bit of each pixel that is not brighter than a neighbour: of the other seven bits a subtraction
        // says it where the top bits are the same.
        let bit = |neighbour: u32, bit: u32| {
            let not_less = (neighbour | TOP).wrapping_sub(low);
            let not_less = (neighbour ^ here) & (turned ^ not_less) ^ not_less;
            (not_less & TOP) >> (7 - bit)
        };
        let codes = bit(first.0, 0) | bit(second.0, 1) | bit(third.0, 2) | bit(left, 3);
        let codes = codes | bit(right, 4) | bit(first.1, 5) | bit(second.1, 6) | bit(third.1, 7);
        *out = (!codes).to_le_bytes();
        (first, second, left) = (second, third, right);
    }
}

/// The gradients along the line and across it, likewise, from the rows above, here, and below.
#[inline(never)]
fn gradients([above, middle, below]: [&[u8]; 3], most: u8, [along, across]: [&mut [Group]; 2]) {
    let most = halves(most.into());
    let rows = words(above, REACH - 1).zip(words(middle, REACH - 1)).zip(words(below, REACH - 1));
    // The columns beside a group's pixels and between them: of four the even and the odd ones. Their Sobel
    // sums along the line, the middle row twice, and how much more there is below than above.
    let mut columns = rows.map(|((above, middle), below)| {
        let sums = [even, odd].map(|half| half(above) + 2 * half(middle) + half(below));
        (sums, [even, odd].map(|half| half(below) + SIGNS / 4 - half(above)))
    });
    let Some(mut last) = columns.next() else { return };
    for ((along, across), next) in along.iter_mut().zip(across).zip(columns) {
        keep_loop();
        // From each half on: those two columns further.
        let on =
            |last: [u32; 2], next: [u32; 2]| [last[0] >> 16 | next[0] << 16, last[1] >> 16 | next[1] << 16];
        let ((sums, fall), sums_on, fall_on) = (last, on(last.0, next.0), on(last.1, next.1));
        // By place: an index of an iteration leaves a panic in a program that is made for size.
        let sides = [sums_on[0] + SIGNS - sums[0], sums_on[1] + SIGNS - sums[1]];
        let ends = [fall[0] + 2 * fall[1] + fall_on[0], fall[1] + 2 * fall_on[0] + fall_on[1]];
        last = next;
        (*along, *across) = (cut(sides, most), cut(ends, most));
    }
}

/// The top bit of each half-word: what a number has more that may be negative.
const SIGNS: u32 = 0x8000_8000;

/// A number in both halves of a word.
#[inline(always)]
const fn halves(number: u32) -> u32 {
    number * 0x0001_0001
}

#[inline(always)]
fn even(word: u32) -> u32 {
    word & 0x00ff_00ff
}

#[inline(always)]
fn odd(word: u32) -> u32 {
    word >> 8 & 0x00ff_00ff
}

/// Cuts differences off, in even and odd half-words and [`SIGNS`] more, at a number to each side, and makes
/// them that number more.
#[inline(always)]
fn cut(differences: [u32; 2], most: u32) -> Group {
    let not_negative = |number: u32| {
        let sign = number & SIGNS;
        number & (sign - (sign >> 15))
    };
    let [even, odd] = differences.map(|difference| {
        let more = not_negative(difference + most);
        2 * most - not_negative(2 * most + SIGNS - more)
    });
    (even | odd << 8).to_le_bytes()
}

/// The least and the greatest of four numbers of seven bits each and those halfway to their neighbours.
#[inline(always)]
fn ranges([before, here, next]: [u32; 3]) -> (u32, u32) {
    let (a, b) = (average(before, here), average(here, next));
    let more = over((a | TOP).wrapping_sub(b));
    let (least, greatest) = (a - more, b + more);
    let here_marked = here | TOP;
    (here - over(here_marked.wrapping_sub(least)), greatest + over(here_marked.wrapping_sub(greatest)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::backend::portable::sgm::features::PlainRows;

    fn features<R: FeatureRows>(lines: &Rows5<'_>, gradient: u8) -> [[u8; 40]; 6] {
        let width = lines[2].len();
        let mut rows = [[0; 40]; 6];
        let [along, across, census, least, greatest, halves] =
            rows.each_mut().map(|row| part_mut(row, ..width));
        R::looks(lines, gradient, [&mut *along, &mut *across, census]);
        R::range(across, least, greatest);
        R::halve(along, halves);
        rows
    }

    #[test]
    fn words_see_what_pixels_see() {
        let mut state = 1u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as u8
        };
        for width in (2..=40).cycle().take(400) {
            let flat = random() < 128;
            let lines =
                [(); 5].map(|()| [(); 40].map(|()| if flat { 100 + random() / 32 } else { random() }));
            let lines = lines.each_ref().map(|line| part(line, ..width));
            for gradient in [7, 9, 28] {
                let found = features::<WordRows>(&lines, gradient);
                assert_eq!(found, features::<PlainRows>(&lines, gradient), "{width} {gradient} {lines:?}");
            }
        }
        for (a, b) in (0..29).flat_map(|a| (0..29).map(move |b| (a, b))) {
            assert_eq!(WordRows::between(a, b, 28 - a), PlainRows::between(a, b, 28 - a));
        }
    }
}
