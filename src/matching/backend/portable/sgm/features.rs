//! What a pixel's cost compares, of a row of both images:
//!
//! * the gradients along the line and across it, cut off;
//! * the brightness, halved;
//! * a census of eight neighbours, wide along the line.

use crate::imaging::{census_wide8, gradients};
use crate::matching::backend::loops::{fill_bytes, keep_loop, once_without_vectors};
use crate::matching::backend::parameters::SgmParameters;
use crate::matching::backend::work::PathWork;
use crate::matching::memory::Rows5;
use crate::matching::memory::slices::{chunks, chunks_mut, part, part_mut};

/// Rows of numbers, a byte a pixel.
#[derive(Clone, Copy)]
pub(in crate::matching::backend) struct Features<'a> {
    /// Features of the left image, by column.
    pub left: Looks<'a>,
    /// Features of the right image, `count` bytes for each one after the other: along the line, across it,
    /// census, brightness halved, and the least and the greatest of a column's gradient along the line and of
    /// those halfway to its neighbours (of no meaning where nothing is compared between pixels; doubled
    /// in `armv7em` and `mve`). Column `x` is compared with `stride` of them from `x` on. The first
    /// column is repeated
    /// for those that lie left of the image.
    pub right: &'a [u8],
    pub count: usize,
}

/// What the left pixels look like.
#[derive(Clone, Copy)]
pub(in crate::matching::backend) struct Looks<'a> {
    /// The first three of the others, one after the other.
    pub rows: &'a [u8],
    pub along: &'a [u8],
    pub across: &'a [u8],
    pub census: &'a [u8],
    pub brightness: &'a [u8],
}

// In vectors compiled with the kernel's instructions; in words once for all numbers of disparities.
once_without_vectors! {
    /// The features of a row, in the workspace.
    pub(in crate::matching::backend) fn of<'a, R: FeatureRows, S: SgmParameters>(
        work: &PathWork<'_>,
        lines: [&Rows5<'a>; 2],
        workspace: &'a mut [u8],
    ) -> Option<Features<'a>> {
        let width = work.width;
        let (most, shift) = (work.penalties.gradient, work.gradient_shift);
        let [left, right] = lines.map(|lines| lines.map(|line| part(line, ..width)));
        let (of_left, of_right) = workspace.split_at_mut_checked(3 * width)?;
        looks_of::<R>(&left, most, shift, rows(of_left, width));
        let of_left = &*of_left;
        let mut of_each = chunks(of_left, width);
        let [along, across, census] = core::array::from_fn(|_| of_each.next().unwrap_or_default());
        let of_left = Looks { rows: of_left, along, across, census, brightness: left[2] };

        // One more than is compared, for the numbers halfway to the last.
        let count = width + work.stride;
        // Some kernels read three numbers beyond the last row, for which there is room.
        let of_right = of_right.get_mut(..6 * count + 3)?;
        let [along, across, census, brightness, least, greatest]: [_; 6] = rows(of_right, count);
        let outside = count.min(work.stride - 1 + work.min_disparity);
        let inside = [&mut *along, &mut *across, &mut *census].map(|row| part_mut(row, outside..));
        looks_of::<R>(&right, most, shift, inside);
        R::halve(right[2], part_mut(brightness, outside..));
        // The first column and the next one: the row may begin behind them.
        let pair = |row: &[u8]| part(row, outside..).first_chunk().copied().unwrap_or([0; 2]);
        let [first_along, first_across, first_census] = if width > 1 && outside + 2 <= count {
            [pair(along), pair(across), pair(census)]
        } else {
            first_columns::<R>(&right, most, shift)
        };
        let first_brightness = [0, 1].map(|x| right[2].get(x).map_or(0, |pixel| pixel >> 1));
        for (row, [first, _]) in [
            (&mut *along, first_along),
            (&mut *across, first_across),
            (&mut *census, first_census),
            (&mut *brightness, first_brightness),
        ] {
            go_on::<R>(row, first, outside, outside + width);
        }
        if S::BETWEEN_PIXELS {
            R::range(along, least, greatest);
            let [first, next] = first_along;
            let range = R::between(first, first, if width > 1 { next } else { first });
            R::fill(part_mut(least, ..outside), range.0);
            R::fill(part_mut(greatest, ..outside), range.1);
        }
        Some(Features { left: of_left, right: of_right, count })
    }
}

/// Rows of so many bytes; what there is no room for is empty.
#[inline(always)]
fn rows<const N: usize>(room: &mut [u8], length: usize) -> [&mut [u8]; N] {
    let mut rows = chunks_mut(room, length);
    core::array::from_fn(|_| rows.next().unwrap_or_default())
}

once_without_vectors! {
    /// The features of the first two columns.
    fn first_columns<R: FeatureRows>(lines: &Rows5<'_>, gradient: u8, shift: u32) -> [[u8; 2]; 3] {
        let width = lines[2].len().min(2);
        let mut first = [[0; 2]; 3];
        looks_of::<R>(lines, gradient, shift, first.each_mut().map(|first| part_mut(first, ..width)));
        first
    }

    /// The features of as many columns as there is a place for. Gradients are cut off before they are
    /// shifted, which is the same as after.
    fn looks_of<R: FeatureRows>(
        lines: &Rows5<'_>,
        gradient: u8,
        shift: u32,
        [along, across, census]: [&mut [u8]; 3],
    ) {
        R::looks(lines, gradient << shift, [&mut *along, &mut *across, census]);
        if shift > 0 {
            shift_down(along, shift);
            shift_down(across, shift);
        }
    }

    /// Numbers, shifted to the right, by up to seven bits.
    fn shift_down(numbers: &mut [u8], shift: u32) {
        let (fours, rest) = numbers.as_chunks_mut();
        let kept = u32::from(u8::MAX >> shift) * 0x0101_0101;
        for four in fours {
            keep_loop();
            *four = (u32::from_le_bytes(*four) >> shift & kept).to_le_bytes();
        }
        for number in rest {
            keep_loop();
            *number >>= shift;
        }
    }

    /// Repeats the first column before the image, and behind it what stands in its last one, before `end`.
    fn go_on<R: FeatureRows>(row: &mut [u8], first: u8, outside: usize, end: usize) {
        R::fill(part_mut(row, ..outside), first);
        let last = row.get(end.wrapping_sub(1)).copied().unwrap_or(0);
        let end = end.min(row.len());
        R::fill(part_mut(row, end..), last);
    }
}

/// What a row's features are made with.
pub(in crate::matching::backend) trait FeatureRows {
    /// The gradients along the line and across it, cut off, and the census, of as many columns as there is a
    /// place for.
    fn looks(lines: &Rows5<'_>, gradient: u8, looks: [&mut [u8]; 3]);
    /// Half of each number.
    fn halve(numbers: &[u8], halves: &mut [u8]);
    /// The least and the greatest of each number and those halfway to its neighbours, rounded down, of all
    /// but the two at the ends.
    fn range(numbers: &[u8], least: &mut [u8], greatest: &mut [u8]);
    /// Fills a row with a number.
    #[inline(always)]
    fn fill(row: &mut [u8], number: u8) {
        fill_bytes(row, number);
    }
    /// The range of one number.
    fn between(before: u8, here: u8, next: u8) -> (u8, u8);
}

/// Features in plain Rust, of which the compiler makes vectors where there are some.
pub(in crate::matching::backend) struct PlainRows;

impl FeatureRows for PlainRows {
    #[inline(always)]
    fn looks(lines: &Rows5<'_>, gradient: u8, [along, across, census]: [&mut [u8]; 3]) {
        gradients(&[lines[1], lines[2], lines[3]], gradient, along, across);
        census_wide8(lines, census);
    }

    #[inline(always)]
    fn halve(numbers: &[u8], halves: &mut [u8]) {
        for (to, from) in halves.iter_mut().zip(numbers) {
            keep_loop();
            *to = from >> 1;
        }
    }

    #[inline(always)]
    fn range(numbers: &[u8], least: &mut [u8], greatest: &mut [u8]) {
        let inner = least.iter_mut().zip(greatest.iter_mut()).skip(1);
        let next = numbers.iter().skip(2);
        for ((least, greatest), ((&before, &here), &next)) in
            inner.zip(numbers.iter().zip(numbers.iter().skip(1)).zip(next))
        {
            keep_loop();
            (*least, *greatest) = Self::between(before, here, next);
        }
    }

    #[inline(always)]
    fn between(before: u8, here: u8, next: u8) -> (u8, u8) {
        // Seven bits each.
        let (a, b) = (before.wrapping_add(here) >> 1, here.wrapping_add(next) >> 1);
        (here.min(a).min(b), here.max(a).max(b))
    }
}
