//! `examples/c-firmware/odometry.c`: pictures of a pair that moves, their features, and the motions, held to
//! the same in Rust.

use super::program::{Scope, beside, crc32_in, program, temporary_folder};
use crate::steps::{Failure, Outcome};
use firmware_scenes::walk::{FRAMES, HEIGHT, WIDTH, Walk, is_right, turned};
use std::fs;
use std::path::Path;
use stereopsis::motion::odometry::Step;
use stereopsis_host::run::MethodName;

/// On each core the example finds what the host finds.
pub fn run(scope: Scope) -> Outcome {
    let folder = temporary_folder()?;
    let expected = expected(folder.path())?;
    let (width, _, disparities) = super::FRAMES[0];
    for &core in scope.cores() {
        let program = program(core, MethodName::Block, width, disparities)?;
        let found = crc32_in(core, &beside(&program, "odometry"), folder.path())?;
        if found != expected {
            let line = format!("odometry, {core}: crc32 {found:08x}, the host has {expected:08x}");
            return Err(Failure::new(line));
        }
        println!("odometry, {core}: crc32 {found:08x}");
    }
    Ok(())
}

/// Writes the pictures into a folder; the checksum of what `odometry.c` sums up, by the host's odometry.
fn expected(folder: &Path) -> Outcome<u32> {
    let mut walk = Box::new(Walk::new());
    let broken = |e| Failure::new(format!("the host finds no motion: {e:?}"));
    walk.start().map_err(broken)?;
    let mut steps = Vec::new();
    for frame in 0..FRAMES {
        walk.take(frame).map_err(broken)?;
        for (camera, pixels) in ["left", "right"].into_iter().zip(walk.pictures()) {
            let name = format!("{camera}{frame}.pgm");
            let bytes = [format!("P5 {WIDTH} {HEIGHT} 255\n").as_bytes(), pixels].concat();
            fs::write(folder.join(&name), bytes).map_err(|e| Failure::new(format!("{name}: {e}")))?;
        }
        steps.push(walk.step().map_err(broken)?);
    }
    if !turned(&steps).is_some_and(is_right) {
        return Err(Failure::new("what the host finds is not the motion"));
    }
    let mut crc = crc32fast::Hasher::new();
    steps.iter().for_each(|step| sum(step, &mut crc));
    Ok(crc.finalize())
}

/// Sums a step up as C has it: matrices row by row.
fn sum(step: &Step<f32>, crc: &mut crc32fast::Hasher) {
    let (rotation, covariance) = (step.motion.rotation().transpose(), step.covariance.transpose());
    let numbers = rotation.iter().chain(step.motion.translation().iter()).chain(covariance.iter());
    numbers.chain([&step.residual]).for_each(|x| crc.update(&x.to_le_bytes()));
    let counts = [step.points, step.found, step.inliers];
    counts.iter().for_each(|count| crc.update(&(*count as u32).to_le_bytes()));
}
