//! Frames of a recording whose camera has every fault, through a pipeline that goes on: what each row is, in
//! `soak.bin`, eight bytes each, then the counters.

#![no_std]
#![no_main]

use static_cell::ConstStaticCell;
use stereopsis::matching::ConfigError;
use stereopsis_firmware::camera::recorded::{NoRecording, Recorded};
use stereopsis_firmware::choice::BOARD;
use stereopsis_firmware::clock::Clock;
use stereopsis_firmware::console::Console;
use stereopsis_firmware::host::{HostError, HostFile};
use stereopsis_firmware::soak::{HEIGHT, Soaked, Told, WIDTH, counts, frame, start};
use stereopsis_firmware::{runtime, stack};

/// All the memory that it takes besides the stack, at an address fixed by the linker.
static PIPELINE: ConstStaticCell<Soaked> = ConstStaticCell::new(Soaked::new());

#[runtime::entry]
fn main() -> ! {
    runtime::run(&PIPELINE, run)
}

/// Why there are no rows.
#[derive(defmt::Format)]
enum Failure {
    /// The pipeline cannot do what is asked.
    Config(ConfigError),
    /// There is nothing to play.
    Recording(NoRecording),
    /// The host did not take the results.
    Host(HostError),
}

fn run(pipeline: &mut Soaked) -> Result<(), Failure> {
    let clock = Clock::start();
    defmt::info!("soak on {=str}", BOARD.core);
    let calibration = clock.calibrate();
    let mut camera = Recorded::open(c"soak.lines", WIDTH as u16, HEIGHT).map_err(Failure::Recording)?;
    let file = HostFile::create(c"soak.bin").map_err(Failure::Host)?;
    start(pipeline).map_err(Failure::Config)?;
    let (mut frames, mut written) = (0, Ok(()));
    while camera.has_frame() {
        frame(pipeline, &mut camera, |told: Told| {
            if written.is_ok() {
                written = file.write(&told.bytes());
            }
        });
        frames += 1;
    }
    written.map_err(Failure::Host)?;
    for count in counts(pipeline.counters()) {
        file.write(&count.to_le_bytes()).map_err(Failure::Host)?;
    }
    let mut console = Console::open();
    console.figure("calibration_ticks", calibration);
    console.figure("frames", frames);
    console.figure("rows", pipeline.counters().rows.into());
    console.figure("rows_damaged", pipeline.counters().rows_damaged.into());
    console.figure("stack_bytes", stack::used() as u64);
    Ok(())
}
