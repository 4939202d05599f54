//! One frame on one core, of two image files or of the built-in scene, with its results in a folder.

use super::arguments::One;
use super::program::Program;
use super::{frame, summary};
use crate::pictures::Pictures;
use crate::setup;
use crate::steps::{Failure, Outcome};
use stereopsis::imaging::{Balance, Noise};
use stereopsis_host::output::Staging;
use stereopsis_host::run::NoiseChoice;

/// Writes the results of one frame on one core into a folder.
pub fn run(one: &One) -> Outcome {
    let (mut pictures, is_scene) = match &one.pair {
        Some((left, right)) => (Pictures::open(left, right)?, false),
        None => (Pictures::of_scene(one.scene())?, true),
    };
    let mut program = Program::new(one.board, one.method, pictures.width, pictures.height, one.disparities)?;
    if !is_scene && one.method.compares_brightness() && pictures.balance()? != Balance::NONE {
        println!("the right camera shows its image in the left one's exposure, as `stereo match` takes it");
    }
    program.noise = match one.noise {
        NoiseChoice::Auto if is_scene => Noise::None,
        choice => pictures.noise(choice)?,
    };
    Staging::probe(&one.out).map_err(|e| Failure::new(format!("--out: {e}")))?;
    setup::firmware(&[one.board.target])?;
    let built = program.build()?;
    let frame = frame::run(&built, &pictures, is_scene)?;
    for line in &frame.log {
        println!("{line}");
    }
    summary::write(&one.out, &frame)?;
    println!("{}", frame.summary());
    println!("results are in {}, equal to the host's to the bit", one.out.display());
    Ok(())
}
