//! What brings lines from sensors.
//!
//! * `scripted`: cameras that do what a test says, and what stands on cameras.
//! * `handoff`: lines from an interrupt; `ping_pong`: out of a circular DMA; `signal`: the task that they
//!   wake. `formats`: pixel formats and streams of two cameras; `told_lost`: streams that say what is lost;
//!   `mosaics`: lost lines of a mosaic.
//! * `sensors`, `hm01b0`: what is written to them; `waited`: the same over a bus that is waited for.
//! * `on_spi`: the driver of `examples/boards/spi-cameras`, on simulated cameras and on ones that fail.

mod formats;
mod handoff;
mod hm01b0;
mod mosaics;
mod on_spi;
mod ping_pong;
mod scripted;
mod sensors;
mod signal;
mod told_lost;
mod waited;
