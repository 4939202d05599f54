//! The options of `stereo calibrate`.

use clap::{Args, ValueEnum};
use std::path::PathBuf;
use stereopsis_host::calibrate::LensModel;
use stereopsis_host::calibrate::board::Pattern;

pub const EXAMPLE: &str = "Example:
  stereo calibrate --left 'left*.png' --right 'right*.png' --pattern 9x6 --square-mm 25 --out stereo.yml --report report

Ten to thirty pairs, in which the board is tilted and turned each time and reaches all corners of both images, are enough. \
Left and right images belong together by the last number in their names, or, where these have none, by their order.

The file is OpenCV's YAML (K1, D1, K2, D2, R, T, E, F) with lengths in metres; match, rectify and calib read it. The folder of \
--report gets index.html and a picture of each view's residuals.";

#[derive(Debug, Args)]
pub struct CalibrateArgs {
    /// The left camera's images, as files or as a pattern with * and ?
    #[arg(long, value_name = "GLOB", required = true, num_args = 1..)]
    pub left: Vec<String>,
    /// The right camera's images
    #[arg(long, value_name = "GLOB", required = true, num_args = 1..)]
    pub right: Vec<String>,
    /// The board's inner corners, where four squares meet, along and down: 3 to 64 each
    #[arg(long, value_name = "COLUMNSxROWS", value_parser = pattern)]
    pub pattern: Pattern,
    /// The side of a square of the board, millimetres
    #[arg(long, value_name = "MM", value_parser = square, allow_negative_numbers = true)]
    pub square_mm: f64,
    /// What the lenses are
    #[arg(long, value_name = "MODEL", default_value = "brown")]
    pub lens: LensChoice,
    /// The calibration file
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    /// Folder for the residuals, drawn
    #[arg(long, value_name = "DIR")]
    pub report: Option<PathBuf>,
}

/// A model of lenses.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
pub enum LensChoice {
    /// k1, k2, p1, p2, k3: most lenses
    Brown,
    /// k1, k2, p1, p2, k3, k4, k5, k6: wide lenses with a strong barrel, many views
    Rational,
    /// k1, k2, k3, k4 of the angle to the axis: lenses of more than some 100 degrees
    Fisheye,
}

impl From<LensChoice> for LensModel {
    fn from(choice: LensChoice) -> Self {
        match choice {
            LensChoice::Brown => Self::Brown,
            LensChoice::Rational => Self::Rational,
            LensChoice::Fisheye => Self::Fisheye,
        }
    }
}

fn pattern(text: &str) -> Result<Pattern, &'static str> {
    let sides = text.split_once(['x', 'X']).and_then(|(c, r)| Some((c.parse().ok()?, r.parse().ok()?)));
    let found = sides.and_then(|(columns, rows)| Pattern::new(columns, rows));
    found.ok_or("the inner corners along and down are needed, 3 to 64 each, as 9x6")
}

fn square(text: &str) -> Result<f64, &'static str> {
    let value: Option<f64> = text.parse().ok();
    match value {
        Some(mm) if (1.0..=1000.0).contains(&mm) => Ok(mm),
        Some(mm) if (0.001..1.0).contains(&mm) => {
            Err("less than a millimetre: is it in metres? 0.025 m are 25 mm")
        }
        _ => Err("a length from 1 to 1000 millimetres is needed"),
    }
}
