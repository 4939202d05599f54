//! The eight-point algorithm alone: what it takes on eight correspondences, in instructions and in flash.
//!
//! That there are eight is known when it is compiled: for any number the normal equations come on top. Its
//! flash is the difference to the same program without it, which the feature `bare` makes.

#![no_std]
#![no_main]

use core::hint::black_box;
use stereopsis::geometry::two_view::Correspondence;
use stereopsis_firmware::clock::Clock;
use stereopsis_firmware::console::Console;
use stereopsis_firmware::{log, runtime, stack};

/// How often they are solved: a tick of the clock is many instructions.
const ROUNDS: u64 = 100;
/// Points of a scene with depth, seen by two cameras: u, v, u', v', px.
const SEEN: [[f32; 4]; 8] = [
    [100.3, 50.2, 80.9, 52.1],
    [520.4, 60.1, 490.7, 66.8],
    [330.1, 240.9, 318.2, 241.5],
    [90.7, 400.2, 60.1, 395.5],
    [560.2, 420.8, 541.9, 431.0],
    [210.5, 130.3, 170.2, 128.7],
    [450.9, 310.6, 440.0, 316.1],
    [280.3, 350.7, 241.6, 349.0],
];

#[runtime::entry]
fn main() -> ! {
    stack::paint();
    log::start();
    let clock = Clock::start();
    let calibration = clock.calibrate();
    let seen = black_box(SEEN).map(|[u, v, u2, v2]| Correspondence::new(u, v, u2, v2));
    let mut solved = 0;
    let start = clock.now();
    for _ in 0..ROUNDS {
        // Hidden from the compiler, which might do it once; the number of them too, which it might make a
        // constant.
        solved += u64::from(solve(black_box(&seen)));
    }
    let ticks = clock.now() - start;
    let mut console = Console::open();
    console.figure("calibration_ticks", calibration);
    console.figure("ticks", ticks);
    console.figure("rounds", ROUNDS);
    console.figure("solved", solved);
    console.figure("stack_bytes", stack::used() as u64);
    runtime::end(solved == ROUNDS)
}

/// F of the correspondences: whether there is one.
#[inline(never)]
fn solve(seen: &[Correspondence<f32>; 8]) -> bool {
    #[cfg(not(feature = "bare"))]
    return stereopsis::geometry::two_view::eight_point(seen).map(black_box).is_ok();
    // The smallest use of them.
    #[cfg(feature = "bare")]
    return seen.len() == 8;
}
