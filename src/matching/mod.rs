//! Lines of two cameras in, disparity rows out, line by line in memory of width x disparities.
//!
//! A row's way: [`Matcher`] owns the memory and lends it as a `Frame`; `stages` calls one stage after the
//! other; a stage calls its method or its target's code (`backend`), which returns to it. The rooms, each of
//! which uses only those above it:
//!
//! * [`Kernel`]: the kernels by name. [`Capacity`]: how many disparities a matcher has room for.
//!   [`Penalties`] and [`Config`] with [`Checks`]: what is asked.
//! * `memory`: what is kept from row to row, the workspace, and the types of what stages hand on.
//! * `backend`: the instructions that the dense path runs on, a folder for each target behind one seam; the
//!   only place that knows targets.
//! * `method`: what a method is made of. [`Fast`] and [`Block`] compare census codes over a window, [`Sgm`],
//!   [`SgmLean`] and [`SgmEdge`] aggregate costs along paths.
//! * [`Filter`]: operating points of the methods.
//! * `stages`: the stages of a row, in running order, with a table of the rows that each one touches:
//!     1. the row that came out last gets back the answers that were refused as unsure (`withhold`);
//!     2. denoise, if asked for: the lines that come in are smoothed against noise (in `method`);
//!     3. census of the row that comes in (`method`, `backend`); along paths both are a part of 7;
//!     4. texture and edges of its pixels, the open places that have none, and patterns that repeat along it,
//!        if asked for;
//!     5. what was filled in the row that came out last is taken out of it: no later row looks at a guess;
//!     6. median of 3 x 3 answers, if asked for;
//!     7. costs, their aggregation and winner-take-all (`method`, `backend`);
//!     8. left-right check and sub-pixel fit;
//!     9. answers refused that are unsure in open places (`open`), on patterns that repeat along the row
//!        (`repeats`), where a near surface is carried on over a place without texture (`fattening`), and
//!        outside of the edges between which it is (`rims`);
//!     10. smoothing along the row, within surfaces;
//!     11. confidence, if asked for;
//!     12. speckle filter, in a band of five rows;
//!     13. vertical filter, with the methods along paths;
//!     14. fill of small gaps, if asked for, but on patterns that repeat (`repeats`);
//!     15. answers refused whose confidence is too low, if asked for (`withhold`);
//!     16. mask: answers taken away where a camera did not see.
//! * `external`: rows of winners that something else computed ([`External`], [`WinnerRecord`]), in place of
//!   stages 2, 3 and 7.
//! * [`Row`]: what comes out, with the uncertainty of each answer. With the feature `trace` a matcher shows
//!   rows of its stages as well (`StageTrace`).

mod kernel;
mod penalties;
mod capacity;
mod config;
mod memory;
#[cfg(feature = "trace")]
mod trace;
mod backend;
mod method;
mod filter;
mod stages;
mod row;
mod error;
mod state_bytes;
mod matcher;
mod external;

pub use backend::MethodParameters;
pub use capacity::{Capacity, Supported};
pub use config::{Checks, Config, ConfigError};
pub use error::MatchError;
pub use filter::Filter;
pub use kernel::{Kernel, KernelError};
pub use matcher::Matcher;
pub use memory::record::WinnerRecord;
pub use method::{Block, External, Fast, Method, Sgm, SgmEdge, SgmLean};
pub use penalties::Penalties;
pub use row::Row;
#[cfg(feature = "ffi")]
pub(crate) use state_bytes::array_bytes;
pub use state_bytes::state_bytes;
#[cfg(feature = "trace")]
pub use trace::{StageTrace, TracedStage};
