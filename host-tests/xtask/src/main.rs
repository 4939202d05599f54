//! `cargo xtask`: the chores of the repository.
//!
//! * `test` sets up what it needs and runs everything: the one test command.
//! * `readme` writes the generated parts of README.md anew, or checks them.
//! * `c` tests the C interface alone, one step of `test`.
//! * `header` writes the header of the C interface anew, or checks it.
//!
//! [`steps`] runs named steps, [`setup`] gets tools, [`mod@test`] is the list of steps, [`firmware`], [`c`] and
//! [`readme`] are three of them.

use clap::{Parser, Subcommand};
use std::process::ExitCode;

mod c;
mod firmware;
mod header;
mod pictures;
mod readme;
mod setup;
mod steps;
mod symbols;
mod test;

/// The chores of the repository.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    chore: Chore,
}

#[derive(Subcommand)]
enum Chore {
    /// Sets up what the tests need and runs all of them; STEREO_DATA names the folder of real stereo pairs.
    Test,
    /// Writes the generated parts of README.md anew.
    Readme {
        /// Writes nothing; fails when a part differs from what would be written.
        #[arg(long)]
        check: bool,
    },
    /// Tests the C interface alone: header, sanitizers, two boards in QEMU.
    C,
    /// Writes the header of the C interface anew.
    Header {
        /// Writes nothing; fails when the header differs from what would be written.
        #[arg(long)]
        check: bool,
    },
}

fn main() -> ExitCode {
    let done = match Arguments::parse().chore {
        Chore::Test => test::run(),
        Chore::Readme { check } => readme::run(check),
        Chore::C => c::run(),
        Chore::Header { check } => header::run(check),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            ExitCode::FAILURE
        }
    }
}
