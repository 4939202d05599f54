//! Features of four pixels side by side at a time: gradients in half-words, of the even and the odd pixels,
//! all else in the four bytes of a word.

use super::features::FeatureRows;
use crate::matching::backend::loops::keep_loop;
use crate::matching::memory::Rows5;
use crate::matching::memory::slices::{part, part_mut};
use crate::matching::memory::views::view;

/// Columns in a word.
const COLUMNS: usize = 4;
/// Columns to each side that a code looks at.
const REACH: usize = 4;
/// Columns that four pixels look at.
const NEAR: usize = COLUMNS + 2 * REACH;
/// The low seven bits of each byte.
const SEVEN: u32 = 0x7f7f_7f7f;
/// The top bit of each half-word: what a difference has more that may be negative.
pub(in crate::matching::backend) const SIGNS: u32 = 0x8000_8000;

/// A number of each pixel.
type Group = [u8; COLUMNS];

/// What is done to four pixels by whatever instructions a core has.
pub(in crate::matching::backend) trait FourPixels {
    /// Whether words of three rows stay in registers from group to group.
    const KEEPS_ROWS: bool = false;
    /// The codes of the pixels `here`: of the first neighbour the lowest bit, 1 where it is darker.
    fn codes(here: u32, neighbours: [u32; 8]) -> u32;
    /// The sums of half-words and of the even bytes of another word.
    fn plus_even(halves: u32, bytes: u32) -> u32 {
        halves + (bytes & 0x00ff_00ff)
    }
    /// The sums of half-words and of the odd bytes of another word.
    fn plus_odd(halves: u32, bytes: u32) -> u32 {
        halves + (bytes >> 8 & 0x00ff_00ff)
    }
    /// Cuts differences off, those of the even and of the odd pixels in half-words and [`SIGNS`] more, at
    /// `most` to each side, which both half-words of it are, and makes them that much more. A byte each.
    fn cut(differences: [u32; 2], most: u32) -> u32;
    /// The least and the greatest of each number and those halfway to its neighbours.
    fn ranges(numbers: [u32; 3]) -> (u32, u32);
}

impl<F: FourPixels> FeatureRows for F {
    /// The features of as many columns as there is a place for: [`gradients`](crate::imaging::gradients) and
    /// [`census_wide8`](crate::imaging::census_wide8). Behind the line it goes on.
    fn looks(lines: &Rows5<'_>, width: usize, gradient: u8, [along, across, census]: [&mut [u8]; 3]) {
        let count = census.len().min(width);
        let groups = groups(width, count);
        let [above2, above, here, below, below2] = *lines;
        codes::<F>([above2, here, below2], places(census, groups));
        gradients::<F>([above, here, below], gradient, [places(along, groups), places(across, groups)]);
        // The first columns, and those that are left at the end.
        let mut x = 0;
        loop {
            keep_loop();
            let near = lines.map(|line| near(part(line, ..width), x));
            let [above2, above, here, below, below2] = near.each_ref().map(|near| view(near));
            let [mut code, mut one, mut other] = [[[0; COLUMNS]]; 3];
            codes::<F>([above2, here, below2], &mut code);
            gradients::<F>([above, here, below], gradient, [&mut one, &mut other]);
            for (row, four) in [(&mut *along, one), (&mut *across, other), (&mut *census, code)] {
                put(row, x, four);
            }
            x = if x == 0 { REACH + groups * COLUMNS } else { x + COLUMNS };
            if x >= count {
                break;
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
            *to = (word(from) >> 1 & SEVEN).to_le_bytes();
        }
        for (to, from) in of_rest.iter_mut().zip(rest) {
            keep_loop();
            *to = from >> 1;
        }
    }

    #[inline(never)]
    fn range(numbers: &[u8], least: &mut [u8], greatest: &mut [u8]) {
        // Groups end with the last number but one.
        let first = numbers.len().saturating_sub(2) % COLUMNS;
        let [before, here, next] =
            [0, 1, 2].map(|next| from(numbers, first + next).iter().copied().map(word));
        let [least, greatest] =
            [least, greatest].map(|row| row.get_mut(first + 1..).unwrap_or_default().as_chunks_mut().0);
        for (((least, greatest), before), (here, next)) in
            least.iter_mut().zip(greatest).zip(before).zip(here.zip(next))
        {
            keep_loop();
            let ranges = F::ranges([before, here, next]);
            (*least, *greatest) = (ranges.0.to_le_bytes(), ranges.1.to_le_bytes());
        }
    }
}

/// Puts as much of a group from a column on as there is a place for.
#[inline(never)]
fn put(row: &mut [u8], column: usize, [four]: [Group; 1]) {
    for (to, from) in part_mut(row, column..).iter_mut().zip(four) {
        keep_loop();
        *to = from;
    }
}

/// How many groups, from column [`REACH`] on, see nothing outside of a line of `width` pixels and have all
/// places among `count`.
#[inline(always)]
fn groups(width: usize, count: usize) -> usize {
    (width.saturating_sub(NEAR - COLUMNS) / COLUMNS).min(count.saturating_sub(REACH) / COLUMNS)
}

/// The places of so many groups from [`REACH`] on.
#[inline(never)]
fn places(row: &mut [u8], groups: usize) -> &mut [Group] {
    part_mut(row.get_mut(REACH..).unwrap_or_default().as_chunks_mut().0, ..groups)
}

/// The columns that the group at `x` looks at, as they stand in memory: in words, which all cores copy as
/// such.
#[inline(never)]
pub(in crate::matching::backend) fn near(line: &[u8], x: usize) -> [u32; NEAR / COLUMNS] {
    let mut near = [0; NEAR / COLUMNS];
    for (group, near) in near.iter_mut().enumerate() {
        keep_loop();
        *near = u32::from_ne_bytes(columns(line, x + group * COLUMNS));
    }
    near
}

/// The columns of a line from [`REACH`] before `place` on; those outside the line are the nearest inside.
#[inline(never)]
fn columns(line: &[u8], place: usize) -> Group {
    let end = |column: Option<&u8>| [column.copied().unwrap_or(0); COLUMNS];
    if place + COLUMNS <= REACH {
        return end(line.first());
    }
    if place >= line.len() + REACH {
        return end(line.last());
    }
    let inside = place.checked_sub(REACH).and_then(|x| line.get(x..)?.first_chunk());
    let outside = || {
        let column = |i: usize| (place + i).saturating_sub(REACH).min(line.len().saturating_sub(1));
        core::array::from_fn(|i| line.get(column(i)).copied().unwrap_or(0))
    };
    inside.copied().unwrap_or_else(outside)
}

/// The groups of a row from a column on.
#[inline(always)]
fn from(row: &[u8], column: usize) -> &[Group] {
    row.get(column..).unwrap_or_default().as_chunks().0
}

/// The codes of groups of four pixels, from the rows two above, here, and two below: each group sees twelve
/// columns of a row, which are four further with each.
#[inline(never)]
fn codes<F: FourPixels>([above, middle, below]: [&[u8]; 3], out: &mut [Group]) {
    if F::KEEPS_ROWS {
        let words = |row, column| from(row, column).iter().copied().map(word);
        let (mut above, mut sides, mut below) = (words(above, 0), words(middle, REACH / 2), words(below, 0));
        let mut next = || Some([above.next()?, below.next()?]);
        let (Some([mut a, mut f]), Some([mut b, mut g]), Some(mut d)) = (next(), next(), sides.next()) else {
            return;
        };
        for (out, here) in out.iter_mut().zip(words(middle, REACH)) {
            keep_loop();
            let (Some([c, h]), Some(e)) = (next(), sides.next()) else { return };
            *out = F::codes(here, [a, b, c, d, e, f, g, h]).to_le_bytes();
            (a, b, d, f, g) = (b, c, e, g, h);
        }
        return;
    }
    let rows = from(above, 0).windows(3).zip(from(below, 0).windows(3));
    let row = from(middle, REACH).iter().zip(from(middle, REACH / 2).windows(2));
    for ((out, (&here, sides)), (above, below)) in out.iter_mut().zip(row).zip(rows) {
        keep_loop();
        let (&[a, b, c], &[d, e], &[f, g, h]) = (above, sides, below) else { return };
        *out = F::codes(word(here), [a, b, c, d, e, f, g, h].map(word)).to_le_bytes();
    }
}

/// The gradients along the line and across it, likewise, from the rows above, here, and below. The columns
/// that they are of stand beside a group's pixels and between them.
#[inline(never)]
fn gradients<F: FourPixels>(
    [above, middle, below]: [&[u8]; 3],
    most: u8,
    [along, across]: [&mut [Group]; 2],
) {
    let most = u32::from(most) * 0x0001_0001;
    let [above, middle, below] =
        [above, middle, below].map(|row| from(row, REACH - 1).iter().copied().map(word));
    // Sums down the columns, the middle row twice; and how much more there is below than above.
    let mut columns = above.zip(middle).zip(below).map(|((above, middle), below)| {
        let sum = |plus: fn(u32, u32) -> u32| plus(plus(plus(plus(0, above), middle), middle), below);
        let fall = |plus: fn(u32, u32) -> u32| plus(SIGNS / 4, below) - plus(0, above);
        ([sum(F::plus_even), sum(F::plus_odd)], [fall(F::plus_even), fall(F::plus_odd)])
    });
    let Some((mut sum, mut fall)) = columns.next() else { return };
    for ((along, across), (next_sum, next_fall)) in along.iter_mut().zip(across).zip(columns) {
        keep_loop();
        let sides = [on(sum[0], next_sum[0]) + SIGNS - sum[0], on(sum[1], next_sum[1]) + SIGNS - sum[1]];
        *along = F::cut(sides, most).to_le_bytes();
        let on = [on(fall[0], next_fall[0]), on(fall[1], next_fall[1])];
        let ends = [fall[0] + 2 * fall[1] + on[0], fall[1] + 2 * on[0] + on[1]];
        *across = F::cut(ends, most).to_le_bytes();
        (sum, fall) = (next_sum, next_fall);
    }
}

/// From each half on: two columns further.
#[inline(always)]
fn on(last: u32, next: u32) -> u32 {
    last >> 16 | next << 16
}

#[inline(always)]
fn word(four: Group) -> u32 {
    u32::from_le_bytes(four)
}
