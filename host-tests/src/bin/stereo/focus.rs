//! `stereo focus`: depth from a stack of frames with the lens in different positions.

use crate::cli::FocusArgs;
use crate::failure::Failure;
use crate::files::png;
use crate::print;
use std::fmt::Write;
use stereopsis::focus::{Breathing, FocusConfig, FocusScale, ThinLens};
use stereopsis_host::command_line::one_line;
use stereopsis_host::focus::breathing::Agreement;
use stereopsis_host::focus::positions::read_positions;
use stereopsis_host::focus::run::run as map;
use stereopsis_host::focus::stack::Stack;
use stereopsis_host::output::Staging;
use stereopsis_host::pfm;

/// What is written only with lens data. A run without them takes the file of an earlier run away.
const WITH_DEPTH: [&str; 1] = ["depth.pfm"];

pub fn run(args: &FocusArgs) -> Result<(), Failure> {
    let stack = Stack::open(&args.frames)?;
    let positions = positions(args, stack.len())?;
    let scale = match (&positions, &args.positions) {
        (Some((lens, images)), Some(path)) => {
            let named = |error| Failure::new(format!("{}: {error}", path.display()));
            Some(FocusScale::new(*lens, images).map_err(named)?)
        }
        _ => None,
    };
    Staging::probe(&args.out)?;
    let (width, height) = stack.size();
    // Images have at most 4096 columns and rows.
    let config = FocusConfig::pixels(width as u16, height as u16);
    let is_breathing = match &scale {
        Some(scale) => breathes(&stack, scale)?,
        None => false,
    };
    let breathing = |frame| match &scale {
        Some(scale) if is_breathing => scale.breathing(frame),
        _ => Ok(Breathing::NONE),
    };
    let result = map(&config, (0..stack.len()).map(|index| stack.frame(index)), breathing)?;

    let mut staging = Staging::new(&args.out)?;
    staging.write("index.pfm", |out| pfm::write(out, result.width, &result.index()))?;
    staging.write("confidence.pfm", |out| pfm::write(out, result.width, &result.confidence()))?;
    staging.write("all_in_focus.png", |out| png(out, &result.picture))?;
    if let Some(scale) = &scale {
        staging.write(WITH_DEPTH[0], |out| pfm::write(out, result.width, &result.depth_m(scale)))?;
    }
    staging.commit(&WITH_DEPTH)?;

    let share = 100.0 * result.answers() as f64 / result.peaks.len().max(1) as f64;
    let mut text =
        format!("{} frames of {width} x {height} pixels, {share:.1} % in focus in one of them\n", stack.len());
    if scale.is_some() {
        let grow = if is_breathing {
            "grow as the lens says: corrected"
        } else {
            "do not grow as the lens says: left as they are"
        };
        let _ = writeln!(text, "the frames {grow}");
    }
    let _ = writeln!(text, "results are in {}", one_line(&args.out.display().to_string()));
    print(&text)
}

/// The lens and its distances from the sensor, m, if both are told of.
fn positions(args: &FocusArgs, frames: usize) -> Result<Option<(ThinLens<f32>, Vec<f32>)>, Failure> {
    let (Some(focal_mm), Some(path)) = (args.focal_length_mm, &args.positions) else { return Ok(None) };
    let named = |error| Failure::new(format!("--focal-length-mm {focal_mm}: {error}"));
    let lens = ThinLens::new(focal_mm / 1000.0).map_err(named)?;
    let single = ThinLens::new((focal_mm / 1000.0) as f32).map_err(named)?;
    Ok(Some((single, read_positions(path, lens, frames)?)))
}

/// Whether frames agree better with each other at the sizes that the lens gives them.
fn breathes(stack: &Stack, scale: &FocusScale<'_>) -> Result<bool, Failure> {
    let mut agreement = Agreement::default();
    let mut before = stack.frame(0)?;
    for index in 1..stack.len() {
        let after = stack.frame(index)?;
        if let Some(ratio) = scale.growth(index) {
            agreement.add(&before.grey, &after.grey, ratio);
        }
        before = after;
    }
    Ok(agreement.is_breathing())
}
