//! `stereo match`: a rectified pair into a folder of results.

use crate::cli::MatchArgs;
use crate::failure::Failure;
use crate::input::{self, Pair};
use crate::progress::Progress;
use crate::{files, print};
use std::fmt::Write;
use std::path::Path;
use stereopsis::depth::DepthScale;
use stereopsis::matching::Config;
use stereopsis_host::calibration::Calibration;
use stereopsis_host::command_line::one_line;
use stereopsis_host::output::Staging;
use stereopsis_host::report::{Report, Summary};
use stereopsis_host::run;

pub fn run(args: &MatchArgs) -> Result<(), Failure> {
    let calibration = args.calib.as_ref().map(|path| Calibration::open(path, &args.pair.left)).transpose()?;
    let mut pair = Pair::open(&args.pair)?;
    let config = input::config(&args.range, &args.way, pair.width, pair.height)?;
    let config = Config { confidence: true, ..config };
    let scale = calibration.as_ref().map(|c| scale(c, pair.width, pair.height)).transpose()?;
    Staging::probe(&args.out)?;

    let (config, meter) = input::with_noise(&args.way, config, &mut pair.camera)?;
    let progress = Progress::over(&config);
    let outcome = run::run(args.way.way(), &config, &mut pair.camera, |rows| progress.rows(rows))?;
    drop(progress);

    let summary = Summary::new(args.way.method, args.way.filter.name(), &config, &outcome, scale.as_ref(), None);
    let summary = summary.with_noise(meter.as_ref());
    let report = Report {
        left_name: &name(&args.pair.left),
        right_name: &name(&args.pair.right),
        left: &pair.left,
        right: &pair.right,
        map: &outcome.map,
        summary: &summary,
        rig: scale.as_ref().map(DepthScale::rig),
        truth: None,
    };
    let mut staging = Staging::new(&args.out)?;
    files::write(&mut staging, &report, scale.as_ref())?;
    staging.commit(&files::WITH_DEPTH)?;

    let mut text = String::new();
    for note in &pair.notes {
        let _ = writeln!(text, "note: {}", one_line(note));
    }
    text += &figures(&summary);
    text += &place(&args.out);
    print(&text)
}

/// The scale of depths for images of that size.
fn scale(calibration: &Calibration, width: u16, height: u16) -> Result<DepthScale, Failure> {
    calibration.check_size(width, height)?;
    DepthScale::new(&calibration.rig).map_err(|e| Failure::new(format!("{}: {e}", calibration.path.display())))
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
