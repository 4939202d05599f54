//! The passes, written once for groups of bytes whose lanes run over the disparities of one pixel.
//!
//! * `cost`, `edges`, `select`: the passes; `gather` and `selection`: the two ends of the last one;
//!   `alternate`: the paths where registers hold a few cells only.

mod alternate;
mod cost;
mod edges;
mod gather;
mod select;
mod selection;
mod two_ends;

use super::Passes;
use super::features::{Features, PlainRows};
use crate::matching::backend::parameters::SgmParameters;
use crate::matching::backend::portable::group::Group;
use crate::matching::backend::work::{EdgeWork, Guide, PathWork};
use crate::matching::backend::work::{MASKS, STEP};
use crate::matching::memory::layout::COLUMNS_OFF;
use crate::matching::memory::slices::{part, part_mut};
use crate::matching::memory::winners::{Found, Unique};
use core::marker::PhantomData;

/// The passes over columns of up to `CELLS` groups, all of them in use if `ALL`: then the compiler knows how
/// many.
pub(in crate::matching::backend) struct Groups<G, const CELLS: usize, const ALL: bool>(PhantomData<G>);

impl<G: Group, const CELLS: usize, const ALL: bool> Passes for Groups<G, CELLS, ALL> {
    type Rows = PlainRows;

    #[inline(always)]
    fn clear(work: &mut PathWork<'_>) {
        work.costs.fill(0);
    }

    #[inline(always)]
    fn enter<S: SgmParameters>(work: &mut PathWork<'_>, features: &Features<'_>) {
        cost::enter::<G, S, CELLS, ALL>(work, features);
        work.close(stride::<G, CELLS, ALL>(work), work.penalties.cost);
    }

    #[inline(always)]
    fn within_edges(work: &mut PathWork<'_>, edges: EdgeWork<'_>) {
        if is_word::<G>() {
            edges::within_edges::<G, CELLS, false>(work, edges);
        } else {
            edges::within_edges::<G, CELLS, ALL>(work, edges);
        }
    }

    #[inline(always)]
    fn select(work: &mut PathWork<'_>, guide: Guide<'_>, unique: Unique<'_>, put: impl FnMut(usize, Found)) {
        if is_word::<G>() && !ALL {
            alternate::select::<G, CELLS>(work, guide, unique, put);
        } else if !is_word::<G>() && ALL {
            two_ends::select::<G, CELLS>(work, guide, unique, put);
        } else {
            select::select::<G, CELLS, ALL>(work, guide, unique, put);
        }
    }
}

/// Whether groups are small, so that a column has many: loops over them take little flash if they are not
/// unrolled, and little longer.
#[inline(always)]
const fn is_word<G: Group>() -> bool {
    G::LANES == size_of::<u32>()
}

/// Lanes of a column, known to the compiler if `ALL` the cells of a path are in use.
#[inline(always)]
fn stride<G: Group, const CELLS: usize, const ALL: bool>(work: &PathWork<'_>) -> usize {
    if ALL { CELLS * G::LANES } else { work.stride.max(STEP) }
}

/// A column of a volume; none where there is none.
#[inline(always)]
fn column<C, const CELLS: usize, const ALL: bool>(volume: &[C], x: usize, count: usize) -> &[C] {
    if ALL {
        volume.get(x * CELLS..).and_then(|rest| rest.first_chunk::<CELLS>()).map_or(&[], |column| column)
    } else {
        part(volume, x * count..(x + 1) * count)
    }
}

/// Mutable access to the costs of column `x`.
#[inline(always)]
fn column_mut<C, const CELLS: usize, const ALL: bool>(volume: &mut [C], x: usize, count: usize) -> &mut [C] {
    if ALL {
        volume
            .get_mut(x * CELLS..)
            .and_then(|rest| rest.first_chunk_mut::<CELLS>())
            .map_or(&mut [], |column| column)
    } else {
        part_mut(volume, x * count..(x + 1) * count)
    }
}

/// A path at a pixel: its costs, of `CELLS` cells, all of them in use if `ALL`.
#[derive(Clone, Copy)]
struct Path<G, const CELLS: usize, const ALL: bool>([G; CELLS]);

impl<G: Group, const CELLS: usize, const ALL: bool> Path<G, CELLS, ALL> {
    /// What stands in memory.
    #[inline(always)]
    fn of(cells: &[G::Cell]) -> Self {
        let mut path = Self([G::splat(0); CELLS]);
        for (to, &from) in path.0.iter_mut().zip(cells) {
            *to = G::of(from);
        }
        path
    }

    /// The cells in use.
    #[inline(always)]
    fn cells(&self, count: usize) -> &[G] {
        if ALL { &self.0 } else { part(&self.0, ..count) }
    }

    /// Puts it in memory.
    #[inline(always)]
    fn put(&self, cells: &mut [G::Cell]) {
        for (to, from) in cells.iter_mut().zip(&self.0) {
            *to = from.cell();
        }
    }

    /// The sum with another one, at most 255 in each lane.
    #[inline(always)]
    fn plus_saturating(mut self, other: &Self) -> Self {
        for (cell, &other) in self.0.iter_mut().zip(&other.0) {
            *cell = cell.plus_saturating(other);
        }
        self
    }

    /// The average with another one, rounded down.
    #[inline(always)]
    fn average(mut self, other: &[G::Cell]) -> Self {
        for (cell, &other) in self.0.iter_mut().zip(other) {
            *cell = cell.average_down(G::of(other));
        }
        self
    }

    /// Advances the path by one pixel and returns its aggregated costs.
    #[inline(always)]
    fn step(mut self, steps: &Steps<G, CELLS, ALL>, change: &[G::Cell; 2], costs: &[G::Cell]) -> Self {
        let (&first, rest) = self.cells(costs.len()).split_first().unwrap_or((&steps.far, &[]));
        let least = rest.iter().fold(
            first,
            #[inline(always)]
            |least, &cell| least.min(cell),
        );
        let least = least.least();
        let (step, jump) = (G::of(change[0]), G::of(change[1]));
        let (mut before, mut here) = (None, self.0.first().copied().unwrap_or(steps.far));
        for (i, &cost) in costs.iter().enumerate().take(CELLS) {
            let next = if i + 1 < costs.len() { self.0.get(i + 1).copied() } else { None };
            // At an end of the column a candidate may stand beside itself: a step from there is no cheaper.
            let above = before.map_or(here.after_end(steps.far), |before| here.after(before));
            let below = next.map_or(here.before_end(steps.far), |next| here.before(next));
            let beside = above.min(below).plus(step);
            let message = here.min(beside).minus(least).min(jump);
            if let Some(cell) = self.0.get_mut(i) {
                *cell = message.plus(G::of(cost));
            }
            (before, here) = (Some(here), next.unwrap_or(steps.far));
        }
        self
    }
}

/// What every step of a path needs.
struct Steps<G: Group, const CELLS: usize, const ALL: bool> {
    /// A cost so high that no path comes from there: beside the search's ends.
    far: G,
    /// What a step and a jump cost where the left image's brightness changes little, more and much; the last
    /// one twice.
    changes: [[G::Cell; 2]; 4],
    /// The changes of brightness at which it is more, and much.
    edges: [u8; 2],
}

impl<G: Group, const CELLS: usize, const ALL: bool> Steps<G, CELLS, ALL> {
    #[inline(always)]
    fn new(work: &PathWork<'_>) -> Self {
        // No path costs more: `Penalties::check`.
        let far = 127u8.saturating_sub(work.penalties.step[0]);
        let [little, more, much] = work
            .penalties
            .changes()
            .map(|change| [change.step, change.jump].map(|cost| G::splat(cost).cell()));
        Self { far: G::splat(far), changes: [little, more, much, much], edges: work.penalties.edges }
    }

    /// What a step and a jump cost between two pixels of the left image.
    #[inline(always)]
    fn between(&self, a: u8, b: u8) -> &[G::Cell; 2] {
        let change = a.abs_diff(b);
        // The first edge is no greater than the second.
        let grade = usize::from(change >= self.edges[0]) + usize::from(change >= self.edges[1]);
        &self.changes[grade & 3]
    }

    /// What stands for the change of brightness between the numbers of each pair, for [`Self::change`].
    #[inline(always)]
    fn grade(&self, a: &[u8], b: &[u8], grades: &mut [u8]) {
        for (grade, (&a, &b)) in grades.iter_mut().zip(a.iter().zip(b)) {
            let change = a.abs_diff(b);
            *grade = u8::from(change >= self.edges[0]) + u8::from(change >= self.edges[1]);
        }
    }

    /// What a step and a jump cost where this is the change.
    #[inline(always)]
    fn change(&self, grade: u8) -> &[G::Cell; 2] {
        &self.changes[usize::from(grade & 3)]
    }
}

/// Masks the lanes of a column but the last `candidates`.
#[inline(always)]
fn mask(stride: usize, candidates: usize) -> &'static [u8] {
    let masked = stride.saturating_sub(candidates);
    let begin = 256usize.saturating_sub(masked);
    part(MASKS, begin..begin + stride)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::backend::portable::words::Word;
    use crate::matching::memory::views::view_mut;
    use crate::matching::penalties::Penalties;
    use crate::units::PixelFlags;

    const WIDTH: usize = 30;
    const MOST: usize = 48;
    const ROWS: usize = 4;
    /// Words of the most candidates.
    const WORDS: usize = MOST / 4;

    /// What is found of a row: of each pixel the disparity, its cost and those beside it, and the margins.
    type Row = ([Option<(u8, u8, (u8, u8))>; WIDTH], [u8; WIDTH], [PixelFlags; WIDTH]);

    #[derive(Clone, Copy, Debug)]
    struct Size {
        width: usize,
        stride: usize,
        disparities: usize,
        min_disparity: usize,
    }

    /// The rows of a frame of costs by chance, cell by cell or path by path.
    fn frame(size: Size, is_alternate: bool) -> [Row; ROWS] {
        let mut state = size.width as u32;
        let mut chance = |below: u32| {
            state = state.wrapping_mul(0x9e37_79b1).wrapping_add(0x7f4a_7c15);
            ((state >> 12) % below) as u8
        };
        let (mut costs, mut sums) = ([0u32; WIDTH * WORDS], [0u32; WIDTH * WORDS]);
        let mut top = [0u32; (WIDTH + COLUMNS_OFF) * WORDS];
        let Size { width, stride, disparities, min_disparity } = size;
        let mut above = [0; WIDTH];
        core::array::from_fn(|row| {
            let costs = &mut view_mut::<u32, u8>(&mut costs)[..width * stride];
            costs.fill_with(|| chance(u32::from(Penalties::DEFAULT.cost) + 1));
            let here: [u8; WIDTH] = core::array::from_fn(|_| chance(4) * 7);
            let mut work = PathWork {
                width,
                stride,
                disparities,
                min_disparity,
                penalties: &Penalties::DEFAULT,
                gradient_shift: 0,
                costs,
                top: &mut view_mut::<u32, u8>(&mut top)[..(width + COLUMNS_OFF) * stride],
                sums: &mut view_mut::<u32, u8>(&mut sums)[..width * stride],
                workspace: &mut [],
            };
            work.close(stride, Penalties::DEFAULT.cost);
            let mut found: Row = ([None; WIDTH], [0; WIDTH], [PixelFlags::CLEAR; WIDTH]);
            let (winners, margins, flags) = (&mut found.0, &mut found.1, &mut found.2);
            let unique = Unique::new(Some(5), flags, margins);
            let put = |x: usize, found: Found| winners[x] = Some((found.disparity, found.cost, found.beside));
            let last_row = above;
            let guide = Guide { here: &here, above: (row > 0).then_some(&last_row), row };
            if is_alternate {
                alternate::select::<Word, { WORDS + 1 }>(&mut work, guide, unique, put);
            } else {
                select::select::<Word, WORDS, false>(&mut work, guide, unique, put);
            }
            above = here;
            found
        })
    }

    #[test]
    fn cell_by_cell_and_path_by_path_winners_are_the_same() {
        let mut all = [false; MOST];
        for (width, stride) in [1, 2, 3, 7, 30].into_iter().flat_map(|width| [16, 32, 48].map(|s| (width, s)))
        {
            for (fewer, min_disparity) in [(0, 0), (1, 0), (15, 2), (0, 20), (7, 29)] {
                let size = Size { width, stride, disparities: stride - fewer, min_disparity };
                let rows = frame(size, false);
                for row in &rows {
                    let has_winner = |x: &usize| (min_disparity..width).contains(x);
                    assert!((0..WIDTH).all(|x| row.0[x].is_some() == has_winner(&x)), "{size:?}");
                    row.0.iter().flatten().for_each(|(disparity, ..)| all[usize::from(*disparity)] = true);
                }
                assert!(frame(size, true) == rows, "{size:?}");
            }
        }
        assert!(all[..30].iter().filter(|&&found| found).count() > 20, "{all:?}");
    }
}
