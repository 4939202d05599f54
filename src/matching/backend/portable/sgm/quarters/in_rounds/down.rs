//! The path from above.

use crate::matching::backend::loops::keep_length;
use crate::matching::backend::portable::sgm::quarters::columns::{column, words};
use crate::matching::backend::portable::sgm::quarters::rounds;
use crate::matching::backend::portable::sgm::quarters::steps::Steps;
use crate::matching::backend::work::{Guide, PathWork};
use crate::matching::memory::layout::COLUMNS_OFF;
use crate::matching::memory::views::{view, view_mut};
use core::cell::Cell;

/// Moves the path from above down to the row, and adds it to the sums.
///
/// It takes no room of its own: the paths of an odd row stand two columns further to the right than those of
/// an even row. So each goes where one of the two was that it comes from, if odd rows are taken from right to
/// left.
#[inline(never)]
pub(super) fn down<const WORDS: usize, const ALL: bool>(work: &mut PathWork<'_>, guide: Guide<'_>) {
    let (count, last) = (words::<WORDS, ALL>(work), work.width.wrapping_sub(1));
    let steps = Steps::new(work.penalties, count);
    let costs = view::<u8, u32>(work.costs);
    let tops = Cell::from_mut(view_mut::<u8, u32>(work.top)).as_slice_of_cells();
    let sums = Cell::from_mut(view_mut::<u8, u32>(work.sums)).as_slice_of_cells();
    let is_odd = !guide.row.is_multiple_of(2);
    let (from, to) = if is_odd { (0, COLUMNS_OFF) } else { (COLUMNS_OFF, 0) };
    // A row of no pixels in place of none: asked for once, the loop would be written out twice.
    let above = keep_length(guide.above.unwrap_or_default());
    for i in 0..work.width {
        let x = if is_odd { last - i } else { i };
        let at = |volume, x: usize| column(volume, x * count, count);
        let Some(&here) = guide.here.get(x) else { return };
        let (Some(costs), Some(sums), Some(kept)) =
            (column(costs, x * count, count), at(sums, x), at(tops, x + to))
        else {
            return;
        };
        let (mut change, mut least) = (0, 0);
        if let Some(&above) = above.get(x) {
            change = here.abs_diff(above);
            let two = [x.saturating_sub(COLUMNS_OFF), (x + COLUMNS_OFF).min(last)];
            let [Some(one), Some(other)] = two.map(|x| at(tops, x + from)) else { return };
            least = rounds::average_two([one, other], kept);
        } else {
            kept.iter().for_each(|path| path.set(0));
        }
        rounds::down(&steps, (change, least), costs, kept, sums);
    }
}
