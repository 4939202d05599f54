//! `stereo match`: a pair, rectified or raw, into a folder of results.

use crate::cli::{MatchArgs, Unit};
use crate::failure::Failure;
use crate::input::{self, Pair};
use crate::progress::Progress;
use crate::{files, print, rectify as raw_pair};
use image::{RgbImage, imageops};
use std::fmt::{Display, Write};
use std::io::Write as _;
use std::path::Path;
use stereopsis::camera::StereoSource;
use stereopsis::depth::DepthScale;
use stereopsis::geometry::camera::{Camera, ImageSize, RectifiedRig};
use stereopsis::imaging::{Balance, BalancedPair, NoiseMeter};
use stereopsis::matching::Config;
use stereopsis_host::calibration::Calibration;
use stereopsis_host::command_line::one_line;
use stereopsis_host::output::Staging;
use stereopsis_host::rectify::{rectify, rectify_colours, with_rectified};
use stereopsis_host::report::{Exposure, Report, Summary};
use stereopsis_host::rows::Rows;
use stereopsis_host::run::{self, Outcome, measure_noise};

/// What is written only of raw images.
const RECTIFIED: [&str; 3] = ["rectified_left.png", "rectified_right.png", "rectified.json"];

/// What is matched, and what its depths are.
struct Scene {
    left: RgbImage,
    right: RgbImage,
    scale: Option<DepthScale>,
    rectified: Option<raw_pair::Summary>,
    rows: Option<Rows>,
}

/// What came of the matching.
struct Matched {
    config: Config,
    meter: Option<NoiseMeter>,
    balance: Balance,
    outcome: Outcome,
}

pub fn run(args: &MatchArgs) -> Result<(), Failure> {
    let mut pair = Pair::open(&args.pair)?;
    let config = input::config(&args.range, &args.way, pair.width, pair.height)?;
    let config = Config { confidence: true, ..config };
    let (scene, matched) = if args.rectify {
        raw(args, config, &mut pair)?
    } else {
        let scale = scale(args, &pair)?;
        Staging::probe(&args.out)?;
        let matched = matched(args, config, &mut pair.camera)?;
        let [left, right] = [&pair.left, &pair.right].map(imageops::grayscale);
        let camera = scale.as_ref().and_then(|scale| camera(scale.rig()));
        let rows = Rows::measure([&left, &right], None, camera.as_ref());
        (Scene { left: pair.left, right: pair.right, scale, rectified: None, rows }, matched)
    };

    let Matched { config, meter, balance, outcome } = matched;
    let scale = scene.scale.as_ref();
    let summary = Summary::new(args.way.method, args.way.filter.name(), &config, &outcome, scale, None);
    let summary = summary.with_noise(meter.as_ref()).with_balance(balance).with_rows(scene.rows);
    let report = Report {
        left_name: &name(&args.pair.left),
        right_name: &name(&args.pair.right),
        left: &scene.left,
        right: &scene.right,
        map: &outcome.map,
        summary: &summary,
        rig: scale.map(DepthScale::rig),
        truth: None,
    };
    let mut staging = Staging::new(&args.out)?;
    files::write(&mut staging, &report, scale)?;
    let [left, right, told] = RECTIFIED;
    if let Some(rectified) = &scene.rectified {
        staging.write(left, |out| files::png(out, &scene.left))?;
        staging.write(right, |out| files::png(out, &scene.right))?;
        staging.write(told, |out| files::json(out, rectified))?;
    }
    let stale: Vec<_> = files::WITH_DEPTH.into_iter().chain(RECTIFIED).collect();
    staging.commit(&stale)?;

    let mut text = String::new();
    for note in &pair.notes {
        let _ = writeln!(text, "note: {}", one_line(note));
    }
    if let Some(warning) = scene.rows.as_ref().and_then(Rows::warning) {
        // Nobody is left to tell when standard error is closed.
        let _ = writeln!(std::io::stderr(), "stereo: warning: {warning}");
    }
    text += &figures(&summary);
    if let Some(rectified) = &scene.rectified {
        text += &rectified.figures();
    }
    text += &place(&args.out);
    print(&text)
}

fn matched<C: StereoSource<Error: Display>>(
    args: &MatchArgs,
    config: Config,
    source: &mut C,
) -> Result<Matched, Failure> {
    if !args.balance.is_for(args.way.method) {
        return matched_as_it_comes(args, config, source);
    }
    let mut balanced = BalancedPair::new(source);
    // The first frame shows the exposures.
    measure_noise(&mut balanced).map_err(|e| Failure::new(e.to_string()))?;
    let matched = matched_as_it_comes(args, config, &mut balanced)?;
    Ok(Matched { balance: balanced.balance(), ..matched })
}

fn matched_as_it_comes<C: StereoSource<Error: Display>>(
    args: &MatchArgs,
    config: Config,
    source: &mut C,
) -> Result<Matched, Failure> {
    let (config, meter) = input::with_noise(&args.way, config, source)?;
    let progress = Progress::over(&config);
    let outcome = run::run(args.way.way(), &config, source, |rows| progress.rows(rows));
    let outcome = outcome.map_err(|e| Failure::new(e.to_string()))?;
    Ok(Matched { config, meter, balance: Balance::NONE, outcome })
}

/// Matches a raw pair: remap, census and matching in one loop over the rows.
fn raw(args: &MatchArgs, config: Config, pair: &mut Pair) -> Result<(Scene, Matched), Failure> {
    if args.calib.is_empty() {
        return Err(Failure::new("--rectify: --calib is missing; give the calibration of the two cameras"));
    }
    let size = ImageSize { width: pair.width, height: pair.height };
    let (calibration, rectification) = raw_pair::open(&args.calib, &args.options, size)?;
    let named = |e: &dyn Display| Failure::new(format!("{}: {e}", calibration.path.display()));
    if !rectification.axis().is_horizontal() {
        return Err(named(&"the cameras stand below each other; match takes cameras beside each other"));
    }
    let rig = rectification.rig().map_err(|e| named(&e))?;
    let scale = DepthScale::new(&rig).map_err(|e| named(&e))?;
    Staging::probe(&args.out)?;
    let (left, right) = rectify_colours(&rectification, &pair.left, &pair.right).map_err(|e| named(&e))?;
    let (rows, matched) = with_rectified(&rectification, &mut pair.camera, |source| {
        (source.remaps().map(|remap| remap.table().rows()), matched(args, config, source))
    })
    .map_err(|e| named(&e))?;
    let told = raw_pair::Summary::new(calibration.format, &rectification, rows, &rectification.report());
    let grey = rectify(&rectification, &mut pair.camera).map_err(|e| named(&e))?;
    let rows =
        Rows::measure(grey.pictures.each_ref(), Some(grey.valid.each_ref()), Some(rectification.camera()));
    Ok((Scene { left, right, scale: Some(scale), rectified: Some(told), rows }, matched?))
}

/// The camera of a rectified pair.
fn camera(rig: &RectifiedRig) -> Option<Camera<f64>> {
    let (f, (cx, cy)) = (f64::from(rig.focal_px()), rig.principal_point());
    Camera::new(f, f, cx.into(), cy.into()).ok()
}

/// The scale of depths in images that are rectified already, where there is a calibration.
fn scale(args: &MatchArgs, pair: &Pair) -> Result<Option<DepthScale>, Failure> {
    if args.options.alpha.is_some() {
        return Err(Failure::new("--alpha: is for raw images; give --rectify too"));
    }
    match args.calib.len() {
        0 if args.options.unit.is_some() => {
            return Err(Failure::new("--unit: is that of --calib, which is missing"));
        }
        0 => return Ok(None),
        1 | 2 => {}
        _ => {
            return Err(Failure::new(
                "--calib: is given more than twice; a file of both cameras or one of each is needed",
            ));
        }
    }
    let calibration =
        Calibration::open_all(&args.calib, &args.pair.left, args.options.unit.map(Unit::metres))?;
    calibration.check_size(pair.width, pair.height)?;
    let scale = DepthScale::new(&calibration.rig);
    scale.map(Some).map_err(|e| Failure::new(format!("{}: {e}", calibration.path.display())))
}

/// The figures of a run in a few lines.
pub fn figures(summary: &Summary) -> String {
    let s = summary;
    let mut text = format!(
        "{} x {} px, disparities {} to {}, method {}, filter {}\n",
        s.width,
        s.height,
        s.min_disparity,
        s.min_disparity + s.disparities - 1,
        s.method,
        s.filter
    );
    let _ = writeln!(text, "density      {:.1} % of the pixels", 100.0 * s.density);
    let _ = match s.noise_sigma {
        Some(sigma) => writeln!(text, "noise        {}, {sigma:.1} grey levels", s.noise),
        None => writeln!(text, "noise        {}, as told", s.noise),
    };
    if let Some(rows) = &s.rows {
        let _ = writeln!(text, "rows         {}", rows.told());
    }
    if let Some(d) = s.disparity_px {
        let _ = writeln!(text, "disparity    {:.2} to {:.2} px, median {:.2} px", d.min, d.max, d.median);
    }
    if let Some(z) = s.depth.as_ref().and_then(|depth| depth.found_m) {
        let _ = writeln!(text, "depth        {:.3} to {:.3} m, median {:.3} m", z.min, z.max, z.median);
    }
    let _ = writeln!(
        text,
        "cost         {:.1} ms on kernel {}, {} bytes of state, {} lines of delay",
        s.time_ms, s.kernel, s.state_bytes, s.latency_lines
    );
    if let Some(Exposure { gain, offset }) = s.balance {
        let _ = writeln!(
            text,
            "exposure     right image x {gain:.2} {offset:+.1} grey levels, as the left one has it"
        );
    }
    text
}

/// Where the results are and how to look at them.
pub fn place(out: &Path) -> String {
    let report = one_line(&out.join("report.html").display().to_string());
    format!("results are in {}\nopen {report} in a browser\n", one_line(&out.display().to_string()))
}

fn name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}
