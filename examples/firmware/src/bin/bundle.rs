//! Bundle adjustment of two views and 128 points, timed and held to the truth.
//!
//! 1. [`Adjusted`]: the world, a guess of it, and the window that is adjusted.
//! 2. What it took on the console, the second view and the points in `bundle.bin`.

#![no_std]
#![no_main]

use static_cell::ConstStaticCell;
use stereopsis::geometry::camera::{PoseError, ProjectionError};
use stereopsis::motion::bundle::{BundleError, WindowError};
use stereopsis_firmware::choice::BOARD;
use stereopsis_firmware::clock::Clock;
use stereopsis_firmware::console::Console;
use stereopsis_firmware::host::{HostError, HostFile};
use stereopsis_firmware::two_views::MATCHES;
use stereopsis_firmware::window::{Adjusted, Broken, TwoViews};
use stereopsis_firmware::{runtime, stack};

/// All the memory that it takes besides the stack, at an address fixed by the linker.
static MEMORY: ConstStaticCell<Adjusted> = ConstStaticCell::new(Adjusted::new());

#[runtime::entry]
fn main() -> ! {
    runtime::run(&MEMORY, run)
}

/// Why nothing was adjusted.
#[derive(defmt::Format)]
enum Failure {
    /// The cameras or the points cannot be.
    World,
    /// The guess is no pose.
    Guess(PoseError),
    /// A point is not seen.
    NotSeen(ProjectionError),
    /// The window is too small.
    Window(WindowError),
    /// The window is no problem.
    Bundle(BundleError),
    /// What was found is not the truth.
    Wrong,
    /// The host did not take the results.
    Host(HostError),
}

impl From<Broken> for Failure {
    fn from(broken: Broken) -> Self {
        match broken {
            Broken::World(_) => Self::World,
            Broken::Guess(error) => Self::Guess(error),
            Broken::NotSeen(error) => Self::NotSeen(error),
            Broken::Window(error) => Self::Window(error),
            Broken::Bundle(error) => Self::Bundle(error),
        }
    }
}

fn run(memory: &mut Adjusted) -> Result<(), Failure> {
    let clock = Clock::start();
    defmt::info!("{=usize} points on {=str}", MATCHES, BOARD.core);
    let calibration = clock.calibrate();
    let (outcome, ticks) = memory.run(|| clock.now())?;
    let stack = stack::used();
    write(&memory.window).map_err(Failure::Host)?;
    let mut console = Console::open();
    console.figure("calibration_ticks", calibration);
    console.figure("ticks", ticks);
    console.figure("iterations", outcome.report.iterations.into());
    console.figure("state_bytes", size_of::<TwoViews>() as u64);
    console.figure("stack_bytes", stack as u64);
    console.figure("initial_cost_millis", (outcome.report.initial_cost * 1e3) as u64);
    console.figure("cost_millis", (outcome.report.cost * 1e3) as u64);
    console.figure("centre_off_ppm", (outcome.centre_off * 1e6) as u64);
    console.figure("turned_off_urad", (outcome.turned_off * 1e6) as u64);
    if outcome.is_good() { Ok(()) } else { Err(Failure::Wrong) }
}

/// R (column by column) and t of the second view, then the points; `f32` with the low byte first.
fn write(window: &TwoViews) -> Result<(), HostError> {
    let file = HostFile::create(c"bundle.bin")?;
    for view in window.views().iter().skip(1) {
        numbers(&file, view.pose.rotation().as_slice())?;
        numbers(&file, view.pose.translation().as_slice())?;
    }
    window.points().iter().try_for_each(|point| numbers(&file, point.coords.as_slice()))
}

fn numbers(file: &HostFile, numbers: &[f32]) -> Result<(), HostError> {
    numbers.iter().try_for_each(|x| file.write(&x.to_le_bytes()))
}
