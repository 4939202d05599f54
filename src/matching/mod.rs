//! Lines of two cameras in, disparity rows out, line by line in memory of width x disparities.
//!
//! One row through the stages, in running order:
//!
//! 1. [`scheme`](Method): what a method is. `window`: [`Fast`] and [`Block`], census codes compared over a
//!    window. `paths`: [`Sgm`], [`SgmLean`] and [`SgmEdge`], gradients, brightness and a census compared
//!    along paths, by [`Penalties`]. If asked for, `quiet`: lines smoothed against noise before.
//! 2. `kernels`: the cost of every candidate, its sum, the winner of every pixel. The only stage whose work
//!    grows with the number of disparities, behind one seam ([`Kernel`]).
//! 3. `texture`: whether the window has texture.
//! 4. `answers`: whether the right image agrees, the winner between whole pixels, what refuses it.
//! 5. `surface`: the answers averaged along the row, within their surface.
//! 6. `median`: if asked for, the middle one of the answers around each.
//! 7. `speckle`: answers dropped that too few others support, in a band of five rows.
//! 8. `down`: with the methods along paths, the answers smoothed down the columns, within their surface.
//! 9. `fill`: if asked for, small gaps along the row closed.
//! 10. `confidence`: if asked for, how sure each answer is, of what its second best cost and of the answers
//!     beside it.
//! 11. `mask`: answers taken away where a camera did not see.
//! 12. [`Row`]: what came out, with the uncertainty of each answer.
//!
//! [`Matcher`] owns the `memory` and runs the `stages`, of which some loops are kept small by `rolled`.
//! [`Config`] says what is searched and which answers are refused.
//!
//! # What was tried and is not done
//!
//! Gradients beside the census of [`Block`], as the methods along paths have them, with plain windows of 9x9
//! pixels, without checks, on 15 real pairs: eight bits of census have 9.5 % of the answers over 2 px off;
//! with half the difference of the gradients along and across, cut off at 7, it is 8.9 % (12 pairs win), with
//! that along alone 9.6 %. With noise of 2 grey levels 24.1 % become 22.5 %. An eighth of the brightness and
//! the whole gradient along beside them make it 8.7 %, but 18.8 % in place of 16.5 % where the right image is
//! x 1.2 + 15. A window's sum no longer fits a byte then, and takes twice the registers.

mod backend;
mod config;
mod filter;
mod kernel;
mod matcher;
mod memory;
mod method;
mod penalties;
mod row;
mod stages;

pub use backend::MethodParameters;
pub use config::{Checks, Config, ConfigError};
pub use filter::Filter;
pub use kernel::{Kernel, KernelError};
pub use matcher::{MatchError, Matcher, state_bytes};
pub use method::{Block, Fast, Method, Sgm, SgmEdge, SgmLean};
pub use penalties::Penalties;
pub use row::Row;
