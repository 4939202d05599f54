//! Frames of any size with any checks and penalties: the checksums of all methods' answers, in
//! `any_frames.bin`, four bytes each, the low one first.

#![no_std]
#![no_main]

use static_cell::ConstStaticCell;
use stereopsis::matching::{ConfigError, MatchError};
use stereopsis_firmware::any_frames::{AnyFrames, Broken};
use stereopsis_firmware::choice::BOARD;
use stereopsis_firmware::clock::Clock;
use stereopsis_firmware::console::Console;
use stereopsis_firmware::host::{HostError, HostFile};
use stereopsis_firmware::{runtime, stack};

/// All the memory that it takes besides the stack, at an address fixed by the linker.
static FRAMES: ConstStaticCell<AnyFrames> = ConstStaticCell::new(AnyFrames::new());

#[runtime::entry]
fn main() -> ! {
    runtime::run(&FRAMES, run)
}

/// Why there are no checksums.
#[derive(defmt::Format)]
enum Failure {
    /// A matcher cannot do what is asked.
    Config(ConfigError),
    /// A line was not due.
    Line(MatchError),
    /// The host did not take the results.
    Host(HostError),
}

fn run(frames: &mut AnyFrames) -> Result<(), Failure> {
    let clock = Clock::start();
    defmt::info!("any frames on {=str}", BOARD.core);
    let calibration = clock.calibrate();
    let file = HostFile::create(c"any_frames.bin").map_err(Failure::Host)?;
    let (mut count, mut written) = (0, Ok(()));
    let put = |sum: u32| {
        count += 1;
        if written.is_ok() {
            written = file.write(&sum.to_le_bytes());
        }
    };
    frames.run(put).map_err(|broken| match broken {
        Broken::Config(error) => Failure::Config(error),
        Broken::Line(error) => Failure::Line(error),
    })?;
    written.map_err(Failure::Host)?;
    let mut console = Console::open();
    console.figure("calibration_ticks", calibration);
    console.figure("frames", count);
    console.figure("stack_bytes", stack::used() as u64);
    Ok(())
}
