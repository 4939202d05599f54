//! `rectified.json` of `rectify` and `match`: the cameras of a rectified pair.

use crate::failure::Failure;
use crate::shared::{RectifyOptions, Unit};
use nalgebra::{DMatrix, Matrix3};
use serde::Serialize;
use std::path::PathBuf;
use stereopsis::geometry::{
    camera::ImageSize,
    rectify::{Crop, Rectification, RectificationReport},
};
use stereopsis_host::calibration::RawCalibration;

/// What `rectify` calls the cameras that it writes, and the masks of what they see, left and right.
pub const CAMERAS: &str = "rectified.json";
pub const MASKS: [&str; 2] = ["valid_left.png", "valid_right.png"];

/// What `rectified.json` holds. Names are a contract with programs that read it.
#[derive(Serialize)]
pub struct RectifiedCameras {
    /// The calibration's format.
    calibration: &'static str,
    /// `horizontal`: rows are aligned; `vertical`: columns.
    pub axis: &'static str,
    width: u16,
    height: u16,
    /// The camera that both rectified images are of.
    focal_px: f64,
    cx: f64,
    cy: f64,
    baseline_m: f64,
    /// `(X Y Z W)^T = Q (u v d 1)^T`, metres.
    q: Vec<Vec<f64>>,
    left: Side,
    right: Side,
    /// The share of the rectified image that both cameras see.
    common: f64,
    /// Across and down, of what both see.
    field_of_view_deg: [f64; 2],
}

#[derive(Serialize)]
struct Side {
    /// `K [1 | t]` in the left rectified camera, as OpenCV's P1 and P2.
    projection: Vec<Vec<f64>>,
    /// From the raw camera's frame into the rectified one's, as OpenCV's R1 and R2.
    rotation: Vec<Vec<f64>>,
    /// Raw rows that the remap holds at once.
    rows: u16,
    /// The share of the rectified image that the camera sees.
    seen: f64,
    /// The largest way of a pixel, px.
    largest_warp_px: f64,
}

/// The rig of a calibration for images of that size, and its rectification.
pub fn open(
    calib: &[PathBuf],
    options: &RectifyOptions,
    size: ImageSize,
) -> Result<(RawCalibration, Rectification<f64>), Failure> {
    if calib.len() > 2 {
        return Err(Failure::usage(
            "--calib: is given more than twice; a file of both cameras or one of each is needed",
        ));
    }
    let calibration = RawCalibration::open(calib, Some(size), options.unit.map(Unit::metres))?;
    let crop = options.alpha.map_or(Crop::Natural, Crop::Alpha);
    let rectification = Rectification::new(&calibration.rig, crop, size)
        .map_err(|e| Failure::new(format!("{}: {e}", calibration.path.display())))?;
    Ok((calibration, rectification))
}

impl RectifiedCameras {
    /// The figures in a few lines.
    pub fn figures(&self) -> String {
        format!(
            "camera       f {:.2} px, baseline {:.4} m\nboth see     {:.1} % of the image\nrows held    {} \
             left, {} right\n",
            self.focal_px,
            self.baseline_m,
            100.0 * self.common,
            self.left.rows,
            self.right.rows
        )
    }

    pub fn new(
        calibration: &'static str,
        rectification: &Rectification<f64>,
        rows: [u16; 2],
        report: &RectificationReport<f64>,
    ) -> Self {
        let camera = rectification.camera();
        let (focal_px, (cx, cy)) = (camera.focal_px().0, camera.principal_point());
        let is_horizontal = rectification.axis().is_horizontal();
        let side = |i: usize, away: f64| {
            let mut projection = DMatrix::zeros(3, 4);
            projection.view_mut((0, 0), (3, 3)).copy_from(&camera.matrix());
            projection[(usize::from(!is_horizontal), 3)] = -focal_px * away;
            let rotation: &Matrix3<f64> = rectification.warps()[i].rotation();
            Side {
                projection: rows_of(&projection),
                rotation: rows_of(&DMatrix::from_fn(3, 3, |r, c| rotation[(r, c)])),
                rows: rows[i],
                seen: report.seen[i],
                largest_warp_px: report.largest_warp_px[i],
            }
        };
        let q = rectification.q();
        Self {
            calibration,
            axis: if is_horizontal { "horizontal" } else { "vertical" },
            width: rectification.size().width,
            height: rectification.size().height,
            focal_px,
            cx,
            cy,
            baseline_m: rectification.baseline_m(),
            q: rows_of(&DMatrix::from_fn(4, 4, |r, c| q[(r, c)])),
            left: side(0, 0.0),
            right: side(1, rectification.baseline_m()),
            common: report.common,
            field_of_view_deg: report.field_of_view_rad.map(f64::to_degrees),
        }
    }
}

fn rows_of(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
}
