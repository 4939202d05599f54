//! Segments of a rectified line: the lattice interpolated between its rows.

use super::segment::{BITS, Cell, HALF, Part, Run, Segment};
use crate::geometry::camera::ImageSize;
use core::slice::Chunks;

/// Fractional bits to which the weights between rows of the lattice are rounded.
const WEIGHT_BITS: u32 = 20;

/// What a table has around a line.
pub(super) struct Lattice<'a> {
    /// Columns of the lattice, three more than there are segments: each begins with the four positions around
    /// the line, which is between the second and the third.
    pub columns: Chunks<'a, [i32; 2]>,
    pub shift: u32,
    pub piece: u32,
    pub raw: ImageSize,
}

/// Segments of one rectified line, from the left.
pub(super) struct Segments<'a> {
    /// Remaining columns of the lattice.
    columns: Chunks<'a, [i32; 2]>,
    weights: [i32; 4],
    /// Positions on the last three columns of the lattice.
    last: [[i32; 2]; 3],
    /// Whether the lens model fails to describe each column so far, the last one in bit 0, unless `is_whole`.
    beyond: u32,
    cell: Cell,
    /// Last column and row of the raw image, with fractional bits.
    most: [i32; 2],
    /// Whether all segments are inside the raw image.
    is_whole: bool,
    /// The last one found.
    segment: Segment,
}

impl<'a> Segments<'a> {
    /// Segments of a line, which is wholly inside the raw image if `is_whole`.
    #[inline(always)]
    pub fn new(lattice: Lattice<'a>, row: u16, is_whole: bool) -> Self {
        let Lattice { columns, shift, piece, raw } = lattice;
        let mut segments = Self {
            columns,
            weights: weights(i32::from(row) & ((1 << shift) - 1), shift),
            last: [[0; 2]; 3],
            beyond: 0,
            cell: Cell::new(shift, piece),
            most: [raw.width, raw.height].map(|side| (i32::from(side) - 1) << BITS),
            is_whole,
            segment: Segment::NONE,
        };
        for _ in 0..3 {
            let [_, b, c] = segments.last;
            segments.last = [b, c, segments.node().unwrap_or_default()];
        }
        segments
    }

    /// Position on the next column of the lattice, interpolated between its four rows.
    #[inline(always)]
    fn node(&mut self) -> Option<[i32; 2]> {
        let around = self.columns.next()?.first_chunk()?;
        let node = interpolate(around, &self.weights);
        if !self.is_whole {
            let [_, [above, _], [below, _], _] = around;
            self.beyond = self.beyond << 1 | ((above | below) & 1).cast_unsigned();
        }
        Some(node)
    }

    /// Overlap of a segment with the raw image.
    fn part(&self, column: &Run, row: &Run) -> Part {
        let [last_column, last_row] = self.most;
        let ((left, right), (top, bottom)) = (column.reach(&self.cell), row.reach(&self.cell));
        // Inside with the pixels to the right and below, or outside for all pixels.
        if left >= 0 && top >= 0 && right < last_column && bottom < last_row {
            Part::All
        } else if right < 0 || bottom < 0 || left >= last_column + 2 * HALF || top >= last_row + 2 * HALF {
            Part::None
        } else {
            Part::Some
        }
    }

    /// The next segment, as [`Iterator::next`] gives it, where it stays: for the loop over a rectified row.
    #[inline(always)]
    pub fn step(&mut self) -> Option<&Segment> {
        if self.advance() { Some(&self.segment) } else { None }
    }

    /// Finds the next segment, if there is one.
    #[inline(never)]
    fn advance(&mut self) -> bool {
        let Some(d) = self.node() else { return false };
        let [a, b, c] = self.last;
        self.last = [b, c, d];
        let column = Run::between([a[0], b[0], c[0], d[0]], &self.cell);
        let row = Run::between([a[1], b[1], c[1], d[1]], &self.cell);
        let part = match self.is_whole {
            true => Part::All,
            // Those at both ends, the last but one and the one before that.
            false if self.beyond & 0b110 != 0 => Part::None,
            false => self.part(&column, &row),
        };
        self.segment = Segment { column, row, part };
        true
    }
}

impl Iterator for Segments<'_> {
    type Item = Segment;

    fn next(&mut self) -> Option<Segment> {
        self.step().copied()
    }
}

/// Interpolates a position between four by their negative weights, rounded to an even number.
#[inline(always)]
fn interpolate(around: &[[i32; 2]; 4], weights: &[i32; 4]) -> [i32; 2] {
    let mut sums = [1_i64 << 31; 2];
    for (place, weight) in around.iter().zip(weights) {
        for (sum, place) in sums.iter_mut().zip(place) {
            *sum += i64::from(*weight) * i64::from(*place);
        }
    }
    sums.map(|sum| ((sum >> 32) as i32).wrapping_mul(-2))
}

/// Lagrange weights of four rows of the lattice, for a line `k` pixels below the second of them; negative,
/// so that a whole one fits.
fn weights(k: i32, shift: u32) -> [i32; 4] {
    let s = 1 << shift;
    let scale = WEIGHT_BITS - 3 * shift;
    let first = ((k * (s - k) * (2 * s - k)) << scale) / 6;
    let second = -(((s + k) * (s - k) * (2 * s - k)) << scale) / 2;
    let third = -(((s + k) * k * (2 * s - k)) << scale) / 2;
    let fourth = -(1 << WEIGHT_BITS) - first - second - third;
    [first, second, third, fourth].map(|weight| weight << (31 - WEIGHT_BITS))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_of_a_cubic() {
        // Halfway: -1/16, 9/16, 9/16, -1/16.
        let sixteenth = 1 << 27;
        assert_eq!(weights(8, 4), [1, -9, -9, 1].map(|weight| weight * sixteenth));
        assert_eq!(weights(0, 5), [0, i32::MIN, 0, 0]);
    }

    #[test]
    fn a_segment_is_inside_with_the_pixels_to_the_right_and_below() {
        let raw = ImageSize { width: 40, height: 30 };
        // All nodes at one place: each segment is a point, with a margin of one around it.
        let part = |column: i32, row: i32| {
            let nodes = [[column, row]; 16];
            let lattice = Lattice { columns: nodes.chunks(4), shift: 3, piece: 2, raw };
            Segments::new(lattice, 0, false).next().expect("a cell").part
        };
        let (right, bottom) = (39 << BITS, 29 << BITS);
        let middle = 9 << BITS;
        // All even. Half a 256th is added. From 0 on, and before the last column.
        for (column, expected) in [
            (2 - HALF, Part::All),
            (-HALF, Part::Some),
            (right - HALF - 2, Part::All),
            (right - HALF, Part::Some),
            (right + HALF - 2, Part::Some),
            (right + HALF + 2, Part::None),
            (-HALF - 2, Part::None),
        ] {
            assert_eq!(part(column, middle), expected, "{column}");
        }
        for (row, expected) in [
            (2 - HALF, Part::All),
            (-HALF, Part::Some),
            (bottom - HALF - 2, Part::All),
            (bottom - HALF, Part::Some),
            (bottom + HALF, Part::Some),
            (bottom + HALF + 2, Part::None),
            (-HALF - 2, Part::None),
        ] {
            assert_eq!(part(middle, row), expected, "{row}");
        }
    }
}
