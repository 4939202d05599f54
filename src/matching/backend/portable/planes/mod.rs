//! The kernel in bit planes, for cores without vectors: 32 candidates are the bits of a word, and a number
//! for each of them is as many words as it has bits. Additions are chains of full adders, bit by bit;
//! comparisons go from the highest plane down. Safe Rust; the arithmetic is that of plain words.
//!
//! * `columns`: what changes from code to code; the bits in which codes differ, counted into the columns
//!   under the window.
//! * `windows`: columns into windows, windows into winners.
//! * `plane`: the word itself.
//!
//! The work is the same for every picture, but for some ten instructions where a winner is at an end of the
//! search.

mod columns;
mod plane;
mod windows;

use super::census as rows;
use crate::matching::backend::parameters::WindowParameters;
use crate::matching::backend::work::{CensusWork, WindowWork};
use crate::matching::memory::layout::OUTSIDE;
use crate::matching::memory::slices::{chunks, multiple_of, part, part_mut, split_mut};
use crate::matching::memory::views::{view, view_mut};
use crate::matching::memory::winners::Select;
use plane::Plane;
use windows::{Check, WINDOW, Windows};

/// The sums of a column, lowest plane first: a place for each eighth of its bytes, of which the last are
/// free.
type Column<P> = [P; 8];

/// [`Isa::census`](crate::matching::backend::Isa::census) in planes.
#[inline]
pub(in crate::matching::backend) fn census<S: WindowParameters>(work: CensusWork<'_>) {
    let CensusWork { lines: [left, right], min_disparity, workspace, codes: out } = work;
    let width = out.len() / 2;
    // Both begin where a word may stand.
    let (of_left, rest) = split_mut(view_mut::<u32, u8>(workspace), multiple_of::<4>(width));
    let (of_left, of_right) = (part_mut(of_left, ..width), part_mut(rest, ..width));
    rows::census::<S>(left, of_left);
    rows::census::<S>(right, of_right);
    columns::prepare::<S>(of_left, of_right, min_disparity, view_mut::<u8, u16>(out));
}

/// [`Isa::window`](crate::matching::backend::Isa::window) in planes.
#[inline(always)]
pub(in crate::matching::backend) fn window<S: WindowParameters, const MOST: usize>(
    work: WindowWork<'_>,
    select: Option<Select<'_>>,
) {
    // The usual numbers of candidates, then any number of words of them, or of half-words.
    match work.stride {
        16 if MOST == 0 || MOST == 16 => row_of::<S, u16, 1>(work, select),
        32 if MOST != 16 => row_of::<S, u32, 1>(work, select),
        64 if MOST == 0 || MOST == 64 => row_of::<S, u32, 2>(work, select),
        stride if MOST == 0 && !stride.is_multiple_of(32) && stride > 32 => row_of::<S, u16, 0>(work, select),
        stride if MOST == 0 && stride > 64 => row_of::<S, u32, 0>(work, select),
        _ => {}
    }
}

/// A row whose candidates are `GROUPS` words of them; 0 where the number is not known when the crate is
/// compiled.
#[inline(always)]
fn row_of<S: WindowParameters, P: Plane, const GROUPS: usize>(
    work: WindowWork<'_>,
    select: Option<Select<'_>>,
) {
    let WindowWork { width, stride, min_disparity, enter, leave, columns, workspace } = work;
    // At least one, for the compiler to see that no column is empty.
    let groups = if GROUPS > 0 { GROUPS } else { (stride / P::CANDIDATES).max(1) };
    let columns = P::of_bytes(columns).as_chunks_mut::<8>().0;
    let workspace = P::of_words(workspace);
    if let Some(inside) = columns.get_mut(OUTSIDE * groups..) {
        let rows = [enter, leave].map(|row| row.map(view::<u8, u16>));
        columns::update::<S, P, GROUPS>(groups, min_disparity, rows, workspace, inside);
    }
    let Some(Select { disparities, winners, unique }) = select else { return };

    // Left of here no pixel has a candidate.
    let begin = min_disparity.min(width);
    let winners = part_mut(winners.words(), begin..);
    // Nothing of it stands in the loops' registers where nothing is asked.
    let is_asked = unique.is_asked();
    let mut check = unique.checks_from(begin);
    let mut check = |cost, second| check(cost, &mut || second);
    let check: Option<&mut Check<'_>> = if is_asked { Some(&mut check) } else { None };
    let Some(windows) = workspace.as_chunks_mut::<WINDOW>().0.get_mut(..groups) else { return };
    let mut windows = Windows::new(windows, disparities);
    // What is farther to the left is no candidate's: its sums are zero.
    let (before, after) = (begin.saturating_sub(S::RADIUS_X), begin + S::RADIUS_X);
    for column in chunks(part(columns, (OUTSIDE + before) * groups..(OUTSIDE + after) * groups), groups) {
        windows.slide::<S>(column, columns);
    }
    let from = |column: usize| part(columns, column * groups..);
    let (entering, leaving) = (from(OUTSIDE + after), from(OUTSIDE + begin - S::RADIUS_X - 1));
    if GROUPS > 0 {
        windows.winners::<S, GROUPS>(entering, leaving, winners, check);
    } else {
        windows.winners_of_many::<S>(entering, leaving, winners, check);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::memory::winners::{Unique, Winner};
    use crate::matching::memory::workspace::{ForWinners, RowWorkspace};
    use crate::matching::method::{Block, Fast};

    const WIDTH: usize = 70;

    /// The sums and the winners of a frame's first row, in a matcher that has room for `MOST` disparities.
    fn first_row<S: WindowParameters, const MOST: usize>(
        stride: usize,
    ) -> ([u32; (WIDTH + 2 * OUTSIDE) * 16], [Winner; WIDTH]) {
        let line: [u8; WIDTH + 9] = core::array::from_fn(|x| (x * x * 7 % 251 + x % 5) as u8);
        let lines = [&[&line[..WIDTH]; 5], &[&line[9..]; 5]];
        let (mut codes, mut columns) = ([0u32; WIDTH / 2], [0; (WIDTH + 2 * OUTSIDE) * 16]);
        let mut memory = [0; 1000];
        let mut workspace = RowWorkspace::of_rest(&mut memory);
        let codes = &mut view_mut::<u32, u8>(&mut codes)[..2 * WIDTH];
        census::<S>(CensusWork { lines, min_disparity: 0, workspace: workspace.costs(), codes });
        workspace.divide(WIDTH);
        let ForWinners { winners, workspace: room, .. } = workspace.for_winners(false);
        let work = WindowWork {
            width: WIDTH,
            stride,
            min_disparity: 0,
            enter: Some(codes),
            leave: None,
            columns: &mut view_mut::<u32, u8>(&mut columns)[..(WIDTH + 2 * OUTSIDE) * stride],
            workspace: room,
        };
        let unique = Unique::new(None, &mut [], &mut []);
        window::<S, MOST>(work, Some(Select { disparities: stride, winners, unique }));
        let winners = workspace.for_answers().winners.words();
        (columns, core::array::from_fn(|x| winners[x]))
    }

    fn capacities<S: WindowParameters>() {
        let (of_16, of_32, of_64) = (first_row::<S, 0>(16), first_row::<S, 0>(32), first_row::<S, 0>(64));
        for (columns, winners) in [&of_16, &of_32, &of_64] {
            assert!(columns.iter().any(|&sums| sums != 0));
            assert!(winners.iter().any(|winner| winner.disparity() == 9));
        }
        assert!(first_row::<S, 16>(16) == of_16);
        assert!(first_row::<S, 32>(32) == of_32);
        assert!(first_row::<S, 64>(32) == of_32, "fewer than there is room for");
        assert!(first_row::<S, 64>(64) == of_64);
    }

    #[test]
    fn the_code_of_a_capacity_gives_the_rows_of_any() {
        capacities::<Fast>();
        capacities::<Block>();
    }
}
