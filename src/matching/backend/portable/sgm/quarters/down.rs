//! The path from above.

use super::columns::{FOUR, column, words};
use super::lanes::{average, least_of_four, lesser, splat};
use super::steps::{Step, Steps, close, ends, most};
use crate::matching::backend::loops::keep_loop;
use crate::matching::backend::work::{Guide, PathWork};
use crate::matching::memory::layout::COLUMNS_OFF;
use crate::matching::memory::slices::part_mut;
use crate::matching::memory::views::{view, view_mut};
use core::cell::Cell;

/// Moves the path from above down to the row, and adds it to the sums.
///
/// It takes no room of its own: the paths of an odd row stand two columns further to the right than those of
/// an even row. So each goes where one of the two was that it comes from, if odd rows are taken from right to
/// left.
#[inline(never)]
pub(super) fn down<const WORDS: usize, const ALL: bool>(work: &mut PathWork<'_>, guide: Guide<'_>) {
    let steps = Steps::new(work.penalties);
    let (count, last) = (words::<WORDS, ALL>(work), work.width.wrapping_sub(1));
    let beyond = (4 * count).saturating_sub(work.disparities);
    // From what stands in memory for a cost to a path's cost, but for a jump.
    let base = splat(most(work.penalties).into()).wrapping_sub(splat(128));
    let costs = view::<u8, u32>(work.costs);
    let tops = Cell::from_mut(view_mut::<u8, u32>(work.top)).as_slice_of_cells();
    let sums = Cell::from_mut(view_mut::<u8, u32>(work.sums)).as_slice_of_cells();
    let mut room = [0; WORDS];
    let cells = Cell::from_mut(part_mut(&mut room, ..count)).as_slice_of_cells();
    let is_odd = !guide.row.is_multiple_of(2);
    let (from, to) = if is_odd { (0, COLUMNS_OFF) } else { (COLUMNS_OFF, 0) };
    for i in 0..work.width {
        let x = if is_odd { last - i } else { i };
        let places = [x * count, (x + to) * count];
        let (Some(&here), Some(costs), Some(sums), Some(kept)) = (
            guide.here.get(x),
            column(costs, places[0], count),
            column(sums, places[0], count),
            column(tops, places[1], count),
        ) else {
            return;
        };
        let (mut least, mut above) = (0, here);
        if let Some(line) = guide.above {
            above = line.get(x).copied().unwrap_or(0);
            let [one, other] = [x.saturating_sub(COLUMNS_OFF), (x + COLUMNS_OFF).min(last)];
            let two = [one, other].map(|x| column(tops, (x + from) * count, count));
            let [Some(one), Some(other)] = two else { return };
            let mut marked = u32::MAX;
            let fours = one.as_chunks::<FOUR>().0.iter().zip(other.as_chunks::<FOUR>().0);
            for (cells, (one, other)) in cells.as_chunks::<FOUR>().0.iter().zip(fours) {
                keep_loop();
                for (cell, (one, other)) in cells.iter().zip(one.iter().zip(other)) {
                    let between = average(one.get(), other.get());
                    cell.set(between);
                    marked = lesser(marked, between);
                }
            }
            least = least_of_four(marked);
        }
        let change = steps.between(here, above);
        let base = base.wrapping_add(splat(change.jump));
        let step = Step::new(ends(cells), least, change, steps.far);
        let with = costs.as_chunks().0.iter().zip(kept.as_chunks().0.iter().zip(sums.as_chunks().0));
        let with = with.map(|([a, b, c, d], ([kept_a, kept_b, kept_c, kept_d], [e, f, g, h]))| {
            [(a, kept_a, e), (b, kept_b, f), (c, kept_c, g), (d, kept_d, h)]
        });
        step.through(cells, with, |(cost, kept, sum), come| {
            let path = come.wrapping_add(base).wrapping_sub(*cost);
            kept.set(path);
            sum.set(sum.get().wrapping_add(path));
        });
        if beyond > 0 {
            close(kept, beyond, steps.far);
        }
    }
}
