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
use crate::matching::backend::loops::{fill_row, keep_loop};
use crate::matching::memory::Rows5;
use crate::matching::memory::rings::waiting;
use crate::matching::memory::slices::{copy, part, part_mut, split_mut};
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

/// Whether patterns are looked for. A window's costs say which of its disparities are as good, so that its
/// methods have no code for it. A narrower row has none.
#[inline(always)]
fn is_asked<S: Method>(frame: &Frame<'_>) -> bool {
    S::VERTICAL_FILTER && frame.config.checks.refuse_repeats && frame.width >= LEAST_PERIOD + LEAST_RUN
}

/// Forgets the frame before.
pub(super) fn begin(frame: &mut Frame<'_>) {
    let bytes = words(frame.width).min(frame.blocks.len());
    part_mut(frame.blocks, bytes..).fill(0);
}

/// Takes row `y` of the left image; below the image all stays as it is.
#[inline(never)]
pub(super) fn take_repeats<S: Method>(frame: &mut Frame<'_>, y: usize, lines: Option<[&Rows5<'_>; 2]>) {
    if let Some([left, _]) = lines
        && is_asked::<S>(frame)
        && y.is_multiple_of(EVERY)
    {
        let most = usize::from(frame.config.disparities) - 1;
        let bytes = words(frame.width);
        let (_, rest) = split_mut(frame.blocks, bytes);
        let (twice, rest) = split_mut(rest, bytes);
        let (latest, rest) = split_mut(rest, bytes);
        let (before, rest) = split_mut(rest, bytes);
        let before_that = part_mut(rest, ..bytes);
        copy(before, before_that);
        copy(latest, before);
        latest.fill(0);
        mark(part(left[2], ..frame.width), most, frame.config.noise, latest);
        let three = latest.iter().zip(before).zip(before_that);
        for (twice, ((a, b), c)) in twice.iter_mut().zip(three) {
            *twice = *a & *b | *a & *c | *b & *c;
        }
    }
}

/// Sets the bits of the blocks where a line repeats itself within `most` pixels.
#[inline(never)]
fn mark(line: &[u8], most: usize, noise: Noise, blocks: &mut [u8]) {
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
fn mark_period(line: &[u8], pixels: Range<usize>, period: usize, slack: u8, blocks: &mut [u8]) {
    let least_run = LEAST_RUN.max(period + period / 2);
    if period == 0 || pixels.len() < least_run {
        return;
    }
    let mut run = 0;
    for x in pixels {
        keep_loop();
        let before = x.checked_sub(period + 1).and_then(|first| line.get(first..first + 3));
        let repeats = match (before, line.get(x)) {
            (Some(&[a, b, c]), Some(&pixel)) => {
                let (low, high) = (a.min(b).min(c), a.max(b).max(c));
                pixel.saturating_add(slack) >= low && pixel <= high.saturating_add(slack)
            }
            _ => false,
        };
        run = if repeats { run + 1 } else { 0 };
        if run == least_run {
            for block in x.saturating_sub(run - 1 + period) / BLOCK..x / BLOCK {
                keep_loop();
                set(blocks, block);
            }
        }
        if run >= least_run {
            set(blocks, x / BLOCK);
        }
    }
}

/// Sets the bit of a block.
#[inline(always)]
fn set(blocks: &mut [u8], block: usize) {
    if let Some(bits) = blocks.get_mut(block / 8) {
        *bits |= 1 << (block % 8);
    }
}

/// Refuses the answers of `newest` that are on a pattern or beside it.
#[inline(never)]
pub(super) fn refuse_repeats<S: Method>(frame: &mut Frame<'_>, newest: usize) {
    if is_asked::<S>(frame) {
        let first = usize::from(frame.config.min_disparity).min(frame.width);
        let (answers, flags) = (frame.band.row_mut(newest), frame.flags.row_mut(newest));
        for_columns(part(frame.blocks, words(frame.width)..), frame.width, &mut |places| {
            // Left of the first candidate pixels are outside.
            let places = places.start.max(first)..places.end.max(first);
            for flags in part_mut(flags, places.clone()) {
                *flags = flags.union(PixelFlags::AMBIGUOUS);
            }
            fill_row(part_mut(answers, places), Disparity::NONE);
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
            // On a large pattern nothing was filled.
            let all = flags.iter().fold(PixelFlags::CLEAR, |all, &flags| all.union(flags));
            if all.contains(PixelFlags::FILLED) {
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
        let mut blocks = [0; 4];
        mark(line, most, Noise::None, &mut blocks);
        u32::from_le_bytes(blocks)
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
}
