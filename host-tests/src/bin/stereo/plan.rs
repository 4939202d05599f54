//! `stereo plan`: what a rig of two cameras can tell, and what it takes, before it is built.

use crate::failure::Failure;
use crate::shared::{image_size, length, method, print};
use crate::typed_rig::{self, angle};
use clap::Args;
use stereopsis::geometry::camera::ImageSize;
use stereopsis::matching::Config;
use stereopsis_host::plan::{CORES, Plan, Rig, Wanted};
use stereopsis_host::run::MethodName;

/// What follows the options in the command's help.
pub const EXAMPLE: &str = "Examples:
  stereo plan --baseline-mm 60 --focal-px 420 --size 320x240 --nearest 0.4 --farthest 5
  stereo plan --baseline-mm 60 --focal-mm 2.1 --sensor-width-mm 2.88 --size 320x240 --nearest 0.4 \
                           --farthest 5 --core m7 --method fast --frame-rate 15

Printed are the search, depths with their deviations, what both cameras see, memory, and estimates of the \
                           work on each core; then what limits the rig and what to change.";

#[derive(Debug, Args)]
pub struct PlanArgs {
    /// Distance of the two cameras, mm
    #[arg(long, value_name = "MM", value_parser = length, allow_negative_numbers = true)]
    baseline_mm: f32,
    #[command(flatten)]
    lens: LensArgs,
    /// Width of the sensor's active area, mm
    #[arg(long, value_name = "MM", requires = "focal_mm", conflicts_with_all = ["focal_px", "field_of_view"],
        value_parser = length, allow_negative_numbers = true)]
    sensor_width_mm: Option<f32>,
    /// Columns and rows of the images that are matched
    #[arg(long, value_name = "COLUMNSxROWS", value_parser = image_size)]
    size: ImageSize,
    /// The nearest depth that is wanted, m
    #[arg(long, value_name = "M", value_parser = length, allow_negative_numbers = true)]
    nearest: f32,
    /// The farthest, m
    #[arg(long, value_name = "M", value_parser = length, allow_negative_numbers = true)]
    farthest: f32,
    /// The standard deviation of the farthest depth that is wanted, percent of it
    #[arg(long, value_name = "PERCENT", default_value = "5", value_parser = percent, allow_negative_numbers =
        true)]
    accuracy: f64,
    /// How many frames a second are wanted
    #[arg(long, value_name = "HZ", value_parser = length, allow_negative_numbers = true)]
    frame_rate: Option<f32>,
    /// How much RAM there is for a pipeline and its stack, KB of 1024 bytes
    #[arg(long, value_name = "KB", value_parser = length, allow_negative_numbers = true)]
    ram_kb: Option<f32>,
    /// A core: m0, m3, m4, m7, m33, m55, rv32 or rv32v; all of them where none is given
    #[arg(long, value_name = "CORE", value_parser = core)]
    core: Option<&'static str>,
    /// The clock, MHz; that of a well-known microcontroller with the core where none is given
    #[arg(long, value_name = "MHZ", value_parser = length, allow_negative_numbers = true)]
    clock_mhz: Option<f32>,
    /// A method, as for match; all of them where none is given
    #[arg(long, value_name = "METHOD", value_parser = method)]
    method: Option<MethodName>,
    /// Print one JSON object in place of text
    #[arg(long)]
    json: bool,
}

/// How wide the lenses see: one of three.
#[derive(Debug, Args)]
#[group(required = true, multiple = false)]
struct LensArgs {
    /// Focal length, px of the images that are matched
    #[arg(long, value_name = "PX", value_parser = length, allow_negative_numbers = true)]
    focal_px: Option<f32>,
    /// Focal length of the lens, mm
    #[arg(long, value_name = "MM", requires = "sensor_width_mm", value_parser = length,
        allow_negative_numbers = true)]
    focal_mm: Option<f32>,
    /// Horizontal field of view, degrees, 1 to 170
    #[arg(long, alias = "fov", value_name = "DEGREES", value_parser = angle, allow_negative_numbers = true)]
    field_of_view: Option<f64>,
}

pub fn percent(text: &str) -> Result<f64, &'static str> {
    let value = text.parse().ok().filter(|value| (0.01..=100.0).contains(value));
    value.ok_or("a number from 0.01 to 100 is needed")
}

fn core(text: &str) -> Result<&'static str, String> {
    let found = CORES.into_iter().map(|(name, _)| name).find(|name| *name == text);
    found.ok_or_else(|| {
        let names: Vec<_> = CORES.into_iter().map(|(name, _)| name).collect();
        format!("the cores are {}", names.join(", "))
    })
}

/// The number that was typed: `0.4` is not 0.4000000059604645.
fn exact(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(f64::from(value))
}

pub fn run(args: &PlanArgs) -> Result<(), Failure> {
    let ImageSize { width, height } = args.size;
    if width < Config::FEWEST_DISPARITIES {
        let least = Config::FEWEST_DISPARITIES;
        return Err(Failure::new(format!("--size {width}x{height}: at least {least} columns are needed")));
    }
    let [nearest_m, farthest_m] = range(args.nearest, args.farthest)?;
    let (baseline_m, focal_px) = (exact(args.baseline_mm) / 1000.0, focal_px(args)?);
    let rig = Rig { baseline_m, focal_px, offset_px: 0.0, width, height };
    let clock = |(core, mhz)| (core, args.clock_mhz.map_or(mhz, exact));
    let cores = CORES.into_iter().filter(|(core, _)| args.core.is_none_or(|only| only == *core));
    let methods = MethodName::ALL.into_iter().filter(|method| args.method.is_none_or(|only| only == *method));
    let wanted = Wanted {
        nearest_m,
        farthest_m,
        accuracy: args.accuracy / 100.0,
        frames_per_s: args.frame_rate.map(exact),
        ram_bytes: args.ram_kb.map(|kb| (exact(kb) * 1024.0) as usize),
        cores: cores.map(clock).collect(),
        methods: methods.map(MethodName::name).collect(),
    };
    let plan = Plan::new(rig, wanted);
    if args.json {
        return print(&(serde_json::to_string_pretty(&plan)? + "\n"));
    }
    print(&plan.describe())
}

/// Depths of which the first one is nearer, m.
pub fn range(nearest: f32, farthest: f32) -> Result<[f64; 2], Failure> {
    let [nearest_m, farthest_m] = [nearest, farthest].map(exact);
    if nearest_m >= farthest_m {
        return Err(Failure::usage(format!(
            "--nearest {nearest_m}: is not nearer than --farthest {farthest_m}; give the smaller depth first"
        )));
    }
    Ok([nearest_m, farthest_m])
}

/// The focal length by whichever option says it, px.
fn focal_px(args: &PlanArgs) -> Result<f64, Failure> {
    let width = f64::from(args.size.width);
    let LensArgs { focal_px, focal_mm, field_of_view } = args.lens;
    let lens = focal_mm.zip(args.sensor_width_mm).map(|(f, sensor)| exact(f) / exact(sensor) * width);
    let seen = field_of_view.map(|degrees| typed_rig::focal_px(degrees, args.size.width));
    let found = focal_px.map(exact).or(lens).or(seen);
    found.ok_or_else(|| Failure::usage("--focal-px: is missing; give it, --focal-mm or --field-of-view"))
}
