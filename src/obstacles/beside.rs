//! What of a corridor lies beside the picture: the part that no column sees, and what left there.
//!
//! Near to the camera a corridor is wider than the picture. What leaves the picture there is still in the
//! corridor, and no later frame can show that it is gone.

use super::column::{Column, NARROW_PX};
use super::held::Hysteresis;
use super::setup::Setup;
use crate::units::Disparity;

/// Frames in a row that have to show something before it is held beside the picture, where a single wrong
/// surface would be held as well.
const LEAST_FRAMES: u8 = 2;

/// What a frame shows at one side of the picture, with its distance, mm.
#[derive(Clone, Copy)]
pub(super) enum Shown {
    Nothing,
    /// It is in the corridor and ends near to the side: it may be beside the picture in the next frame.
    Leaving(u16),
    /// It is in the corridor and reaches farther in: if it goes, the picture shows it.
    Wide(u16),
    /// It is not in the corridor, or as far as the picture sees the whole width.
    There(u16),
}

/// What a frame shows at both sides of the picture.
#[derive(Clone, Copy)]
pub(super) struct Sides<'a> {
    pub(super) setup: &'a Setup,
    pub(super) columns: &'a [Column],
    /// Half of the corridor's width, mm.
    pub(super) half_mm: i64,
    /// Way that the vehicle may have gone until the next frame, mm.
    pub(super) way_mm: u16,
}

impl Sides<'_> {
    /// How far a column of cells of a side lies outward at a depth, mm. On the left both cameras see less
    /// than the left one: that is taken off where `seen` asks for what both see.
    fn outward_mm(&self, is_right: bool, x: usize, depth_mm: u16, seen: bool) -> i64 {
        if is_right {
            return self.setup.across_mm(x, depth_mm).into();
        }
        let steps = self.setup.millimetre_steps.checked_div(depth_mm.into()).unwrap_or(0);
        let least_16ths = (i64::from(steps) - i64::from(self.setup.offset_steps)).max(0) / 2;
        let right = self.setup.cells(&[]).right_16ths(x) + if seen { least_16ths } else { 0 };
        let across = (i64::from(depth_mm) * right).checked_div(self.setup.rig.focal_16ths.into());
        -across.unwrap_or(0)
    }

    /// What a frame shows at a side.
    pub(super) fn shown(&self, is_right: bool) -> Shown {
        let last = self.setup.columns.saturating_sub(1);
        let at = |inward: usize| if is_right { last.saturating_sub(inward) } else { inward.min(last) };
        let zone = (NARROW_PX as usize).div_ceil(usize::from(self.setup.config.cell_width).max(1));
        let is_beside = |x: usize, mm: u16| {
            let then = mm.saturating_sub(self.way_mm);
            let inner = self.outward_mm(is_right, at(zone), then, true).max(0);
            self.outward_mm(is_right, x, mm, false) >= inner
        };
        let surely = |column: &Column| {
            let depth = self.setup.depth_mm(column.parallax);
            depth.saturating_sub(self.setup.sigma_mm(column).saturating_mul(2))
        };
        let standing = |inward: &usize| {
            let column = self.columns.get(at(*inward)).filter(|column| column.is_supported())?;
            Some((at(*inward), column, surely(column)))
        };
        let (mut leaving, mut there) = (None::<(u16, usize, i32)>, None);
        for inward in 0..=last {
            let Some((x, column, mm)) = standing(&inward).filter(|&(x, _, mm)| is_beside(x, mm)) else {
                continue;
            };
            let is_inside = self.outward_mm(is_right, x, mm, false).abs() <= self.half_mm;
            if is_inside && self.outward_mm(is_right, at(0), mm, true) < self.half_mm {
                if leaving.is_none_or(|(least, ..)| mm < least) {
                    leaving = Some((mm, inward, column.parallax));
                }
            } else {
                there = Some(there.map_or(mm, |least: u16| least.min(mm)));
            }
        }
        let Some((mm, first, parallax)) = leaving else { return there.map_or(Shown::Nothing, Shown::There) };
        // Its front: what is beside it and not farther by a px.
        let is_front = |column: &Column| column.parallax.saturating_add(Disparity::ONE.into()) >= parallax;
        let front = (first..=last).take_while(|inward| standing(inward).is_some_and(|(_, c, _)| is_front(c)));
        let inner = front.last().unwrap_or(first);
        if is_beside(at(inner), mm) { Shown::Leaving(mm) } else { Shown::Wide(mm) }
    }
}

/// What is held beside one side of the picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beside {
    /// Distance at which it was seen last, mm; 0 where nothing is held.
    mm: u16,
    /// Frames since then.
    missing: u8,
}

impl Beside {
    pub(super) const NOTHING: Self = Self { mm: 0, missing: 0 };

    /// The distance that counts.
    pub(super) fn mm(&self) -> Option<u16> {
        Some(self.mm).filter(|&mm| mm > 0)
    }

    /// Takes what a frame shows, the last of `frames` in a row that show something in the corridor.
    ///
    /// What is farther by an eighth than what is held is something else, and leaves it where it is.
    pub(super) fn update(&mut self, shown: Shown, frames: u8, rule: Hysteresis) {
        let is_held = self.mm > 0;
        let may_be_it = |mm: u16| !is_held || u32::from(mm) <= u32::from(self.mm) + u32::from(self.mm / 8);
        match shown {
            Shown::Leaving(mm) if may_be_it(mm) => {
                if is_held || frames >= rule.confirm.max(LEAST_FRAMES) {
                    *self = Self { mm: mm.max(1), missing: 0 };
                }
            }
            Shown::There(mm) if may_be_it(mm) => *self = Self::NOTHING,
            Shown::Wide(mm) if may_be_it(mm) && self.missing <= rule.release => *self = Self::NOTHING,
            _ => self.missing = if is_held { self.missing.saturating_add(1) } else { 0 },
        }
    }
}

impl Setup {
    /// Columns that a corridor would reach over beside the picture at a depth.
    pub(super) fn columns_beside(&self, half_mm: i64, depth_mm: u16) -> usize {
        let cells = self.cells(&[]);
        // The farthest to the side, sixteenths of a px, that is not yet a whole mm outside.
        let outside = (half_mm + 1) * i64::from(self.rig.focal_16ths) - 1;
        let Some(reach) = outside.checked_div(depth_mm.into()) else { return 0 };
        let ends = [-cells.right_16ths(0), cells.right_16ths(self.columns.saturating_sub(1))];
        let beside = ends.map(|end| (reach - end).max(0).checked_div(16 * cells.cell_width).unwrap_or(0));
        // More than any picture has is enough to be blind.
        beside.iter().map(|&columns| columns.min(1 << 20) as usize).sum()
    }
}
