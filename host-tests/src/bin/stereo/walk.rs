//! `stereo walk`: the frames of a built-in street that a pair of cameras is driven through, with true poses.

use crate::failure::Failure;
use crate::place::{json, png};
use crate::progress::Progress;
use crate::shared::{print, whole};
use clap::{Args, ValueEnum};
use serde::Serialize;
use std::path::PathBuf;
use stereopsis::geometry::camera::RectifiedRig;
use stereopsis_host::command_line::one_line;
use stereopsis_host::odometry::poses;
use stereopsis_host::odometry::sequence::numbered;
use stereopsis_host::output::Staging;
use stereopsis_host::scene::MovingScene;

/// What follows the options in the command's help.
pub const EXAMPLE: &str = "Example:
  stereo walk --out street
  stereo odometry --sequence street --calib street/calib.txt --truth street/poses.txt --out found.txt

Written into the folder: left/000000.png and so on, right/000000.png, calib.txt and poses.txt in KITTI's \
                           formats, and walk.json, what was asked for: a folder with frames and without \
                           it is left alone.";

/// What tells a sequence that this command wrote from others.
const MARK: &str = "walk.json";

/// What was asked for. Names are a contract with programs that read them.
#[derive(Serialize)]
struct Asked {
    scene: String,
    frames: u16,
    width: u16,
    noise: u16,
    shutter: u16,
    exposure: u16,
}

/// What is driven through.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
pub enum WalkScene {
    /// Boxes and walls on both sides, 0.5 m from frame to frame
    Street,
    /// Bends, cars and lorries that move by themselves, 1.2 m from frame to frame
    Road,
    /// A room; the cameras stand still
    Still,
    /// The room; the cameras turn on the spot
    Turn,
    /// One wall, 12 cm from frame to frame
    Wall,
    /// All is 3 km away
    Far,
}

#[derive(Debug, Args)]
pub struct WalkArgs {
    /// Folder for the sequence; made when it is missing
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// What is driven through
    #[arg(long, value_name = "SCENE", default_value = "street")]
    pub scene: WalkScene,
    /// Metres from frame to frame on a street or road, 0.1 to 2
    #[arg(long, value_name = "M", value_parser = step, allow_negative_numbers = true)]
    pub step: Option<f64>,
    /// How many frames, 2 to 2000
    #[arg(long, value_name = "N", default_value_t = 12, value_parser = frames, allow_negative_numbers = true)]
    pub frames: u16,
    /// Columns of a picture, 160 to 1280; it has half as many rows, on a road three tenths, in a room two
    /// thirds
    #[arg(long, value_name = "PX", default_value_t = 320, value_parser = width, allow_negative_numbers =
        true)]
    pub width: u16,
    /// Deviation of the sensors' noise, grey levels, 0 to 50
    #[arg(long, value_name = "GREY", default_value_t = 2, value_parser = noise, allow_negative_numbers =
        true)]
    pub noise: u16,
    /// Percent of the time between frames that the shutter is open, 0 to 100: motion blurs, and takes four
    /// times as long to draw
    #[arg(long, value_name = "PERCENT", default_value_t = 0, value_parser = percent, allow_negative_numbers =
        true)]
    pub shutter: u16,
    /// Percent by which the pictures' brightness changes from frame to frame and back, 0 to 80
    #[arg(long, value_name = "PERCENT", default_value_t = 0, value_parser = exposure,
        allow_negative_numbers = true)]
    pub exposure: u16,
}

fn step(text: &str) -> Result<f64, &'static str> {
    let value = text.parse().ok().filter(|value| (0.1..=2.0).contains(value));
    value.ok_or("a number from 0.1 to 2 is needed")
}

fn exposure(text: &str) -> Result<u16, String> {
    whole(text, 0, 80)
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
    let (width, frames) = (args.width, args.frames.into());
    let street = match args.scene {
        WalkScene::Street => MovingScene::street(width, width / 2, frames, args.step.unwrap_or(0.5), 7),
        WalkScene::Road => MovingScene::road(width, frames, args.step.unwrap_or(1.2), 3),
        WalkScene::Still => MovingScene::still(width, frames),
        WalkScene::Turn => MovingScene::turning(width, frames),
        WalkScene::Wall => MovingScene::along_wall(width, frames),
        WalkScene::Far => MovingScene::far(width, frames),
    };
    // Down and up again in ten frames or so.
    let gain = |i: u32| 1.0 - f64::from(args.exposure) / 100.0 * (0.5 - 0.5 * (f64::from(i) * 0.6).cos());
    let street = street
        .with_noise(args.noise.into())
        .with_shutter(f64::from(args.shutter) / 100.0)
        .with_gains((0..args.frames.into()).map(gain).collect());
    let mut top = Staging::new(&args.out)?;
    let folders = ["left", "right"].map(|side| args.out.join(side));
    let [mut left, mut right] = [Staging::new(&folders[0])?, Staging::new(&folders[1])?];
    // Frames of an earlier run that was longer.
    let stale = folders.map(|folder| numbered(&folder));
    if stale.iter().any(|names| !names.is_empty()) && !args.out.join(MARK).is_file() {
        let out = args.out.display();
        return Err(Failure::new(format!("{out}: has frames that walk did not write; name another folder")));
    }
    let progress = Progress::over_frames(street.len());
    for i in 0..street.len() {
        let (seen_left, seen_right) = street.frame(i);
        let name = format!("{i:06}.png");
        left.write(&name, |out| png(out, &seen_left))?;
        right.write(&name, |out| png(out, &seen_right))?;
        progress.one_more();
    }
    drop(progress);
    let asked = Asked {
        scene: args.scene.to_possible_value().map_or_else(String::new, |scene| scene.get_name().to_owned()),
        frames: args.frames,
        width,
        noise: args.noise,
        shutter: args.shutter,
        exposure: args.exposure,
    };
    top.write(MARK, |out| json(out, &asked))?;
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
