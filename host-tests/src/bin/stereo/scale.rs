//! The scale of depths in a pair that is rectified already.

use crate::failure::Failure;
use crate::input::Pair;
use crate::match_args::MatchArgs;
use crate::shared::Unit;
use stereopsis::depth::DepthScale;
use stereopsis::geometry::camera::{Camera, RectifiedRig};
use stereopsis_host::calibration::Calibration;

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
    if let Some((focal_px, baseline_mm)) = args.focal_px.zip(args.baseline_mm) {
        let [cx, cy] = [pair.width, pair.height].map(|side| (f32::from(side) - 1.0) / 2.0);
        let rig = RectifiedRig::new(focal_px, baseline_mm / 1000.0, cx, cy);
        let scale =
            rig.map_err(|e| e.to_string()).and_then(|rig| DepthScale::new(&rig).map_err(|e| e.to_string()));
        return scale.map(Some).map_err(|e| Failure::new(format!("--focal-px, --baseline-mm: {e}")));
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
    let calibration =
        Calibration::open_all(&args.calib, &pair.inputs[0], args.options.unit.map(Unit::metres))?;
    calibration.check_size(pair.width, pair.height)?;
    let scale = DepthScale::new(&calibration.rig);
    scale.map(Some).map_err(|e| Failure::new(format!("{}: {e}", calibration.path.display())))
}
