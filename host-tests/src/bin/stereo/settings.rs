//! One pair with several settings: a folder for each, a table, and one picture of all, side by side, with
//! their names.

use crate::failure::Failure;
use crate::many::{Line, tell, write_table};
use crate::match_args::MatchArgs;
use crate::solve::solve;
use crate::sources::Input;
use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_10X20};
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::*;
use embedded_graphics::text::{Baseline, Text};
use image::{Rgb, RgbImage, imageops};
use std::convert::Infallible;
use std::path::Path;
use stereopsis_host::run::NoiseChoice;

/// The table and the picture.
const TABLE: &str = "settings.csv";
const PICTURE: &str = "settings.png";
/// Pixels between two of the pictures.
const GAP: u32 = 4;
/// Pictures in a row, at most: the others are below.
const MOST_IN_A_ROW: usize = 4;
/// Rows of a name.
const NAME: u32 = FONT_10X20.character_size.height + GAP;

/// Matches the pair with each.
pub fn run(args: &MatchArgs, input: &Input) -> Result<(), Failure> {
    let mut all: Vec<(String, MatchArgs)> = Vec::new();
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
        if all.iter().any(|(other, _)| *other == name) {
            return Err(Failure::usage(format!("--settings: {name} is given twice")));
        }
        one.out = args.out.join(&name);
        all.push((name, one));
    }
    let mut lines: Vec<Line> = Vec::new();
    let mut pictures = Vec::new();
    for (name, one) in all {
        let pair = input.open()?;
        if pictures.is_empty() && !args.rectify {
            pictures.push(("left".to_owned(), pair.left.clone()));
        }
        solve(&one, pair, None, &format!("{name}: "), None)?;
        if pictures.is_empty() {
            pictures.push(("left, rectified".to_owned(), read(&one.out.join("rectified_left.png"))?));
        }
        pictures.push((name.clone(), read(&one.out.join("disparity_colour.png"))?));
        lines.push(Line::of(&one.out, name, input.name())?);
    }
    write_table(&args.out, TABLE, &lines, Some((PICTURE, &side_by_side(&pictures))), None)?;
    tell(args, &lines, None)
}

fn read(path: &Path) -> Result<RgbImage, Failure> {
    let image = image::open(path).map_err(|e| Failure::new(format!("{}: {e}", path.display())))?;
    Ok(image.into_rgb8())
}

/// Pictures of one size in rows, with gaps between them, each below its name.
fn side_by_side(pictures: &[(String, RgbImage)]) -> RgbImage {
    let (width, height) = pictures.first().map_or((0, 0), |(_, picture)| picture.dimensions());
    let longest = pictures.iter().map(|(name, _)| name.len() as u32).max().unwrap_or(0);
    let columns = pictures.len().min(MOST_IN_A_ROW);
    let rows = pictures.len().div_ceil(MOST_IN_A_ROW);
    let step_x = width.max(longest * FONT_10X20.character_size.width) + GAP;
    let step_y = NAME + height + GAP;
    let sides = [step_x * columns as u32, step_y * rows as u32].map(|side| side.saturating_sub(GAP));
    let mut all = Canvas(RgbImage::from_pixel(sides[0], sides[1], Rgb([255; 3])));
    let style = MonoTextStyle::new(&FONT_10X20, Rgb888::BLACK);
    for (place, (name, picture)) in pictures.iter().enumerate() {
        let (column, row) = (place % MOST_IN_A_ROW, place / MOST_IN_A_ROW);
        let (x, y) = (step_x * column as u32, step_y * row as u32);
        let place = Point::new(x as i32, y as i32);
        let Ok(_) = Text::with_baseline(name, place, style, Baseline::Top).draw(&mut all);
        imageops::replace(&mut all.0, picture, x.into(), (y + NAME).into());
    }
    all.0
}

/// A picture that text is drawn into.
struct Canvas(RgbImage);

impl OriginDimensions for Canvas {
    fn size(&self) -> Size {
        Size::new(self.0.width(), self.0.height())
    }
}

impl DrawTarget for Canvas {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb888>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(Point { x, y }, colour) in pixels {
            let place = u32::try_from(x).ok().zip(u32::try_from(y).ok());
            if let Some(pixel) = place.and_then(|(x, y)| self.0.get_pixel_mut_checked(x, y)) {
                *pixel = Rgb([colour.r(), colour.g(), colour.b()]);
            }
        }
        Ok(())
    }
}
