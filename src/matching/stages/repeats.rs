//! Answers refused on patterns that repeat along the row, as a chessboard's, a fence's and those of windows
//! do: disparities a period apart explain both images as well, and paths choose one of them by chance.
//!
//! Each [`EVERY`]th row of the left image is looked at, in one pass. Brightness rises where it has grown by
//! as much as an edge has since it fell, and falls likewise. The pixels between two rises are a period, if it
//! is shorter than the search is. A pixel repeats the one a period before it if its brightness lies in the
//! range of the three there, give or take some, and if rises go on to be a period apart. What repeats for
//! [`LEAST_RUN`] pixels and for a period and a half is a pattern, from the period before it on. Textures
//! hardly ever do that by chance, and less often in two of three rows.
//!
//! A block of four columns is refused where two of the last three rows that were looked at have the pattern
//! there: a bit for each of the three and one for the outcome.

use super::fattening::least_gradient;
use super::open::{BLOCK, for_columns, words};
use crate::imaging::Noise;
use crate::matching::backend::Isa;
use crate::matching::backend::loops::{HAS_VECTORS, NO_ANSWER, fill_bytes, keep_loop, keep_scalar_loop};
use crate::matching::memory::Rows5;
use crate::matching::memory::rings::waiting;
use crate::matching::memory::slices::{part, part_mut, split_mut};
use crate::matching::memory::views::{view, view_mut};
use crate::matching::method::{Frame, Method};
use crate::units::{Disparity, PixelFlags};
use core::ops::Range;

/// Rows from one that is looked at to the next one: no power of two, as the sides of squares often are, whose
/// edges would be all that is seen.
const EVERY: usize = 5;
/// The shortest period, px.
const LEAST_PERIOD: usize = 4;
/// The fewest pixels that repeat those before them.
const LEAST_RUN: usize = 24;
/// How many pixels are compared with those before them at once.
const AT_ONCE: usize = if HAS_VECTORS { 16 } else { 4 };
/// The flag of answers on a pattern, of four pixels.
const AMBIGUOUS: u32 = PixelFlags::AMBIGUOUS.bits() as u32 * 0x0101_0101;
/// The flag of answers that were filled in, of four pixels.
const FILLED: u32 = PixelFlags::FILLED.bits() as u32 * 0x0101_0101;

/// Whether patterns are looked for. A window's costs say which of its disparities are as good, so that its
/// methods have no code for it. A narrower row has none.
#[inline(always)]
fn is_asked<S: Method>(frame: &Frame<'_>) -> bool {
    S::ALONG_PATHS && frame.config.checks.refuse_repeats && frame.width >= LEAST_PERIOD + LEAST_RUN
}

/// Forgets the frame before.
pub(super) fn begin(frame: &mut Frame<'_>) {
    let words = words(frame.width).min(frame.blocks.len());
    fill_bytes(part_mut(frame.blocks, words..), 0);
}

/// Takes row `y` of the left image; below the image all stays as it is.
#[inline(never)]
pub(super) fn take_repeats<S: Method>(frame: &mut Frame<'_>, y: usize, lines: Option<[&Rows5<'_>; 2]>) {
    if let Some([left, _]) = lines
        && is_asked::<S>(frame)
        && y.is_multiple_of(EVERY)
    {
        let most = usize::from(frame.config.disparities) - 1;
        let words = words(frame.width);
        let (_, rest) = split_mut(frame.blocks, words);
        let (twice, rest) = split_mut(rest, words);
        let (latest, rest) = split_mut(rest, words);
        let (before, rest) = split_mut(rest, words);
        let before_that = part_mut(rest, ..words);
        for ((latest, before), before_that) in latest.iter_mut().zip(&mut *before).zip(&mut *before_that) {
            keep_loop();
            (*before_that, *before, *latest) = (*before, *latest, 0);
        }
        mark(part(left[2], ..frame.width), most, frame.config.noise, latest);
        let three = latest.iter().zip(before).zip(before_that);
        for (twice, ((a, b), c)) in twice.iter_mut().zip(three) {
            keep_loop();
            *twice = *a & *b | (*a | *b) & *c;
        }
    }
}

/// Sets the bits of the blocks where a line repeats itself within `most` pixels.
#[inline(never)]
fn mark(line: &[u8], most: usize, noise: Noise, blocks: &mut [u32]) {
    let least = u32::from(least_gradient(noise));
    let slack = (least / 8 * 3) as u8;
    // Where brightness falls, it is turned round: so it is always the least value that is looked for.
    let (mut turned, mut lowest) = (0, u32::from(line.first().copied().unwrap_or(0)));
    // The last rise is farther away than any period.
    let (mut first, mut risen, mut period) = (0, usize::MAX / 2, 0);
    for (x, &pixel) in line.iter().enumerate() {
        keep_loop();
        let value = u32::from(pixel) ^ turned;
        lowest = lowest.min(value);
        if value - lowest >= least {
            turned ^= 255;
            lowest = u32::from(pixel) ^ turned;
            if turned != 0 {
                let apart = x.wrapping_sub(risen);
                if period == 0 || apart.abs_diff(period) > 1 {
                    // Hardly ever: what it is called with need not be put together.
                    if x - first >= LEAST_RUN {
                        mark_period(line, first..x.min(risen + period + 2), period, slack, blocks);
                    }
                    period = if (LEAST_PERIOD..=most).contains(&apart) { apart } else { 0 };
                    first = x;
                }
                risen = x;
            }
        }
    }
    mark_period(line, first..line.len().min(risen + period + 2), period, slack, blocks);
}

/// Sets the bits of the blocks where a line repeats itself among the pixels whose rises are `period` pixels
/// apart, give or take `slack` in brightness. Most textures have far fewer of them than a pattern needs.
#[inline(never)]
fn mark_period(line: &[u8], pixels: Range<usize>, period: usize, slack: u8, blocks: &mut [u32]) {
    let least_run = LEAST_RUN.max(period + period / 2);
    if period == 0 || pixels.len() < least_run {
        return;
    }
    // Before these there are no three a period away.
    let first = pixels.start.max(period + 1);
    let end = pixels.end.min(line.len()).max(first);
    let (before, here) = (part(line, first - period..end - period), part(line, first..end));
    let (groups, rest) = here.as_chunks();
    let mut runs = Runs { line, period, slack, least_run, begin: first, blocks };
    let mut x = first;
    for (pixels, others) in groups.iter().zip(before.as_chunks().0) {
        keep_scalar_loop();
        // Mostly those in the middle of the three stand for them.
        if !are_near(pixels, others, slack) {
            runs.look_at(x..x + AT_ONCE);
        }
        x += AT_ONCE;
    }
    runs.look_at(end - rest.len()..end);
    runs.end(end);
}

/// Runs of pixels that repeat those a period before them.
struct Runs<'a> {
    line: &'a [u8],
    period: usize,
    slack: u8,
    least_run: usize,
    /// Where the newest one begins.
    begin: usize,
    blocks: &'a mut [u32],
}

impl Runs<'_> {
    /// Ends a run at each pixel that does not repeat one of the three.
    #[inline(never)]
    fn look_at(&mut self, pixels: Range<usize>) {
        for x in pixels {
            keep_loop();
            if !self.is_repeated(x) {
                self.end(x);
                self.begin = x + 1;
            }
        }
    }

    /// Whether the brightness of a pixel lies in the range of the three a period before it, give or take
    /// `slack`.
    #[inline(always)]
    fn is_repeated(&self, x: usize) -> bool {
        let before = self.line.get(x.wrapping_sub(self.period + 1)..).and_then(|before| before.first_chunk());
        let Some((&pixel, &[a, b, c])) = self.line.get(x).zip(before) else { return false };
        let (pixel, slack) = (u32::from(pixel), u32::from(self.slack));
        pixel + slack >= u32::from(a.min(b).min(c)) && pixel <= u32::from(a.max(b).max(c)) + slack
    }

    /// Sets the bits of the blocks of the run up to a pixel, if it is long enough, and of the period before.
    #[inline(always)]
    fn end(&mut self, end: usize) {
        if end - self.begin >= self.least_run {
            mark_blocks((self.begin - self.period) / BLOCK..end.div_ceil(BLOCK), self.blocks);
        }
    }
}

/// Whether pixels are as bright as others, give or take `slack`.
#[inline(always)]
fn are_near(pixels: &[u8; AT_ONCE], others: &[u8; AT_ONCE], slack: u8) -> bool {
    if HAS_VECTORS {
        return pixels.iter().zip(others).fold(0, |most, (a, b)| most.max(a.abs_diff(*b))) <= slack;
    }
    // In each half-word the difference, either way, and so much more that a bit is set if it is greater.
    const EVEN: u32 = 0x00ff_00ff;
    const GREATER: u32 = 0x0200_0200;
    let more = GREATER - (u32::from(slack) + 1) * 0x1_0001;
    let bits = |a: u32, b: u32| (more + a - b) | (more + b - a);
    pixels.as_chunks().0.iter().zip(others.as_chunks().0).all(|(four, others)| {
        let [a, b] = [four, others].map(|four| u32::from_le_bytes(*four));
        (bits(a & EVEN, b & EVEN) | bits(a >> 8 & EVEN, b >> 8 & EVEN)) & GREATER == 0
    })
}

/// Sets the bits of blocks.
#[inline(never)]
fn mark_blocks(of: Range<usize>, blocks: &mut [u32]) {
    for (number, word) in blocks.iter_mut().enumerate() {
        keep_loop();
        // The bits from the first block on, and those from the end on.
        let from = |block: usize| u32::MAX.unbounded_shl(block.saturating_sub(32 * number) as u32);
        *word |= from(of.start) & !from(of.end);
    }
}

/// Refuses the answers of `newest` that are on a pattern or beside it.
#[inline(never)]
pub(super) fn refuse_repeats<S: Method>(frame: &mut Frame<'_>, newest: usize) {
    if is_asked::<S>(frame) {
        let (first, backend) = (usize::from(frame.config.min_disparity).min(frame.width), frame.backend);
        let (answers, flags) = (frame.band.row_mut(newest), frame.flags.row_mut(newest));
        for_columns(part(frame.blocks, words(frame.width)..), frame.width, &mut |places| {
            // Left of the first candidate pixels are outside.
            let places = places.start.max(first)..places.end.max(first);
            let flags = part_mut(flags, places.clone());
            let words = view_mut::<PixelFlags, u32>(flags);
            if size_of_val(words) == places.len() {
                for word in words {
                    keep_scalar_loop();
                    *word |= AMBIGUOUS;
                }
            } else {
                for flags in flags {
                    keep_loop();
                    *flags = flags.union(PixelFlags::AMBIGUOUS);
                }
            }
            backend.fill_bytes(part_mut(answers, places), NO_ANSWER);
        });
    }
}

/// Takes out what was filled of the row that waits where the newest row repeats.
#[inline(never)]
pub(super) fn empty_filled<S: Method>(frame: &mut Frame<'_>, newest: usize) {
    if is_asked::<S>(frame) && frame.config.checks.fill_pixels > 0 {
        let here = waiting(newest);
        let (answers, flags) = (frame.finished.row_mut(here), frame.flags.row_mut(here));
        for_columns(part(frame.blocks, words(frame.width)..), frame.width, &mut |places| {
            let flags = part_mut(flags, places.clone());
            // On a large pattern nothing was filled; what does not stand at words is looked at by the pixel.
            let words = view::<PixelFlags, u32>(flags);
            let mut all = if size_of_val(words) == places.len() { 0 } else { FILLED };
            for word in words {
                keep_scalar_loop();
                all |= word;
            }
            if all & FILLED != 0 {
                for (flags, answer) in flags.iter_mut().zip(part_mut(answers, places)) {
                    keep_loop();
                    if flags.contains(PixelFlags::FILLED) {
                        *flags = flags.without(PixelFlags::FILLED);
                        *answer = Disparity::NONE;
                    }
                }
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn marked(line: &[u8], most: usize) -> u32 {
        let mut blocks = [0];
        mark(line, most, Noise::None, &mut blocks);
        blocks[0]
    }

    #[test]
    fn squares_repeat_from_their_first_rise_on() {
        // Rises in columns 6, 18, 30 ...: a period of 12 px, from a period before the second one on.
        let squares: [u8; 80] = core::array::from_fn(|x| if x / 6 % 2 == 1 { 180 } else { 60 });
        assert_eq!(marked(&squares, 12), 0x000f_fffe);
        assert_eq!(marked(&squares, 11), 0, "a period beyond the search");
        // Too faint to be an edge.
        assert_eq!(marked(&squares.map(|pixel| 60 + pixel / 16), 12), 0);
    }

    #[test]
    fn a_pixel_that_differs_by_more_than_the_slack_ends_a_run() {
        let marked_with = |pixel: u8| {
            let mut squares: [u8; 80] = core::array::from_fn(|x| if x / 6 % 2 == 1 { 180 } else { 60 });
            squares[38] = pixel;
            marked(&squares, 12)
        };
        // Three eighths of an edge's 16 are 6.
        assert_eq!([54, 66].map(marked_with), [0x000f_fffe; 2]);
        // From the second rise to the pixel there are 20, too few. Behind it the pattern goes on.
        assert_eq!([53, 67].map(marked_with), [0x000f_ffc0; 2]);
    }

    #[test]
    fn pixels_are_near_others_if_each_of_them_is() {
        for (a, b) in (0..=255u8).flat_map(|a| (0..=255u8).map(move |b| (a, b))) {
            for (slack, at) in [6, 9, 18].into_iter().zip([0, 1, AT_ONCE - 1]) {
                for (around, other) in [(0, 0), (slack, 0), (255 - slack, 255)] {
                    let (mut pixels, mut others) = ([around; AT_ONCE], [other; AT_ONCE]);
                    (pixels[at], others[at]) = (a, b);
                    assert_eq!(are_near(&pixels, &others, slack), a.abs_diff(b) <= slack, "{a} {b} {slack}");
                }
            }
        }
    }

    #[test]
    fn what_changes_from_period_to_period_does_not_repeat() {
        let stairs: [u8; 80] =
            core::array::from_fn(|x| (x / 12 * 20) as u8 + if x / 6 % 2 == 1 { 60 } else { 0 });
        assert_eq!(marked(&stairs, 12), 0);
        // Rises in columns 6, 18, 32, 48, 66: each period is two pixels longer.
        let bright = [6..12, 18..25, 32..40, 48..57, 66..76];
        let line: [u8; 80] =
            core::array::from_fn(|x| if bright.iter().any(|run| run.contains(&x)) { 180 } else { 60 });
        assert_eq!(marked(&line, 40), 0);
    }

    #[test]
    fn a_pattern_ends_a_period_behind_its_last_rise() {
        // From column 60 on the squares are too faint to rise, while each pixel still repeats.
        let bright = |x: usize| x / 6 % 2 == 1;
        let squares: [u8; 80] = core::array::from_fn(|x| match (bright(x), x < 60) {
            (true, _) => 76,
            (false, true) => 60,
            (false, false) => 61,
        });
        // The last rise is in column 54: up to two pixels behind column 66.
        let expected = 0x0001_fffe;
        assert_eq!(marked(&squares, 12), expected);
        // Another rise, farther away.
        let mut longer = [61; 128];
        for (x, pixel) in longer.iter_mut().enumerate() {
            *pixel = squares.get(x).copied().unwrap_or(if x < 110 { 0 } else { 200 });
        }
        assert_eq!(marked(&longer, 12), expected);
    }
}
