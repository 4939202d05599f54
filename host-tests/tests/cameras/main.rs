//! What stands between sensors and the pipeline, and what it does when they fail.
//!
//! * `faults`: the pipeline before a source with every fault, held against the injector's record; `changing`:
//!   that source.
//! * `handoff`: lines from an interrupt. `formats`: pixel formats and streams of two cameras. `sensors`,
//!   `hm01b0`: what is written to them; `waited`: the same over a bus that is waited for.
//! * `after`: answers over frames, smaller rows, rows on a display.
//! * `exposure`: one exposure for two cameras, and what their pictures tell of their health.

mod after;
mod balance;
mod changing;
mod exposure;
mod faults;
mod formats;
mod handoff;
mod hm01b0;
mod sensors;
mod waited;
