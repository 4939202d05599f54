//! `stereo calibrate`: pictures of a chessboard, plain or with markers, into a calibration file.

mod boards;

use crate::failure::Failure;
use crate::image_files::pairs;
use crate::place::{Place, png};
use crate::shared::{print, remark};
use boards::{Found, boards};
use clap::{Args, ValueEnum};
use image::RgbImage;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use stereopsis::geometry::rectify::{Crop, Rectification, RectifyError};
use stereopsis_host::calibrate::board::{Dictionary, Markers, Pattern};
use stereopsis_host::calibrate::coverage::{self, Coverage, coverage};
use stereopsis_host::calibrate::{Calibrated, LensModel, View, report, solve_paired};
use stereopsis_host::calibration::{warnings, write_opencv};
use stereopsis_host::command_line::one_line;
use stereopsis_host::mock::MockCamera;
use stereopsis_host::output::Staging;

/// What follows the options in the command's help.
pub const EXAMPLE: &str = "Example:
  stereo calibrate --left 'left*.png' --right 'right*.png' --pattern 9x6 --square-mm 25 --out stereo.yml \
                           --report report

Ten to thirty pairs, in which the board is tilted and turned each time and reaches all corners of both \
                           images, are enough. Left and right images belong together by the last number in \
                           their names, or, where these have none, by their order.

Of a ChArUco board, whose white squares hold markers, any part with eight corners is enough, so that it may \
                           reach over the borders of the images: name its markers and their side, as in \
                           --markers 5x5_100 --marker-mm 18. A board of 10 x 7 squares has the pattern 9x6.

The file is OpenCV's YAML (K1, D1, K2, D2, R, T, E, F) with lengths in metres; match, rectify and calib read \
                           it. The folder of --report gets index.html and a picture of each view's \
                           residuals.";

#[derive(Debug, Args)]
pub struct CalibrateArgs {
    /// The left camera's images, as files, a folder, or a pattern with * and ?
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
    /// The markers of a ChArUco board, by OpenCV's name of their dictionary: 4x4, 5x5, 6x6 or 7x7, and _50,
    /// _100, _250 or _1000
    #[arg(long, value_name = "DICTIONARY", requires = "marker_mm", value_parser = dictionary)]
    pub markers: Option<Dictionary>,
    /// The side of a marker with its black border, millimetres
    #[arg(long, value_name = "MM", requires = "markers", allow_negative_numbers = true)]
    pub marker_mm: Option<f64>,
    /// The first square of the ChArUco board is white: OpenCV before 4.6 made boards with an even number of
    /// rows of squares like that
    #[arg(long, requires = "markers")]
    pub begins_white: bool,
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

fn dictionary(text: &str) -> Result<Dictionary, &'static str> {
    Dictionary::named(text).ok_or("4x4, 5x5, 6x6 or 7x7 with _50, _100, _250 or _1000 is needed, as 5x5_100")
}

/// The markers of the options.
fn markers(args: &CalibrateArgs) -> Result<Option<Markers>, Failure> {
    let (Some(dictionary), Some(mm)) = (&args.markers, args.marker_mm) else { return Ok(None) };
    let share = mm / args.square_mm;
    if !(0.4..=0.9).contains(&share) {
        return Err(Failure::usage(format!(
            "--marker-mm {mm}: a marker's side is .4 to .9 of the side of a square, {} mm here",
            args.square_mm
        )));
    }
    let (columns, rows) = (args.pattern.columns() + 1, args.pattern.rows() + 1);
    if dictionary.len() < columns * rows / 2 {
        return Err(Failure::new(format!(
            "--markers: {columns} x {rows} squares hold {} markers, and the dictionary has {}; give the one \
             that the board was made with",
            columns * rows / 2,
            dictionary.len()
        )));
    }
    Ok(Some(Markers { dictionary: dictionary.clone(), share, begins_white: args.begins_white }))
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

pub fn run(args: &CalibrateArgs) -> Result<(), Failure> {
    let markers = markers(args)?;
    let place = Place::of_yaml("--out", &args.out)?;
    if let Some(folder) = &args.report {
        Staging::probe(folder)?;
    }
    let mut notes = Vec::new();
    let pairs = pairs(&args.left, &args.right, &mut notes)?;
    let count = pairs.len();
    let (size, found) = boards(args.pattern, markers.as_ref(), pairs, &mut notes)?;
    let all: Vec<View> = found.iter().map(|found| found.view.clone()).collect();
    let failed = |e: &dyn std::fmt::Display| {
        let last = notes.last().map(|note| format!("; {note}")).unwrap_or_default();
        Failure::new(format!("--left and --right: {e}{last}"))
    };
    let (result, kept) = solve_paired(args.lens.into(), args.pattern, args.square_mm / 1000.0, size, &all)
        .map_err(|e| failed(&e))?;
    let hint = |e| if e == RectifyError::Apart { "; is one of them upside down?" } else { "" };
    let rectified = Rectification::new(&result.rig, Crop::Natural, size)
        .map_err(|e| failed(&format!("{e}{}", hint(e))))?;
    let wrong = warnings(&result.rig, &rectified);
    let (found, left_out): (Vec<_>, Vec<_>) =
        found.into_iter().enumerate().partition(|(place, _)| kept.contains(place));
    for (_, Found { paths: [left, right], .. }) in left_out {
        notes.push(format!(
            "{} and {} are left out: they do not belong together, as the other pairs do",
            left.display(),
            right.display()
        ));
    }
    let found: Vec<_> = found.into_iter().map(|(_, found)| found).collect();
    let views: Vec<View> = found.iter().map(|found| found.view.clone()).collect();

    for i in result.outliers() {
        let [left, right] = &found[i].paths;
        let [a, b] = result.views[i].rms_px;
        notes.push(format!(
            "{} and {} fit badly: {a:.2} and {b:.2} px, most views {:.2} px; look at them, and leave them \
             out if they are blurred",
            left.display(),
            right.display(),
            result.middle_rms_px()
        ));
    }
    let reached = coverage(&views, size);
    let covered = reached.map(|coverage| 100.0 * coverage.share());
    let advice = advice(&result, &reached);
    notes.extend(advice.iter().cloned());
    notes.extend(wrong);
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
        draw(folder, &found, &result, &reached, &advice)?;
    }
    place.write(|out| out.write_all(file.as_bytes()), None)?;

    for note in &notes {
        remark(&format!("note: {note}"));
    }
    let mut text = format!("{} of {count} views, {} x {} px\n", views.len(), size.width, size.height);
    text += &result.words();
    let ([columns, rows], [left, right]) = (coverage::CELLS, covered);
    let _ = writeln!(
        text,
        "coverage      left {left:.0} %, right {right:.0} % of {columns} x {rows} parts of the picture"
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

/// What is to be known of a result that may be worth little, and what to do about it.
fn advice(result: &Calibrated, reached: &[Coverage; 2]) -> Vec<String> {
    let mut advice = Vec::new();
    let least = 100.0 * reached[0].share().min(reached[1].share());
    if least < 60.0 {
        advice.push(format!(
            "the boards reach only {least:.0} % of a picture: elsewhere the lens is a guess; bring the board \
             to all borders and corners"
        ));
    }
    for (name, coverage) in ["left", "right"].iter().zip(reached) {
        let missing = coverage.missing();
        if least >= 60.0 && !missing.is_empty() {
            advice.push(format!("fill the {} of the {name} picture", missing.join(" and the ")));
        }
    }
    for (name, camera) in [("left", 0), ("right", 1)] {
        let share = result.focal_sigma_px[camera] / result.rig.cameras()[camera].focal_px().0;
        if share.is_nan() || share > 0.01 {
            advice.push(format!(
                "the {name} focal length is uncertain by {:.1} %: tilt the board more, about two axes",
                100.0 * share
            ));
        }
    }
    for (how, tilt) in ["to the left and right", "up and down"].iter().zip(result.tilts_deg()) {
        if tilt < Calibrated::LEAST_TILT_DEG {
            advice.push(format!(
                "the boards are hardly tilted {how}, by {tilt:.0} degrees (root mean square): tilt them \
                 more, by 20 to 45 degrees, in several views"
            ));
        }
    }
    let is_certain = result.disparity_sigma_px <= Calibrated::MOST_DISPARITY_SIGMA_PX;
    if !is_certain {
        advice.push(format!(
            "the turn along the baseline (yaw) is weakly determined: with it all disparities are uncertain \
             by {:.2} px; take more views, with boards near and far that are tilted and reach the left and \
             right borders",
            result.disparity_sigma_px
        ));
    }
    let alone = result.alone_px[0].max(result.alone_px[1]);
    if result.rms_px > 1.5 * alone && result.rms_px > alone + 0.1 {
        advice.push(
            "each camera by itself fits much better than both together: are the images of a pair of one \
             moment?"
                .into(),
        );
    }
    advice
}

fn draw(
    folder: &Path,
    found: &[Found],
    result: &Calibrated,
    reached: &[Coverage; 2],
    advice: &[String],
) -> Result<(), Failure> {
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
    let page = report::page(result, reached, advice, &names, &files);
    staging.write("index.html", |out| out.write_all(page.as_bytes()))?;
    Ok(staging.commit(&[])?)
}
