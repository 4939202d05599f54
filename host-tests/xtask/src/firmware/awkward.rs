//! Lines that fill no vector, and disparities that fill no group of lanes, on the cores whose assembly no
//! test of the host runs: equal to the host's to the bit, as all frames are; and frames of any size with any
//! checks and penalties, of all methods.

use super::frame;
use super::program::{Optimised, Program};
use super::results::Ran;
use crate::pictures::Pictures;
use crate::steps::{Failure, Outcome};
use firmware_boards::{M3, M55, RV32, RV32V};
use firmware_scenes::any_frames::AnyFrames;
use stereopsis_host::run::MethodName;

/// Pixels in a line at most, and disparities: of 32 and of 64 lanes, and of a number that there is no
/// assembly for.
const PROGRAMS: [(u16, u16); 3] = [(67, 29), (161, 53), (97, 47)];
/// Disparities of a column that takes eight registers of a RISC-V core, and of one that is too long for them:
/// along paths that is worked on in words, which take more stack than a frame may here.
const LONG: [(u16, u16); 2] = [(161, 93), (261, 201)];
/// Pixels in a line less than the most.
const NARROWER: [u16; 4] = [0, 1, 37, 50];
/// Lines: the window never is whole, and a few more.
const HEIGHTS: [u16; 2] = [5, 21];

/// Each method, program and size.
pub fn check() -> Outcome {
    // Code in words for up to 32 disparities is linked where there is room for no more: not in the frames of
    // any size, which are searched with that for any number.
    let programs = [
        (M55, MethodName::Fast, &PROGRAMS[..]),
        (M55, MethodName::Block, &PROGRAMS[..]),
        (M3, MethodName::Sgm, &PROGRAMS[..1]),
        (RV32, MethodName::Sgm, &PROGRAMS[..1]),
        (RV32V, MethodName::Sgm, &PROGRAMS[..]),
        (RV32V, MethodName::Sgm, &LONG[..1]),
        (RV32V, MethodName::Block, &LONG[..]),
    ];
    for (board, method, programs) in programs {
        for &(most, disparities) in programs {
            let built = Program::new(board, method, most, HEIGHTS[1], disparities)?.build()?;
            for (less, height) in NARROWER.into_iter().flat_map(|less| HEIGHTS.map(|height| (less, height))) {
                frame::run(&built, &Pictures::drawn(most - less, height, pixel), false)?;
            }
            println!(
                "{}: {} awkward sizes are equal to the host's",
                built.program,
                NARROWER.len() * HEIGHTS.len()
            );
        }
    }
    any_frames()
}

/// What the boards find in any frames beside what the host finds.
fn any_frames() -> Outcome {
    let mut host = Vec::new();
    let put = |sum: u32| host.extend_from_slice(&sum.to_le_bytes());
    let mut frames = Box::new(AnyFrames::new());
    frames.run(put).map_err(|e| Failure::new(format!("any frames on the host: {e:?}")))?;
    for board in [M55, RV32, RV32V] {
        let ran = Ran::of(board, "any_frames", Optimised::Speed, &host)?;
        println!(
            "any_frames: {} frames on {} are equal to the host's",
            ran.figure("frames")?,
            ran.taken.core
        );
    }
    Ok(())
}

/// Noise in grains, nearer in the middle of every few columns, with some of its own in each camera.
fn pixel(u: u32, v: u32, right: bool) -> u8 {
    let mix = |n: u32| {
        let n = (n ^ (n >> 15)).wrapping_mul(0x2C1B_3C6D);
        n ^ (n >> 13)
    };
    let disparity = if u / 24 % 3 == 1 { 21 } else { 4 + v / 5 };
    let seen = u + if right { disparity } else { 0 };
    let texture = mix((seen / 2).wrapping_mul(0x9E37_79B1) ^ (v / 2).wrapping_mul(0x85EB_CA77)) & 0xff;
    let noise = mix(u.wrapping_mul(0xC2B2_AE3D) ^ v.wrapping_mul(0x27D4_EB2F) ^ u32::from(right)) % 5;
    (texture * 3 / 4 + noise) as u8
}
