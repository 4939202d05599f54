//! Bilinear interpolation in the band of raw lines.

use super::segment::{BITS, NARROW, Segment};
use crate::geometry::camera::ImageSize;
use core::cell::Cell;

/// Number of raw columns that a piece may span to be read in one window.
const SPAN: usize = 8;
/// Length of such a row, with one pixel to the right.
const ROW: usize = SPAN + 1;

/// Band of `N` raw lines of `W` pixels, the last one a copy of the first.
pub(super) struct Band<'a, const W: usize, const N: usize> {
    lines: &'a [u8],
    /// Raw row of the first line, px with [`BITS`] fractional bits.
    top: i32,
    raw: ImageSize,
    piece: u32,
}

impl<'a, const W: usize, const N: usize> Band<'a, W, N> {
    /// Wraps the lines of a raw image, with row `top` in the first, for segments in pieces of `2^piece`
    /// pixels.
    pub fn new(lines: &'a [[u8; W]; N], top: u16, raw: ImageSize, piece: u32) -> Self {
        Self { lines: lines.as_flattened(), top: i32::from(top) << BITS, raw, piece }
    }

    /// Writes the pixels of a segment, which is at an `EDGE` unless it is wholly inside the raw image.
    #[inline(always)]
    pub fn segment<const EDGE: bool>(&self, segment: &Segment, out: &[Cell<u8>], valid: &[u8]) {
        #[cfg(any(stereopsis_dsp, stereopsis_vectors))]
        if !EDGE && self.piece == 2 {
            let (fours, rest) = out.as_chunks();
            if self.in_step(segment, fours) == fours.len() && rest.is_empty() {
                return;
            }
        }
        self.pieces::<EDGE>(segment, out, valid);
    }

    /// Writes the first pixels of a segment in fours, as many as [`armv7em::fours`](super::armv7em::fours)
    /// does; returns how many fours.
    #[cfg(any(stereopsis_dsp, stereopsis_vectors))]
    #[inline(never)]
    fn in_step(&self, Segment { column, row, .. }: &Segment, fours: &[[Cell<u8>; 4]]) -> usize {
        let mut row = *row;
        row.start = row.start.wrapping_sub(self.top);
        let at = Self::index(column.start, row.start);
        super::armv7em::fours::<W>(self.lines, at, [column, &row], fours)
    }

    /// Writes the pixels of a segment, piece by piece.
    ///
    /// Writing to cells makes the compiler finish each pixel before the next, which keeps its values in
    /// registers.
    #[inline(never)]
    fn pieces<const EDGE: bool>(&self, segment: &Segment, out: &[Cell<u8>], valid: &[u8]) {
        let (mut segment, mut out, mut valid) = (*segment, out, valid);
        if self.piece == 2 && segment.column.is_narrow(out.len() / 4) {
            let ((fours, rest), (valids, rest_valid)) = (out.as_chunks::<4>(), valid.as_chunks::<4>());
            #[cfg(any(stereopsis_dsp, stereopsis_vectors))]
            self.mostly_in_step::<EDGE>(&mut segment, fours, valids);
            #[cfg(not(any(stereopsis_dsp, stereopsis_vectors)))]
            self.fours::<EDGE>(&mut segment, fours, valids);
            if rest.is_empty() {
                return;
            }
            (out, valid) = (rest, rest_valid);
        }
        let Segment { mut column, mut row, .. } = segment;
        row.start = row.start.wrapping_sub(self.top);
        for (out, valid) in out.chunks(1 << self.piece).zip(valid.chunks(1 << self.piece)) {
            self.piece::<EDGE>(column.start, row.start, column.step, row.step, out, valid);
            column.advance(self.piece);
            row.advance(self.piece);
        }
    }

    /// [`Self::fours`] by [`Self::in_step`], but for those that it stops before.
    #[cfg(any(stereopsis_dsp, stereopsis_vectors))]
    fn mostly_in_step<const EDGE: bool>(
        &self,
        segment: &mut Segment,
        mut fours: &[[Cell<u8>; 4]],
        mut valids: &[[u8; 4]],
    ) {
        while !fours.is_empty() {
            let most = match EDGE {
                true => valids.iter().take_while(|valid| **valid == [1; 4]).count(),
                false => fours.len(),
            };
            let done = self.in_step(segment, fours.get(..most).unwrap_or_default());
            segment.column = segment.column.after(done as i32);
            segment.row = segment.row.after(done as i32);
            // Where it does none that it may do, it would do none of the others.
            let end = if done == 0 && most > 0 { fours.len() } else { fours.len().min(done + 1) };
            let others = fours.get(done..end).unwrap_or_default();
            self.fours::<EDGE>(segment, others, valids.get(done..end).unwrap_or_default());
            (fours, valids) = (fours.get(end..).unwrap_or_default(), valids.get(end..).unwrap_or_default());
        }
    }

    /// Writes pixels in fours, whose columns advance by less than 2 px; the segment goes on after them.
    #[inline(always)]
    fn fours<const EDGE: bool>(&self, segment: &mut Segment, fours: &[[Cell<u8>; 4]], valids: &[[u8; 4]]) {
        let Segment { column, row, .. } = segment;
        let (mut x, mut y) = (column.start, row.start.wrapping_sub(self.top));
        let (mut right, mut down) = (column.step, row.step);
        for (four, valid) in fours.iter().zip(valids) {
            let end = y.wrapping_add(down << 2);
            // Mostly all of it is between the same two rows.
            let crossed = (y ^ end) >> BITS;
            let is_done = (!EDGE || *valid == [1; 4])
                && if crossed == 0 {
                    self.between_two(x, y, right, down, four)
                } else {
                    self.between_three(x, y, right, down, four)
                };
            if !is_done {
                self.piece::<EDGE>(x, y, right, down, four, valid);
            }
            x = x.wrapping_add(right << 2);
            y = end;
            // Says no more than is known, places being less than 2^29 apart, and keeps the compiler from
            // counting multiples of the steps along.
            right = right.wrapping_add(column.bend) & NARROW;
            down = down.wrapping_add(row.bend) << 4 >> 4;
        }
        (column.start, column.step) = (x, right);
        (row.start, row.step) = (y.wrapping_add(self.top), down);
    }

    /// Interpolates four pixels between the same two rows; false if they are not.
    #[inline(always)]
    fn between_two(&self, x: i32, mut y: i32, right: i32, down: i32, out: &[Cell<u8>; 4]) -> bool {
        let at = Self::index(x, y);
        let Some(window) = self.lines.get(at..at.wrapping_add(W + ROW)) else { return false };
        let mut along = x & ((1 << BITS) - 1);
        for out in out {
            let at = (along >> BITS) as usize % SPAN;
            out.set(mean(two(window, at), two(window, W + at), fraction(along), fraction(y)));
            along = along.wrapping_add(right);
            y = y.wrapping_add(down);
        }
        true
    }

    /// Interpolates four pixels within three adjacent rows; false if they are not.
    #[inline(always)]
    fn between_three(&self, x: i32, mut y: i32, right: i32, down: i32, out: &[Cell<u8>; 4]) -> bool {
        let top = y.min(y.wrapping_add(down << 2));
        let at = Self::index(x, top);
        let Some(window) = self.lines.get(at..at.wrapping_add(2 * W + ROW)) else { return false };
        // Four steps of a quarter cross one row at most.
        if down.unsigned_abs() > 1 << (BITS - 2) {
            return false;
        }
        y = y.wrapping_sub(top >> BITS << BITS);
        let mut along = x & ((1 << BITS) - 1);
        for out in out {
            let at = ((along >> BITS) as usize % SPAN).wrapping_add((y >> BITS) as usize % 2 * W);
            out.set(mean(two(window, at), two(window, W + at), fraction(along), fraction(y)));
            along = along.wrapping_add(right);
            y = y.wrapping_add(down);
        }
        true
    }

    /// Interpolates the pixels of a piece anywhere.
    #[inline(never)]
    fn piece<const EDGE: bool>(
        &self,
        mut x: i32,
        mut y: i32,
        right: i32,
        down: i32,
        out: &[Cell<u8>],
        valid: &[u8],
    ) {
        for (out, &valid) in out.iter().zip(valid) {
            let at = Self::index(x, y);
            out.set(match self.lines.get(at..at.wrapping_add(W + 2)) {
                _ if EDGE && valid == 0 => 0,
                Some(window) => mean(two(window, 0), two(window, W), fraction(x), fraction(y)),
                // It is the band's last pixel.
                None => self.near_the_last(x, y.wrapping_add(self.top)),
            });
            x = x.wrapping_add(right);
            y = y.wrapping_add(down);
        }
    }

    /// The pixel at a place that may be on the image's last column or row.
    #[inline(never)]
    fn near_the_last(&self, column: i32, row: i32) -> u8 {
        let (x, right) = split(column, self.raw.width);
        let (y, down) = split(row, self.raw.height);
        let [upper, lower] = self.four(x << BITS, (y << BITS).wrapping_sub(self.top));
        mean(upper, lower, right, down)
    }

    /// Index in the band of the pixel of a position inside.
    #[inline(always)]
    fn index(column: i32, row: i32) -> usize {
        let (rows, row) = (N as u32 - 1, row.cast_unsigned() >> BITS);
        // Lines are counted from one within the band: those past its end begin again.
        let line = if rows.is_power_of_two() { row & (rows - 1) } else { row.min(row.wrapping_sub(rows)) };
        // 16 bits each, of lines with at most 4096 pixels.
        (line as usize).wrapping_mul(W).wrapping_add((column.cast_unsigned() >> BITS) as usize)
    }

    /// Two adjacent pixels of the band, and the two below.
    #[inline(always)]
    fn four(&self, column: i32, row: i32) -> [u16; 2] {
        let at = Self::index(column, row);
        let window = self.lines.get(at..at.wrapping_add(W + 2)).unwrap_or_default();
        [two(window, 0), two(window, W)]
    }
}

/// Two adjacent pixels, the left one in the low byte.
#[inline(always)]
fn two(pixels: &[u8], at: usize) -> u16 {
    pixels.get(at..at + 2).and_then(|two| two.first_chunk()).map_or(0, |two| u16::from_le_bytes(*two))
}

/// Splits a position into a pixel with a successor and 256ths of the way to it: 256 on the image's last
/// pixel.
fn split(place: i32, side: u16) -> (i32, u32) {
    let whole = (place >> BITS).clamp(0, i32::from(side.saturating_sub(2)));
    (whole, (place >> (BITS - 8)).wrapping_sub(whole << 8) as u32)
}

/// Fraction of a position in 256ths.
#[inline(always)]
fn fraction(place: i32) -> u32 {
    (place >> (BITS - 8)) as u32 & 0xff
}

/// Bilinear mean of two pixels and the two below them, with weights in 256ths to the right and down, rounded.
///
/// Both rows are weighted at once in the halves of a word: each is at most 255 * 256 plus a rounding half of
/// 256.
#[inline(always)]
fn mean(upper: u16, lower: u16, right: u32, down: u32) -> u8 {
    let four = u32::from(upper) | u32::from(lower) << 16;
    let (left, next) = (four & 0x00ff_00ff, (four >> 8) & 0x00ff_00ff);
    let both = (left << 8 | 0x0080_0080).wrapping_add(next.wrapping_sub(left).wrapping_mul(right));
    let (top, bottom) = (both & 0xffff, both >> 16);
    ((top << 8).wrapping_add(bottom.wrapping_sub(top).wrapping_mul(down)) >> 16) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_of_four() {
        let mean = |upper, lower, right, down| {
            mean(u16::from_le_bytes(upper), u16::from_le_bytes(lower), right, down)
        };
        assert_eq!(mean([10, 20], [30, 40], 0, 0), 10);
        assert_eq!(mean([10, 20], [30, 40], 128, 0), 15);
        assert_eq!(mean([10, 20], [30, 40], 128, 128), 25);
        assert_eq!(mean([10, 20], [30, 40], 256, 256), 40);
        assert_eq!(mean([255; 2], [255; 2], 255, 255), 255);
        assert_eq!(mean([255, 0], [0, 255], 256, 128), 128);
    }

    #[test]
    fn the_band_begins_again() {
        // Three rows and the copy of the first.
        let lines = [[1, 2], [3, 4], [5, 6], [1, 2]];
        let band = Band::new(&lines, 0, ImageSize { width: 2, height: 9 }, 2);
        assert_eq!(band.four(0, 2 << BITS), [0x605, 0x201]);
        assert_eq!(band.four(0, 4 << BITS), [0x403, 0x605]);
    }

    #[test]
    fn a_place_is_split_before_the_last_pixel() {
        // A quarter behind the third pixel, and 255/256 behind it.
        assert_eq!(split((3 << BITS) + (1 << 14), 9), (3, 64));
        assert_eq!(split((4 << BITS) - 1, 9), (3, 255));
        // The last of five pixels is all of the way from the one before it.
        assert_eq!(split(4 << BITS, 5), (3, 256));
        assert_eq!(split(0, 1), (0, 0));
    }

    #[test]
    fn the_last_pixel_of_the_image_is_itself() {
        // Three rows and the copy of the first; the second is the image's last, of two pixels.
        let lines = [[1, 2], [3, 4], [5, 6], [1, 2]];
        let band = Band::new(&lines, 0, ImageSize { width: 2, height: 2 }, 2);
        let one = 1 << BITS;
        assert_eq!(
            [(0, 0), (one, 0), (0, one), (one, one)].map(|(x, y)| band.near_the_last(x, y)),
            [1, 2, 3, 4]
        );
        assert_eq!(band.near_the_last(one / 2, one), 4, "3.5, rounded");
        // With row 6 in the first line.
        let band = Band::new(&lines, 6, ImageSize { width: 2, height: 8 }, 2);
        assert_eq!([6, 7].map(|row| band.near_the_last(one, row << BITS)), [2, 4]);
    }
}
