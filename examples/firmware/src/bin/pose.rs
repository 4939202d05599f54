//! From matches with wrong ones among them to the pose of a second camera and the points that both see, timed
//! and held to the truth.
//!
//! 1. [`World::fill`]: 128 matches of a world that is known, a third of them wrong.
//! 2. [`eight_point()`] on eight right ones, for its cost alone.
//! 3. [`World::fundamental`]: F, and which matches agree with it. [`World::pose`]: the pose and the points.
//! 4. What it took on the console, what was found in `pose.bin`.

#![no_std]
#![no_main]

use nalgebra::Point3;
use static_cell::ConstStaticCell;
use stereopsis::geometry::{
    robust::RobustError,
    two_view::{Correspondence, EightPointError, Fundamental, eight_point},
};
use stereopsis_firmware::choice::BOARD;
use stereopsis_firmware::clock::Clock;
use stereopsis_firmware::console::Console;
use stereopsis_firmware::host::{HostError, HostFile};
use stereopsis_firmware::two_views::{Cameras, Errors, Found, MATCHES, Missing, World, is_right};
use stereopsis_firmware::{runtime, stack};

/// What the world begins with.
const SEED: u32 = 5;
/// How often eight points are solved: a tick of the clock is many instructions.
const ROUNDS: u64 = 100;

/// All the memory that it takes besides the stack, at an address fixed by the linker.
struct Memory {
    world: World,
    inliers: [bool; MATCHES],
    points: [Option<Point3<f32>>; MATCHES],
}

static MEMORY: ConstStaticCell<Memory> =
    ConstStaticCell::new(Memory { world: World::new(), inliers: [false; MATCHES], points: [None; MATCHES] });

#[runtime::entry]
fn main() -> ! {
    runtime::run(&MEMORY, run)
}

/// Why there is no pose.
#[derive(defmt::Format)]
enum Failure {
    /// The cameras or the points cannot be.
    World,
    /// The matches agree on nothing.
    Fundamental(RobustError),
    /// F is not that of the cameras.
    Pose,
    /// Eight right matches have no F.
    EightPoint(EightPointError),
    /// What was found is not the truth.
    Wrong,
    /// The host did not take the results.
    Host(HostError),
}

impl From<Missing> for Failure {
    fn from(missing: Missing) -> Self {
        match missing {
            Missing::World => Self::World,
            Missing::Fundamental(error) => Self::Fundamental(error),
            Missing::Pose => Self::Pose,
        }
    }
}

fn run(Memory { world, inliers, points }: &mut Memory) -> Result<(), Failure> {
    let clock = Clock::start();
    let cameras = Cameras::new()?;
    world.fill(&cameras, SEED)?;
    defmt::info!("{=usize} matches on {=str}", MATCHES, BOARD.core);
    let calibration = clock.calibrate();
    let eight_ticks = eight(world, &clock).map_err(Failure::EightPoint)?;

    let start = clock.now();
    let robust = world.fundamental(inliers)?;
    let robust_ticks = clock.now() - start;
    let found = world.pose(&cameras, robust, inliers, points)?;
    let ticks = clock.now() - start;

    let stack = stack::used();
    let errors = world.errors(&cameras, &found, inliers, points);
    write(&found, inliers, points).map_err(Failure::Host)?;
    let mut console = Console::open();
    console.figure("matches", MATCHES as u64);
    console.figure("calibration_ticks", calibration);
    console.figure("eight_point_ticks", eight_ticks);
    console.figure("eight_point_rounds", ROUNDS);
    console.figure("robust_ticks", robust_ticks);
    console.figure("ticks", ticks);
    console.figure("stack_bytes", stack as u64);
    console.figure("samples", robust.samples.into());
    console.figure("inliers", robust.inliers as u64);
    console.figure("points", found.points as u64);
    tell(&mut console, &errors);
    if errors.are_small() { Ok(()) } else { Err(Failure::Wrong) }
}

/// The errors in millionths.
fn tell(console: &mut Console, errors: &Errors) {
    console.figure("right_lost", errors.lost as u64);
    console.figure("wrong_kept", errors.kept as u64);
    console.figure("rotation_off_urad", (errors.rotation_rad * 1e6) as u64);
    console.figure("direction_off_urad", (errors.direction_rad * 1e6) as u64);
    console.figure("points_off_ppm", (errors.points * 1e6) as u64);
}

/// The ticks that [`ROUNDS`] times F of the first eight right matches take.
fn eight(world: &World, clock: &Clock) -> Result<u64, EightPointError> {
    let mut seen = [Correspondence::new(0.0, 0.0, 0.0, 0.0); 8];
    let right = world.seen.iter().enumerate().filter(|(at, _)| is_right(*at));
    for (slot, (_, &seen)) in seen.iter_mut().zip(right) {
        *slot = seen;
    }
    let start = clock.now();
    for _ in 0..ROUNDS {
        // Hidden from the compiler, which might do it once.
        core::hint::black_box(solve(core::hint::black_box(&seen))?);
    }
    Ok(clock.now() - start)
}

// Not inlined: a call of its own is what is timed.
#[inline(never)]
fn solve(seen: &[Correspondence<f32>; 8]) -> Result<Fundamental<f32>, EightPointError> {
    eight_point(seen)
}

/// What was found: F, R and t row by row (nalgebra goes column by column), `f32` with the low byte first;
/// then for every match a byte, whether it agrees, and its point, zeros when it has none.
fn write(
    found: &Found,
    inliers: &[bool; MATCHES],
    points: &[Option<Point3<f32>>; MATCHES],
) -> Result<(), HostError> {
    let file = HostFile::create(c"pose.bin")?;
    numbers(&file, found.robust.fundamental.matrix().transpose().as_slice())?;
    numbers(&file, found.recovered.pose.rotation().transpose().as_slice())?;
    numbers(&file, found.recovered.pose.direction().as_slice())?;
    for (&inlier, point) in inliers.iter().zip(points) {
        file.write(&[u8::from(inlier)])?;
        numbers(&file, point.unwrap_or(Point3::origin()).coords.as_slice())?;
    }
    Ok(())
}

fn numbers(file: &HostFile, numbers: &[f32]) -> Result<(), HostError> {
    numbers.iter().try_for_each(|x| file.write(&x.to_le_bytes()))
}
