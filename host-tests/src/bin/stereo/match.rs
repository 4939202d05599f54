//! `stereo match`: a pair, or many, into folders of results.

use crate::failure::Failure;
use crate::many;
use crate::match_args::MatchArgs;
use crate::rectified::RectifiedCameras;
use crate::results::{figures, place};
use crate::settings;
use crate::shared::{self, print};
use crate::solve::solve;
use crate::sources::Sources;
use crate::watch::Watch;
use std::fmt::Write as _;
use stereopsis_host::report::Summary;

/// What follows the options in the command's help.
pub const EXAMPLE: &str = "Example:
  stereo match --left left.png --right right.png --disparities 64 --calib calib.txt --out out/scene
  stereo match --left 'left*.png' --right 'right*.png' --disparities 64 --out out/all
  ffmpeg -i pair.mp4 -f rawvideo -pix_fmt gray - | stereo match --raw 1280x480 --side-by-side - \
                           --disparities 64 --out out/frames
  stereo match --left raw_left.png --right raw_right.png --disparities 64 --rectify --calib stereo.yml --out \
                           out/raw

Written into the folder: disparity.pfm (px, infinity where there is no answer), disparity.png (16 bit, px x \
                           256, 0 where there is none), disparity_colour.png (near is bright), flags.png (a \
                           byte a pixel: 1 outside, 2 ceiling, 4 untextured, 8 ambiguous, 16 mismatch, 32 \
                           speckle, 64 filled), confidence.png (a byte a pixel: surer is more, 0 is no \
                           answer), summary.json and report.html; with --calib also depth.pfm (metres), \
                           depth.png (16 bit, millimetres) and cloud.ply; with --rectify also \
                           rectified_left.png, rectified_right.png and rectified.json, the cameras of all \
                           the others; with --obstacles also obstacles.json and obstacles.png. The files \
                           appear together when all of them are complete. Of several pairs each has a \
                           numbered folder with these files, and frames.csv has a line for each, with \
                           --obstacles obstacles.csv too, and obstacles.png shows them over time; what is \
                           finished is not matched again.";

pub fn run(args: &MatchArgs) -> Result<(), Failure> {
    let mut notes = Vec::new();
    let sources = args.source.open(&mut notes)?;
    if !args.settings.is_empty() {
        let Sources::One(input) = &sources else {
            return Err(Failure::usage(
                "--settings: is for one pair; give one, or one setting to many pairs",
            ));
        };
        return settings::run(args, input);
    }
    for note in notes {
        shared::remark(&format!("note: {note}"));
    }
    match sources {
        Sources::Many(inputs) => {
            let count = inputs.len();
            many::run(args, inputs.into_iter().map(Ok), Some(count))
        }
        Sources::Raw(frames) => many::run(args, frames, None),
        Sources::One(input) => {
            let mut watch = args.watch.watch();
            let (summary, rectified) = solve(args, input.open()?, None, "", watch.as_mut())?;
            tell(args, &summary, rectified.as_ref(), watch.as_ref())
        }
    }
}

/// Prints the figures of one pair as the options ask for.
fn tell(
    args: &MatchArgs,
    summary: &Summary,
    rectified: Option<&RectifiedCameras>,
    watch: Option<&Watch>,
) -> Result<(), Failure> {
    if args.quiet {
        return Ok(());
    }
    if args.json {
        return print(&(serde_json::to_string_pretty(summary)? + "\n"));
    }
    let mut text = figures(summary);
    if let Some(rectified) = rectified {
        text += &rectified.figures();
    }
    if let Some(record) = watch.and_then(|watch| watch.timeline.last()) {
        let _ = writeln!(text, "obstacles    {}", record.line());
    }
    text += &place(&args.out);
    print(&text)
}
