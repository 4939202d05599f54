//! The costs of a row's pixels.
//!
//! Of a cost there is the agreement, the most that it may be less what it is, and the [`margin`]: a
//! difference that ends at 0 cuts the cost off, and the average, which is rounded down, rounds the cost up.

use super::columns::words;
use super::lanes::{before, splat};
use super::others::{Costs, LANES, NUMBERS, Others};
use super::paths::{self, shift_in};
use super::steps::margin;
use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::parameters::SgmParameters;
use crate::matching::backend::portable::sgm::features::Features;
use crate::matching::backend::work::PathWork;
use crate::matching::memory::slices::{part, part_mut};
use crate::matching::memory::views::view_mut;
use core::cell::Cell;

/// Adds a row. There is room for so many groups of right pixels, more than a column has words.
#[inline(never)]
pub(super) fn enter<S: SgmParameters, const WORDS: usize, const ALL: bool, const GROUPS: usize>(
    work: &mut PathWork<'_>,
    features: &Features<'_>,
) {
    let Features { left, right, count } = *features;
    let words = words::<WORDS, ALL>(work);
    let costs = Costs {
        left,
        rounds: words / super::columns::FOUR,
        most: splat(work.penalties.cost.into()),
        margin: splat(margin(work.penalties).into()),
    };
    let columns = view_mut::<u8, u32>(work.costs);
    let width = left.brightness.len();
    let mut others = [Others::default(); GROUPS];
    // The next pixel, and where its others begin.
    let (mut x, mut first) = (0, 0);
    while x < width {
        let all = Cell::from_mut(others.as_flattened_mut()).as_slice_of_cells().as_chunks::<NUMBERS>().0;
        let before = part(all, ..words);
        if x == 0 {
            let mut column = 0;
            while column < LANES * words {
                shift_in::<S>((right, count), column, before, before);
                column += words;
            }
        } else {
            // The last groups stay: the first of them stands one column before this pixel.
            for (to, from) in before.iter().zip(part(all, GROUPS.saturating_sub(words)..)) {
                keep_loop();
                to.iter().zip(from).for_each(|(to, from)| to.set(from.get()));
            }
            first = 1;
        }
        shift_in::<S>((right, count), x - first + LANES * words, all, part(all, words..));
        let pixels = (GROUPS + 1 - first).saturating_sub(words).max(1).min(width - x);
        let columns = part_mut(columns, x * words..(x + pixels) * words);
        paths::enter::<S, WORDS, ALL>(&costs, x, part(&others, first..), columns);
        x += pixels;
    }
    close::<WORDS, ALL>(work);
}

/// [`PathWork::close`] in the order of the words.
#[inline(always)]
fn close<const WORDS: usize, const ALL: bool>(work: &mut PathWork<'_>) {
    let words = words::<WORDS, ALL>(work);
    let beyond = (LANES * words).saturating_sub(work.disparities);
    if beyond > 0 {
        let (closed, margin) = (before(beyond, words), splat(margin(work.penalties).into()));
        let mut word = 0;
        for costs in view_mut::<u8, u32>(work.costs) {
            keep_loop();
            let lanes = closed(word);
            *costs = *costs & !lanes | margin & lanes;
            word = if word + 1 < words { word + 1 } else { 0 };
        }
    }
}
