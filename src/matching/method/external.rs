//! A method whose winners something else computes: a block of gates, another core, a file.
//!
//! All that comes before a row's winners is left out, with the memory of width x disparities that it takes.

use super::{Costs, Frame, Method};
use crate::matching::backend::MethodParameters;
use crate::matching::config::Checks;
use crate::matching::memory::record::WinnerRecord;
use crate::matching::memory::views::view;
use crate::matching::memory::winners::Unique;
use crate::matching::memory::workspace::ForWinners;
use crate::matching::memory::{Bytes, RecordMemory, Rows5};
use crate::matching::penalties::Penalties;
use crate::units::PixelFlags;
use core::marker::PhantomData;

/// Method `S` from its winners on: a [`Matcher`](crate::matching::Matcher) of it takes rows of
/// [`WinnerRecord`]s in place of the right image's lines, and gives the bits that `S` gives.
///
/// What it takes grows with the width alone:
///
/// ```
/// use stereopsis::matching::{Block, External, state_bytes};
/// assert_eq!(state_bytes::<Block>(320, 64), 44_032);
/// assert_eq!(state_bytes::<External<Block>>(320, 64), 16_256);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct External<S>(PhantomData<S>);

impl<S: MethodParameters> MethodParameters for External<S> {
    const RADIUS_X: usize = S::RADIUS_X;
    const RADIUS_Y: usize = S::RADIUS_Y;
    const SLANT_COST: u8 = S::SLANT_COST;
    const ALONG_PATHS: bool = S::ALONG_PATHS;
    const EXTERNAL_WINNERS: bool = true;
}

impl<S: Method> Method for External<S>
where
    Self: super::Steps,
{
    const SIGMA_PX: f32 = S::SIGMA_PX;
    const VERTICAL_FILTER: bool = S::VERTICAL_FILTER;
    const DEFAULT: Checks = S::DEFAULT;
    const DEFAULT_IN_NOISE: [Checks; 2] = S::DEFAULT_IN_NOISE;
    const STRICT: Checks = S::STRICT;
    const PENALTIES: Penalties = S::PENALTIES;
    const PENALTIES_IN_NOISE: Penalties = S::PENALTIES_IN_NOISE;
    const NAME: &'static str = S::NAME;
}

impl<S> Costs for External<S> {
    type Memory<const W: usize, const D: usize> = RecordMemory<W, D>;
    const BYTES: Bytes = RecordMemory::<0, 0>::BYTES;

    #[inline(always)]
    fn enter(_: &mut Frame<'_>, _: usize, _: [&Rows5<'_>; 2]) {}

    #[inline(always)]
    fn select<const MOST: usize>(
        frame: &mut Frame<'_>,
        _: usize,
        _: Option<[&Rows5<'_>; 2]>,
        row: Option<usize>,
    ) {
        if let Some(row) = row {
            check_second_best(frame, row);
        }
    }
}

/// Flags the winners of `row` whose second best is too near, and gives their margins.
#[inline(never)]
fn check_second_best(frame: &mut Frame<'_>, row: usize) {
    let config = frame.config;
    let flags = frame.flags.row_mut(row);
    flags.fill(PixelFlags::CLEAR);
    let ForWinners { margins, .. } = frame.workspace.for_winners(config.needs_margins());
    let mut unique = Unique::new(config.checks.uniqueness_percent, flags, margins);
    let records = view::<u8, WinnerRecord>(frame.codes).iter().enumerate();
    for (x, record) in records.skip(usize::from(config.min_disparity)) {
        unique.check(x, record.cost(), || record.second());
    }
}
