//! The paths through a row.
#![allow(unsafe_code)]

use super::super::{COLUMNS_OFF, Guide, PathWork};
use super::blocks::{self, Padded};
use super::{Steps, far, splat, stride};
use crate::matching::kernels::scratch::{words_mut, words_of};

/// Where a path along the row goes.
pub(super) enum Way {
    Left,
    Right,
}

/// Whether there are all columns that the loops go through.
fn is_whole(work: &PathWork<'_>, stride: usize) -> bool {
    let volumes = [&work.costs, &work.top, &work.sums];
    volumes.iter().all(|volume| volume.len() >= work.width * stride)
}

/// Moves the path from above down to the row.
#[inline(always)]
pub(super) fn down<const WORDS: usize, const ALL: bool>(work: &mut PathWork<'_>, guide: Guide<'_>) {
    let (width, stride) = (work.width, stride::<WORDS, ALL>(work));
    let (count, fours) = (stride / 4, stride / 16);
    if !is_whole(work, stride) {
        return;
    }
    let steps = Steps::new(work.penalties);
    let (mut costs, tops) = (words_of(work.costs).as_ptr(), words_mut(work.top));
    // What stood above columns that are overwritten already: of even and odd ones the last. Before the first there is
    // the first.
    let mut passed = [[0; WORDS]; COLUMNS_OFF];
    for passed in &mut passed {
        for (to, from) in passed.iter_mut().zip(tops.iter().take(count)) {
            *to = *from;
        }
    }
    let mut top = tops.as_mut_ptr();
    let mut between = Padded::<WORDS>::new(count, splat(far(work.penalties)));
    // In the first row nothing is above.
    let line = guide.above.unwrap_or(guide.here);
    for (x, (&here, &above)) in guide.here.iter().zip(line).take(width).enumerate() {
        // SAFETY: column `x` and those up to `COLUMNS_OFF` after it are in the volumes, and a column has `4 * fours` words,
        // `WORDS` at the most.
        unsafe {
            let mut least = 0;
            if guide.above.is_some() {
                let ahead = top.add(COLUMNS_OFF.min(width - 1 - x) * count);
                least = blocks::average(&mut passed[x % COLUMNS_OFF], top, ahead, &mut between, fours);
            }
            let step = steps.between(work.penalties, here, above);
            blocks::step_down(&between, least, step, costs, top, fours);
            (costs, top) = (costs.add(count), top.add(count));
        }
    }
}

/// Takes a path along the row, and adds it to the path from above, or the second one to both.
#[inline(always)]
pub(super) fn along<const WORDS: usize, const ALL: bool>(work: &mut PathWork<'_>, line: &[u8], way: Way) {
    let (width, stride) = (work.width, stride::<WORDS, ALL>(work));
    let (count, fours) = (stride / 4, stride / 16);
    if !is_whole(work, stride) || line.len() < width {
        return;
    }
    let steps = Steps::new(work.penalties);
    let mut paths = [Padded::<WORDS>::new(count, splat(far(work.penalties))); 2];
    let [mut here, mut next] = paths.each_mut();
    let (costs, sums) = (words_of(work.costs).as_ptr(), words_mut(work.sums).as_mut_ptr());
    let from = match way {
        Way::Right => words_mut(work.top).as_mut_ptr(),
        Way::Left => sums,
    };
    let (mut least, mut before) = (0, None);
    let pixels = line.iter().take(width).enumerate();
    let go_on = |(x, &pixel): (usize, &u8)| {
        let step = steps.between(work.penalties, pixel, before.unwrap_or(pixel));
        let off = x * count;
        // SAFETY: column `x` is in the volumes, and has `4 * fours` words, `WORDS` at the most.
        least = unsafe {
            let sums = [from.add(off), sums.add(off)];
            blocks::step_along(here, least, step, costs.add(off), next, sums, fours)
        };
        before = Some(pixel);
        core::mem::swap(&mut here, &mut next);
    };
    match way {
        Way::Right => pixels.for_each(go_on),
        Way::Left => pixels.skip(work.min_disparity).rev().for_each(go_on),
    }
}
