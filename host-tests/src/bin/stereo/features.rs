//! `stereo features`: points of one image found in another.

use crate::failure::Failure;
use crate::place::Place;
use crate::print;
use crate::two_view::{FeaturesArgs, OrientationChoice};
use image::{GrayImage, RgbImage};
use std::fmt::Write;
use std::path::Path;
use stereopsis::camera::LineSource;
use stereopsis::features::{MatchConfig, Orientation};
use stereopsis::imaging::GreyLines;
use stereopsis_host::command_line::one_line;
use stereopsis_host::correspond::{Correspondences, Plan, correspond};
use stereopsis_host::matches_picture::matches_picture;
use stereopsis_host::mock::MockCamera;

/// Bytes of the longest raw line: RGB with 16 bits.
const RAW: usize = MockCamera::MOST_PIXELS as usize * 6;

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

    let found = correspond(&plan(args), &left.grey, &right.grey)?;
    let drawn = |place| (place, matches_picture(&left.colours, &right.colours, found.points()));
    out.write(|out| out.write_all(lines(&found).as_bytes()), picture.as_ref().map(drawn))?;

    let mut text = String::new();
    for note in [left.note, right.note].iter().flatten() {
        let _ = writeln!(text, "note: {}", one_line(note));
    }
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
