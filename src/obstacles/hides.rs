//! What ends a column's sight of the ground without being a surface.

use super::column::{Column, MOST_GAP, StixelKind};
use super::finder::ObstaclesView;
use super::ground::Ground;
use super::setup::Setup;
use crate::units::Disparity;

/// What ends a column's sight of the ground without being a surface.
#[derive(Clone, Copy)]
pub(super) struct Hides {
    /// Depths between which it stands, mm.
    pub(super) from_mm: u16,
    pub(super) to_mm: u16,
    /// Whether it is lower than an obstacle, as is all behind it.
    pub(super) is_low: bool,
}

impl Hides {
    /// What is beyond all that is needed.
    const BEYOND: Self = Self { from_mm: u16::MAX, to_mm: u16::MAX, is_low: true };
}

/// Parallaxes of what is as far as has to be seen.
#[derive(Clone, Copy)]
pub(super) struct Needed {
    parallax: i32,
    /// That of the ground that an obstacle there hides.
    ground: i32,
}

impl Needed {
    pub(super) fn new(setup: &Setup, ground: Option<&Ground>, needed_mm: u16) -> Self {
        let parallax = setup.millimetre_steps.checked_div(needed_mm.into()).unwrap_or(u32::MAX);
        let parallax = parallax.min(i32::MAX as u32) as i32;
        let hidden =
            ground.map_or(0, |ground| setup.above_obstacle(parallax.clamp(0, 0xffff) as u16, ground));
        Self { parallax, ground: hidden.into() }
    }
}

impl ObstaclesView<'_> {
    /// What ends the sight of the ground in column `x`, if that are answers of neither the ground nor a
    /// surface. It stands where it is as high as an obstacle and hides the ground, or further.
    pub(super) fn hides(
        &self,
        setup: &Setup,
        x: usize,
        column: &Column,
        ground: &Ground,
        needed: &Needed,
    ) -> Option<Hides> {
        let answer = |row: usize| {
            let d = self.cells.get(row * setup.columns + x).filter(|d| d.is_some())?;
            Some((row, i32::from(d.raw()) + setup.offset_steps))
        };
        let above = (0..usize::from(column.seen)).rev().take(usize::from(MOST_GAP) + 1);
        let (row, parallax) = above.into_iter().find_map(answer)?;
        let is_of_it =
            column.kind == StixelKind::Drop || parallax <= column.parallax + i32::from(Disparity::ONE);
        if column.is_supported() && column.is_seen_up_to() && is_of_it {
            return None;
        }
        let cells = setup.cells(self.cells);
        let right = cells.right_16ths(x);
        let ground_at = |row: usize| ground.parallax(cells.halves(row), right);
        // Near the horizon an answer may be the sky's.
        let at = ground_at(row);
        let own = if at >= 2 * cells.farthest { parallax } else { at };
        if at <= needed.ground && own <= needed.parallax {
            return Some(Hides::BEYOND);
        }
        let (mut is_low, mut gap) = (true, 0);
        let beside = ground.beside_256ths(right);
        for row in (0..=row).rev().take_while(|&row| ground_at(row) > needed.ground) {
            let between = self.intervals.get(row).map(|row| row.at(beside, cells.farthest));
            let lies = |p: i32| between.is_some_and(|between| (between.low..=between.high).contains(&p));
            let answer = answer(row);
            gap = if answer.is_some() { 0 } else { gap + 1 };
            is_low &= gap <= MOST_GAP && answer.is_none_or(|(_, p)| lies(p));
        }
        let (own_mm, ground_mm) = (setup.depth_mm(own), setup.depth_mm(at));
        let from_mm = own_mm.min(setup.above_obstacle(ground_mm, ground));
        Some(Hides { from_mm, to_mm: own_mm.min(ground_mm), is_low })
    }
}
