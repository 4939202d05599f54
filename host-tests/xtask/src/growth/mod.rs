//! `cargo xtask growth`: what an evaluation, one disparity of one pixel, costs while the work grows.
//!
//! * `sizes`: what grows, and how far.
//! * `cores`: instructions on emulated cores, which are exact: the table of docs/performance.md, and a limit.
//! * `host`: nanoseconds on this machine, for each of its kernels: printed only.
//! * `table`: both as tables, and where an evaluation costs more than the limit allows.
//!
//! Linear growth is a cost that does not rise. A frame has costs of its own, a row and a pixel too, which
//! larger ones share among more evaluations: so the cost falls.

mod cores;
mod host;
mod sizes;
mod table;

use crate::firmware::tables::Readme;
use crate::steps::{Failure, Outcome};
use clap::Args;

/// The options of `growth`.
#[derive(Args)]
pub struct Arguments {
    /// Times all methods and kernels on this machine instead, in nanoseconds; nothing is written
    #[arg(long, conflicts_with = "check")]
    host: bool,
    /// Writes nothing, fails when the figures' table is another
    #[arg(long)]
    check: bool,
}

/// Does what the command line asks for.
pub fn run(arguments: &Arguments) -> Outcome {
    if !arguments.host {
        return cores::run(Readme::of_check(arguments.check));
    }
    if cfg!(debug_assertions) {
        return Err(Failure::new(
            "growth --host times a release build: cargo run --release -p xtask -- growth --host",
        ));
    }
    host::run()
}

/// A few instructions on one core, held to the limits.
pub fn sample() -> Outcome {
    cores::sample()
}
