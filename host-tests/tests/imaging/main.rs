//! What is made of lines before they are matched.
//!
//! * `census`, `gradient`, `noise`, `remap`: stages against their naive twins. `remap_faults`: raw lines that
//!   are lost.
//! * `exposure`: one exposure for two cameras, and what their pictures say about their health. `balance`:
//!   pairs whose cameras are exposed otherwise.

mod balance;
mod census;
mod exposure;
mod gradient;
mod noise;
mod picture;
mod remap;
mod remap_faults;
mod remap_pair;
mod remap_turned;
