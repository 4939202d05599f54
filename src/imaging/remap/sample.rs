//! Pixels between four raw ones of the band.

use super::segment::{BITS, NARROW, Segment};
use crate::geometry::ImageSize;

/// Columns of the raw image that a piece may span to be looked up at once.
const SPAN: usize = 8;
/// A row of them, with the one to the right of the last.
const ROW: usize = SPAN + 1;

/// The raw lines that are held: `N` of `W` pixels, the last one a copy of the first.
pub(super) struct Band<'a, const W: usize, const N: usize> {
    lines: &'a [u8],
    /// The raw row in the first line, px with [`BITS`] fractional bits: rows of places count from it.
    top: i32,
    raw: ImageSize,
    piece: u32,
}

impl<'a, const W: usize, const N: usize> Band<'a, W, N> {
    /// Lines of a raw image of that size, with its row `top` in the first, for segments in pieces of `2^piece` pixels.
    pub fn new(lines: &'a [[u8; W]; N], top: u16, raw: ImageSize, piece: u32) -> Self {
        Self { lines: lines.as_flattened(), top: i32::from(top) << BITS, raw, piece }
    }

    /// The pixels of a segment; unless all of it is inside the raw image, it is at an `EDGE`.
    #[inline(never)]
    pub fn segment<const EDGE: bool>(&self, segment: &Segment, out: &mut [u8], valid: &[u8]) {
        let (mut column, mut row) = (segment.column, segment.row);
        row.start -= self.top;
        let (mut out, mut valid) = (out, valid);
        if self.piece == 2 && column.is_narrow(out.len() / 4) {
            let ((fours, rest), (valids, rest_valid)) = (out.as_chunks_mut::<4>(), valid.as_chunks::<4>());
            for (four, valid) in fours.iter_mut().zip(valids) {
                let (x, y, right, down) = (column.start, row.start, column.step, row.step);
                // What is right of the last column and below the last row weighs nothing: any pixel of the band will do.
                let is_edge = EDGE && *valid != [1; 4];
                column.advance(2);
                row.advance(2);
                // Says no more than is known, and keeps the compiler from counting multiples of the step along.
                column.step &= NARROW;
                let at = Self::index(x, y);
                match self.lines.get(at..at.wrapping_add(W + ROW)) {
                    // Mostly all of it is between the same two rows.
                    Some(window) if (y ^ row.start) >> BITS == 0 && !is_edge => {
                        between_two::<W>(window, x, y, right, down, four)
                    }
                    _ if EDGE => self.at_the_edge(x, y, right, down, four, valid),
                    _ => self.anywhere(x, y, right, down, four),
                }
            }
            if rest.is_empty() {
                return;
            }
            (out, valid) = (rest, rest_valid);
        }
        for (out, valid) in out.chunks_mut(1 << self.piece).zip(valid.chunks(1 << self.piece)) {
            let (x, y, right, down) = (column.start, row.start, column.step, row.step);
            if EDGE {
                self.at_the_edge(x, y, right, down, out, valid);
            } else {
                self.anywhere(x, y, right, down, out);
            }
            column.advance(self.piece);
            row.advance(self.piece);
        }
    }

    /// Pixels of which some are outside, or on the last column or row.
    #[inline(never)]
    fn at_the_edge(&self, mut x: i32, mut y: i32, right: i32, down: i32, out: &mut [u8], valid: &[u8]) {
        for (out, &valid) in out.iter_mut().zip(valid) {
            *out = if valid == 0 { 0 } else { self.near_the_last(x, y.wrapping_add(self.top)) };
            x = x.wrapping_add(right);
            y = y.wrapping_add(down);
        }
    }

    /// Pixels that are inside, the first at a place, the others by steps from it.
    #[inline(never)]
    fn anywhere(&self, mut x: i32, mut y: i32, right: i32, down: i32, out: &mut [u8]) {
        for out in out {
            let [upper, lower] = self.four(x, y);
            *out = mean(upper, lower, fraction(x), fraction(y));
            x = x.wrapping_add(right);
            y = y.wrapping_add(down);
        }
    }

    /// The pixel at a place that may be on the image's last column or row.
    fn near_the_last(&self, column: i32, row: i32) -> u8 {
        let (x, right) = split(column, self.raw.width);
        let (y, down) = split(row, self.raw.height);
        let [upper, lower] = self.four(x << BITS, (y << BITS).wrapping_sub(self.top));
        mean(upper, lower, right, down)
    }

    /// Where the pixel of a place that is inside is in the band.
    #[inline(always)]
    fn index(column: i32, row: i32) -> usize {
        let (rows, row) = (N as u32 - 1, row.cast_unsigned() >> BITS);
        // Lines are counted from one within the band: those past its end begin again.
        let line = if rows.is_power_of_two() { row & (rows - 1) } else { row.min(row.wrapping_sub(rows)) };
        // 16 bits each, of lines with at most 4096 pixels.
        (line as usize).wrapping_mul(W).wrapping_add((column.cast_unsigned() >> BITS) as usize)
    }

    /// Four pixels of the band: two neighbours, and the two below.
    #[inline(always)]
    fn four(&self, column: i32, row: i32) -> [u16; 2] {
        let at = Self::index(column, row);
        let window = self.lines.get(at..at.wrapping_add(W + 2)).unwrap_or_default();
        [two(window, 0), two(window, W)]
    }
}

/// Four pixels that are between the same two rows, in a window that begins where the first one is.
#[inline(always)]
fn between_two<const W: usize>(window: &[u8], x: i32, mut y: i32, right: i32, down: i32, out: &mut [u8; 4]) {
    let mut along = x & ((1 << BITS) - 1);
    for out in out {
        let at = (along >> BITS) as usize % SPAN;
        *out = mean(two(window, at), two(window, W + at), fraction(along), fraction(y));
        along = along.wrapping_add(right);
        y = y.wrapping_add(down);
    }
}

/// Two neighbours, the left one in the low byte.
#[inline(always)]
fn two(pixels: &[u8], at: usize) -> u16 {
    pixels.get(at..at + 2).and_then(|two| two.first_chunk()).map_or(0, |two| u16::from_le_bytes(*two))
}

/// A place as a pixel that has another after it, and 256ths of the way to that: all of it on the image's last one.
fn split(place: i32, side: u16) -> (i32, u32) {
    let whole = (place >> BITS).clamp(0, i32::from(side.saturating_sub(2)));
    (whole, (place >> (BITS - 8)).wrapping_sub(whole << 8) as u32)
}

/// 256ths of the way from a place's pixel to the next.
#[inline(always)]
fn fraction(place: i32) -> u32 {
    (place >> (BITS - 8)) as u32 & 0xff
}

/// The mean of two pixels and the two below them, weighted by 256ths of a pixel to the right and down, to the nearest.
///
/// The two rows are weighted together, in the halves of a word: each is at most 255 * 256, and half of a 256th is added for
/// rounding, so that neither leaves its half.
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
        let mean = |upper, lower, right, down| mean(u16::from_le_bytes(upper), u16::from_le_bytes(lower), right, down);
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
}
