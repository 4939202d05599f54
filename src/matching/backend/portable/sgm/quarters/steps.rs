//! What a step of a path costs, and the step itself.

use super::columns::FOUR;
use super::lanes::{TOP, before, lesser, splat, up_to_top};
use crate::matching::backend::loops::keep_loop;
use crate::matching::penalties::Penalties;
use core::cell::Cell;

/// What changes of the disparity cost between two pixels.
#[derive(Clone, Copy)]
pub(super) struct Change {
    /// A step, in all lanes.
    pub step: u32,
    pub jump: u32,
}

/// What every step of a path needs.
pub(super) struct Steps {
    /// What changes cost where the left image's brightness changes little, more and much; the last one twice.
    changes: [Change; 4],
    /// The changes of brightness at which it is more, and much.
    edges: [u8; 2],
    /// A cost so high that no path comes from there: beside the search's ends.
    pub far: u32,
}

/// How much more than the agreement of a cost stands in memory: what keeps a path's costs and the step from
/// them under 128 when they are counted from it.
#[inline(always)]
pub(super) fn margin(penalties: &Penalties) -> u8 {
    penalties.step[0].wrapping_add(1)
}

/// The most that stands in memory for a cost, that of none.
#[inline(always)]
pub(super) fn most(penalties: &Penalties) -> u8 {
    penalties.cost.wrapping_add(margin(penalties))
}

impl Steps {
    #[inline(always)]
    pub fn new(penalties: &Penalties) -> Self {
        let [little, more, much] = penalties
            .changes()
            .map(|change| Change { step: splat(change.step.into()), jump: change.jump.into() });
        let far = 127u8.wrapping_sub(penalties.step[0]).into();
        Self { changes: [little, more, much, much], edges: penalties.edges, far }
    }

    /// What changes cost between two pixels of the left image.
    #[inline(always)]
    pub fn between(&self, a: u8, b: u8) -> Change {
        let change = a.abs_diff(b);
        // The first edge is no greater than the second.
        let grade = usize::from(change >= self.edges[0]) + usize::from(change >= self.edges[1]);
        self.changes[grade & 3]
    }
}

/// A path on its way from a pixel to the next one, word by word.
pub(super) struct Step {
    step: u32,
    /// The least cost and a jump, in all lanes.
    bound: u32,
    /// The word before, marked.
    before: u32,
    here: u32,
    /// What is behind the last word.
    behind: u32,
}

impl Step {
    /// Before the first word of a path's costs, whose `least` this is. Beside the last candidate of a lane is
    /// the first one of the next lane; no path comes from beyond the ends.
    #[inline(always)]
    pub fn new([first, last]: [u32; 2], least: u32, change: Change, far: u32) -> Self {
        Self {
            step: change.step,
            bound: splat(least + change.jump),
            before: (last << 8 | far) | TOP,
            here: first,
            behind: first >> 8 | far << 24,
        }
    }

    /// Gives what it costs to come to the candidates of each word of a path's column, with the numbers
    /// that are handed on for it, four words at a time: 128 from the least cost by a jump, by as much
    /// less as it is to come from near.
    #[inline(always)]
    pub fn through<T: Copy>(
        mut self,
        column: &[Cell<u32>],
        with: impl Iterator<Item = [T; FOUR]>,
        mut put: impl FnMut(T, u32),
    ) {
        let fours = column.as_chunks::<FOUR>().0;
        for (number, ([_, b, c, d], with)) in fours.iter().zip(with).enumerate() {
            keep_loop();
            let [of_a, of_b, of_c, of_d] = with;
            put(of_a, self.come(b.get()));
            put(of_b, self.come(c.get()));
            put(of_c, self.come(d.get()));
            let next = fours.get(number + 1).map_or(self.behind, |[next, ..]| next.get());
            put(of_d, self.come(next));
        }
    }

    /// What it costs to come to the word before this `next` one.
    #[inline(always)]
    fn come(&mut self, next: u32) -> u32 {
        let beside = lesser(self.before, next) + self.step;
        let near = lesser(beside, self.here);
        self.before = self.here | TOP;
        self.here = next;
        up_to_top(near.wrapping_sub(self.bound))
    }
}

/// The first word of a column and the last one.
#[inline(always)]
pub(super) fn ends(column: &[Cell<u32>]) -> [u32; 2] {
    [column.first(), column.last()].map(|word| word.map_or(0, Cell::get))
}

/// Makes `far` the costs of the candidates before one, where no path is to come from; returns the least of
/// all, marked, in each lane.
#[inline(never)]
pub(super) fn close(cells: &[Cell<u32>], place: usize, far: u32) -> u32 {
    let mut least = u32::MAX;
    for (word, cell) in cells.iter().enumerate() {
        let lanes = before(place, word, cells.len());
        cell.set(cell.get() & !lanes | splat(far) & lanes);
        least = lesser(least, cell.get());
    }
    least
}
