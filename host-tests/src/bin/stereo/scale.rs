//! The scale of depths in a pair that is rectified already.

use crate::failure::Failure;
use crate::input::Pair;
use crate::match_args::MatchArgs;
use crate::shared::Unit;
use crate::uncalibrated::is_uncalibrated;
use std::path::{Path, PathBuf};
use stereopsis::depth::DepthScale;
use stereopsis::geometry::camera::{Camera, ImageSize, RectifiedRig};
use stereopsis_host::calibration::{Calibration, off_middle};

/// The camera of a rectified pair.
pub fn camera(rig: &RectifiedRig) -> Option<Camera<f64>> {
    let (f, (cx, cy)) = (f64::from(rig.focal_px()), rig.principal_point());
    Camera::new(f, f, cx.into(), cy.into()).ok()
}

/// The scale of depths in images that are rectified already, where there is a calibration. Of matches alone
/// there is none.
pub fn scale(args: &MatchArgs, pair: &Pair) -> Result<Option<DepthScale>, Failure> {
    if args.options.alpha.is_some() {
        return Err(Failure::usage("--alpha: is for raw images; give --rectify too"));
    }
    let size = ImageSize { width: pair.width, height: pair.height };
    if let Some(rig) = args.typed.numbers(size) {
        return of_numbers(rig, size).map(Some);
    }
    match args.calib.len() {
        0 if args.depth.depth_unit.is_some() || args.depth.max_depth.is_some() => {
            let option = if args.depth.depth_unit.is_some() { "--depth-unit" } else { "--max-depth" };
            return Err(Failure::usage(format!(
                "{option}: is of depths; give --calib too, or --focal-px and --baseline-mm"
            )));
        }
        0 if args.options.unit.is_some() => {
            return Err(Failure::usage("--unit: is that of --calib, which is missing"));
        }
        0 => return Ok(None),
        1 if is_uncalibrated(&args.calib[0]) => {
            let is_of_depths = args.depth.depth_unit.is_some() || args.depth.max_depth.is_some();
            return if is_of_depths || args.watch.obstacles {
                let path = args.calib[0].display();
                Err(Failure::new(format!(
                    "{path}: is of matches alone and knows no depths; give a calibration"
                )))
            } else {
                Ok(None)
            };
        }
        1 | 2 => {}
        _ => {
            return Err(Failure::usage(
                "--calib: is given more than twice; a file of both cameras or one of each is needed",
            ));
        }
    }
    of_files(&args.calib, args.options.unit, &pair.inputs[0], size).map(Some)
}

/// What is wrong with a calibration that is most likely of images of another size.
pub fn off_middle_of(calib: &[PathBuf], scale: &DepthScale, size: ImageSize) -> Option<String> {
    let (path, (cx, cy)) = (calib.first()?, scale.rig().principal_point());
    let off = off_middle((cx.into(), cy.into()), size)?;
    let path = path.display();
    Some(format!("{path}: {off}: depths are wrong if it was made for images of another size"))
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
