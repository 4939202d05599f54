//! `stereo features`: points of one image found in another.

use crate::failure::Failure;
use crate::input::RAW;
use crate::place::Place;
use crate::shared::{PairArgs, print, remark, whole};
use clap::{Args, ValueEnum};
use image::{GrayImage, RgbImage};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use stereopsis::camera::LineSource;
use stereopsis::features::{MatchConfig, Orientation};
use stereopsis::imaging::GreyLines;
use stereopsis_host::command_line::one_line;
use stereopsis_host::correspond::{Correspondences, Plan, correspond};
use stereopsis_host::correspond_refine::refine;
use stereopsis_host::matches_picture::matches_picture;
use stereopsis_host::mock::MockCamera;

/// What follows the options in the command's help.
pub const EXAMPLE: &str = "Example:
  stereo features --left first.png --right second.png --out matches.csv --picture matches.png

Written is a line x1,y1,x2,y2 for every match, under that header: column and row in the left image, column \
                           and row in the right one, in px. The images need not be rectified or of one size.";

#[derive(Debug, Args)]
pub struct FeaturesArgs {
    #[command(flatten)]
    pub pair: PairArgs,
    /// File for the matches
    #[arg(long, value_name = "FILE.csv")]
    pub out: PathBuf,
    /// File for a picture of the matches over the images
    #[arg(long, value_name = "FILE.png")]
    pub picture: Option<PathBuf>,
    /// About how many corners are kept of each image, 50 to 12000, spread over it
    #[arg(long, value_name = "N", default_value_t = 4000, value_parser = corners, allow_negative_numbers =
        true)]
    pub corners: u16,
    /// Grey levels by which a corner differs from its surroundings, 1 to 254
    #[arg(long, value_name = "G", default_value_t = 8, value_parser = contrast, allow_negative_numbers =
        true)]
    pub contrast: u16,
    /// How many sizes of the images are searched, 1 to 8, each three quarters of the one before
    #[arg(long, value_name = "L", default_value_t = 4, value_parser = levels, allow_negative_numbers = true)]
    pub levels: u16,
    /// A match differs in fewer bits than so many percent of the second best, 1 to 100
    #[arg(long, value_name = "PERCENT", default_value_t = 80, value_parser = percent,
        allow_negative_numbers = true)]
    pub ratio: u16,
    /// How many columns partners may lie apart, px; anywhere by default
    #[arg(long, value_name = "PX", value_parser = apart, allow_negative_numbers = true)]
    pub columns_apart: Option<u16>,
    /// How many rows partners may lie apart, px; anywhere by default
    #[arg(long, value_name = "PX", value_parser = apart, allow_negative_numbers = true)]
    pub rows_apart: Option<u16>,
    /// upright, turned (the images may be turned against each other by any angle), or auto, which tries
    /// turned when few corners match upright
    #[arg(long, value_name = "WAY", default_value = "auto")]
    pub orientation: OrientationChoice,
    /// Leaves matches where the corners were found; by default the right one is moved to where the pixels
    /// around the left one fit best
    #[arg(long)]
    pub as_found: bool,
}

/// How corners are described.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
pub enum OrientationChoice {
    Auto,
    Upright,
    Turned,
}

fn corners(text: &str) -> Result<u16, String> {
    whole(text, Plan::FEWEST, Plan::MOST)
}

fn contrast(text: &str) -> Result<u16, String> {
    whole(text, 1, 254)
}

fn levels(text: &str) -> Result<u16, String> {
    whole(text, 1, 8)
}

fn percent(text: &str) -> Result<u16, String> {
    whole(text, 1, 100)
}

fn apart(text: &str) -> Result<u16, String> {
    whole(text, 0, 4096)
}

/// An image in grey, with its picture for display and what is to be known about the file.
struct Image {
    grey: GrayImage,
    colours: RgbImage,
    note: Option<String>,
}

pub fn run(args: &FeaturesArgs) -> Result<(), Failure> {
    let left = open(&args.pair.left)?;
    let right = open(&args.pair.right)?;
    let (out, picture) = Place::with_picture(&args.out, args.picture.as_deref())?;

    let mut found = correspond(&plan(args), &left.grey, &right.grey)?;
    if !args.as_found {
        refine(&left.grey, &right.grey, &mut found);
    }
    let drawn = |place| (place, matches_picture(&left.colours, &right.colours, found.points()));
    out.write(|out| out.write_all(lines(&found).as_bytes()), picture.as_ref().map(drawn))?;

    for note in [left.note, right.note].iter().flatten() {
        remark(&format!("note: {note}"));
    }
    let mut text = String::new();
    let _ = writeln!(
        text,
        "{} and {} corners, {} matches",
        found.left.len(),
        found.right.len(),
        found.matches.len()
    );
    let _ = writeln!(text, "results are in {}", one_line(&args.out.display().to_string()));
    print(&text)
}

/// What the options ask for.
fn plan(args: &FeaturesArgs) -> Plan {
    let px = |most: Option<u16>| most.map_or(f32::INFINITY, f32::from);
    // The options' limits are those of bytes.
    let byte = |value: u16| u8::try_from(value).unwrap_or(u8::MAX);
    Plan {
        corners: args.corners,
        threshold: byte(args.contrast),
        levels: byte(args.levels),
        orientation: match args.orientation {
            OrientationChoice::Auto => None,
            OrientationChoice::Upright => Some(Orientation::Upright),
            OrientationChoice::Turned => Some(Orientation::Centroid),
        },
        search: MatchConfig {
            ratio_percent: byte(args.ratio),
            along_px: px(args.columns_apart),
            across_px: px(args.rows_apart),
            ..Plan::default().search
        },
    }
}

/// An image file, as the cameras of the other commands see it.
fn open(path: &Path) -> Result<Image, Failure> {
    let camera = MockCamera::open(path)?;
    let note = camera.had_alpha().then(|| format!("{}: the alpha channel is dropped", path.display()));
    let colours = camera.picture();
    let mut lines = GreyLines::<_, RAW>::new(camera)?;
    let format = lines.format();
    let mut grey = GrayImage::new(format.width.into(), format.height.into());
    lines.start_frame()?;
    for line in grey.chunks_exact_mut(format.width.into()) {
        lines.next_line(line)?;
    }
    Ok(Image { grey, colours, note })
}

/// The matches as lines of numbers, to a thousandth of a pixel.
fn lines(found: &Correspondences) -> String {
    let mut text = "x1,y1,x2,y2\n".to_owned();
    for [x1, y1, x2, y2] in found.points() {
        let _ = writeln!(text, "{x1:.3},{y1:.3},{x2:.3},{y2:.3}");
    }
    text
}
