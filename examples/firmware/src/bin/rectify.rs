//! Raw lines of two cameras of 320x240, rectified as they come: what that costs behind three lenses, and a
//! frame of depth from them in one loop over the rows.
//!
//! 1. [`RawPair`]: the remaps, a pipeline, and the cameras' geometry.
//! 2. What it took on the console, the lines and the depth in `rectify.bin`.

#![no_std]
#![no_main]

use core::convert::Infallible;
use static_cell::ConstStaticCell;
use stereopsis::camera::CameraError;
use stereopsis::geometry::rectify::RectifyError;
use stereopsis::imaging::{RectifiedPairError, RemapError};
use stereopsis::matching::{ConfigError, Row};
use stereopsis::pipeline::PipelineError;
use stereopsis_firmware::camera::scene::SceneCamera;
use stereopsis_firmware::camera::timed::Timed;
use stereopsis_firmware::choice::BOARD;
use stereopsis_firmware::clock::Clock;
use stereopsis_firmware::console::Console;
use stereopsis_firmware::host::{HostError, HostFile};
use stereopsis_firmware::raw_pair::{Broken, LINES, Lens, Lowered, RawPair, Remaps, SCENE, on_board};
use stereopsis_firmware::{runtime, stack};

/// All the memory that it takes besides the stack, at an address fixed by the linker.
static MEMORY: ConstStaticCell<RawPair> = ConstStaticCell::new(RawPair::new());

#[runtime::entry]
fn main() -> ! {
    runtime::run(&MEMORY, run)
}

/// Why there are no lines.
#[derive(defmt::Format)]
enum Failure {
    /// The numbers are no cameras.
    Numbers,
    /// They have no rectified images.
    Rectify(RectifyError),
    /// The remap does not have the room.
    Remap(RemapError),
    /// The raw lines are not those of the rig.
    Pair(RectifiedPairError<Infallible>),
    /// A line did not come.
    Lines(CameraError<RectifiedPairError<Infallible>>),
    /// The pipeline cannot do what is asked.
    Config(ConfigError),
    /// The frame broke off.
    Frame(PipelineError<RectifiedPairError<Infallible>>),
    /// The host did not take the results.
    Host(HostError),
}

impl From<Broken<HostError>> for Failure {
    fn from(broken: Broken<HostError>) -> Self {
        match broken {
            Broken::Numbers => Self::Numbers,
            Broken::Rectify(error) => Self::Rectify(error),
            Broken::Remap(error) => Self::Remap(error),
            Broken::Pair(error) => Self::Pair(error),
            Broken::Lines(error) => Self::Lines(error),
            Broken::Config(error) => Self::Config(error),
            Broken::Frame(error) => Self::Frame(error),
            Broken::Taker(error) => Self::Host(error),
        }
    }
}

fn run(pair: &mut RawPair) -> Result<(), Failure> {
    let clock = Clock::start();
    defmt::info!("{=u16}x{=u16} on {=str}", SCENE.width, SCENE.height, BOARD.core);
    let calibration = clock.calibrate();
    let file = HostFile::create(c"rectify.bin").map_err(Failure::Host)?;
    let mut console = Console::open();
    for (name, lens) in
        [("none_ticks", Lens::None), ("mild_ticks", Lens::Mild), ("strong_ticks", Lens::Strong)]
    {
        let mut camera = Timed::new(SceneCamera::new(SCENE), &clock);
        let take = |lines: [&[u8]; 4]| lines.iter().try_for_each(|line| file.write(line));
        let ticks = pair.remap(lens, &mut camera, || clock.now(), take)?;
        console.figure(name, ticks - camera.ticks());
    }
    let mut camera = Timed::new(Lowered::new(), &clock);
    let (mut shown, mut right) = (0, 0);
    let take = |row: &Row<'_>| {
        let (more_shown, more_right) = on_board(row);
        (shown, right) = (shown + more_shown, right + more_right);
        let mut bytes = row.disparities().iter().zip(row.flags());
        bytes.try_for_each(|(disparity, flags)| {
            let [low, high] = disparity.raw().to_le_bytes();
            file.write(&[low, high, flags.bits()])
        })
    };
    let ticks = pair.depth(&mut camera, || clock.now(), take)?;
    console.figure("depth_ticks", ticks - camera.ticks());
    console.figure("calibration_ticks", calibration);
    console.figure("shown", shown.into());
    console.figure("right", right.into());
    let band = 2 * LINES * usize::from(SCENE.width);
    console.figure("band_bytes", band as u64);
    console.figure("state_bytes", (size_of::<Remaps>() - band) as u64);
    console.figure("stack_bytes", stack::used() as u64);
    Ok(())
}
