//! `cargo xtask firmware`: the firmware example, built, run in QEMU and compared with the host.
//!
//! * [`arguments`]: what is asked for. [`program`]: one build of the example. [`emulate`]: QEMU. [`log`]: the
//!   firmware's log as text.
//! * [`frame`]: one frame on one core, held to the host; [`call_graph`]: the stack that its program can take;
//!   [`one_frame`]: with the files that are written of it, [`summary`].
//! * [`all`]: every core, method and size; [`tables`] of it for docs/performance.md; [`checksums`] on real
//!   pictures; [`measured`]: what they are made of.
//! * [`stage_rows`]: the rows of a frame's stages, held to the twins.
//! * [`as_match`]: noisy cameras that are exposed unequally, beside `stereo match`.
//! * [`awkward`]: sizes that fill no vector, where the rows are in assembly.
//! * [`pose`]: two views on one core, held to the host; [`two_views_all`]: on every core.
//! * [`bundle`]: their adjustment, likewise.
//! * [`features`]: features of two pictures and their matches, on one core and on those of the table.
//! * [`focus`]: a lens that moves, likewise. [`odometry`]: where a pair of cameras goes. [`interrupt`]: lines
//!   that an interrupt brings.
//! * [`drive`]: a robot that drives by its obstacles, likewise.
//! * [`rectify`]: raw lines, and depth from them, likewise.
//! * [`results`]: the run of such a program, and what it leaves; [`plain`]: the table of it.
//! * [`stages`]: a frame's instructions by stage. [`profiles`]: a program by levels of optimisation.
//! * [`refusals`]: a panic does not link, and a bad file is named.

mod all;
mod arguments;
mod as_match;
mod awkward;
mod bundle;
mod call_graph;
mod checksums;
mod drive;
pub mod emulate;
mod features;
mod focus;
pub mod frame;
mod interrupt;
mod log;
mod measured;
mod odometry;
mod one_frame;
mod plain;
mod pose;
mod profiles;
pub mod program;
mod rectify;
mod refusals;
mod results;
mod stage_rows;
mod stages;
mod summary;
pub mod tables;
mod two_views_all;

pub use arguments::Arguments;
pub use program::{Optimised, VECTORS, cargo};
pub use results::Ran;

use crate::setup;
use crate::steps::{Failure, Outcome};
use arguments::{Asked, Plain};
use bundle::Bundle;
use drive::Drive;
use features::Features;
use firmware_boards::{self as board, Board};
use focus::Focus;
use interrupt::Interrupt;
use odometry::Odometry;
use pose::Pose;
use rectify::Rectify;
use serde::Serialize;
use std::path::Path;
use stereopsis_host::output::Staging;
use tables::Readme;

/// Does what the command line asks for.
pub fn run(arguments: &Arguments) -> Outcome {
    match arguments.asked()? {
        Asked::Depth(one) => one_frame::run(&one),
        Asked::StageRows(one) => stage_rows::run(&one),
        Asked::Pose(plain) => run_plain(&plain, pose::run, Pose::summary),
        Asked::Features(plain) => run_plain(&plain, features::run, Features::summary),
        Asked::Drive(plain) => run_plain(&plain, drive::run, Drive::summary),
        Asked::Focus(plain) => run_plain(&plain, focus::run, Focus::summary),
        Asked::Bundle(plain) => run_plain(&plain, bundle::run, Bundle::summary),
        Asked::Odometry(plain) => run_plain(&plain, odometry::run, Odometry::summary),
        Asked::Rectify(plain) => run_plain(&plain, rectify::run, Rectify::summary),
        Asked::Interrupt(plain) => run_plain(&plain, interrupt::run, Interrupt::summary),
        Asked::All => run_all(Readme::of_check(arguments.check)),
        Asked::Stages => stages::run(Readme::of_check(arguments.check)),
        Asked::Profiles => profiles::run(Readme::of_check(arguments.check)),
    }
}

/// Every core and program; writes the figures' tables, or compares them.
fn run_all(readme: Readme) -> Outcome {
    all::run(readme)?;
    two_views_all::run(readme)?;
    plain::run_all(readme, bundle::run, Bundle::summary)?;
    plain::run_all(readme, features::run, Features::summary)?;
    plain::run_all(readme, focus::run, Focus::summary)?;
    plain::run_all(readme, drive::run, Drive::summary)?;
    plain::run_all(readme, odometry::run, Odometry::summary)?;
    plain::run_all(readme, rectify::run, Rectify::summary)?;
    println!("{}", interrupt::run(board::M4, Optimised::Speed)?.summary());
    Ok(())
}

/// Every core and method and a part of the sizes and programs, compared with docs/performance.md. Where
/// instructions have changed by over a hundredth, it names the stages.
pub fn check_sample() -> Outcome {
    run_all(Readme::Sample).map_err(stages::named)
}

/// A frame with what the program `stereo` at that path makes of it.
pub fn check_as_match(stereo: &Path) -> Outcome {
    as_match::check(stereo)
}

/// The rows of all stages on all cores, and a part of the profiles, compared with docs/performance.md.
pub fn check_stages_and_profiles() -> Outcome {
    profiles::run(Readme::Sample)?;
    stage_rows::check()
}

/// A program without sizes to choose, on one core into a folder.
fn run_plain<T: Serialize>(
    Plain { board, optimised, out }: &Plain,
    run: fn(Board, Optimised) -> Outcome<T>,
    told: fn(&T) -> String,
) -> Outcome {
    Staging::probe(out).map_err(|e| Failure::new(format!("--out: {e}")))?;
    setup::firmware(&[board.target])?;
    let found = run(*board, *optimised)?;
    results::write(&found, out)?;
    println!("{}", told(&found));
    println!("results are in {}; what was found is what the host finds, to the bit", out.display());
    Ok(())
}
