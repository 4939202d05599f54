//! The rows in the vectors of a 32-bit RISC-V core (Zve32x), in assembly; the stages behind winners are
//! portable. Lanes run over the disparities of one pixel, the largest first: so a pixel's candidates stand in
//! memory as they do in the right image.
//!
//! One instruction works on all candidates of a pixel: a column of up to 128 is a group of as many registers
//! as it takes where one has 16 bytes ([`Columns`]), which every core has that the crate is compiled for. The
//! code is the same for any number of candidates. Where there are more, `any` has windows, and costs along
//! paths are worked on in words.
//!
//! * `rows`: bytes filled and copied. `census`: the codes.
//! * `windows`: sums of columns and windows, and their winners.
//! * `features`: what is compared along paths. `cost`: what pixels differ by; `within_edges`: averaged so.
//! * `changes`: what paths pay at each pixel. `down`, `right`, `left`: the paths, the last one with the
//!   winners.
//! * `edges`: where brightness changes. `speckle`: support counted. `fill`: small gaps.
//! * `step`, `winner`: pieces of the assembly.
//!
//! Of the stages around it the compiler makes vectors where it finds that they gain.
#![allow(unsafe_code)]

#[macro_use]
mod step;
#[macro_use]
mod winner;

mod any;
mod census;
mod changes;
mod columns;
mod cost;
mod down;
mod edges;
mod features;
mod fill;
mod left;
mod right;
mod rows;
mod speckle;
mod windows;
mod within_edges;

use super::isa::{Isa, sole_kernel};
use super::parameters::{SgmParameters, WindowParameters};
use super::portable::{self, sgm};
use super::work::{CensusWork, CostWork, EdgeWork, FillWork, Guide, PathWork, SpeckleWork, WindowWork};
use crate::matching::kernel::Kernel;
use crate::matching::memory::slices::{part, split_mut};
use crate::matching::memory::views::{Plain, view_mut};
use crate::matching::memory::winners::Select;
use crate::units::Disparity;
use columns::Columns;
use features::VectorRows;

pub(in crate::matching) use super::plain::{BY_CAPACITY, CODES_SHARE_A_BYTE, columns_begin};

sole_kernel! {
    /// The vectors of a RISC-V core, which it has by what the compiler was given.
    Rvv
}

impl Isa for Backend {
    #[inline(always)]
    fn kernel(self) -> Kernel {
        Kernel::Rvv
    }

    #[inline(always)]
    fn fill_bytes<T: Plain>(self, row: &mut [T], byte: u8) {
        rows::fill(view_mut(row), byte);
    }

    #[inline(always)]
    fn census<P: WindowParameters>(self, work: CensusWork<'_>) {
        census::census::<P>(work);
    }

    #[inline(always)]
    fn window<P: WindowParameters, const MOST: usize>(
        self,
        work: WindowWork<'_>,
        select: Option<Select<'_>>,
    ) {
        match Columns::of(work.stride) {
            Some(columns) => windows::window::<P>(work, select, columns),
            None if MOST == 0 => any::window::<P>(work, select),
            None => {}
        }
    }

    #[inline(always)]
    fn sgm_cost<P: SgmParameters, const MOST: usize>(self, work: &mut PathWork<'_>, row: CostWork<'_>) {
        match Columns::of(work.stride) {
            Some(columns) => enter::<P>(work, row, columns),
            None if MOST == 0 => sgm::cost_in_words::<P, 0>(work, row),
            None => {}
        }
    }

    #[inline(always)]
    fn sgm_within_edges<const MOST: usize>(self, work: &mut PathWork<'_>, edges: EdgeWork<'_>) {
        match Columns::of(work.stride) {
            Some(columns) => within_edges::within_edges(work, edges, columns),
            None if MOST == 0 => sgm::within_edges_in_words::<0>(work, edges),
            None => {}
        }
    }

    #[inline(always)]
    fn sgm_select<const MOST: usize>(self, work: &mut PathWork<'_>, guide: Guide<'_>, select: Select<'_>) {
        match Columns::of(work.stride) {
            Some(columns) => self::select(work, guide, select, columns),
            None if MOST == 0 => sgm::select_in_words::<0>(work, guide, select),
            None => {}
        }
    }

    #[inline(always)]
    fn median(self, rows: [&[Disparity]; 3], out: &mut [Disparity]) {
        median(rows, out);
    }

    #[inline(always)]
    fn speckle(self, work: SpeckleWork<'_>) {
        speckle::speckle(work);
    }

    #[inline(always)]
    fn fill(self, work: FillWork<'_>) {
        fill::fill(work);
    }

    #[inline(always)]
    fn push_edges(self, edges: &mut [u8], lines: [&[u8]; 3], least: u16) {
        edges::push(edges, lines, least);
    }
}

#[inline(never)]
fn median(rows: [&[Disparity]; 3], out: &mut [Disparity]) {
    portable::median::median_in_rows(rows, out);
}

/// Adds a row to the costs; the first row of a frame to none.
#[inline(never)]
fn enter<S: SgmParameters>(work: &mut PathWork<'_>, row: CostWork<'_>, columns: Columns) {
    if row.is_first {
        rows::fill(work.costs, 0);
    }
    if let Some(features) = sgm::features::of::<VectorRows, S>(work, row.lines, row.workspace) {
        cost::enter::<S>(work, &features, columns);
        work.close(work.stride, work.penalties.cost);
    }
}

/// Moves the paths through a row, and selects the winner of every pixel that has a candidate.
#[inline(never)]
fn select(work: &mut PathWork<'_>, guide: Guide<'_>, select: Select<'_>, columns: Columns) {
    let Select { winners, unique, .. } = select;
    let width = work.width;
    let winners = winners.words();
    let workspace = core::mem::take(&mut work.workspace);
    let (along, room) = split_mut(view_mut::<u32, u16>(workspace), width + 1);
    // There are no winners yet where the changes down to the row are.
    let (down, _) = split_mut(view_mut(&mut *winners), width);
    changes::changes(guide.here, guide.above.unwrap_or(guide.here), work.penalties, down);
    down::down(work, guide.row, down, columns);
    // Into a column from the one before it, from the right into that one from it. What a path pays that comes
    // from nowhere is nothing, whatever stands there.
    if let (Some(places), Some(next)) = (along.get_mut(1..width), guide.here.get(1..)) {
        changes::changes(next, guide.here, work.penalties, places);
    }
    right::right(work, guide.row, along, columns);
    left::left(work, along, view_mut(room), winners, unique.is_asked(), columns);
    let begin = work.min_disparity;
    if unique.is_asked() {
        let mut check = unique.checks_from(begin);
        for (winner, &second) in part(winners, begin..).iter().zip(part(along, begin + 1..)) {
            check(winner.cost(), &mut || second as u8);
        }
    }
}
