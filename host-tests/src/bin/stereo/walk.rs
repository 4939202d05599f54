//! `stereo walk`: the frames of a built-in street that a pair of cameras is driven through, with true poses.

use crate::cli::whole;
use crate::failure::Failure;
use crate::files::png;
use crate::print;
use crate::progress::Progress;
use clap::Args;
use std::path::PathBuf;
use stereopsis::geometry::RectifiedRig;
use stereopsis_host::command_line::one_line;
use stereopsis_host::odometry::poses;
use stereopsis_host::odometry::sequence::numbered;
use stereopsis_host::output::Staging;
use stereopsis_host::scene::MovingScene;

/// What follows the options in the command's help.
pub const EXAMPLE: &str = "Example:
  stereo walk --out street
  stereo odometry --sequence street --calib street/calib.txt --truth street/poses.txt --out found.txt

Written into the folder: left/000000.png and so on, right/000000.png, calib.txt and poses.txt in KITTI's formats.";

/// Metres from frame to frame.
const STEP_M: f64 = 0.5;

#[derive(Debug, Args)]
pub struct WalkArgs {
    /// Folder for the sequence; made when it is missing
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// How many frames, 2 to 2000
    #[arg(long, value_name = "N", default_value_t = 12, value_parser = frames, allow_negative_numbers = true)]
    pub frames: u16,
    /// Columns of a picture, 160 to 1280; it has half as many rows
    #[arg(long, value_name = "PX", default_value_t = 320, value_parser = width, allow_negative_numbers = true)]
    pub width: u16,
    /// Deviation of the sensors' noise, grey levels, 0 to 50
    #[arg(long, value_name = "GREY", default_value_t = 2, value_parser = noise, allow_negative_numbers = true)]
    pub noise: u16,
    /// Percent of the time between frames that the shutter is open, 0 to 100: motion blurs, and takes four times as long to draw
    #[arg(long, value_name = "PERCENT", default_value_t = 0, value_parser = percent, allow_negative_numbers = true)]
    pub shutter: u16,
}

fn frames(text: &str) -> Result<u16, String> {
    whole(text, 2, 2000)
}

fn width(text: &str) -> Result<u16, String> {
    whole(text, 160, 1280)
}

fn noise(text: &str) -> Result<u16, String> {
    whole(text, 0, 50)
}

fn percent(text: &str) -> Result<u16, String> {
    whole(text, 0, 100)
}

pub fn run(args: &WalkArgs) -> Result<(), Failure> {
    let street = MovingScene::street(args.width, args.width / 2, args.frames.into(), STEP_M, 7)
        .with_noise(args.noise.into())
        .with_shutter(f64::from(args.shutter) / 100.0);
    let mut top = Staging::new(&args.out)?;
    let folders = ["left", "right"].map(|side| args.out.join(side));
    let [mut left, mut right] = [Staging::new(&folders[0])?, Staging::new(&folders[1])?];
    // Frames of an earlier run that was longer.
    let stale = folders.map(|folder| numbered(&folder));
    let progress = Progress::over_frames(street.len());
    for i in 0..street.len() {
        let (seen_left, seen_right) = street.frame(i);
        let name = format!("{i:06}.png");
        left.write(&name, |out| png(out, &seen_left))?;
        right.write(&name, |out| png(out, &seen_right))?;
        progress.one_more();
    }
    drop(progress);
    top.write("calib.txt", |out| out.write_all(calibration(&street.rig()).as_bytes()))?;
    top.write("poses.txt", |out| poses::write(out, &street.truth()))?;
    for (staging, stale) in [left, right].into_iter().zip(&stale) {
        staging.commit(&stale.iter().map(String::as_str).collect::<Vec<_>>())?;
    }
    top.commit(&[])?;
    print(&format!("{} frames are in {}\n", street.len(), one_line(&args.out.display().to_string())))
}

/// As KITTI writes it.
fn calibration(rig: &RectifiedRig) -> String {
    let (f, (cx, cy)) = (rig.focal_px(), rig.principal_point());
    let matrix = |name: &str, shift: f32| format!("{name}: {f} 0 {cx} {shift} 0 {f} {cy} 0 0 0 1 0\n");
    matrix("P0", 0.0) + &matrix("P1", -f * rig.baseline_m())
}
