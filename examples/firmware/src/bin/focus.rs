//! Depth from focus by one camera whose lens moves: nine frames of 160x120 to the one in which each tile is
//! sharpest.
//!
//! 1. [`Sweep`]: a slope that is in focus in one frame at the left and in another at the right, and its
//!    `FocusMap`.
//! 2. What it took on the console, what was found in `focus.bin`.

#![no_std]
#![no_main]

use static_cell::ConstStaticCell;
use stereopsis::focus::{FocusConfigError, FocusLineError};
use stereopsis_firmware::choice::BOARD;
use stereopsis_firmware::clock::Clock;
use stereopsis_firmware::console::Console;
use stereopsis_firmware::host::{HostError, HostFile};
use stereopsis_firmware::sweep::{Broken, CONFIG, FRAMES, HEIGHT, Map, Sweep, WIDTH};
use stereopsis_firmware::{runtime, stack};

/// All the memory that it takes besides the stack, at an address fixed by the linker.
static SWEEP: ConstStaticCell<Sweep> = ConstStaticCell::new(Sweep::new());

#[runtime::entry]
fn main() -> ! {
    runtime::run(&SWEEP, run)
}

/// Why there is no focus.
#[derive(defmt::Format)]
enum Failure {
    /// The map cannot do what is asked.
    Config(FocusConfigError),
    /// A line is not what is due.
    Line(FocusLineError),
    /// The host did not take the results.
    Host(HostError),
}

impl From<Broken> for Failure {
    fn from(broken: Broken) -> Self {
        match broken {
            Broken::Config(error) => Self::Config(error),
            Broken::Line(error) => Self::Line(error),
        }
    }
}

fn run(sweep: &mut Sweep) -> Result<(), Failure> {
    let clock = Clock::start();
    defmt::info!("{=u32} frames of {=usize}x{=usize} on {=str}", FRAMES, WIDTH, HEIGHT, BOARD.core);
    let calibration = clock.calibrate();
    let ticks = sweep.run(|| clock.now())?;
    let stack = stack::used();
    let in_focus = write(&sweep.map).map_err(Failure::Host)?;
    let mut console = Console::open();
    console.figure("calibration_ticks", calibration);
    console.figure("pixels", (WIDTH * HEIGHT) as u64 * u64::from(FRAMES));
    console.figure("ticks", ticks);
    console.figure("state_bytes", size_of::<Map>() as u64);
    console.figure("tiles", CONFIG.cells() as u64);
    console.figure("in_focus", in_focus);
    console.figure("stack_bytes", stack as u64);
    Ok(())
}

/// What was found, the low byte first: for every tile, row by row, the frame and its deviation in 1/256 in
/// four bytes each, and the confidence in one; all ones where none is sharpest. How many are in focus.
fn write(map: &Map) -> Result<u64, HostError> {
    let file = HostFile::create(c"focus.bin")?;
    let mut in_focus = 0;
    for row in 0..CONFIG.rows() {
        for column in 0..CONFIG.columns() {
            let Ok(peak) = map.peak(column, row) else {
                file.write(&[0xff; 9])?;
                continue;
            };
            in_focus += 1;
            file.write(&peak.position_q8.to_le_bytes())?;
            file.write(&peak.sigma_q8.to_le_bytes())?;
            file.write(&[peak.confidence])?;
        }
    }
    Ok(in_focus)
}
