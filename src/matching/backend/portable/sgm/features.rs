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
use crate::matching::memory::slices::{chunks, chunks_mut, part, part_mut, split_mut};
use core::ops::Range;

/// Rows of numbers, a byte a pixel.
#[derive(Clone, Copy)]
pub(in crate::matching::backend) struct Features<'a> {
    /// Features of the left image, by column.
    pub left: Looks<'a>,
    /// Features of the right image, `count` bytes for each one after the other: along the line, across it,
    /// census, brightness halved, and the least and the greatest of a column's gradient along the line and of
    /// those halfway to its neighbours (of no meaning where nothing is compared between pixels; doubled
    /// in `armv7em` and `mve`). Column `x` is compared with `stride` of them from `x` on. The first column is
    /// repeated for those that lie left of the image.
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
    /// The features of a row, in the workspace; none where no pixel has a candidate.
    pub(in crate::matching::backend) fn of<'a, R: FeatureRows, S: SgmParameters>(
        work: &PathWork<'_>,
        [left, right]: [&Rows5<'a>; 2],
        workspace: &'a mut [u8],
    ) -> Option<Features<'a>> {
        let (width, outside) = (work.width, work.stride - 1 + work.min_disparity);
        // One more than is compared, for the numbers halfway to the last.
        let count = width + work.stride;
        if outside + 1 >= count {
            return None;
        }
        let inside = outside..count.min(outside + width);
        let (of_left, of_right) = workspace.split_at_mut_checked(3 * width)?;
        // Some kernels read three numbers beyond the last row, for which there is room.
        let of_right = of_right.get_mut(..6 * count + 3)?;
        looks_of::<R>(work, left, of_left, 0);
        looks_of::<R>(work, right, part_mut(of_right, ..3 * count), outside);
        R::halve(part(right[2], ..width), part_mut(of_right, 3 * count + outside..4 * count));
        for row in chunks_mut(of_right, count).take(4) {
            keep_loop();
            go_on::<R>(row, inside.clone());
        }
        if S::BETWEEN_PIXELS {
            let (features, ranges) = split_mut(of_right, 4 * count);
            let (least, greatest) = split_mut(ranges, count);
            let greatest = part_mut(greatest, ..count);
            R::range(part(features, ..count), least, greatest);
            go_on::<R>(least, inside.clone());
            go_on::<R>(greatest, inside);
        }
        let of_left = &*of_left;
        let mut of_each = chunks(of_left, width);
        let [along, across, census] = core::array::from_fn(|_| of_each.next().unwrap_or_default());
        let brightness = part(left[2], ..width);
        let left = Looks { rows: of_left, along, across, census, brightness };
        Some(Features { left, right: of_right, count })
    }

    /// The gradients and the census of a line, in three rows, of which each has `outside` columns before the
    /// first. Gradients are cut off before they are shifted, which is the same as after.
    fn looks_of<R: FeatureRows>(work: &PathWork<'_>, lines: &Rows5<'_>, rows: &mut [u8], outside: usize) {
        let shift = work.gradient_shift;
        let mut of_each = chunks_mut(rows, rows.len() / 3).map(|row| part_mut(row, outside..));
        let [along, across, census] = core::array::from_fn(|_| of_each.next().unwrap_or_default());
        R::looks(lines, work.width, work.penalties.gradient << shift, [&mut *along, &mut *across, census]);
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

    /// Repeats the first of a row's columns `inside` before it, and the last one behind it.
    fn go_on<R: FeatureRows>(row: &mut [u8], inside: Range<usize>) {
        let ends = part(row, inside.clone());
        let [first, last] = [ends.first(), ends.last()].map(|end| end.copied().unwrap_or(0));
        R::fill(part_mut(row, ..inside.start), first);
        R::fill(part_mut(row, inside.end..), last);
    }
}

/// What a row's features are made with.
pub(in crate::matching::backend) trait FeatureRows {
    /// The gradients along the line and across it, cut off, and the census, of as many of a line's `width`
    /// columns as there is a place for.
    fn looks(lines: &Rows5<'_>, width: usize, gradient: u8, looks: [&mut [u8]; 3]);
    /// Half of each number.
    fn halve(numbers: &[u8], halves: &mut [u8]);
    /// The least and the greatest of each number and those halfway to its neighbours, rounded down. Those of
    /// the first four numbers and of the last one are of no meaning.
    fn range(numbers: &[u8], least: &mut [u8], greatest: &mut [u8]);
    /// Fills a row with a number.
    #[inline(always)]
    fn fill(row: &mut [u8], number: u8) {
        fill_bytes(row, number);
    }
}

/// Features in plain Rust, of which the compiler makes vectors where there are some.
pub(in crate::matching::backend) struct PlainRows;

impl FeatureRows for PlainRows {
    #[inline(always)]
    fn looks(lines: &Rows5<'_>, width: usize, gradient: u8, [along, across, census]: [&mut [u8]; 3]) {
        let lines = lines.map(|line| part(line, ..width));
        gradients(&[lines[1], lines[2], lines[3]], gradient, along, across);
        census_wide8(&lines, census);
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
            // Seven bits each.
            let (a, b) = (before.wrapping_add(here) >> 1, here.wrapping_add(next) >> 1);
            (*least, *greatest) = (here.min(a).min(b), here.max(a).max(b));
        }
    }
}
