//! `stereo features`: points of one image found in another.

use crate::cli::FeaturesArgs;
use crate::failure::Failure;
use crate::files::png;
use crate::print;
use image::{GrayImage, RgbImage};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use stereopsis::camera::LineSource;
use stereopsis::features::{Orientation, Search};
use stereopsis::imaging::GreyLines;
use stereopsis_host::command_line::one_line;
use stereopsis_host::correspond::{Correspondences, Plan, correspond};
use stereopsis_host::matches_picture::matches_picture;
use stereopsis_host::mock::MockCamera;
use stereopsis_host::output::Staging;

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
    let out = Place::of("--out", &args.out)?;
    let picture = args.picture.as_ref().map(|path| Place::of("--picture", path)).transpose()?;
    if picture.as_ref().is_some_and(|picture| picture.folder == out.folder && picture.name == out.name) {
        return Err(Failure::new(format!("--picture: {} is the file of --out; name another", args.out.display())));
    }

    let found = correspond(&plan(args), &left.grey, &right.grey)?;
    // Both files are complete and on the disk before either moves to its place.
    let mut staging = Staging::new(&out.folder)?;
    staging.write(&out.name, |out| out.write_all(lines(&found).as_bytes()))?;
    let mut elsewhere = None;
    if let Some(place) = &picture {
        let drawn = matches_picture(&left.colours, &right.colours, found.points());
        let to = if place.folder == out.folder { &mut staging } else { elsewhere.insert(Staging::new(&place.folder)?) };
        to.write(&place.name, |out| png(out, &drawn))?;
    }
    if let Some(elsewhere) = elsewhere {
        elsewhere.commit(&[])?;
    }
    staging.commit(&[])?;

    let mut text = String::new();
    for note in [left.note, right.note].iter().flatten() {
        let _ = writeln!(text, "note: {}", one_line(note));
    }
    let _ = writeln!(text, "{} and {} corners, {} matches", found.left.len(), found.right.len(), found.matches.len());
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
        orientation: if args.turned { Orientation::Centroid } else { Orientation::Upright },
        search: Search {
            ratio_percent: byte(args.ratio),
            along_px: px(args.columns_apart),
            across_px: px(args.rows_apart),
            ..Search::new()
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

/// A result's folder and its name there.
struct Place {
    folder: PathBuf,
    name: String,
}

impl Place {
    /// Where the option wants its file; refused before any work where none can be made.
    fn of(option: &str, path: &Path) -> Result<Self, Failure> {
        let no_file = || Failure::new(format!("{option}: '{}' is not the name of a file", path.display()));
        let name = path.file_name().and_then(|name| name.to_str()).ok_or_else(no_file)?.to_owned();
        if path.is_dir() {
            return Err(no_file());
        }
        let folder = match path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder.to_owned(),
            _ => PathBuf::from("."),
        };
        Staging::probe(&folder)?;
        // One folder has one spelling, so that two options that mean one file are seen to; a new one keeps its own.
        let folder = folder.canonicalize().unwrap_or(folder);
        Ok(Self { folder, name })
    }
}

/// The matches as lines of numbers, to a thousandth of a pixel.
fn lines(found: &Correspondences) -> String {
    let mut text = "x1,y1,x2,y2\n".to_owned();
    for [x1, y1, x2, y2] in found.points() {
        let _ = writeln!(text, "{x1:.3},{y1:.3},{x2:.3},{y2:.3}");
    }
    text
}
