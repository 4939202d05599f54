//! What a matching method is made of: numbers, its memory, and how a row gets its winners.
//!
//! * `window`: [`Fast`] and [`Block`], census codes compared over a window.
//! * `sgm`: [`Sgm`], [`SgmLean`] and [`SgmEdge`], gradients, brightness and a census aggregated along paths
//!   by [`Penalties`].
//! * `external`: [`External`], the winners of any of these from outside.

mod denoise;
mod external;
mod sgm;
mod window;

pub use external::External;
pub use sgm::{Sgm, SgmEdge, SgmLean};
pub use window::{Block, Fast};

use super::backend::{Backend, MethodParameters};
use super::config::{Checks, Config};
use super::memory::rings::{BAND, HISTORY, Ring};
use super::memory::workspace::RowWorkspace;
use super::memory::{Bytes, Memory, Rows5};
use super::penalties::Penalties;
#[cfg(feature = "trace")]
use super::trace::StageTrace;
#[cfg(doc)]
use crate::imaging::Noise;
use crate::units::{Disparity, PixelFlags};

/// A matching method. The crate's own types implement it: [`Fast`], [`Block`], [`SgmLean`], [`Sgm`] and
/// [`SgmEdge`].
pub trait Method: MethodParameters + Costs + Steps + Sized + 'static {
    /// Standard deviation of an answer away from depth edges, px: so that on rendered scenes, with sensor
    /// noise of up to two grey levels, three of it hold 99 % of the answers.
    const SIGMA_PX: f32;
    /// Whether answers that are averaged along the row are filtered down the columns as well:
    /// `d += 5/8 (d_above - d) + 5/32 (d_below - d)`, where each of the two is at most 1 px less than d and
    /// less than 1 px more, the row above has come out, and the one below is four rows away.
    const VERTICAL_FILTER: bool = false;
    /// The checks of [`Filter::Default`](super::Filter::Default).
    const DEFAULT: Checks = Checks::DEFAULT;
    /// The checks of [`Filter::Default`](super::Filter::Default) where cameras have noise, [`Noise::Low`] and
    /// [`Noise::High`].
    const DEFAULT_IN_NOISE: [Checks; 2] = [Self::DEFAULT; 2];
    /// The checks of [`Filter::Strict`](super::Filter::Strict).
    const STRICT: Checks = Checks::STRICT;
    /// P1, P2 and truncations of semi-global matching; the methods over windows ignore them.
    ///
    /// ```
    /// use stereopsis::matching::{Config, Filter, Method, SgmEdge};
    /// let config = Config::for_method::<SgmEdge>(320, 240, 64).with_filter::<SgmEdge>(Filter::Default);
    /// assert_eq!(config.penalties, SgmEdge::PENALTIES);
    /// ```
    const PENALTIES: Penalties = Penalties::DEFAULT;
    /// P1, P2 and truncations where cameras have noise.
    const PENALTIES_IN_NOISE: Penalties = Self::PENALTIES;
    /// The method's name, as the programs spell it.
    const NAME: &'static str;
}

/// How a method comes to the winners of a row, and the memory that it takes. Only this crate's methods have
/// it.
pub trait Costs: Sized {
    /// What the method keeps from row to row, and its workspace.
    type Memory<const W: usize, const D: usize>: Memory;
    /// Bytes of [`Self::Memory`].
    const BYTES: Bytes;
    /// Takes row `y` of both images, before [`Self::select`].
    fn enter(frame: &mut Frame<'_>, y: usize, lines: [&Rows5<'_>; 2]);
    /// Adds row `bottom` to the costs, while there are `lines`, and selects the winners of `row`, where there
    /// is one. It is called for every row, because it divides the workspace for the stages behind it. `MOST`
    /// is as for [`Isa::window`](super::backend::Isa::window).
    fn select<const MOST: usize>(
        frame: &mut Frame<'_>,
        bottom: usize,
        lines: Option<[&Rows5<'_>; 2]>,
        row: Option<usize>,
    );
}

/// Takes row `y` of both images (`None` below the last one) and finishes the row that is due with it.
pub type Step = fn(frame: Frame<'_>, y: usize, lines: Option<[&Rows5<'_>; 2]>);

/// The stages of a method. Each method has them for itself, so that they are compiled with this crate, once,
/// and not with every crate that chooses a capacity.
pub trait Steps {
    /// The step of a matcher that has room for `most` disparities.
    fn step_for(most: usize) -> Step;
}

/// The matcher's memory, cut to the frame's size.
pub struct Frame<'a> {
    pub(super) width: usize,
    /// Candidates of a column that the backend works on.
    pub(super) stride: usize,
    pub(super) backend: Backend,
    pub(super) config: &'a Config,
    pub(super) codes: &'a mut [u8],
    pub(super) columns: &'a mut [u8],
    pub(super) workspace: RowWorkspace<'a>,
    /// Texture history of each column: bit `k` is the row `k` above the newest.
    pub(super) texture: &'a mut [u16],
    /// Number of textured pixels of each column in the window's rows.
    pub(super) textured: &'a mut [u8],
    /// Edges of each column: a bit for each of the last eight rows, the newest in the lowest.
    pub(super) edges: &'a mut [u8],
    /// Bits of blocks of four columns, in words of 32: those that are open, those that are refused as
    /// repeated, and those that repeat in each of the last three rows that were looked at.
    pub(super) blocks: &'a mut [u32],
    /// Support of each column's answers so far.
    pub(super) support: &'a mut [u16],
    /// Answers before the speckle filter.
    pub(super) band: Ring<'a, Disparity, BAND>,
    /// Flags of the band's rows, or [notes](super::memory::notes).
    pub(super) flags: Ring<'a, PixelFlags, BAND>,
    /// Answers after the speckle filter.
    pub(super) finished: Ring<'a, Disparity, HISTORY>,
    /// What takes the rows of stages, if anything does.
    #[cfg(feature = "trace")]
    pub(super) trace: Option<&'a mut (dyn StageTrace + 'a)>,
}
