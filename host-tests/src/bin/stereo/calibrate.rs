//! `stereo calibrate`: pictures of a chessboard into a calibration file.

use crate::cli::CalibrateArgs;
use crate::failure::Failure;
use crate::files::png;
use crate::place::Place;
use crate::print;
use image::{DynamicImage, GrayImage, RgbImage};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use stereopsis::camera::LineSource;
use stereopsis::geometry::{
    camera::ImageSize,
    rectify::{Crop, Rectification},
};
use stereopsis_host::calibrate::board::{self, Board, BoardError, Pattern};
use stereopsis_host::calibrate::{Calibrated, View, report, solve};
use stereopsis_host::calibration::write_opencv;
use stereopsis_host::command_line::one_line;
use stereopsis_host::mock::MockCamera;
use stereopsis_host::output::Staging;

/// A pair in which the board was found in both images.
struct Found {
    paths: [PathBuf; 2],
    view: View,
}

/// An image with its board.
struct Seen {
    size: ImageSize,
    board: Result<Board, BoardError>,
}

pub fn run(args: &CalibrateArgs) -> Result<(), Failure> {
    let place = Place::of("--out", &args.out)?;
    if let Some(folder) = &args.report {
        Staging::probe(folder)?;
    }
    let mut notes = Vec::new();
    let pairs = pairs(&args.left, &args.right, &mut notes)?;
    let count = pairs.len();
    let (size, found) = boards(args.pattern, pairs, &mut notes)?;
    let views: Vec<View> = found.iter().map(|found| found.view.clone()).collect();
    let failed = |e: &dyn std::fmt::Display| {
        let last = notes.last().map(|note| format!("; {note}")).unwrap_or_default();
        Failure::new(format!("--left and --right: {e}{last}"))
    };
    let result = solve(args.lens.into(), args.pattern, args.square_mm / 1000.0, size, &views)
        .map_err(|e| failed(&e))?;
    let rectified = Rectification::new(&result.rig, Crop::Natural, size).map_err(|e| failed(&e))?;

    for i in result.outliers() {
        let [left, right] = &found[i].paths;
        let [a, b] = result.views[i].rms_px;
        notes.push(format!(
            "{} and {} fit badly: {a:.2} and {b:.2} px, most views {:.2} px; look at them, and leave them out if they are blurred",
            left.display(),
            right.display(),
            result.middle_rms_px()
        ));
    }
    notes.extend(doubts(&result));
    let told = [
        format!(
            "stereo calibrate: {} views of {} x {} corners",
            views.len(),
            args.pattern.columns(),
            args.pattern.rows()
        ),
        format!("squares of {} mm; re-projection error {:.4} px", args.square_mm, result.rms_px),
    ];
    let file = write_opencv(&result.rig, &told);
    if let Some(folder) = &args.report {
        draw(folder, &found, &result)?;
    }
    place.write(|out| out.write_all(file.as_bytes()), None)?;

    let mut text = String::new();
    for note in &notes {
        let _ = writeln!(text, "note: {}", one_line(note));
    }
    let _ = writeln!(text, "{} of {count} views, {} x {} px", views.len(), size.width, size.height);
    let [left, right] = result.alone_px;
    let _ = writeln!(
        text,
        "re-projection {:.3} px (by themselves: left {left:.3}, right {right:.3})",
        result.rms_px
    );
    for (name, camera, sigma) in
        [("left", 0, result.focal_sigma_px[0]), ("right", 1, result.focal_sigma_px[1])]
            .map(|(n, i, s)| (n, &result.rig.cameras()[i], s))
    {
        let ((fx, fy), (cx, cy)) = (camera.focal_px(), camera.principal_point());
        let _ = writeln!(text, "{name:<13} f {fx:.2} x {fy:.2} px (+- {sigma:.2}), centre {cx:.2}, {cy:.2}");
    }
    let (b, sigma) = (1000.0 * result.rig.baseline_m(), 1000.0 * result.baseline_sigma_m);
    let angle = result.rig.pose().angle_rad().to_degrees();
    let _ = writeln!(
        text,
        "baseline      {b:.2} mm (+- {sigma:.2}), cameras turned against each other by {angle:.2} degrees"
    );
    let error = rectified.report().row_error_px(result.rms_px);
    let _ = writeln!(text, "row error     {error:.2} px expected after rectification");
    let _ = writeln!(text, "the calibration is in {}", one_line(&args.out.display().to_string()));
    if let Some(folder) = &args.report {
        let page = folder.join("index.html").display().to_string();
        let _ = writeln!(text, "open {} in a browser", one_line(&page));
    }
    print(&text)
}

/// What is to be known of a result that may be worth little.
fn doubts(result: &Calibrated) -> Vec<String> {
    let mut doubts = Vec::new();
    for (name, camera) in [("left", 0), ("right", 1)] {
        let share = result.focal_sigma_px[camera] / result.rig.cameras()[camera].focal_px().0;
        if share.is_nan() || share > 0.01 {
            doubts.push(format!(
                "the {name} focal length is uncertain by {:.1} %: tilt the board more, about two axes",
                100.0 * share
            ));
        }
    }
    let alone = result.alone_px[0].max(result.alone_px[1]);
    if result.rms_px > 1.5 * alone && result.rms_px > alone + 0.1 {
        doubts.push(
            "each camera by itself fits much better than both together: are the images of a pair of one moment?".into(),
        );
    }
    doubts
}

/// Left and right images by the last number in their names; by their order where names have none.
fn pairs(left: &[String], right: &[String], notes: &mut Vec<String>) -> Result<Vec<[PathBuf; 2]>, Failure> {
    let (left, right) = (files("--left", left)?, files("--right", right)?);
    let numbered = |paths: &[PathBuf]| -> Option<BTreeMap<u64, PathBuf>> {
        let found: BTreeMap<_, _> =
            paths.iter().filter_map(|path| Some((number(path)?, path.clone()))).collect();
        // Some may have none, but no two the same.
        let count = paths.iter().filter(|path| number(path).is_some()).count();
        (found.len() == count && count > 0).then_some(found)
    };
    if let (Some(mut of_left), Some(mut of_right)) = (numbered(&left), numbered(&right))
        && of_left.keys().any(|key| of_right.contains_key(key))
    {
        let alone = |path: &PathBuf| format!("{} has no partner; it is left out", path.display());
        notes.extend(left.iter().chain(&right).filter(|path| number(path).is_none()).map(alone));
        notes.extend(
            of_left.iter().filter(|(key, _)| !of_right.contains_key(key)).map(|(_, path)| alone(path)),
        );
        notes.extend(
            of_right.iter().filter(|(key, _)| !of_left.contains_key(key)).map(|(_, path)| alone(path)),
        );
        let keys: Vec<_> = of_left.keys().copied().collect();
        let pair = |key: u64| Some([of_left.remove(&key)?, of_right.remove(&key)?]);
        return Ok(keys.into_iter().filter_map(pair).collect());
    }
    if left.len() != right.len() {
        return Err(Failure::new(format!(
            "--left and --right: {} and {} images; as many of both are needed, or numbers in their names that say which belong \
             together",
            left.len(),
            right.len()
        )));
    }
    Ok(left.into_iter().zip(right).map(|(left, right)| [left, right]).collect())
}

/// The last number in a file's name.
fn number(path: &Path) -> Option<u64> {
    let name = path.file_stem()?.to_str()?;
    let tail = name.trim_end_matches(|c: char| !c.is_ascii_digit());
    tail.rsplit(|c: char| !c.is_ascii_digit()).next()?.parse().ok()
}

/// The files that patterns name, in order of their names.
pub fn files(option: &str, patterns: &[String]) -> Result<Vec<PathBuf>, Failure> {
    let mut found = Vec::new();
    for pattern in patterns {
        // A name with brackets in it may be a file's.
        if Path::new(pattern).is_file() {
            found.push(pattern.into());
            continue;
        }
        let paths = glob::glob(pattern).map_err(|e| Failure::new(format!("{option} {pattern}: {e}")))?;
        let before = found.len();
        for path in paths {
            found.push(path?);
        }
        if found.len() == before {
            return Err(Failure::new(format!(
                "{option} {pattern}: there is no such file; name the images, as 'left*.png'"
            )));
        }
    }
    found.sort();
    found.dedup();
    Ok(found)
}

/// The pairs with a board in both images, and the images' size.
fn boards(
    pattern: Pattern,
    pairs: Vec<[PathBuf; 2]>,
    notes: &mut Vec<String>,
) -> Result<(ImageSize, Vec<Found>), Failure> {
    let mut all = Vec::new();
    for paths in pairs {
        let left = look(&paths[0], pattern, None)?;
        let right = look(&paths[1], pattern, left.board.as_ref().ok())?;
        all.push((paths, left, right));
    }
    // The size that most images have.
    let sizes = all.iter().flat_map(|(_, left, right)| [left.size, right.size]);
    let mut counts: Vec<(usize, ImageSize)> = Vec::new();
    for size in sizes {
        match counts.iter_mut().find(|(_, other)| *other == size) {
            Some((count, _)) => *count += 1,
            None => counts.push((1, size)),
        }
    }
    let size = counts.iter().max_by_key(|(count, _)| *count).map(|(_, size)| *size);
    let size = size.ok_or_else(|| Failure::new("--left and --right: no image has a partner"))?;
    let mut found = Vec::new();
    for (paths, left, right) in all {
        if let Some((path, seen)) = paths.iter().zip([&left, &right]).find(|(_, seen)| seen.size != size) {
            notes.push(format!(
                "{}: {} x {} px, most images have {} x {}; the pair is left out",
                path.display(),
                seen.size.width,
                seen.size.height,
                size.width,
                size.height
            ));
            continue;
        }
        match (left.board, right.board) {
            (Ok(left), Ok(right)) => {
                found.push(Found { paths, view: View { corners: [left.corners, right.corners] } })
            }
            (Err(e), _) => notes.push(format!("{}: {e}; the pair is left out", paths[0].display())),
            (_, Err(e)) => notes.push(format!("{}: {e}; the pair is left out", paths[1].display())),
        }
    }
    Ok((size, found))
}

fn look(path: &Path, pattern: Pattern, like: Option<&Board>) -> Result<Seen, Failure> {
    let camera = MockCamera::open(path)?;
    let (width, height) = (camera.format().width, camera.format().height);
    let grey: GrayImage = DynamicImage::from(camera.picture()).into_luma8();
    Ok(Seen { size: ImageSize { width, height }, board: board::find(&grey, pattern, like) })
}

fn draw(folder: &Path, found: &[Found], result: &Calibrated) -> Result<(), Failure> {
    let mut staging = Staging::new(folder)?;
    let (mut files, mut names) = (Vec::new(), Vec::new());
    for (i, (found, figures)) in found.iter().zip(&result.views).enumerate() {
        let picture = |path: &Path| -> Result<RgbImage, Failure> { Ok(MockCamera::open(path)?.picture()) };
        let [left, right] = &found.paths;
        let drawn = report::picture(&picture(left)?, &picture(right)?, &found.view, figures);
        let file = format!("view{:03}.png", i + 1);
        staging.write(&file, |out| png(out, &drawn))?;
        files.push(file);
        let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        names.push([name(left), name(right)]);
    }
    let page = report::page(result, &names, &files);
    staging.write("index.html", |out| out.write_all(page.as_bytes()))?;
    Ok(staging.commit(&[])?)
}
