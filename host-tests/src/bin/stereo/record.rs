//! `stereo record`: a recording from images, with faults if they are wanted.

use crate::failure::Failure;
use crate::image_files::{files, is_pattern};
use crate::place::Place;
use crate::shared::{print, rate, seed, whole};
use clap::Args;
use std::path::{Path, PathBuf};
use stereopsis_host::command_line::one_line;
use stereopsis_host::fault::{Fault, Faulty};
use stereopsis_host::recording::{Pictures, record};

/// What follows the options in the command's help.
pub const EXAMPLE: &str = "Example:
  stereo record --left left.png --right right.png --frames 10 --faults 0.01 --out field.lines

--left and --right are an image each, or folders or patterns in quotes, whose images belong together by the \
                           last number in their names, or, where these have none, by their order. \
                           With --faults each line has a fault with that probability, as cameras have them: \
                           lines that are dropped, torn, late, old or repeated, bus errors, time-outs, \
                           short frames, lost sync. A recording begins with two lines of text; the \
                           documentation of `stereopsis_host::recording` has its format, which firmware can \
                           write as well.";

#[derive(Debug, Args)]
pub struct RecordArgs {
    /// The left image, or a folder of them, or a pattern in quotes, as 'left*.png'
    #[arg(long, value_name = "FILE|DIR")]
    pub left: PathBuf,
    /// The right image, or those
    #[arg(long, value_name = "FILE|DIR")]
    pub right: PathBuf,
    /// How many frames, 1 to 60000; by default each pair once. They begin again after the last
    #[arg(long, value_name = "K", value_parser = frames, allow_negative_numbers = true)]
    pub frames: Option<u16>,
    /// Frames per second of the recorded clock
    #[arg(long, value_name = "F", default_value_t = 30.0, value_parser = rate, allow_negative_numbers = true)]
    pub fps: f64,
    /// The probability of a fault, for each line and frame
    #[arg(long, value_name = "P", default_value_t = 0.0, value_parser = probability, allow_negative_numbers =
        true)]
    pub faults: f64,
    /// Where the faults' random numbers begin
    #[arg(long, value_name = "S", default_value_t = 1, value_parser = seed, allow_negative_numbers = true)]
    pub seed: u64,
    /// The recording
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
}

fn frames(text: &str) -> Result<u16, String> {
    whole(text, 1, 60_000)
}

fn probability(text: &str) -> Result<f64, &'static str> {
    text.parse().ok().filter(|value| (0.0..=1.0).contains(value)).ok_or("a number from 0 to 1 is needed")
}

pub fn run(args: &RecordArgs) -> Result<(), Failure> {
    let pictures = if is_pattern(&args.left) || is_pattern(&args.right) {
        let named = |option, path: &Path| files(option, &[path.to_string_lossy().into_owned()]);
        let [left, right] = [named("--left", &args.left)?, named("--right", &args.right)?];
        Pictures::of([(&args.left, left), (&args.right, right)], args.fps)?
    } else {
        Pictures::open(&args.left, &args.right, args.fps)?
    };
    let place = Place::of("--out", &args.out)?;
    let frames = args.frames.map_or(pictures.frames() as u32, u32::from);
    let faults: &[Fault] = if args.faults > 0.0 { &Fault::ALL } else { &[] };
    let mut source = Faulty::new(pictures, faults, args.faults, args.seed);
    let mut recorded = None;
    let mut bad_image = None;
    let written = place.write(
        |out| {
            recorded = Some(record(&mut source, frames, out)?);
            bad_image = source.inner_mut().failed();
            // What is written is then of no use, and it is not the place that is at fault.
            if bad_image.is_some() { Err(std::io::ErrorKind::InvalidData.into()) } else { Ok(()) }
        },
        None,
    );
    if let Some(error) = bad_image {
        return Err(error.into());
    }
    written?;
    let report = recorded.unwrap_or_default();
    let name = one_line(&args.out.display().to_string());
    print(&format!(
        "{} frames, {} lines, {} errors are in {name}\n",
        report.frames, report.lines, report.faults
    ))
}
