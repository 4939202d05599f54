//! The winner of each pixel, and what is asked of the second best (winner-take-all).
#![allow(dead_code, reason = "each target uses the form that suits it")]

use super::slices::{part_mut, split_mut};
use super::views::view_mut;
pub(in crate::matching) use super::winner::Winner;
use crate::units::PixelFlags;
use core::ops::Range;

/// How near a disparity may be to the winner and still be of it: what costs little there does not make it
/// ambiguous.
pub(in crate::matching) const BESIDE: usize = 2;

/// What is selected, and where to.
pub(in crate::matching) struct Select<'a> {
    /// Disparities searched.
    pub disparities: usize,
    /// The best disparity of each pixel; left of the smallest disparity they mean nothing.
    pub winners: Winners<'a>,
    /// What is asked of the others.
    pub unique: Unique<'a>,
}

/// What is asked of the second best: the least cost of the candidates over two px beside the winner,
/// `u8::MAX` where there is none. A kernel that is asked for nothing ([`Unique::is_asked`]) need not look for
/// it; [`Unique::check`] and [`Unique::checks_from`] look where it is asked for.
pub(in crate::matching) struct Unique<'a> {
    /// The share of the second best cost, percent, that a winner's has to stay below.
    share: u32,
    /// The flags of pixels whose second best is too near:
    /// [`Checks::uniqueness_percent`](crate::matching::Checks::uniqueness_percent). Empty where that is not
    /// asked.
    flags: &'a mut [PixelFlags],
    /// How much more the second best costs, for [`confidence`](crate::matching::stages::confidence). Empty
    /// where that is not asked.
    margins: &'a mut [u8],
}

impl<'a> Unique<'a> {
    /// Flags the pixels of a row, none of them where no `percent` is asked for, and gives their margins, as
    /// far as there are places for them.
    pub fn new(percent: Option<u8>, flags: &'a mut [PixelFlags], margins: &'a mut [u8]) -> Self {
        match percent {
            Some(percent) => Self { share: 100 - u32::from(percent.min(99)), flags, margins },
            None => Self { share: 100, flags: &mut [], margins },
        }
    }

    /// Whether the second best is wanted of any pixel.
    #[inline(always)]
    pub fn is_asked(&self) -> bool {
        !self.flags.is_empty() | !self.margins.is_empty()
    }

    /// Checks the pixel in column `x`, given the winner's cost and what finds the second best, which is
    /// called where it is wanted.
    #[inline(always)]
    pub fn check(&mut self, x: usize, cost: u8, second: impl FnOnce() -> u8) {
        if self.is_asked() {
            let second = second();
            check_second(self.share, (self.flags.get_mut(x), self.margins.get_mut(x)), cost, second);
        }
    }

    /// [`Self::check`] for the pixels from column `begin` on, one after the other.
    #[inline(always)]
    pub fn checks_from(self, begin: usize) -> impl FnMut(u8, &mut dyn FnMut() -> u8) {
        let (share, is_asked) = (self.share, self.is_asked());
        let mut flags = self.flags.get_mut(begin..).unwrap_or_default().iter_mut();
        let mut margins = self.margins.get_mut(begin..).unwrap_or_default().iter_mut();
        move |cost, second| {
            if is_asked {
                let second = second();
                check_second(share, (flags.next(), margins.next()), cost, second);
            }
        }
    }
}

/// Whether the winner costs too much.
#[inline(always)]
fn is_ambiguous(share: u32, cost: u8, second: u8) -> bool {
    second < u8::MAX && u32::from(second) * share <= u32::from(cost) * 100
}

/// Flags a pixel whose second best is too near, and gives its margin.
#[inline(always)]
fn check_second(
    share: u32,
    (flags, margin): (Option<&mut PixelFlags>, Option<&mut u8>),
    cost: u8,
    second: u8,
) {
    if let Some(flags) = flags {
        *flags = flags.union(PixelFlags::AMBIGUOUS.when(is_ambiguous(share, cost, second)));
    }
    if let Some(margin) = margin {
        *margin = second.wrapping_sub(cost);
    }
}

/// The parts of a [`Winner`].
#[derive(Clone, Copy)]
pub(in crate::matching) struct Found {
    pub disparity: u8,
    pub cost: u8,
    pub beside: (u8, u8),
}

/// The costs one below a winner and one above it, of those in so many lanes. At an end of the candidates it
/// is the one that there is; beside an only candidate, itself.
#[inline(always)]
pub(in crate::matching) fn beside(
    lanes: usize,
    disparity: u8,
    candidates: usize,
    at: impl Fn(usize) -> u8,
) -> (u8, u8) {
    let disparity = usize::from(disparity);
    let lane = (lanes - 1).wrapping_sub(disparity);
    if disparity > 0 && disparity + 1 < candidates {
        (at(lane + 1), at(lane.wrapping_sub(1)))
    } else {
        let one = at(if disparity > 0 { lane + 1 } else { lane.wrapping_sub(usize::from(candidates > 1)) });
        (one, one)
    }
}

/// The winners of a row, four bytes for each pixel, in the form that suits the target: words, or a row of
/// bytes for each part. What finds them and what makes answers of them are of one target.
pub(in crate::matching) struct Winners<'a>(pub(super) &'a mut [Winner]);

impl<'a> Winners<'a> {
    /// Pixels of the row.
    pub fn width(&self) -> usize {
        self.0.len()
    }

    /// A word for each pixel.
    #[inline(always)]
    pub fn words(self) -> &'a mut [Winner] {
        self.0
    }

    /// All rows of bytes, one after the other.
    #[inline(always)]
    pub fn bytes(&mut self) -> &mut [u8] {
        view_mut::<Winner, u8>(self.0)
    }

    /// A row of bytes for each part, from column `begin` on.
    #[inline(always)]
    pub fn rows(self, begin: usize) -> WinnerRows<'a> {
        let width = self.0.len();
        let (below, rest) = split_mut(view_mut::<Winner, u8>(self.0), width);
        let (costs, rest) = split_mut(rest, width);
        let (above, disparities) = split_mut(rest, width);
        let [below, costs, above, disparities] =
            [below, costs, above, disparities].map(|row| part_mut(row, begin..));
        WinnerRows { below, costs, above, disparities }
    }
}

/// The parts of a row's winners.
pub(in crate::matching) struct WinnerRows<'a> {
    pub below: &'a mut [u8],
    pub costs: &'a mut [u8],
    pub above: &'a mut [u8],
    pub disparities: &'a mut [u8],
}

/// Length of each answer's surface along the row, in the form that suits the target:
/// half-words, or bytes at the front. What counts them and what sums them up are of one target.
pub(in crate::matching) struct Lengths<'a>(pub(super) &'a mut [u16]);

impl<'a> Lengths<'a> {
    /// A half-word for each pixel.
    #[inline(always)]
    pub fn half_words(self) -> &'a mut [u16] {
        self.0
    }

    /// Lets no half-word of some pixels be over `most`.
    #[inline(always)]
    pub fn limit_half_words(&mut self, places: Range<usize>, most: u16) {
        part_mut(self.0, places).iter_mut().for_each(|length| *length = most.min(*length));
    }

    /// The bytes of some pixels.
    #[inline(always)]
    pub fn bytes_of(&mut self, places: Range<usize>) -> &mut [u8] {
        part_mut(view_mut::<u16, u8>(self.0), places)
    }

    /// A byte for each pixel, the length as far as it holds it.
    #[inline(always)]
    pub fn bytes(self) -> &'a mut [u8] {
        let width = self.0.len();
        part_mut(view_mut::<u16, u8>(self.0), ..width)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_second_best_is_near_when_it_costs_the_percentage_more_or_less() {
        for percent in [0, 1, 5, 50, 98, 99] {
            for (cost, second) in (0..=255).flat_map(|cost| (0..=255).map(move |second| (cost, second))) {
                let mut flags = [PixelFlags::CLEAR];
                let mut margins = [0];
                Unique::new(Some(percent), &mut flags, &mut margins).check(0, cost, || second);
                let kept_of_second = f64::from(second) * f64::from(100 - percent) / 100.0;
                let is_near = second != 255 && kept_of_second <= f64::from(cost);
                assert_eq!(
                    flags[0].contains(PixelFlags::AMBIGUOUS),
                    is_near,
                    "{cost}, then {second}, {percent} %"
                );
                assert_eq!(margins[0], second.wrapping_sub(cost));
            }
        }
    }

    #[test]
    fn what_nobody_asks_for_is_not_sought() {
        for (percent, wants_margins) in [(None, false), (None, true), (Some(5), false), (Some(5), true)] {
            let (mut flags, mut margins) = ([PixelFlags::CLEAR; 3], [0; 3]);
            let margins = if wants_margins { &mut margins[..] } else { &mut [] };
            let mut unique = Unique::new(percent, &mut flags, margins);
            let is_asked = percent.is_some() || wants_margins;
            assert_eq!(unique.is_asked(), is_asked);
            let mut sought = 0;
            unique.check(1, 10, || {
                sought += 1;
                10
            });
            unique.checks_from(2)(20, &mut || {
                sought += 1;
                25
            });
            assert_eq!(sought, if is_asked { 2 } else { 0 });
            let ambiguous = flags.map(|flags| flags.contains(PixelFlags::AMBIGUOUS));
            assert_eq!(ambiguous, [false, percent.is_some(), false]);
        }
    }

    #[test]
    fn costs_beside_a_winner_are_those_of_its_neighbours() {
        const LANES: usize = 16;
        // The largest disparity stands in the first lane.
        let cost = |disparity: usize| 10 + disparity as u8;
        let at = |lane: usize| cost(LANES - 1 - lane);
        for candidates in 1..=LANES {
            for disparity in 0..candidates {
                let below = disparity.checked_sub(1).map(cost);
                let above = Some(disparity + 1).filter(|&above| above < candidates).map(cost);
                let one = below.or(above).unwrap_or(cost(disparity));
                let expected = below.zip(above).unwrap_or((one, one));
                let found = beside(LANES, disparity as u8, candidates, at);
                assert_eq!(found, expected, "{disparity} of {candidates}");
            }
        }
    }

    #[test]
    fn lengths_change_in_their_places() {
        let mut lengths = [1, 200, 300, 4, 500];
        Lengths(&mut lengths).limit_half_words(1..4, 250);
        assert_eq!(lengths, [1, 200, 250, 4, 500]);
        let mut lengths = [0u16; 5];
        view_mut::<u16, u8>(&mut lengths)[..5].copy_from_slice(&[9, 8, 7, 6, 5]);
        Lengths(&mut lengths).bytes_of(1..4).fill(7);
        assert_eq!(Lengths(&mut lengths).bytes(), [9, 7, 7, 7, 5]);
        assert_eq!(Lengths(&mut lengths).half_words().len(), 5);
    }
}
