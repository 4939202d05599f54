//! The places of a rectified line's pixels in the raw image, piece by piece.

use super::RemapTable;

/// Fractional bits of a place.
pub(super) const BITS: u32 = 16;
/// Half of the finest step that pixels are weighted in, 1/256 px.
const HALF: i32 = 1 << (BITS - 9);
/// Fractional bits of the weights between rows of the lattice.
const WEIGHT_BITS: u32 = 20;

/// What of a segment is in the raw image.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Part {
    /// Nothing.
    None,
    /// To be asked for each pixel.
    Some,
    /// All of it, and more than a pixel's fraction from the last column and row.
    All,
}

/// The pixels between two columns of the lattice.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    pub column: Run,
    pub row: Run,
    pub part: Part,
}

/// One coordinate of a segment's pixels, px with [`BITS`] fractional bits, half a 256th added: along straight pieces of as many
/// pixels as the table has it, from `start`, by `step` a pixel in the first piece and `bend` more in each next one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    pub start: i32,
    pub step: i32,
    pub bend: i32,
    /// The least and the greatest place are not beyond these.
    pub least: i32,
    pub greatest: i32,
}

impl Run {
    /// Along the parabola through two places of the lattice that is bent as the cubic through these and the two beside them is
    /// halfway, in pieces of `2^piece` pixels, 1 or 4. A straight line between two places of it is off by up to half of `bend` in the
    /// middle of four pixels: all are moved by a quarter.
    fn between([before, from, to, after]: [i32; 4], shift: u32, piece: u32) -> Self {
        let (length, pieces) = (1 << piece, 1 << (shift - piece));
        let bend = rounded(before + after - from - to, 2 * shift + 1 - piece);
        let bent = length * pieces * (pieces - 1) / 2 * bend;
        let step = rounded(to - from - bent, shift);
        let start = from + HALF - if piece == 0 { 0 } else { bend / 4 };
        // A parabola stays between its ends and the place where its tangents there meet (Bézier).
        let end = start + length * pieces * step + bent;
        let meet = start + length * pieces * (2 * step - bend) / 4;
        let least = start.min(end).min(meet) - 1;
        let greatest = start.max(end).max(meet) + 1;
        Self { start, step, bend, least, greatest }
    }

    /// The places of the pixels.
    pub fn places(&self, piece: u32) -> impl Iterator<Item = i32> {
        let mut run = *self;
        let pieces = core::iter::from_fn(move || {
            let (start, step) = (run.start, run.step);
            run.advance(piece);
            Some((0..1 << piece).map(move |k| start.wrapping_add(step.wrapping_mul(k))))
        });
        pieces.flatten()
    }

    /// Moves on by a piece. Past its last one a run may go anywhere.
    #[inline(always)]
    pub fn advance(&mut self, piece: u32) {
        self.start = self.start.wrapping_add(self.step << piece);
        self.step = self.step.wrapping_add(self.bend);
    }
}

/// `x / 2^shift`, to the nearest.
fn rounded(x: i32, shift: u32) -> i32 {
    (x + (1 << (shift - 1))) >> shift
}

/// The segments of one rectified line, from the left.
pub(super) struct Segments<'a> {
    /// Four rows of the lattice: the line is between the second and the third.
    rows: [&'a [[i32; 2]]; 4],
    weights: [i32; 4],
    /// Places on the last columns of the lattice: those of three, and the next one's.
    window: [Node; 4],
    next: usize,
    left: u16,
    shift: u32,
    piece: u32,
    /// The last column and row of the raw image, with fractional bits.
    most: [i32; 2],
}

#[derive(Clone, Copy, Default)]
struct Node {
    place: [i32; 2],
    is_beyond: bool,
}

impl<'a> Segments<'a> {
    pub fn new<const SLOTS: usize>(table: &'a RemapTable<SLOTS>, row: u16) -> Self {
        let shift = table.shift();
        let raw = table.raw_size();
        let mut segments = Self {
            rows: table.rows_around(row),
            weights: weights(i32::from(row) & ((1 << shift) - 1), shift),
            window: [Node::default(); 4],
            next: 0,
            left: table.cells(),
            shift,
            piece: table.piece(),
            most: [raw.width, raw.height].map(|side| (i32::from(side) - 1) << BITS),
        };
        for _ in 0..3 {
            segments.advance();
        }
        segments
    }

    /// Moves the window on by a column of the lattice.
    fn advance(&mut self) {
        let [_, b, c, d] = self.window;
        let [n0, n1, n2, n3] = self.rows.map(|row| row.get(self.next).copied().unwrap_or([1, 0]));
        let [w0, w1, w2, w3] = self.weights.map(i64::from);
        let at = |axis: usize| {
            let sum = w0 * i64::from(n0[axis]) + w1 * i64::from(n1[axis]);
            let sum = sum + w2 * i64::from(n2[axis]) + w3 * i64::from(n3[axis]);
            ((sum + (1 << (WEIGHT_BITS - 1))) >> WEIGHT_BITS) as i32
        };
        let node = Node { place: [at(0), at(1)], is_beyond: (n1[0] | n2[0]) & 1 != 0 };
        self.window = [b, c, d, node];
        self.next += 1;
    }
}

impl Iterator for Segments<'_> {
    type Item = Segment;

    #[inline]
    fn next(&mut self) -> Option<Segment> {
        self.left = self.left.checked_sub(1)?;
        self.advance();
        let [a, b, c, d] = self.window;
        let run = |axis: usize| Run::between([a, b, c, d].map(|node| node.place[axis]), self.shift, self.piece);
        let (column, row) = (run(0), run(1));
        let [last_column, last_row] = self.most;
        // Outside for all pixels, or inside with the pixels to the right and below.
        let out = |run: &Run, last: i32| run.greatest < 0 || run.least >= last + 2 * HALF;
        let inside = |run: &Run, last: i32| run.least >= 0 && run.greatest < last;
        let part = if b.is_beyond || c.is_beyond || out(&column, last_column) || out(&row, last_row) {
            Part::None
        } else if inside(&column, last_column) && inside(&row, last_row) {
            Part::All
        } else {
            Part::Some
        };
        Some(Segment { column, row, part })
    }
}

/// Lagrange's weights of four rows of the lattice, for a line `k` pixels below the second of them.
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
    fn a_parabola_in_fours() {
        // 16 k^2 at -8, 0, 8 and 16: at 0, 4 and 8 it is 0, 256 and 1024, less a quarter of the bend.
        let run = Run::between([1024, 0, 1024, 4096], 3, 2);
        assert_eq!((run.start, run.step, run.bend), (HALF - 32, 64, 128));
        let places: [i32; 6] = core::array::from_fn(|k| run.places(2).nth(k).unwrap_or(0) - run.start);
        assert_eq!(places, [0, 64, 128, 192, 256, 448]);
        assert_eq!((run.least, run.greatest), (run.start - 1, run.start + 1025));
        // And in pieces of one.
        let run = Run::between([1024, 0, 1024, 4096], 3, 0);
        let places: [i32; 5] = core::array::from_fn(|k| run.places(0).nth(k).unwrap_or(0) - HALF);
        assert_eq!(places, [0, 16, 64, 144, 256]);
    }
}
