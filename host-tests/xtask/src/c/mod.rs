//! The C interface: the header, every misuse under sanitizers, and `examples/c-firmware` with the host's bits
//! on a desktop and on four boards in QEMU.
//!
//! Everything is built by CMake, as a user's project is. The desktop's programs run under the address and
//! undefined-behaviour sanitizers, with a library that checks its own arithmetic and pointers.
//!
//! [`mod@program`] builds and runs the example, [`raw`] holds the one for raw pictures to the host's
//! pipeline, [`mod@odometry`] the one for motion, [`every`] links all functions, [`components`] is the same
//! library in others' build systems, [`misuse`] what must be refused.

mod components;
mod every;
mod misuse;
mod odometry;
mod program;
mod raw;

pub use program::{Core, Scope, cargo, cargo_folder, crc32s};

use crate::header;
use crate::pictures::Pictures;
use crate::setup;
use crate::steps::{Failure, Outcome};
use firmware_scenes::scene::Scene;
use program::{beside, crc32_of, program};
use stereopsis_host::run::MethodName;

/// Frames that the cores have to agree on: width, height, disparities.
const FRAMES: [(u16, u16, u16); 2] = [(160, 120, 32), (320, 240, 64)];

/// One method over windows and one along paths: the same macro makes all functions of the interface.
const ONE_OF_A_KIND: [MethodName; 2] = [MethodName::Block, MethodName::Sgm];

/// The test step: what is refused, and a sample of what is found.
pub fn run() -> Outcome {
    setup::c()?;
    header::run(true)?;
    misuse::statuses()?;
    misuse::fresh_memory()?;
    misuse::panicking_library()?;
    found(Scope::Sample)?;
    components::run()?;
    misuse::refused()
}

/// The step before a release: every method, in both sizes.
pub fn every_method() -> Outcome {
    setup::c()?;
    found(Scope::All)
}

/// Holds what the examples find to what the host's pipeline finds.
fn found(scope: Scope) -> Outcome {
    let frames = FRAMES
        .map(|(width, height, disparities)| Ok((Pictures::of_scene(Scene { width, height })?, disparities)));
    let frames: Vec<_> = frames.into_iter().collect::<Outcome<_>>()?;
    let runs: Vec<_> = frames
        .iter()
        .flat_map(|(pictures, disparities)| MethodName::ALL.map(|method| (pictures, method, *disparities)))
        .filter(|&(pictures, method, _)| pictures.width == FRAMES[0].0 || ONE_OF_A_KIND.contains(&method))
        .collect();
    for (&(pictures, method, disparities), found) in runs.iter().zip(crc32s(&runs, scope)?) {
        let expected = pictures.crc32(method, disparities)?;
        for (core, found) in found {
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
    interrupt(scope)?;
    raw::run(scope)?;
    odometry::run(scope)
}

/// Lines that an interrupt hands over give the rows of lines from files, on each core.
fn interrupt(scope: Scope) -> Outcome {
    let (width, height, disparities) = FRAMES[0];
    let pictures = Pictures::of_scene(Scene { width, height })?;
    let expected = pictures.crc32(MethodName::Block, disparities)?;
    for &core in scope.cores() {
        let program = program(core, MethodName::Block, width, disparities)?;
        let found = crc32_of(core, &beside(&program, "interrupt"), &pictures)?;
        if found != expected {
            let line =
                format!("interrupt, {core}: crc32 {found:08x}, the host's pipeline has {expected:08x}");
            return Err(Failure::new(line));
        }
        println!("interrupt, {core}: crc32 {found:08x}");
    }
    Ok(())
}
