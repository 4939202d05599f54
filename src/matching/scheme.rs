//! What a matching method is made of.

use super::config::Checks;
#[cfg(doc)]
use super::filter::Filter;
use super::memory::{Bytes, Memory};
use super::penalties::Penalties;
use super::stages::Stages;
#[cfg(doc)]
use crate::imaging::Noise;

/// A matching method. The crate's own types implement it: [`Fast`](super::Fast), [`Block`](super::Block),
/// [`SgmLean`](super::SgmLean), [`Sgm`](super::Sgm) and [`SgmEdge`](super::SgmEdge).
pub trait Scheme: Lines + Sized + 'static {
    /// What an answer rests on reaches this many columns to each side: there texture is counted.
    const RADIUS_X: usize;
    /// And this many rows up and down. A row has its costs when so many rows below it are in.
    const RADIUS_Y: usize;
    /// Standard deviation of an answer away from depth edges, px: so that on rendered scenes, with sensor
    /// noise of up to two grey levels, three of it hold 99 % of the answers.
    const SIGMA_PX: f32;
    /// How much more a disparity one px beside the winner's costs for that alone, on a slanted surface: what
    /// is left of the rise tells where between pixels it lies.
    const STEP: u8 = 0;
    /// Whether answers that are averaged along the line are smoothed down the columns as well: of what an
    /// answer is away from the one above, as that came out, 5/8, and 5/32 of what it is away from that
    /// four rows below, where both are within 1 px.
    const SMOOTH_DOWN: bool = false;
    /// The checks of [`Filter::Default`].
    const DEFAULT: Checks = Checks::DEFAULT;
    /// The same where cameras have noise, [`Noise::Low`] and [`Noise::High`].
    const DEFAULT_IN_NOISE: [Checks; 2] = [Self::DEFAULT; 2];
    /// The checks of [`Filter::Strict`].
    const STRICT: Checks = Checks::STRICT;
    /// What changes of the disparity are worth; of no meaning to the block methods.
    ///
    /// ```
    /// use stereopsis::matching::{Config, Filter, Scheme, SgmEdge};
    /// let config = Config::new(320, 240, 64).with_filter::<SgmEdge>(Filter::Default);
    /// assert_eq!(config.penalties, SgmEdge::PENALTIES);
    /// ```
    const PENALTIES: Penalties = Penalties::DEFAULT;
    /// The same where cameras have noise.
    const PENALTIES_IN_NOISE: Penalties = Self::PENALTIES;
    /// The method's name, as the programs spell it.
    const NAME: &'static str;
}

/// The parts of a method that only the matcher sees: its storage and its arithmetic.
pub trait Lines: Sized {
    /// What it keeps from row to row, and room to work in.
    type Memory<const W: usize, const D: usize>: Memory;
    /// How much that is.
    const BYTES: Bytes;
    /// Takes row `y` of both images, before [`Self::select`].
    fn enter(stages: &mut Stages<'_, Self>, y: usize, lines: [&Around<'_>; 2])
    where
        Self: Scheme;
    /// Adds row `bottom` to the costs, while there are `lines`, and selects the winners of `row`, where there
    /// is one. Called for every step: after it, the slices of the stages stand for what they say.
    fn select(
        stages: &mut Stages<'_, Self>,
        bottom: usize,
        lines: Option<[&Around<'_>; 2]>,
        row: Option<usize>,
    ) where
        Self: Scheme;
    /// [`Stages::step`]. Each method says so for itself, so that its stages are compiled with this crate,
    /// once, and not with every crate that chooses a capacity.
    fn step(stages: Stages<'_, Self>, y: usize, lines: Option<[&Around<'_>; 2]>)
    where
        Self: Scheme;
}

/// The five lines around a row.
pub type Around<'a> = [&'a [u8]; 5];
