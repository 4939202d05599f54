//! `cargo xtask focus`: how right depth from focus is on rendered stacks, beside the plain method.

use crate::firmware::tables::{Part, Readme, into_readme};
use crate::steps::{Failure, Outcome};
use clap::Args;
use image::GrayImage;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use stereopsis_host::focus::evaluation::{FocusScore, RenderedStack, stacks};
use stereopsis_host::pfm;

/// The options of `focus`.
#[derive(Args)]
pub struct Arguments {
    /// Writes the table into docs/performance.md
    #[arg(long)]
    readme: bool,
    /// Fails when the table of docs/performance.md is another, and writes nothing there
    #[arg(long, conflicts_with = "readme")]
    check: bool,
    /// Writes the rendered frames into this folder, with positions.csv and truth.pfm beside them, for
    /// `stereo focus`
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// The part of docs/performance.md.
const PART: Part = Part { name: "focus-accuracy", command: "cargo xtask focus --readme" };
/// Deviations of the sensor's noise, grey levels.
const NOISES: [u8; 3] = [0, 2, 10];

/// Measures and prints or writes.
pub fn run(arguments: &Arguments) -> Outcome {
    let mut table = String::from(
        "| stack | noise | median error | within one | answered | plain: error | within one |\n",
    );
    table += "| --- | ---: | ---: | ---: | ---: | ---: | ---: |\n";
    for stack in stacks() {
        for noise in NOISES {
            let frames = stack.frames(noise.into());
            if let Some(out) = &arguments.out {
                write(
                    &out.join(stack.name.replace([' ', ','], "-")).join(noise.to_string()),
                    &stack,
                    &frames,
                )?;
            }
            let failed = |e| Failure::new(format!("{}: {e}", stack.name));
            let FocusScore { median, within_one, answered } = stack.ours(&frames).map_err(failed)?;
            let plain = stack.plain(&frames);
            let _ = writeln!(
                table,
                "| {} | {noise} | {median:.3} | {within_one:.3} | {answered:.3} | {:.3} | {:.3} |",
                stack.name, plain.median, plain.within_one
            );
        }
    }
    println!("{table}");
    if arguments.readme || arguments.check {
        into_readme(&PART, &table, Readme::of_check(arguments.check))?;
    }
    Ok(())
}

/// Writes a stack: `frames/`, where the sensor was in each of them, and the true frame of each pixel.
fn write(out: &Path, stack: &RenderedStack, frames: &[GrayImage]) -> Outcome {
    let failed = |error: &dyn std::fmt::Display| Failure::new(format!("{}: {error}", out.display()));
    let folder = out.join("frames");
    fs::create_dir_all(&folder).map_err(|e| failed(&e))?;
    let mut positions = String::from("image_distance_mm\n");
    for (number, (frame, image_m)) in (1..).zip(frames.iter().zip(&stack.images_m)) {
        frame.save(folder.join(format!("{number:02}.png"))).map_err(|e| failed(&e))?;
        let _ = writeln!(positions, "{:.6}", f64::from(*image_m) * 1000.0);
    }
    fs::write(out.join("positions.csv"), positions).map_err(|e| failed(&e))?;
    let truth: Vec<f32> = stack.truth().iter().map(|&frame| frame as f32).collect();
    let mut bytes = Vec::new();
    pfm::write(&mut bytes, stack.scene.width, &truth).map_err(|e| failed(&e))?;
    fs::write(out.join("truth.pfm"), bytes).map_err(|e| failed(&e))
}
