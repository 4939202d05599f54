//! The C interface: the header, every misuse under sanitizers, and `examples/c-firmware` with the host's bits
//! on a desktop and on two boards in QEMU.
//!
//! Everything is built by CMake, as a user's project is. The desktop's programs run under the address and
//! undefined-behaviour sanitizers, with a library that checks its own arithmetic and pointers.
//!
//! [`program`] builds and runs the example, [`raw`] holds the one for raw pictures to the host's pipeline,
//! [`misuse`] is what must be refused.

mod misuse;
mod program;
mod raw;

pub use program::{CORES, cargo, crc32s};

use crate::header;
use crate::pictures::Pictures;
use crate::steps::{Failure, Outcome};
use firmware_scenes::scene::Scene;
use stereopsis_host::run::MethodName;

/// Frames that the cores have to agree on: width, height, disparities.
const FRAMES: [(u16, u16, u16); 2] = [(160, 120, 32), (320, 240, 64)];

/// One method over windows and one along paths: the same macro makes all functions of the interface.
const IN_THE_LARGER: [MethodName; 2] = [MethodName::Block, MethodName::Sgm];

/// The test step.
pub fn run() -> Outcome {
    header::run(true)?;
    misuse::statuses()?;
    misuse::panicking_library()?;
    let frames = FRAMES
        .map(|(width, height, disparities)| Ok((Pictures::of_scene(Scene { width, height })?, disparities)));
    let frames: Vec<_> = frames.into_iter().collect::<Outcome<_>>()?;
    let runs: Vec<_> = frames
        .iter()
        .flat_map(|(pictures, disparities)| MethodName::ALL.map(|method| (pictures, method, *disparities)))
        .filter(|&(pictures, method, _)| pictures.width == FRAMES[0].0 || IN_THE_LARGER.contains(&method))
        .collect();
    for (&(pictures, method, disparities), found) in runs.iter().zip(crc32s(&runs)?) {
        let expected = pictures.crc32(method, disparities)?;
        for (core, found) in CORES.iter().zip(found) {
            let what = format!(
                "{method}, {}x{}, {disparities} disparities, {core}",
                pictures.width, pictures.height
            );
            if found != expected {
                let line = format!("{what}: crc32 {found:08x}, the host's pipeline has {expected:08x}");
                return Err(Failure::new(line));
            }
            println!("{what}: crc32 {found:08x}");
        }
    }
    raw::run()?;
    misuse::refused()
}
