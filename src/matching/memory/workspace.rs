//! Memory that the stages of a row share: what stands in it changes from phase to phase.
//!
//! ```text
//! phase      winners: 4 B/pixel   right: 2 B/pixel      lengths: 2 B/pixel   rest
//! Costs      smoothed lines       smoothed lines        -                    what a kernel works with
//! Winners    winners              keys of right pixels  margins              kernel, then fractions
//! Surfaces   confidences          -                     surface lengths      sums along the row
//! Finished   confidences, withheld answers  masks       -                    -
//! ```
//!
//! A row goes through the phases in this order. In the methods along paths the first three are nothing in
//! phase `Costs`: there the rest is all of it, until [`RowWorkspace::divide`].
//!
//! In debug builds each access asserts its phase.

use super::slices::{chunks_mut, part, part_mut, split_mut};
use super::views::{view, view_mut};
use super::winner::Winner;
use super::winners::{Lengths, Winners};

/// What stands in the memory.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Phase {
    Costs,
    Winners,
    Surfaces,
    Finished,
}

/// The memory that the stages of a row share.
pub struct RowWorkspace<'a> {
    winners: &'a mut [Winner],
    right: &'a mut [u16],
    lengths: &'a mut [u16],
    rest: &'a mut [u32],
    #[cfg(debug_assertions)]
    phase: Phase,
}

/// Where winners go, and what is worked with.
pub(in crate::matching) struct ForWinners<'a> {
    pub winners: Winners<'a>,
    /// A byte a pixel.
    pub margins: &'a mut [u8],
    /// What a kernel works with.
    pub workspace: &'a mut [u32],
}

/// Winners, and what answers are made of them with.
pub(in crate::matching) struct ForAnswers<'a> {
    pub winners: Winners<'a>,
    /// What each right pixel keeps.
    pub right: &'a mut [u16],
    /// At least two bytes a pixel.
    pub workspace: &'a mut [u32],
}

/// What a finished row has, a byte a pixel.
pub(in crate::matching) struct Finished<'a> {
    pub confidences: &'a mut [u8],
    /// The answers that are withheld of it.
    pub withheld: &'a mut [u16],
    /// Places for the masks of the left and of the right image.
    pub masks: [&'a mut [u8]; 2],
}

impl<'a> RowWorkspace<'a> {
    /// A workspace whose rows stand beside the rest.
    pub(super) fn of_rows(
        winners: &'a mut [Winner],
        right: &'a mut [u16],
        lengths: &'a mut [u16],
        rest: &'a mut [u32],
    ) -> Self {
        Self {
            winners,
            right,
            lengths,
            rest,
            #[cfg(debug_assertions)]
            phase: Phase::Costs,
        }
    }

    /// A workspace whose rows stand in the same memory as the rest, and come after it.
    pub(in crate::matching) fn of_rest(rest: &'a mut [u32]) -> Self {
        Self::of_rows(&mut [], &mut [], &mut [], rest)
    }

    /// Gives the rows of `width` pixels their places, where they have none yet: the costs are done with.
    // In flash once.
    #[inline(never)]
    pub(in crate::matching) fn divide(&mut self, width: usize) {
        self.check(Phase::Costs);
        if self.winners.is_empty() {
            let (winners, rest) = split_mut(core::mem::take(&mut self.rest), width);
            let (right, rest) = split_mut(rest, width.div_ceil(2));
            let (lengths, rest) = split_mut(rest, width.div_ceil(2));
            self.winners = view_mut::<u32, Winner>(winners);
            self.right = part_mut(view_mut::<u32, u16>(right), ..width);
            self.lengths = part_mut(view_mut::<u32, u16>(lengths), ..width);
            self.rest = rest;
        }
    }

    /// What a kernel works with, before there are winners.
    pub(in crate::matching) fn costs(&mut self) -> &mut [u32] {
        self.check(Phase::Costs);
        self.rest
    }

    /// Places for six smoothed lines of `width` pixels, and what a kernel works with.
    pub(in crate::matching) fn smoothed_lines(
        &mut self,
        width: usize,
    ) -> (impl Iterator<Item = &mut [u8]>, &mut [u32]) {
        self.check(Phase::Costs);
        let memory = [view_mut::<Winner, u8>(self.winners), view_mut::<u16, u8>(self.right)];
        (memory.into_iter().flat_map(move |memory| chunks_mut(memory, width)), self.rest)
    }

    /// Places for winners and, if wanted, margins.
    #[inline(always)]
    pub(in crate::matching) fn for_winners(&mut self, with_margins: bool) -> ForWinners<'_> {
        self.enter(Phase::Winners);
        let count = if with_margins { self.winners.len() } else { 0 };
        ForWinners {
            winners: Winners(self.winners),
            margins: part_mut(view_mut::<u16, u8>(self.lengths), ..count),
            workspace: self.rest,
        }
    }

    /// The winners, and what answers are made of them with.
    pub(in crate::matching) fn for_answers(&mut self) -> ForAnswers<'_> {
        self.check(Phase::Winners);
        ForAnswers { winners: Winners(self.winners), right: self.right, workspace: self.rest }
    }

    /// The margins of the winners, a byte a pixel.
    pub(in crate::matching) fn margins(&self) -> &[u8] {
        self.check(Phase::Winners);
        part(view::<u16, u8>(self.lengths), ..self.winners.len())
    }

    /// Places for the lengths of surfaces and for sums along the row: the winners are done with.
    pub(in crate::matching) fn for_smoothing(&mut self) -> (Lengths<'_>, &mut [u16]) {
        self.enter(Phase::Surfaces);
        (Lengths(self.lengths), view_mut::<u32, u16>(self.rest))
    }

    /// Says that a row below the image has neither winners nor surfaces.
    pub(in crate::matching) fn skip_row(&mut self) {
        self.enter(Phase::Surfaces);
    }

    /// The lengths of surfaces, as the target's smoothing leaves them.
    pub(in crate::matching) fn lengths(&mut self) -> Lengths<'_> {
        self.check(Phase::Surfaces);
        Lengths(self.lengths)
    }

    /// Scratch row of a half-word per pixel.
    pub(in crate::matching) fn scratch(&mut self) -> &mut [u16] {
        self.check(Phase::Surfaces);
        self.right
    }

    /// The confidences of the row that waited, a byte a pixel.
    pub(in crate::matching) fn confidences(&mut self) -> &mut [u8] {
        self.check(Phase::Surfaces);
        let count = self.winners.len();
        part_mut(view_mut::<Winner, u8>(self.winners), ..count)
    }

    /// The confidences of the row that waited, and places for the answers that are withheld.
    pub(in crate::matching) fn confidences_and_withheld(&mut self) -> (&mut [u8], &mut [u16]) {
        self.check(Phase::Surfaces);
        let count = self.winners.len();
        let (confidences, withheld) = split_mut(view_mut::<Winner, u16>(self.winners), count.div_ceil(2));
        (part_mut(view_mut::<u16, u8>(confidences), ..count), part_mut(withheld, ..count))
    }

    /// The answers of `width` pixels that were withheld of the row before, until anything else is written.
    pub(in crate::matching) fn withheld_before(&mut self, width: usize) -> &mut [u16] {
        self.check(Phase::Costs);
        let before =
            if self.winners.is_empty() { view_mut(self.rest) } else { view_mut::<Winner, u16>(self.winners) };
        part_mut(before, width.div_ceil(2)..width.div_ceil(2) + width)
    }

    /// What stands in the workspace of a row that is out.
    pub(in crate::matching) fn finished(mut self) -> Finished<'a> {
        self.enter(Phase::Finished);
        let width = self.winners.len();
        let (left, right) = split_mut(part_mut(view_mut::<u16, u8>(self.right), ..2 * width), width);
        let (confidences, withheld) = split_mut(view_mut::<Winner, u16>(self.winners), width.div_ceil(2));
        Finished {
            confidences: part_mut(view_mut::<u16, u8>(confidences), ..width),
            withheld: part_mut(withheld, ..width),
            masks: [left, right],
        }
    }

    /// Asserts that the memory is in a phase.
    #[inline(always)]
    #[track_caller]
    fn check(&self, _phase: Phase) {
        #[cfg(debug_assertions)]
        assert_eq!(self.phase, _phase, "the workspace of a row");
    }

    /// Goes on to a later phase.
    #[inline(always)]
    #[track_caller]
    fn enter(&mut self, _phase: Phase) {
        #[cfg(debug_assertions)]
        {
            assert!(self.phase < _phase, "from {:?} to {_phase:?}", self.phase);
            self.phase = _phase;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: usize = 7;

    #[test]
    fn rows_have_their_places_one_after_the_other() {
        let mut memory: [u32; 40] = core::array::from_fn(|word| word as u32);
        let mut workspace = RowWorkspace::of_rest(&mut memory);
        assert_eq!(workspace.costs().len(), 40);
        assert_eq!(workspace.withheld_before(WIDTH).len(), WIDTH);
        workspace.divide(WIDTH);
        let ForWinners { winners, margins, workspace: rest } = workspace.for_winners(true);
        assert_eq!((winners.width(), margins.len()), (WIDTH, WIDTH));
        // Seven winners, and twice seven half-words in four words.
        assert_eq!((rest.len(), rest[0]), (40 - 7 - 4 - 4, 15));
        assert_eq!(workspace.margins(), [11, 0, 0, 0, 12, 0, 0]);
        let ForAnswers { winners, right, .. } = workspace.for_answers();
        assert_eq!((winners.width(), &*right), (WIDTH, &[7, 0, 8, 0, 9, 0, 10][..]));
        let (lengths, sums) = workspace.for_smoothing();
        assert_eq!((lengths.half_words().len(), sums.len()), (WIDTH, 2 * (40 - 15)));
        assert_eq!(workspace.lengths().half_words(), [11, 0, 12, 0, 13, 0, 14]);
        assert_eq!(workspace.scratch(), [7, 0, 8, 0, 9, 0, 10]);
        assert_eq!(workspace.confidences(), [0, 0, 0, 0, 1, 0, 0]);
        let (confidences, withheld) = workspace.confidences_and_withheld();
        assert_eq!((confidences.len(), &*withheld), (WIDTH, &[2, 0, 3, 0, 4, 0, 5][..]));
        let Finished { confidences, withheld, masks: [left, right] } = workspace.finished();
        assert_eq!((confidences.len(), &*withheld), (WIDTH, &[2, 0, 3, 0, 4, 0, 5][..]));
        assert_eq!((&*left, &*right), (&[7, 0, 0, 0, 8, 0, 0][..], &[0, 9, 0, 0, 0, 10, 0][..]));
    }

    #[test]
    fn a_row_without_margins_has_no_place_for_them() {
        let mut memory = [0; 40];
        let mut workspace = RowWorkspace::of_rest(&mut memory);
        workspace.divide(WIDTH);
        assert!(workspace.for_winners(false).margins.is_empty());
        workspace.skip_row();
        assert_eq!(workspace.lengths().half_words().len(), WIDTH);
    }

    #[cfg(debug_assertions)]
    #[test]
    #[should_panic(expected = "the workspace of a row")]
    fn what_is_not_there_yet_is_not_looked_at() {
        RowWorkspace::of_rest(&mut [0; 40]).margins();
    }

    #[cfg(debug_assertions)]
    #[test]
    #[should_panic(expected = "from Winners to Winners")]
    fn a_phase_comes_once() {
        let mut memory = [0; 40];
        let mut workspace = RowWorkspace::of_rest(&mut memory);
        workspace.for_winners(false);
        workspace.for_winners(false);
    }
}
