//! What `match` and `demo` write and print. Names and formats are a contract with programs that read them.

use crate::place::{json, png};
use clap::Args;
use image::{ImageBuffer, Luma, RgbImage};
use std::fmt::Write;
use std::path::Path;
use stereopsis::depth::DepthScale;
use stereopsis_host::colour::{ColourScale, confidence_raw, flags_raw};
use stereopsis_host::command_line::one_line;
use stereopsis_host::map::DisparityMap;
use stereopsis_host::output::{OutputError, Staging};
use stereopsis_host::pfm;
use stereopsis_host::ply::{self, ColouredPoint};
use stereopsis_host::report::{Exposure, Report, Summary};
use stereopsis_host::samples::{MILLIMETRE, Samples};

/// What is written only with a calibration. A run without one takes the files of an earlier run with it away.
pub const WITH_DEPTH: [&str; 3] = ["depth.pfm", "depth.png", "cloud.ply"];

/// The options of the files of depths.
#[derive(Clone, Debug, Default, Args)]
pub struct DepthArgs {
    /// Length of a step of depth.png, m: 0.001 where none is given, 1/256 as KITTI has it, 1/5000 as TUM has
    /// it
    #[arg(long, value_name = "M", value_parser = depth_unit, allow_negative_numbers = true)]
    pub depth_unit: Option<f64>,
    /// Depth beyond which answers are no points of cloud.ply, m: the farthest that the search can tell where
    /// none is given (farthest_m of summary.json)
    #[arg(long, value_name = "M", value_parser = max_depth, allow_negative_numbers = true)]
    pub max_depth: Option<f32>,
}

/// Files of depths.
pub struct DepthFiles {
    metres: Vec<f32>,
    samples: Vec<u16>,
    points: Vec<ColouredPoint>,
}

impl DepthFiles {
    /// Makes the files of a map, and says in the summary what they leave out.
    pub fn new(
        args: &DepthArgs,
        map: &DisparityMap,
        scale: &DepthScale,
        left: &RgbImage,
        summary: &mut Summary,
    ) -> Self {
        let unit_m = args.depth_unit.unwrap_or(MILLIMETRE);
        let Samples { samples, clamped } = Samples::of_depths(map, scale, unit_m);
        let metres = map.depth_m(scale);
        let max_m = args.max_depth.or(summary.depth.as_ref().and_then(|depth| depth.cloud_max_m));
        let points = points(map, scale, left, |pixel| max_m.is_none_or(|max_m| metres[pixel] <= max_m));
        if let Some(depth) = &mut summary.depth {
            depth.png_unit_m = unit_m;
            depth.png_clamped = clamped;
            depth.cloud_max_m = max_m;
            depth.cloud_left_out = map.answers() - points.len();
        }
        Self { metres, samples, points }
    }
}

/// A length in metres, as a number or a fraction.
pub fn depth_unit(text: &str) -> Result<f64, &'static str> {
    let value = match text.split_once('/') {
        Some((above, below)) => {
            above.parse::<f64>().ok().zip(below.parse().ok()).map(|(a, b): (f64, f64)| a / b)
        }
        None => text.parse().ok(),
    };
    value
        .filter(|value| (1e-6..=1.0).contains(value))
        .ok_or("a length from 0.000001 to 1 is needed, as 0.001 or 1/256")
}

fn max_depth(text: &str) -> Result<f32, &'static str> {
    let value = text.parse().ok().filter(|value| (1e-3..=1e6).contains(value));
    value.ok_or("a number from 0.001 to 1000000 is needed")
}

/// Writes all files of a run but those of the truth.
pub fn write(
    staging: &mut Staging,
    report: &Report<'_>,
    depth: Option<&DepthFiles>,
) -> Result<(), OutputError> {
    let map = report.map;
    let pixels = map.pixels();
    staging.write("disparity.pfm", |out| pfm::write(out, map.width, &pixels))?;
    staging.write("disparity.png", |out| png(out, &grey16(map, &Samples::of_disparities(map).samples)))?;
    // Of the search, not of the answers, so that two runs with the same search compare by eye.
    let first_px = f32::from(report.summary.min_disparity);
    let searched =
        ColourScale { far_px: first_px, near_px: first_px + f32::from(report.summary.disparities) };
    let colour = report.colours.unwrap_or(searched).picture(map.width, &pixels);
    staging.write("disparity_colour.png", |out| png(out, &colour))?;
    staging.write("flags.png", |out| png(out, &flags_raw(map)))?;
    staging.write("confidence.png", |out| png(out, &confidence_raw(map)))?;
    staging.write("summary.json", |out| json(out, report.summary))?;
    if let Some(DepthFiles { metres, samples, points }) = depth {
        let [depth_pfm, depth_png, cloud] = WITH_DEPTH;
        staging.write(depth_pfm, |out| pfm::write(out, map.width, metres))?;
        staging.write(depth_png, |out| png(out, &grey16(map, samples)))?;
        staging.write(cloud, |out| ply::write(out, points))?;
    }
    staging.write("report.html", |out| report.write(out))
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
        None => writeln!(text, "noise        {}, told, or not to be measured", s.noise),
    };
    if let Some(pair) = &s.pair {
        let _ = writeln!(text, "images       {}", pair.lacks());
    }
    if let Some(rows) = &s.rows {
        let _ = writeln!(text, "rows         {}", rows.summary());
    }
    if let Some(d) = s.disparity_px {
        let _ = writeln!(text, "disparity    {:.2} to {:.2} px, median {:.2} px", d.min, d.max, d.median);
    }
    if s.disparity_png_clamped > 0 {
        let clamped = s.disparity_png_clamped;
        let _ =
            writeln!(text, "disparity.png {clamped} answers from 256 px on are 65535 (not in disparity.pfm)");
    }
    if let Some(z) = s.depth.as_ref().and_then(|depth| depth.found_m) {
        let _ = writeln!(text, "depth        {:.3} to {:.3} m, median {:.3} m", z.min, z.max, z.median);
    }
    if let Some(depth) = s.depth.as_ref().filter(|depth| depth.png_clamped > 0) {
        let most_m = depth.png_unit_m * f64::from(u16::MAX);
        let _ = writeln!(
            text,
            "depth.png    {} answers beyond {most_m:.3} m are 65535 (--depth-unit)",
            depth.png_clamped
        );
    }
    if let Some(depth) = s.depth.as_ref().filter(|depth| depth.cloud_left_out > 0) {
        let where_from = match depth.cloud_max_m {
            Some(most_m) => format!("beyond {most_m:.3} m (--max-depth)"),
            None => "at infinity or behind".to_owned(),
        };
        let _ = writeln!(text, "cloud.ply    without {} answers {where_from}", depth.cloud_left_out);
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

fn grey16<'a>(map: &DisparityMap, samples: &'a [u16]) -> ImageBuffer<Luma<u16>, &'a [u16]> {
    ImageBuffer::from_raw(map.width as u32, map.height as u32, samples).expect("a sample for each pixel")
}

/// The answered pixels in space that are asked for by their number, with the left image's colours.
fn points(
    map: &DisparityMap,
    scale: &DepthScale,
    left: &RgbImage,
    is_asked: impl Fn(usize) -> bool,
) -> Vec<ColouredPoint> {
    let answers = map.disparity.iter().enumerate().zip(left.enumerate_pixels());
    let all = answers.filter_map(|((pixel, &d), (u, v, colour))| {
        // Images have at most 4096 columns and rows.
        let point = scale.point(u as u16, v as u16, d).filter(|_| is_asked(pixel))?;
        Some(ColouredPoint { position_m: [point.x, point.y, point.z], colour: colour.0 })
    });
    all.collect()
}
