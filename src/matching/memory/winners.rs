//! The winner of each pixel, and what is asked of the second best (winner-take-all).
#![allow(dead_code, reason = "each target uses the form that suits it")]

use super::views::view_mut;
pub(in crate::matching) use super::winner::Winner;
use crate::units::PixelFlags;

/// How near a disparity may be to the winner and still be of it: what costs little there does not make it
/// ambiguous.
pub(in crate::matching) const BESIDE: usize = 2;

/// What is selected, and where to.
pub(in crate::matching) struct Select<'a> {
    /// Disparities searched.
    pub disparities: usize,
    /// The best disparity of each pixel; left of the smallest disparity they mean nothing. Kernels in
    /// vectors leave them as [`WinnerRows`].
    pub winners: &'a mut [Winner],
    /// What is asked of the others.
    pub unique: Unique<'a>,
}

/// What is asked of the second best: the least cost of the candidates over two px beside the winner,
/// `u8::MAX` where there is none. A kernel that is asked for nothing ([`Unique::is_asked`]) need not look for
/// it; [`Unique::judge`] and [`Unique::starting_at`] look where it is asked for.
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

    /// Judges the pixel in column `x`: it is given the winner's cost, and what finds the second best, which
    /// is asked where it is wanted.
    #[inline(always)]
    pub fn judge(&mut self, x: usize, cost: u8, second: impl FnOnce() -> u8) {
        if self.is_asked() {
            let second = second();
            judge(self.share, (self.flags.get_mut(x), self.margins.get_mut(x)), cost, second);
        }
    }

    /// Judges the pixels from column `begin` on, one after the other: see [`Self::judge`].
    #[inline(always)]
    pub fn starting_at(self, begin: usize) -> impl FnMut(u8, &mut dyn FnMut() -> u8) {
        let (share, is_asked) = (self.share, self.is_asked());
        let mut flags = self.flags.get_mut(begin..).unwrap_or_default().iter_mut();
        let mut margins = self.margins.get_mut(begin..).unwrap_or_default().iter_mut();
        move |cost, second| {
            if is_asked {
                let second = second();
                judge(share, (flags.next(), margins.next()), cost, second);
            }
        }
    }
}

/// Says of a pixel what is asked.
#[inline(always)]
fn judge(share: Share, (flags, margin): (Option<&mut PixelFlags>, Option<&mut u8>), cost: u8, second: u8) {
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

/// Winners as the kernels in vectors leave them: a row of bytes for each part, one after the other in the
/// same memory.
pub(in crate::matching) struct WinnerRows<'a> {
    pub below: &'a mut [u8],
    pub costs: &'a mut [u8],
    pub above: &'a mut [u8],
    pub disparities: &'a mut [u8],
}

impl<'a> WinnerRows<'a> {
    /// The rows from column `begin` on.
    pub fn of(winners: &'a mut [Winner], begin: usize) -> Self {
        let width = winners.len().max(1);
        let mut rows = view_mut::<Winner, u8>(winners)
            .chunks_exact_mut(width)
            .map(|row| row.get_mut(begin..).unwrap_or_default());
        let mut row = || rows.next().unwrap_or_default();
        Self { below: row(), costs: row(), above: row(), disparities: row() }
    }
}
