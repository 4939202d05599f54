//! What `cargo xtask firmware` is asked for.

use super::board::{self, Board};
use super::scene::Scene;
use crate::steps::{Failure, Outcome};
use clap::Args;
use std::path::PathBuf;
use stereopsis::matching::Config;
use stereopsis_host::run::{Method, NoiseChoice, UnknownNoise};

/// The options of `firmware`.
#[derive(Args)]
pub struct Arguments {
    /// The core: m0, m3, m4, m7, m33, m55 or rv32
    #[arg(long, value_parser = core, required_unless_present = "all")]
    core: Option<Board>,
    /// The left image, PNG, JPEG, PGM/PPM or TIFF; without images the cameras see the built-in scene
    #[arg(long, value_name = "FILE", requires = "right")]
    left: Option<PathBuf>,
    /// The right image, of the same size
    #[arg(long, value_name = "FILE", requires = "left")]
    right: Option<PathBuf>,
    /// How many whole disparities are searched: 16 to 256
    #[arg(long, value_name = "N", value_parser = disparities, required_unless_present = "all")]
    #[arg(allow_negative_numbers = true)]
    disparities: Option<u16>,
    /// The matching method
    #[arg(long, default_value = "block", value_parser = method)]
    method: Method,
    /// How noisy the images are: none, low, high, or auto, which measures it; the built-in scene is taken to have none
    #[arg(long, default_value = "auto", value_parser = noise)]
    noise: NoiseChoice,
    /// Folder for the results; made when it is missing
    #[arg(long, value_name = "DIR", required_unless_present = "all")]
    out: Option<PathBuf>,
    /// Every core, method and size on the built-in scene: writes the table of README.md
    #[arg(long, conflicts_with_all = ["core", "left", "right", "disparities", "method", "noise", "out"])]
    all: bool,
    /// With --all: writes nothing, fails when README.md's table is another
    #[arg(long, requires = "all")]
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
    pub method: Method,
    /// The images' noise.
    pub noise: NoiseChoice,
    /// Where the results go.
    pub out: PathBuf,
}

impl Arguments {
    /// The one frame that is asked for; `None` for all cores.
    pub fn one(&self) -> Outcome<Option<One>> {
        if self.all {
            return Ok(None);
        }
        let (Some(board), Some(disparities), Some(out)) = (self.core, self.disparities, self.out.clone()) else {
            return Err(Failure::new("--core, --disparities and --out are needed, or --all"));
        };
        let pair = self.left.clone().zip(self.right.clone());
        Ok(Some(One { board, pair, disparities, method: self.method, noise: self.noise, out }))
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

fn method(name: &str) -> Result<Method, String> {
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
