//! What a pixel's cost compares, of four pixels at a time: gradients in half-words, of the even and the odd
//! pixels; all else in bytes.

#![allow(unsafe_code)]

use super::splat;
use crate::dsp::{ONE, average, max, min, saturating_subtract_halves, select};
use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::portable::sgm::features::FeatureRows;
use crate::matching::backend::portable::sgm::features_by_four::{COLUMNS, REACH, columns, groups, put};
use crate::matching::memory::Rows5;
use crate::matching::memory::slices::{part, part_mut};

/// The codes of groups of four pixels, from the rows two above, here, and two below: each group sees
/// three words of a row's columns, and begins a word further on than the one before.
///
/// # Safety
/// They can be read, and the codes written.
#[inline(never)]
unsafe fn codes([above, middle, below]: [*const u8; 3], out: *mut u32, groups: usize) {
    for group in 0..groups {
        // SAFETY: the last columns that are read are those from 8 on.
        let word = |row: *const u8, column: usize| unsafe {
            row.add(COLUMNS * group + column).cast::<u32>().read_unaligned()
        };
        let here = word(middle, REACH);
        let mut codes = 0;
        macro_rules! look {
            ($($bit:literal: $row:ident $column:literal),*) => {
                $(codes = select(word($row, $column), here, codes, codes | ONE << $bit);)*
            };
        }
        look!(0: above 0, 1: above 4, 2: above 8, 3: middle 2);
        look!(4: middle 6, 5: below 0, 6: below 4, 7: below 8);
        // SAFETY: as the function's.
        unsafe { out.add(group).write_unaligned(codes) };
    }
}

/// The gradients along the line and across it, likewise, from the rows above, here, and below.
///
/// # Safety
/// As for [`codes`].
#[inline(never)]
unsafe fn gradients(
    [above, middle, below]: [*const u8; 3],
    most: u8,
    [along, across]: [*mut u32; 2],
    groups: usize,
) {
    let cut = Cut::new(most);
    // The columns beside a group's pixels and between them: of four the even and the odd ones. Their Sobel
    // sums along the line, the middle row twice, and how much more there is below than above.
    let columns = |group: usize| {
        // SAFETY: the last columns that are read are those from 7 on.
        let [above, middle, below] = [above, middle, below]
            .map(|row| unsafe { row.add(COLUMNS * group + REACH - 1).cast::<u32>().read_unaligned() });
        let sums = [even, odd].map(|half| half(above) + 2 * half(middle) + half(below));
        (sums, [even, odd].map(|half| half(below) + halves(BIAS / 4) - half(above)))
    };
    if groups == 0 {
        return;
    }
    let mut last = columns(0);
    for group in 0..groups {
        let next = columns(group + 1);
        // From each half on: those two columns further.
        let on =
            |last: [u32; 2], next: [u32; 2]| [last[0] >> 16 | next[0] << 16, last[1] >> 16 | next[1] << 16];
        let ((sums, fall), sums_on, fall_on) = (last, on(last.0, next.0), on(last.1, next.1));
        // By place: an index of an iteration leaves a panic in a program that is made for size.
        let sides = [sums_on[0] + halves(BIAS) - sums[0], sums_on[1] + halves(BIAS) - sums[1]];
        let ends = [fall[0] + 2 * fall[1] + fall_on[0], fall[1] + 2 * fall_on[0] + fall_on[1]];
        last = next;
        // SAFETY: as the function's.
        unsafe {
            along.add(group).write_unaligned(cut.of(sides));
            across.add(group).write_unaligned(cut.of(ends));
        }
    }
}

/// More than any sum of Sobel's.
const BIAS: u32 = 1 << 10;

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

/// Cuts differences off at a number to each side.
struct Cut {
    /// [`BIAS`] less the number, and twice the number, in half-words.
    least: u32,
    range: u32,
}

impl Cut {
    #[inline(always)]
    fn new(most: u8) -> Self {
        Self { least: halves(BIAS - u32::from(most)), range: halves(2 * u32::from(most)) }
    }

    /// The differences in even and odd half-words, [`BIAS`] more, cut off, and what they are cut off at more.
    #[inline(always)]
    fn of(&self, differences: [u32; 2]) -> u32 {
        // What the difference lacks of the greatest, 0 to the range: one saturating subtraction for each end.
        let [even, odd] = differences
            .map(|it| saturating_subtract_halves(self.range, saturating_subtract_halves(it, self.least)));
        (self.range | self.range << 8) - (even | odd << 8)
    }
}

/// The range of one number: the least and the greatest of it and those halfway to its neighbours, rounded
/// down; doubled.
fn between(before: u8, here: u8, next: u8) -> (u8, u8) {
    let (least, greatest) = ranges([before, here, next].map(u32::from));
    (least as u8, greatest as u8)
}

/// The ranges of four numbers.
#[inline(always)]
fn ranges([before, here, next]: [u32; 3]) -> (u32, u32) {
    let (a, b) = (average(before, here), average(here, next));
    (2 * min(here, min(a, b)), 2 * max(here, max(a, b)))
}

/// Features in Arm's instructions on four bytes.
pub(in crate::matching::backend) struct DspRows;

impl FeatureRows for DspRows {
    /// The features of as many columns as there is a place for: [`gradients`](crate::imaging::gradients) and
    /// [`census_wide8`](crate::imaging::census_wide8). Behind the line it goes on.
    fn looks(lines: &Rows5<'_>, gradient: u8, [along, across, census]: [&mut [u8]; 3]) {
        let width = lines.iter().fold(usize::MAX, |width, line| width.min(line.len()));
        let count = along.len().min(across.len()).min(census.len());
        let groups = groups(width, count);
        let [above2, above, here, below, below2] = lines.map(<[u8]>::as_ptr);
        // SAFETY: what `groups` groups see from the first column on is in the lines, and from `REACH` on they
        // have places.
        unsafe {
            let place = |row: &mut [u8]| row.as_mut_ptr().wrapping_add(REACH).cast();
            codes([above2, here, below2], place(census), groups);
            gradients([above, here, below], gradient, [place(along), place(across)], groups);
        }
        let after = REACH + groups * COLUMNS;
        let behind = count.min(width).saturating_sub(after).div_ceil(COLUMNS);
        for x in core::iter::once(0).chain((0..behind).map(|group| after + group * COLUMNS)) {
            let near =
                lines.map(|line| [0, 1, 2].map(|word| columns(part(line, ..width), x + word * COLUMNS)));
            let [above2, above, here, below, below2] =
                near.each_ref().map(|near| near.as_flattened().as_ptr());
            let [mut code, mut one, mut other] = [0; 3];
            // SAFETY: a group sees three words of columns.
            unsafe {
                codes([above2, here, below2], &raw mut code, 1);
                gradients([above, here, below], gradient, [&raw mut one, &raw mut other], 1);
            }
            for (row, word) in [(&mut *along, one), (&mut *across, other), (&mut *census, code)] {
                put(part_mut(row, x..), word.to_le_bytes());
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
            *to = (u32::from_le_bytes(from) >> 1 & splat(0x7f)).to_le_bytes();
        }
        for (to, from) in of_rest.iter_mut().zip(rest) {
            keep_loop();
            *to = from >> 1;
        }
    }

    /// The ranges of all numbers but the two at the ends.
    fn range(numbers: &[u8], least: &mut [u8], greatest: &mut [u8]) {
        let count = numbers.len().saturating_sub(2);
        let [before, here, next] =
            [0, 1, 2].map(|from| part(numbers, from..from + count).as_chunks::<COLUMNS>());
        let [(low, low_rest), (high, high_rest)] =
            [least, greatest].map(|row| part_mut(row, 1..=count).as_chunks_mut::<COLUMNS>());
        let fours = before.0.iter().zip(here.0).zip(next.0);
        for ((low, high), ((before, here), next)) in low.iter_mut().zip(high).zip(fours) {
            let (least, greatest) = ranges([before, here, next].map(|four| u32::from_le_bytes(*four)));
            (*low, *high) = (least.to_le_bytes(), greatest.to_le_bytes());
        }
        let ones = before.1.iter().zip(here.1).zip(next.1);
        for ((low, high), ((&before, &here), &next)) in low_rest.iter_mut().zip(high_rest).zip(ones) {
            (*low, *high) = between(before, here, next);
        }
    }

    #[inline(always)]
    fn between(before: u8, here: u8, next: u8) -> (u8, u8) {
        between(before, here, next)
    }
}
