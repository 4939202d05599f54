//! Raw positions of a rectified line's pixels, by piecewise linear interpolation of the lattice.

use crate::geometry::camera::ImageSize;

/// Fractional bits of a position.
pub(super) const BITS: u32 = 16;
/// Half of the step of the interpolation weights, 1/256 px.
pub(super) const HALF: i32 = 1 << (BITS - 9);
/// Largest step of pieces that are read in one window, less than 2 px: four pixels begin within 7 columns.
pub(super) const NARROW: i32 = (2 << BITS) - 1;

/// Overlap of a segment with the raw image.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Part {
    /// No pixel is inside.
    None,
    /// Each pixel has to be tested.
    Some,
    /// All pixels are inside, and before the last column and row.
    All,
}

/// Pixels between two columns of the lattice.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    pub column: Run,
    pub row: Run,
    pub part: Part,
}

/// One coordinate of a segment's pixels, px with [`BITS`] fractional bits plus half a 256th: from `start`
/// along straight pieces, by `step` per pixel in the first piece and `bend` more in each next one. All three
/// are even, so that the fractions of both coordinates, with a bit for what overflows, fit into one word.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    pub start: i32,
    pub step: i32,
    pub bend: i32,
}

/// Constants of all cells of a lattice.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    /// Side as a power of two.
    shift: u32,
    /// From the distance of two positions to a step.
    step: Rounded,
    /// From a second difference of four positions to a bend.
    bend: Rounded,
    /// Number of bends along a cell.
    bent: i32,
    /// All bits of the bend where straight pieces have four pixels, none where they have one.
    moved: i32,
}

/// Division by a power of two, rounded to the nearest even number.
#[derive(Clone, Copy, Debug)]
struct Rounded {
    half: i32,
    shift: u32,
}

impl Rounded {
    fn by(shift: u32) -> Self {
        Self { half: 1 << shift, shift: shift + 1 }
    }

    // A shift that is known to be less than 32 takes no code for others.
    #[inline(always)]
    fn of(self, x: i32) -> i32 {
        (x.wrapping_add(self.half) >> (self.shift & 31)) << 1
    }
}

impl Cell {
    /// Creates the constants of cells of `2^shift` px in pieces of `2^piece`.
    pub fn new(shift: u32, piece: u32) -> Self {
        let pieces = 1 << (shift - piece);
        Self {
            shift,
            step: Rounded::by(shift),
            bend: Rounded::by(2 * shift + 1 - piece),
            bent: (pieces * (pieces - 1) / 2) << piece,
            moved: if piece > 0 { -1 } else { 0 },
        }
    }
}

impl Segment {
    /// One without pixels.
    pub const NONE: Self = {
        let nowhere = Run { start: 0, step: 0, bend: 0 };
        Self { column: nowhere, row: nowhere, part: Part::None }
    };

    /// Clears the mask of pixels outside the raw image.
    pub fn mask(&self, raw: ImageSize, piece: u32, valid: &mut [u8]) {
        match self.part {
            Part::None => valid.fill(0),
            Part::All => {}
            Part::Some => self.mask_pieces(raw, piece, valid),
        }
    }

    #[inline(never)]
    fn mask_pieces(&self, raw: ImageSize, piece: u32, valid: &mut [u8]) {
        let (mut column, mut row) = (self.column, self.row);
        // From 0 to the last pixel, within a 256th.
        let [right, bottom] =
            [raw.width, raw.height].map(|side| ((u32::from(side) - 1) << BITS) + 2 * HALF as u32);
        let is_in = |x: i32, y: i32| x.cast_unsigned() < right && y.cast_unsigned() < bottom;
        let mut begins_in = is_in(column.start, row.start);
        for valid in valid.chunks_mut(1 << piece) {
            let (mut x, mut y, step) = (column.start, row.start, (column.step, row.step));
            column.advance(piece);
            row.advance(piece);
            let ends_in = is_in(column.start, row.start);
            // A piece is straight: its ends decide.
            if !begins_in || !ends_in {
                for valid in valid {
                    *valid = is_in(x, y).into();
                    (x, y) = (x.wrapping_add(step.0), y.wrapping_add(step.1));
                }
            }
            begins_in = ends_in;
        }
    }
}

impl Run {
    /// Fits the parabola through two lattice points with the curvature of the cubic through these and their
    /// two neighbours, in pieces of 1 or 4 pixels. A chord of four pixels is off by up to half of `bend` in
    /// its middle, so that all are moved by a quarter.
    #[inline(always)]
    pub fn between([before, from, to, after]: [i32; 4], cell: &Cell) -> Self {
        let bend = cell.bend.of(before + after - from - to);
        let step = cell.step.of(to - from - cell.bent * bend);
        let start = from + HALF - ((bend & cell.moved) >> 2);
        Self { start: start & !1, step, bend }
    }

    /// Bounds of the positions along a cell.
    pub fn reach(&self, cell: &Cell) -> (i32, i32) {
        let end = self.start + (self.step << cell.shift) + cell.bent * self.bend;
        // Where the tangents at both ends meet: a parabola stays between its ends and that (Bézier).
        let meet = self.start + (((2 * self.step - self.bend) << cell.shift) >> 2);
        (self.start.min(end).min(meet) - 1, self.start.max(end).max(meet) + 1)
    }

    /// Positions of the pixels.
    pub fn places(&self, piece: u32) -> impl Iterator<Item = i32> {
        let mut run = *self;
        let pieces = core::iter::from_fn(move || {
            let this = run;
            run.advance(piece);
            Some((0..1 << piece).map(move |k| this.at(k)))
        });
        pieces.flatten()
    }

    /// Position of pixel `k` of the current piece.
    #[inline(always)]
    pub fn at(&self, k: i32) -> i32 {
        self.start.wrapping_add(self.step.wrapping_mul(k))
    }

    /// Whether each of that many pieces of four pixels advances by 0 to [`NARROW`] per pixel.
    #[inline(always)]
    pub fn is_narrow(&self, pieces: usize) -> bool {
        // The step grows or shrinks all along: its ends decide.
        let is_small = |step: i32| (0..=NARROW).contains(&step);
        is_small(self.step) && is_small(self.step.wrapping_add(self.bend.wrapping_mul(pieces as i32)))
    }

    /// The run from that many pieces of four pixels on.
    #[cfg(any(test, stereopsis_dsp, stereopsis_vectors))]
    #[inline(always)]
    pub fn after(&self, pieces: i32) -> Self {
        let bent = self.bend.wrapping_mul(pieces.wrapping_mul(pieces.wrapping_sub(1)) << 1);
        let advance = self.step.wrapping_mul(pieces << 2).wrapping_add(bent);
        let step = self.step.wrapping_add(self.bend.wrapping_mul(pieces));
        Self { start: self.start.wrapping_add(advance), step, bend: self.bend }
    }

    /// Advances by a piece; past the last one the run is meaningless.
    #[inline(always)]
    pub fn advance(&mut self, piece: u32) {
        self.start = self.start.wrapping_add(self.step << piece);
        self.step = self.step.wrapping_add(self.bend);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_in_fours() {
        // 16 k^2 at -8, 0, 8 and 16: at 0, 4 and 8 it is 0, 256 and 1024, less a quarter of the bend.
        let cell = Cell::new(3, 2);
        let run = Run::between([1024, 0, 1024, 4096], &cell);
        assert_eq!((run.start, run.step, run.bend), (HALF - 32, 64, 128));
        let places: [i32; 6] = core::array::from_fn(|k| run.places(2).nth(k).unwrap_or(0) - run.start);
        assert_eq!(places, [0, 64, 128, 192, 256, 448]);
        assert_eq!(run.reach(&cell), (run.start - 1, run.start + 1025));
        let after = |pieces: i32| (run.after(pieces).start - run.start, run.after(pieces).step);
        assert_eq!([0, 1, 2].map(after), [(0, 64), (256, 192), (1024, 320)]);
        // And in pieces of one.
        let run = Run::between([1024, 0, 1024, 4096], &Cell::new(3, 0));
        let places: [i32; 5] = core::array::from_fn(|k| run.places(0).nth(k).unwrap_or(0) - HALF);
        assert_eq!(places, [0, 16, 64, 144, 256]);
    }

    #[test]
    fn pieces_are_narrow_when_the_first_and_the_last_are() {
        let is_narrow = |step: i32, bend: i32, pieces: usize| Run { start: 9, step, bend }.is_narrow(pieces);
        assert_eq!([-1, 0, NARROW, NARROW + 1].map(|step| is_narrow(step, 0, 4)), [false, true, true, false]);
        // Steps that shrink to less than none, and that grow to less than two pixels or to more.
        assert_eq!([2, 3].map(|pieces| is_narrow(100, -50, pieces)), [true, false]);
        assert_eq!([2, 3].map(|pieces| is_narrow(NARROW - 10, 5, pieces)), [true, false]);
        assert!(!is_narrow(-10, 5, 4) && !is_narrow(NARROW + 10, -5, 4));
    }

    #[test]
    fn pixels_outside_are_masked() {
        // Sixteen pixels in steps of three quarters of a pixel, from two pixels left of an image of 9.
        let raw = ImageSize { width: 9, height: 4 };
        let run = |start: i32, step: i32| Run { start: start + HALF, step, bend: 0 };
        let one = 1 << BITS;
        for piece in [0, 2] {
            let mask = |column: Run, row: Run| {
                let mut valid = [1; 16];
                Segment { column, row, part: Part::Some }.mask(raw, piece, &mut valid);
                valid
            };
            let along = run(-2 * one, one / 4 * 3);
            let inside: [u8; 16] = core::array::from_fn(|k| {
                let x = -2.0 + 0.75 * k as f64;
                u8::from((0.0..=8.0).contains(&x))
            });
            assert_eq!(mask(along, run(one, 0)), inside);
            // Below and above the image there is none; its last row is one.
            let rows =
                [-one / 8, 0, 3 * one, 3 * one + one / 8].map(|row| mask(along, run(row, 0)) == inside);
            assert_eq!(rows, [false, true, true, false]);
            assert_eq!(mask(along, run(-one / 8, 0)), [0; 16]);
        }
        let part = |part: Part| {
            let mut valid = [7; 4];
            Segment { column: run(0, one), row: run(0, 0), part }.mask(raw, 2, &mut valid);
            valid
        };
        assert_eq!([part(Part::None), part(Part::All)], [[0; 4], [7; 4]]);
    }
}
