//! Segments of a rectified line: the lattice interpolated between its rows.

use super::segment::{BITS, Cell, HALF, Part, Run, Segment};
use crate::geometry::camera::ImageSize;
use core::iter::Zip;
use core::slice::Iter;

/// Fractional bits of the weights between rows of the lattice.
const WEIGHT_BITS: u32 = 20;

/// What a table has around a line.
#[derive(Clone, Copy)]
pub(super) struct Lattice<'a> {
    /// Four rows of the lattice; the line is between the second and the third.
    pub rows: [&'a [[i32; 2]]; 4],
    pub shift: u32,
    pub piece: u32,
    pub cells: u16,
    pub raw: ImageSize,
}

/// Segments of one rectified line, from the left.
pub(super) struct Segments<'a> {
    /// Remaining columns of four rows of the lattice; the line is between the second and the third.
    columns: Columns<'a>,
    weights: [i32; 4],
    /// Positions on the last three columns of the lattice.
    last: [[i32; 2]; 3],
    /// Whether the lens model fails to describe each column so far, the last one in bit 0.
    beyond: u32,
    left: u16,
    cell: Cell,
    /// Last column and row of the raw image, with fractional bits.
    most: [i32; 2],
    /// Whether all segments are inside the raw image.
    is_whole: bool,
}

/// Four rows of the lattice in parallel.
type Columns<'a> =
    Zip<Zip<Iter<'a, [i32; 2]>, Iter<'a, [i32; 2]>>, Zip<Iter<'a, [i32; 2]>, Iter<'a, [i32; 2]>>>;

impl<'a> Segments<'a> {
    /// Segments of a line, which is wholly inside the raw image if `is_whole`.
    pub fn new(lattice: &Lattice<'a>, row: u16, is_whole: bool) -> Self {
        let Lattice { rows: [n0, n1, n2, n3], shift, piece, cells, raw } = *lattice;
        let mut segments = Self {
            columns: n0.iter().zip(n1).zip(n2.iter().zip(n3)),
            weights: weights(i32::from(row) & ((1 << shift) - 1), shift),
            last: [[0; 2]; 3],
            beyond: 0,
            left: cells,
            cell: Cell::new(shift, piece),
            most: [raw.width, raw.height].map(|side| (i32::from(side) - 1) << BITS),
            is_whole,
        };
        segments.last = [segments.node(), segments.node(), segments.node()];
        segments
    }

    /// Position on the next column of the lattice, interpolated between its four rows.
    #[inline(always)]
    fn node(&mut self) -> [i32; 2] {
        // There is one for each cell, and three.
        let Some(((n0, n1), (n2, n3))) = self.columns.next() else { return [0; 2] };
        self.beyond = self.beyond << 1 | ((n1[0] | n2[0]) & 1).cast_unsigned();
        let [w0, w1, w2, w3] = self.weights.map(i64::from);
        let at = |[a, b, c, d]: [i32; 4]| {
            let sum = w0 * i64::from(a) + w1 * i64::from(b);
            let sum = sum + w2 * i64::from(c) + w3 * i64::from(d);
            ((sum + (1 << (WEIGHT_BITS - 1))) >> WEIGHT_BITS) as i32
        };
        [at([n0[0], n1[0], n2[0], n3[0]]), at([n0[1], n1[1], n2[1], n3[1]])]
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

    /// The next segment, as [`Iterator::next`] gives it: for the loop over a rectified row.
    #[inline(always)]
    pub fn step(&mut self) -> Option<Segment> {
        self.left = self.left.checked_sub(1)?;
        let [a, b, c] = self.last;
        let d = self.node();
        self.last = [b, c, d];
        let column = Run::between([a[0], b[0], c[0], d[0]], &self.cell);
        let row = Run::between([a[1], b[1], c[1], d[1]], &self.cell);
        let part = match self.is_whole {
            true => Part::All,
            // Those at both ends, the last but one and the one before that.
            false if self.beyond & 0b110 != 0 => Part::None,
            false => self.part(&column, &row),
        };
        Some(Segment { column, row, part })
    }
}

impl Iterator for Segments<'_> {
    type Item = Segment;

    // Inlined wherever segments are looked at it takes flash each time.
    #[inline(never)]
    fn next(&mut self) -> Option<Segment> {
        self.step()
    }
}

/// Lagrange weights of four rows of the lattice, for a line `k` pixels below the second of them.
fn weights(k: i32, shift: u32) -> [i32; 4] {
    let s = 1 << shift;
    let scale = WEIGHT_BITS - 3 * shift;
    let first = -((k * (s - k) * (2 * s - k)) << scale) / 6;
    let second = (((s + k) * (s - k) * (2 * s - k)) << scale) / 2;
    let third = (((s + k) * k * (2 * s - k)) << scale) / 2;
    [first, second, third, (1 << WEIGHT_BITS) - first - second - third]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_of_a_cubic() {
        // Halfway: -1/16, 9/16, 9/16, -1/16.
        assert_eq!(weights(8, 4), [-65536, 9 * 65536, 9 * 65536, -65536]);
        assert_eq!(weights(0, 5), [0, 1 << 20, 0, 0]);
    }

    #[test]
    fn a_segment_is_inside_with_the_pixels_to_the_right_and_below() {
        let raw = ImageSize { width: 40, height: 30 };
        // All nodes at one place: each segment is a point, with a margin of one around it.
        let part = |column: i32, row: i32| {
            let nodes = [[column & !1, row]; 4];
            let lattice = Lattice { rows: [&nodes; 4], shift: 3, piece: 2, cells: 1, raw };
            Segments::new(&lattice, 0, false).step().expect("a cell").part
        };
        let (right, bottom) = (39 << BITS, 29 << BITS);
        let middle = 9 << BITS;
        // Half a 256th is added. From 0 on, and before the last column.
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
            (1 - HALF, Part::All),
            (-HALF, Part::Some),
            (bottom - HALF - 2, Part::All),
            (bottom - HALF - 1, Part::Some),
            (bottom + HALF, Part::Some),
            (bottom + HALF + 1, Part::None),
            (-HALF - 1, Part::Some),
            (-HALF - 2, Part::None),
        ] {
            assert_eq!(part(middle, row), expected, "{row}");
        }
    }
}
