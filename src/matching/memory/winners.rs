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
    share: Share,
    /// The flags of pixels whose second best is too near:
    /// [`Checks::uniqueness_percent`](crate::matching::Checks::uniqueness_percent). Empty where that is not
    /// asked.
    flags: &'a mut [PixelFlags],
    /// How much more the second best costs, for [`confidence`](crate::matching::stages::confidence). Empty
    /// where that is not asked.
    margins: &'a mut [u8],
}

/// The share of the second best cost, percent, that a winner's has to stay below.
#[derive(Clone, Copy)]
struct Share(u32);

impl Share {
    /// Whether the winner costs too much.
    #[inline(always)]
    fn is_ambiguous(self, cost: u8, second: u8) -> bool {
        second < u8::MAX && u32::from(second) * self.0 <= u32::from(cost) * 100
    }
}

impl<'a> Unique<'a> {
    /// Flags the pixels of a row, none of them where no `percent` is asked for, and gives their margins, as
    /// far as there are places for them.
    pub fn new(percent: Option<u8>, flags: &'a mut [PixelFlags], margins: &'a mut [u8]) -> Self {
        match percent {
            Some(percent) => Self { share: Share(100 - u32::from(percent.min(99))), flags, margins },
            None => Self { share: Share(100), flags: &mut [], margins },
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

/// Flags a pixel whose second best is too near, and gives its margin.
#[inline(always)]
fn check_second(
    share: Share,
    (flags, margin): (Option<&mut PixelFlags>, Option<&mut u8>),
    cost: u8,
    second: u8,
) {
    if let Some(flags) = flags {
        *flags = flags.union(PixelFlags::AMBIGUOUS.when(share.is_ambiguous(cost, second)));
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

    /// Lets no byte of some pixels be over `most`.
    #[inline(always)]
    pub fn limit_bytes(&mut self, places: Range<usize>, most: u8) {
        let bytes = view_mut::<u16, u8>(self.0);
        part_mut(bytes, places).iter_mut().for_each(|length| *length = most.min(*length));
    }

    /// A byte for each pixel, the length as far as it holds it.
    #[inline(always)]
    pub fn bytes(self) -> &'a mut [u8] {
        let width = self.0.len();
        part_mut(view_mut::<u16, u8>(self.0), ..width)
    }
}
