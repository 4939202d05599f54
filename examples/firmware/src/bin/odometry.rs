//! Where a pair of cameras goes: both pictures of a moment in memory, the left one's features, and the motion
//! since the last.
//!
//! 1. [`Walk`]: pictures of the built-in scene, features, and the odometry.
//! 2. What it took on the console, the motions in `odometry.bin`.

#![no_std]
#![no_main]

use heapless::Vec;
use static_cell::ConstStaticCell;
use stereopsis::motion::odometry::Step;
use stereopsis_firmware::choice::BOARD;
use stereopsis_firmware::clock::Clock;
use stereopsis_firmware::console::Console;
use stereopsis_firmware::host::{HostError, HostFile};
use stereopsis_firmware::walk::{Broken, FRAMES, HEIGHT, Odometry, WIDTH, Walk, is_right, turned};
use stereopsis_firmware::{runtime, stack};

/// All the memory that it takes besides the stack, at an address fixed by the linker.
static MEMORY: ConstStaticCell<Walk> = ConstStaticCell::new(Walk::new());

#[runtime::entry]
fn main() -> ! {
    runtime::run(&MEMORY, run)
}

/// Why there is no motion.
#[derive(defmt::Format)]
enum Failure {
    /// There is none.
    Walk(Broken),
    /// The motion is not known, or not that of the window.
    Wrong,
    /// The host did not take the results.
    Host(HostError),
}

impl From<Broken> for Failure {
    fn from(broken: Broken) -> Self {
        Self::Walk(broken)
    }
}

fn run(walk: &mut Walk) -> Result<(), Failure> {
    let clock = Clock::start();
    defmt::info!("{=usize}x{=usize} on {=str}", WIDTH, HEIGHT, BOARD.core);
    let calibration = clock.calibrate();
    walk.start()?;
    let (mut ticks, mut worst) = (0, 0);
    let mut steps = Vec::<Step<f32>, FRAMES>::new();
    for frame in 0..FRAMES {
        walk.take(frame)?;
        let start = clock.now();
        let step = walk.step()?;
        let took = clock.now() - start;
        (ticks, worst) = (ticks + took, took.max(worst));
        defmt::info!(
            "{=usize} points, {=usize} found, {=usize} agree",
            step.points,
            step.found,
            step.inliers
        );
        // There is room for all frames.
        let _ = steps.push(step);
    }
    let stack = stack::used();
    write(&steps).map_err(Failure::Host)?;
    let turned = turned(&steps).ok_or(Failure::Wrong)?;
    let mut console = Console::open();
    console.figure("calibration_ticks", calibration);
    console.figure("frames", FRAMES as u64);
    console.figure("ticks", ticks);
    console.figure("worst_frame_ticks", worst);
    console.figure("inliers", steps.last().map_or(0, |step| step.inliers) as u64);
    console.figure("turned_urad", (turned * 1e6) as u64);
    console.figure("state_bytes", size_of::<Odometry>() as u64);
    console.figure("stack_bytes", stack as u64);
    if is_right(turned) { Ok(()) } else { Err(Failure::Wrong) }
}

/// R (column by column) and t of every motion; `f32` with the low byte first.
fn write(steps: &[Step<f32>]) -> Result<(), HostError> {
    let file = HostFile::create(c"odometry.bin")?;
    let motions = steps.iter().map(|step| &step.motion);
    let mut numbers = motions.flat_map(|motion| motion.rotation().iter().chain(motion.translation().iter()));
    numbers.try_for_each(|x| file.write(&x.to_le_bytes()))
}
