//! One pair with several settings: a folder for each, a table, and one picture of all, side by side.

use crate::failure::Failure;
use crate::many::{Line, tell, write_table};
use crate::match_args::MatchArgs;
use crate::solve::solve;
use crate::sources::Input;
use image::{RgbImage, imageops};
use std::path::Path;
use stereopsis_host::run::NoiseChoice;

/// The table and the picture.
const TABLE: &str = "settings.csv";
const PICTURE: &str = "settings.png";
/// Columns between two of the pictures.
const GAP: u32 = 4;

/// Matches the pair with each.
pub fn run(args: &MatchArgs, input: &Input) -> Result<(), Failure> {
    let mut lines: Vec<Line> = Vec::new();
    let mut pictures = Vec::new();
    let mut names = Vec::new();
    for setting in &args.settings {
        let mut one = args.clone();
        one.method.method = setting.method;
        one.method.filter = setting.filter.unwrap_or(one.method.filter);
        one.method.noise = setting.noise.unwrap_or(one.method.noise);
        let name = [
            Some(setting.method.name().to_owned()),
            setting.filter.map(|filter| filter.name().to_owned()),
            setting.noise.map(|noise| match noise {
                NoiseChoice::Auto => "auto".to_owned(),
                NoiseChoice::Given(noise) => noise.name().to_owned(),
            }),
        ];
        let name = name.into_iter().flatten().collect::<Vec<_>>().join("-");
        if names.contains(&name) {
            return Err(Failure::new(format!("--settings: {name} is given twice")));
        }
        one.out = args.out.join(&name);
        let pair = input.open()?;
        if pictures.is_empty() && !args.rectify {
            pictures.push(pair.left.clone());
        }
        solve(&one, pair, None, &format!("{name}: "), None)?;
        if pictures.is_empty() {
            pictures.push(read(&one.out.join("rectified_left.png"))?);
        }
        pictures.push(read(&one.out.join("disparity_colour.png"))?);
        lines.push(Line::of(&one.out, name.clone(), input.name())?);
        names.push(name);
    }
    write_table(&args.out, TABLE, &lines, Some((PICTURE, &side_by_side(&pictures))), None)?;
    tell(args, &lines, None)
}

fn read(path: &Path) -> Result<RgbImage, Failure> {
    let image = image::open(path).map_err(|e| Failure::new(format!("{}: {e}", path.display())))?;
    Ok(image.into_rgb8())
}

/// Pictures in a row, with gaps between them.
fn side_by_side(pictures: &[RgbImage]) -> RgbImage {
    let height = pictures.iter().map(RgbImage::height).max().unwrap_or(0);
    let width: u32 = pictures.iter().map(|picture| picture.width() + GAP).sum();
    let mut all = RgbImage::from_pixel(width.saturating_sub(GAP), height, image::Rgb([255; 3]));
    let mut x = 0;
    for picture in pictures {
        imageops::replace(&mut all, picture, x, 0);
        x += i64::from(picture.width() + GAP);
    }
    all
}
