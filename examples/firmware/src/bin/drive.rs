//! A robot that drives by what it sees: frames of 160x120 to rows of disparity, obstacles, a decision, and
//! values for two motors.
//!
//! 1. [`Robot`]: a pipeline, an `Obstacles` and a `DriveRule`, before cameras that drive towards a board.
//! 2. What it took on the console, each frame's decision in the log, and all of them in `drive.bin`.

#![no_std]
#![no_main]

use static_cell::ConstStaticCell;
use stereopsis::obstacles::Decision;
use stereopsis_firmware::choice::BOARD;
use stereopsis_firmware::clock::Clock;
use stereopsis_firmware::console::Console;
use stereopsis_firmware::drive::{BOARD as AHEAD, Broken, Finder, HEIGHT, Matcher, Robot, Ticks, WIDTH};
use stereopsis_firmware::host::{HostError, HostFile};
use stereopsis_firmware::{runtime, stack};

/// All the memory that it takes besides the stack, at an address fixed by the linker.
static ROBOT: ConstStaticCell<Robot> = ConstStaticCell::new(Robot::new());

#[runtime::entry]
fn main() -> ! {
    runtime::run(&ROBOT, run)
}

/// Why there is no drive.
#[derive(defmt::Format)]
enum Failure {
    /// The drive broke off.
    Broken(Broken),
    /// The host did not take the results.
    Host(HostError),
}

fn run(robot: &mut Robot) -> Result<(), Failure> {
    let clock = Clock::start();
    defmt::info!("{=usize} frames of {=usize}x{=usize} on {=str}", AHEAD.len(), WIDTH, HEIGHT, BOARD.core);
    let calibration = clock.calibrate();
    let file = HostFile::create(c"drive.bin").map_err(Failure::Host)?;
    robot.start().map_err(Failure::Broken)?;
    let (mut rule, mut ticks) = (Robot::rule(), Ticks::default());
    for board in AHEAD {
        let step = robot.frame(&mut rule, board, || clock.now(), &mut ticks).map_err(Failure::Broken)?;
        // A product writes these two into the compare registers of its timer.
        let motors = step.motors;
        match step.decision {
            Decision::Clear => defmt::info!("clear: {=i16} {=i16}", motors.left, motors.right),
            Decision::Slow(mm) => {
                defmt::info!("slow, {=u16} mm: {=i16} {=i16}", mm, motors.left, motors.right)
            }
            Decision::Stop(mm) => {
                defmt::info!("stop, {=u16} mm: {=i16} {=i16}", mm, motors.left, motors.right)
            }
            Decision::Blind(reason) => defmt::warn!("blind: {}", reason),
        }
        file.write(&step.bytes()).map_err(Failure::Host)?;
    }
    let mut console = Console::open();
    console.figure("calibration_ticks", calibration);
    console.figure("frames", AHEAD.len() as u64);
    console.figure("row_ticks", ticks.rows);
    console.figure("decision_ticks", ticks.decisions);
    console.figure("matching_ticks", ticks.matching);
    console.figure("state_bytes", size_of::<Finder>() as u64);
    console.figure("matcher_bytes", size_of::<Matcher>() as u64);
    console.figure("stack_bytes", stack::used() as u64);
    Ok(())
}
