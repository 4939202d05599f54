//! The scale of depths in a pair that is rectified already.

use crate::failure::Failure;
use crate::input::Pair;
use crate::match_args::MatchArgs;
use crate::shared::{Unit, length};
use clap::Args;
use std::path::{Path, PathBuf};
use stereopsis::depth::DepthScale;
use stereopsis::geometry::camera::{Camera, ImageSize, RectifiedRig};
use stereopsis_host::calibration::Calibration;

/// Rectified cameras in numbers, where there is no file.
#[derive(Clone, Debug, Args)]
pub struct TypedRig {
    #[command(flatten)]
    lens: TypedLens,
    /// Distance of the two cameras, mm
    #[arg(long, value_name = "MM", requires = "typed_lens", value_parser = length, allow_negative_numbers =
        true)]
    baseline_mm: Option<f32>,
}

/// How wide rectified cameras see, where there is no file: their centre is taken to be that of the images.
#[derive(Clone, Debug, Args)]
#[group(id = "typed_lens", multiple = false, conflicts_with = "calib", requires = "baseline_mm")]
struct TypedLens {
    /// Focal length of the rectified cameras, px, where there is no file: their centre is taken to be that of
    /// the images
    #[arg(long, value_name = "PX", value_parser = length, allow_negative_numbers = true)]
    focal_px: Option<f32>,
    /// Their horizontal field of view in place of it, degrees, 1 to 170
    #[arg(long, alias = "fov", value_name = "DEGREES", value_parser = angle, allow_negative_numbers = true)]
    field_of_view: Option<f64>,
}

impl TypedRig {
    /// Whether there are numbers.
    pub fn is_given(&self) -> bool {
        self.baseline_mm.is_some()
    }

    /// The focal length, px, and the baseline, mm, of images of a size.
    pub fn numbers(&self, size: ImageSize) -> Option<(f32, f32)> {
        let seen = self.lens.field_of_view.map(|degrees| focal_px(degrees, size.width) as f32);
        self.lens.focal_px.or(seen).zip(self.baseline_mm)
    }
}

/// The focal length of cameras that see so many degrees along their rows, px.
pub fn focal_px(degrees: f64, width: u16) -> f64 {
    f64::from(width) / 2.0 / (degrees.to_radians() / 2.0).tan()
}

/// Parses a field of view, degrees.
pub fn angle(text: &str) -> Result<f64, &'static str> {
    let value = text.parse().ok().filter(|value| (1.0..=170.0).contains(value));
    value.ok_or("a number from 1 to 170 is needed")
}

/// The camera of a rectified pair.
pub fn camera(rig: &RectifiedRig) -> Option<Camera<f64>> {
    let (f, (cx, cy)) = (f64::from(rig.focal_px()), rig.principal_point());
    Camera::new(f, f, cx.into(), cy.into()).ok()
}

/// The scale of depths in images that are rectified already, where there is a calibration.
pub fn scale(args: &MatchArgs, pair: &Pair) -> Result<Option<DepthScale>, Failure> {
    if args.options.alpha.is_some() {
        return Err(Failure::new("--alpha: is for raw images; give --rectify too"));
    }
    let size = ImageSize { width: pair.width, height: pair.height };
    if let Some(rig) = args.typed.numbers(size) {
        return of_numbers(rig, size).map(Some);
    }
    match args.calib.len() {
        0 if args.depth.depth_unit.is_some() || args.depth.max_depth.is_some() => {
            return Err(Failure::new("--depth-unit, --max-depth: are of depths; give --calib too"));
        }
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
    of_files(&args.calib, args.options.unit, &pair.inputs[0], size).map(Some)
}

/// The scale of a focal length, px, and a baseline, mm, with the principal point in the middle of the images.
pub fn of_numbers((focal_px, baseline_mm): (f32, f32), size: ImageSize) -> Result<DepthScale, Failure> {
    let [cx, cy] = [size.width, size.height].map(|side| (f32::from(side) - 1.0) / 2.0);
    let rig = RectifiedRig::new(focal_px, baseline_mm / 1000.0, cx, cy);
    let scale =
        rig.map_err(|e| e.to_string()).and_then(|rig| DepthScale::new(&rig).map_err(|e| e.to_string()));
    scale.map_err(|e| Failure::new(format!("--focal-px, --baseline-mm: {e}")))
}

/// The scale of calibration files, for images of a size.
pub fn of_files(
    calib: &[PathBuf],
    unit: Option<Unit>,
    left: &Path,
    size: ImageSize,
) -> Result<DepthScale, Failure> {
    let calibration = Calibration::open_all(calib, left, unit.map(Unit::metres))?;
    calibration.check_size(size.width, size.height)?;
    let scale = DepthScale::new(&calibration.rig);
    scale.map_err(|e| Failure::new(format!("{}: {e}", calibration.path.display())))
}
