//! `cargo xtask`: the chores of the repository.
//!
//! * `test` sets up what it needs and runs what every change passes, or all there is: the one test command.
//! * `firmware` runs the firmware example in QEMU, on one core or on all.
//! * `growth` measures how the cost grows with the work.
//! * `rtl` simulates the block of `examples/fpga` before the library's second half.
//! * `fuzz` looks for inputs that break a promise.
//! * `miri` runs what is `unsafe` and no assembly under an interpreter that sees undefined behaviour.
//! * `races` runs what threads share under ThreadSanitizer.
//! * `mutants` changes the code and says which changes no test sees.
//! * `soak` runs thousands of frames of a camera with every fault.
//! * `view` builds the live page's module and shows the page.
//! * `book` writes the pages of docs/ as a book.
//! * `altered` measures how right the methods are on altered real images, beside OpenCV.
//! * `focus` measures how right depth from focus is on rendered stacks.
//! * `readme` writes the tables and pictures that are made of the code alone anew, or checks them.
//! * `c` tests the C interface alone, one step of `test`.
//! * `cross` checks the core for all targets and with every feature.
//! * `publish` checks what a registry would hand out; it publishes nothing.
//! * `header` writes the header of the C interface anew, or checks it.
//!
//! [`steps`] runs named steps, [`setup`] gets tools, [`mod@test`] is the list of steps, [`mod@firmware`],
//! [`growth`], [`c`], [`arm`], [`cross`], [`mod@rtl`], [`view`], [`book`], [`package`] and [`readme`] are ten
//! of them.
//! [`altered`] needs data that not everybody has, [`fuzz`], [`miri`], [`races`], [`mutants`] and
//! [`soak`] time.

use clap::error::ErrorKind;
use clap::{Parser, Subcommand};
use std::process::ExitCode;
use stereopsis_host::command_line::{one_line, usage_line};

mod altered;
mod arm;
mod boards;
mod book;
mod c;
mod cross;
mod elf;
mod examples;
mod firmware;
mod focus;
mod fuzz;
mod growth;
mod header;
mod kernels;
mod miri;
mod mutants;
mod named;
mod package;
mod packages;
mod parallel;
mod pictures;
mod profile;
mod races;
mod readme;
mod rtl;
mod setup;
mod soak;
mod steps;
mod test;
mod view;

/// The chores of the repository.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    chore: Chore,
}

#[derive(Subcommand)]
enum Chore {
    /// Sets up what the tests need and runs those of every change; STEREO_DATA names the folder of real
    /// stereo pairs.
    Test {
        /// Runs what is checked before a release too: more processors, boards and compilers.
        #[arg(long, conflicts_with = "step")]
        all: bool,
        /// Runs only the steps with these words in their names, such as "clippy" or "firmware".
        #[arg(long, value_name = "WORDS")]
        step: Option<String>,
    },
    /// Runs the firmware example in QEMU and holds it to the host, bit for bit.
    Firmware(firmware::Arguments),
    /// Measures what an evaluation costs while the work grows: instructions on two cores, or times on this
    /// machine.
    Growth(growth::Arguments),
    /// Simulates the gates of examples/fpga and holds them to the host, bit for bit.
    Rtl(rtl::Arguments),
    /// Looks for inputs that break a promise of the library, led by coverage.
    Fuzz(fuzz::Arguments),
    /// Runs what is unsafe and no assembly under Miri, for a 64-bit and a 32-bit processor.
    Miri,
    /// Runs what threads share under ThreadSanitizer.
    Races,
    /// Changes the code, a place at a time, and says which changes no test sees.
    Mutants(mutants::Arguments),
    /// Runs thousands of frames of a camera with every fault, and holds each row to the frame without one.
    Soak(soak::Arguments),
    /// Builds the core for browsers and runs `stereo view` with it.
    View(view::Arguments),
    /// Writes the pages of docs/ as a book of HTML, with the pictures that their commands draw.
    Book(book::Arguments),
    /// Measures how right the methods are on real pairs with noise and unequal cameras, beside OpenCV.
    Altered(altered::Arguments),
    /// Measures how right depth from focus is on rendered stacks, beside the plain method.
    Focus(focus::Arguments),
    /// Measures where the nanoseconds of a frame go on this machine, by stage.
    Profile(profile::Arguments),
    /// Writes what is made of the code alone anew: memory, accuracy and false surfaces in
    /// docs/performance.md, README.md's figures, and two pictures. Other chores make the other tables.
    Readme {
        /// Writes nothing; fails when one of them differs from what would be written.
        #[arg(long)]
        check: bool,
    },
    /// Tests the C interface alone: header, sanitizers, every method on four boards in QEMU.
    C,
    /// Checks the core for all targets and with every feature.
    Cross,
    /// Checks the crate as it would be published, its dependencies' licences and advisories, and what its
    /// interface breaks since the last tag. Publishes nothing.
    Publish,
    /// Writes the header of the C interface anew.
    Header {
        /// Writes nothing; fails when the header differs from what would be written.
        #[arg(long)]
        check: bool,
    },
}

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(help) if matches!(help.kind(), ErrorKind::DisplayHelp | ErrorKind::DisplayVersion) => help.exit(),
        Err(error) => {
            eprintln!(
                "error: {}",
                one_line(&usage_line(
                    &error,
                    "the chores are test, firmware, growth, rtl, fuzz, miri, races, mutants, soak, view, \
                        book, altered, focus, profile, c, cross, header, publish and readme"
                ))
            );
            return ExitCode::FAILURE;
        }
    };
    let done = match arguments.chore {
        Chore::Test { all, step } => test::run(step, all),
        Chore::Firmware(arguments) => firmware::run(&arguments),
        Chore::Growth(arguments) => growth::run(&arguments),
        Chore::Rtl(arguments) => rtl::run(&arguments),
        Chore::Fuzz(arguments) => fuzz::run(&arguments),
        Chore::Miri => miri::run(),
        Chore::Races => races::run(),
        Chore::Mutants(arguments) => mutants::run(&arguments),
        Chore::Soak(arguments) => soak::run(&arguments),
        Chore::View(arguments) => view::run(&arguments),
        Chore::Book(arguments) => book::run(&arguments),
        Chore::Focus(arguments) => focus::run(&arguments),
        Chore::Altered(arguments) => altered::run(&arguments),
        Chore::Profile(arguments) => profile::run(&arguments),
        Chore::Readme { check } => readme::run(check),
        Chore::C => c::run().and_then(|()| c::every_method()),
        Chore::Cross => cross::run(),
        Chore::Publish => package::publish(),
        Chore::Header { check } => header::run(check),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {}", one_line(&failure.to_string()));
            ExitCode::FAILURE
        }
    }
}
