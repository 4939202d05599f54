//! What a step of a path costs.

use super::lanes::{TOP, splat};
use crate::matching::penalties::Penalties;
use core::cell::Cell;

/// What changes of the disparity cost between two pixels.
#[derive(Clone, Copy)]
#[repr(C)]
pub(super) struct Change {
    /// A step, in all lanes.
    pub step: u32,
    pub jump: u32,
}

/// What every step of a path needs. The order of the numbers is that in which assembly takes them.
#[repr(C)]
pub(super) struct Steps {
    /// A cost so high that no path comes from there: beside the search's ends.
    pub far: u32,
    /// Words of a column, in fours.
    pub rounds: usize,
    /// The changes of brightness at which it is more, and much.
    pub edges: [u32; 2],
    /// What changes cost where the left image's brightness changes little, more and much; the last one twice.
    pub changes: [Change; 4],
    /// From what stands in memory for a cost to a path's cost, but for a jump, in all lanes.
    pub base: u32,
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
    /// For columns of so many words.
    #[inline(never)]
    pub fn new(penalties: &Penalties, words: usize) -> Self {
        let [little, more, much] = penalties
            .changes()
            .map(|change| Change { step: splat(change.step.into()), jump: change.jump.into() });
        Self {
            far: 127u8.wrapping_sub(penalties.step[0]).into(),
            rounds: words / super::columns::FOUR,
            edges: penalties.edges.map(u32::from),
            changes: [little, more, much, much],
            base: splat(most(penalties).into()).wrapping_sub(splat(128)),
        }
    }

    /// What changes cost where the left image's brightness changes by so much.
    #[inline(always)]
    pub fn of(&self, change: u8) -> Change {
        // The first edge is no greater than the second.
        let [more, much] = self.edges.map(|edge| usize::from(u32::from(change) >= edge));
        self.changes[(more + much) & 3]
    }
}

/// The words before a column, marked, and behind it: beside the last candidate of a lane is the first one of
/// the next lane; no path comes from beyond the ends.
#[inline(always)]
pub(super) fn beside(column: &[Cell<u32>], far: u32) -> [u32; 2] {
    let [first, last] = [column.first(), column.last()].map(|word| word.map_or(0, Cell::get));
    [(last << 8 | far) | TOP, first >> 8 | far << 24]
}
