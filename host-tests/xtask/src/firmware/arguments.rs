//! What `cargo xtask firmware` is asked for.

use super::program::Optimised;
use crate::steps::{Failure, Outcome};
use clap::Args;
use firmware_boards::{self as board, Board};
use firmware_scenes::scene::Scene;
use std::path::PathBuf;
use stereopsis::matching::Config;
use stereopsis_host::run::{MethodName, NoiseChoice, UnknownNoise};

/// The options of `firmware`.
#[derive(Args)]
pub struct Arguments {
    /// The program: depth, rows of disparity; pose, two views; bundle, their adjustment; features, corners
    /// of two pictures and their matches; focus, a lens that moves; drive, a robot among obstacles;
    /// odometry, where a pair goes; rectify, raw lines; or interrupt, lines that a timer brings
    #[arg(long, default_value = "depth", value_parser =
        ["depth", "pose", "bundle", "features", "focus", "drive", "odometry", "rectify", "interrupt"])]
    program: String,
    /// With a program other than depth: made for size, not for speed
    #[arg(long)]
    small: bool,
    /// The core: m0, m3, m4, m7, m33, m55, rv32 or rv32v
    #[arg(long, value_parser = core, required_unless_present_any = ["all", "stages", "profiles"])]
    core: Option<Board>,
    /// The left image, PNG, JPEG, PGM/PPM, TIFF, BMP or WebP; without images the cameras see the built-in
    /// scene
    #[arg(long, value_name = "FILE", requires = "right")]
    left: Option<PathBuf>,
    /// The right image, of the same size
    #[arg(long, value_name = "FILE", requires = "left")]
    right: Option<PathBuf>,
    /// How many whole disparities are searched: 16 to 256
    #[arg(long, value_name = "N", value_parser = disparities, allow_negative_numbers = true)]
    disparities: Option<u16>,
    /// The matching method
    #[arg(long, default_value = "block", value_parser = method)]
    method: MethodName,
    /// How noisy the images are: none, low, high, or auto, which measures it; the built-in scene is taken to
    /// have none
    #[arg(long, default_value = "auto", value_parser = noise)]
    noise: NoiseChoice,
    /// The rows of stages that the core makes of a frame, in the files of `stereo dump`, in place of figures
    #[arg(long)]
    dump: bool,
    /// Folder for the results; made when it is missing
    #[arg(long, value_name = "DIR", required_unless_present_any = ["all", "stages", "profiles"])]
    out: Option<PathBuf>,
    /// Every core, method and size on the built-in scene: writes the table of docs/performance.md
    #[arg(long, conflicts_with_all =
        ["program", "small", "core", "left", "right", "disparities", "method", "noise", "out"])]
    all: bool,
    /// The instructions of a frame by stage, on cores whose code differs: writes the table of
    /// docs/performance.md
    #[arg(long, conflicts_with_all =
        ["all", "program", "small", "core", "left", "right", "disparities", "method", "noise", "out"])]
    stages: bool,
    /// A program at each level of optimisation, with and without optimisation of the whole: writes the table
    /// of docs/performance.md
    #[arg(long, conflicts_with_all =
        ["all", "stages", "program", "small", "core", "left", "right", "disparities", "method", "noise",
         "out"])]
    profiles: bool,
    /// With --all, --stages or --profiles: writes nothing, fails when the table in docs/performance.md is
    /// another
    #[arg(long)]
    pub check: bool,
}

/// One frame on one core.
pub struct One {
    /// The core's board.
    pub board: Board,
    /// The two images, else the built-in scene.
    pub pair: Option<(PathBuf, PathBuf)>,
    /// Disparities that are searched.
    pub disparities: u16,
    /// The matching method.
    pub method: MethodName,
    /// The images' noise.
    pub noise: NoiseChoice,
    /// Where the results go.
    pub out: PathBuf,
}

/// A program without sizes to choose.
pub struct Plain {
    /// The core's board.
    pub board: Board,
    /// What the optimiser is asked for.
    pub optimised: Optimised,
    /// Where the results go.
    pub out: PathBuf,
}

/// What is asked for.
pub enum Asked {
    /// One frame on one core.
    Depth(One),
    /// The rows of stages of one frame on one core.
    StageRows(One),
    /// Two views on one core.
    Pose(Plain),
    /// Two views and their points adjusted, on one core.
    Bundle(Plain),
    /// Features of two pictures on one core.
    Features(Plain),
    /// A lens that moves, on one core.
    Focus(Plain),
    /// A robot among obstacles, on one core.
    Drive(Plain),
    /// Where a pair goes, on one core.
    Odometry(Plain),
    /// Raw lines rectified, on one core.
    Rectify(Plain),
    /// Lines by an interrupt, on one core.
    Interrupt(Plain),
    /// All cores.
    All,
    /// Instructions by stage.
    Stages,
    /// Levels of optimisation.
    Profiles,
}

impl Arguments {
    /// The one program that is asked for, or all.
    pub fn asked(&self) -> Outcome<Asked> {
        if self.all {
            return Ok(Asked::All);
        }
        if self.stages {
            return Ok(Asked::Stages);
        }
        if self.profiles {
            return Ok(Asked::Profiles);
        }
        if self.check {
            return Err(Failure::new("--check is for --all, --stages and --profiles"));
        }
        let (Some(board), Some(out)) = (self.core, self.out.clone()) else {
            return Err(Failure::new("--core and --out are needed, or --all"));
        };
        let pair = self.left.clone().zip(self.right.clone());
        if self.program != "depth" {
            let name = &self.program;
            if board == board::M0 {
                return Err(Failure::new(format!(
                    "--core m0: {name} needs more RAM than QEMU's microbit has"
                )));
            }
            if board.target == board::RV32.target && name == "interrupt" {
                return Err(Failure::new("--core rv32 and rv32v: interrupt needs the timer of a Cortex-M"));
            }
            if self.small && (name == "rectify" || name == "drive") {
                return Err(Failure::new(format!(
                    "--small: {name} has the dense path in it, which is made for speed"
                )));
            }
            if pair.is_some() || self.disparities.is_some() || self.dump {
                return Err(Failure::new(format!(
                    "--program {name} takes no images: --left, --right, --disparities, --dump are for depth"
                )));
            }
            let optimised = if self.small { Optimised::Size } else { Optimised::Speed };
            let plain = Plain { board, optimised, out };
            return Ok(match name.as_str() {
                "pose" => Asked::Pose(plain),
                "bundle" => Asked::Bundle(plain),
                "drive" => Asked::Drive(plain),
                "features" => Asked::Features(plain),
                "odometry" => Asked::Odometry(plain),
                "rectify" => Asked::Rectify(plain),
                "interrupt" => Asked::Interrupt(plain),
                _ => Asked::Focus(plain),
            });
        }
        if self.small {
            return Err(Failure::new(
                "--small is for the programs other than depth, which is made for speed",
            ));
        }
        let disparities = self
            .disparities
            .ok_or_else(|| Failure::new("--disparities is needed: how many whole ones are searched"))?;
        let one = One { board, pair, disparities, method: self.method, noise: self.noise, out };
        Ok(if self.dump { Asked::StageRows(one) } else { Asked::Depth(one) })
    }
}

impl One {
    /// The built-in scene in a size that suits the disparities and the core.
    pub fn scene(&self) -> Scene {
        match (self.board.core, self.disparities) {
            ("m0", _) => Scene { width: 96, height: 64 },
            (_, ..=32) => Scene { width: 160, height: 120 },
            _ => Scene { width: 320, height: 240 },
        }
    }
}

fn core(name: &str) -> Result<Board, String> {
    let found = board::ALL.into_iter().find(|board| board.core == name);
    found.ok_or_else(|| format!("the cores are {}", board::ALL.map(|board| board.core).join(", ")))
}

fn method(name: &str) -> Result<MethodName, String> {
    name.parse().map_err(|unknown| format!("{unknown}"))
}

fn noise(name: &str) -> Result<NoiseChoice, String> {
    name.parse().map_err(|unknown: UnknownNoise| unknown.to_string())
}

fn disparities(text: &str) -> Result<u16, String> {
    let (least, most) = (Config::FEWEST_DISPARITIES, Config::MOST_DISPARITIES);
    let value = text.parse().ok().filter(|value| (least..=most).contains(value));
    value.ok_or_else(|| format!("a whole number from {least} to {most} is needed"))
}
