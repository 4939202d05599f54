//! How well the rows of a pair agree: features of both pictures, and by how much the right camera is turned
//! by them.

use crate::pair::PairMatches;
use serde::Serialize;
use stereopsis::geometry::{
    camera::{Camera, ImageSize},
    rectify::{RowAlignment, RowHealth, RowMeter},
};

/// How far rows may be off before answers are lost, px.
const BORNE_PX: f64 = 0.25;
/// Standard deviations below its mean that a normal variable stays above with a probability of 95 %.
const ONE_SIDED_95: f64 = 1.645;

/// How far rows are off. Names are those of `summary.json`.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Rows {
    /// The root mean square over the image of how far the right image's rows are from the left one's, px.
    pub error_px: f64,
    /// Its standard deviation.
    pub sigma_px: f64,
    /// How much lower the right image shows what the left one shows, px: the root mean square over the image
    /// of what the pitch does.
    pub lower_px: f64,
    /// By how much the right camera is turned about the axis that points right, degrees; absent when no
    /// calibration tells the focal length.
    pub pitch_deg: Option<f64>,
    /// Its standard deviation.
    pub pitch_sigma_deg: Option<f64>,
    /// By how much it is turned about its own axis, degrees.
    pub roll_deg: f64,
    /// Its standard deviation.
    pub roll_sigma_deg: f64,
    /// Features that were matched.
    pub matches: usize,
    /// `good`: under 0.25 px; `worn`: up to 0.5 px, answers are lost; `bad`: more.
    pub health: &'static str,
}

impl Rows {
    /// Measures a pair with aligned rows by the camera that both pictures are of, where a calibration tells
    /// it. `None` where too few features match.
    pub fn measure(matches: &PairMatches, size: ImageSize, camera: Option<&Camera<f64>>) -> Option<Self> {
        // Without a calibration: a field of view of 53 degrees. Rows and the roll are the same by any other.
        let (w, h) = (f64::from(size.width), f64::from(size.height));
        let assumed = Camera::new(w, w, (w - 1.0) / 2.0, (h - 1.0) / 2.0).ok()?;
        let by = camera.unwrap_or(&assumed);
        let seen = &matches.in_rows;
        let mut meter = RowMeter::new();
        meter.add(by, seen).ok()?;
        Some(Self::of(&meter.alignment().ok()?, by, camera.is_some(), size, seen.len()))
    }

    fn of(
        found: &RowAlignment<f64>,
        camera: &Camera<f64>,
        is_calibrated: bool,
        size: ImageSize,
        matches: usize,
    ) -> Self {
        // What an angle alone does to rows.
        let alone = |axis: usize, rad: [f64; 3]| {
            let mut rotation_rad = [0.0; 3];
            rotation_rad[axis] = rad[axis];
            RowAlignment { rotation_rad, sigma_rad: [0.0; 3] }.row_error_px(camera, size)
        };
        let degrees = |rad: f64| is_calibrated.then(|| rad.to_degrees());
        Self {
            error_px: found.row_error_px(camera, size),
            sigma_px: (0..3).map(|axis| alone(axis, found.sigma_rad).powi(2)).sum::<f64>().sqrt(),
            lower_px: alone(0, found.rotation_rad).copysign(-found.rotation_rad[0]),
            pitch_deg: degrees(found.rotation_rad[0]),
            pitch_sigma_deg: degrees(found.sigma_rad[0]),
            roll_deg: found.rotation_rad[2].to_degrees(),
            roll_sigma_deg: found.sigma_rad[2].to_degrees(),
            matches,
            health: match found.health(camera, size) {
                RowHealth::Good => "good",
                RowHealth::Worn => "worn",
                RowHealth::Bad => "bad",
            },
        }
    }

    /// In a line.
    pub fn summary(&self) -> String {
        let health = match self.health {
            "worn" => "worn: some answers are lost",
            "bad" => "bad: many answers are lost",
            good => good,
        };
        let sure = if self.is_sure() { "" } else { ", but that is not sure" };
        format!("{:.2} px off (+- {:.2}), {health}{sure}", self.error_px, self.sigma_px)
    }

    /// Whether with a probability of 95 % the rows are on that side of what matching bears.
    fn is_sure(&self) -> bool {
        (self.error_px - BORNE_PX).abs() >= ONE_SIDED_95 * self.sigma_px
    }

    /// What is wrong, where with a probability of 95 % it is more than matching bears.
    pub fn warning(&self) -> Option<String> {
        let is_off = self.error_px > BORNE_PX && self.is_sure();
        let turned = match self.pitch_deg {
            Some(pitch) => format!("the right camera seems turned: pitch {pitch:+.2} degrees"),
            None => {
                let side = if self.lower_px < 0.0 { "higher" } else { "lower" };
                format!("the right image stands {:.2} px {side} than the left one", self.lower_px.abs())
            }
        };
        is_off.then(|| {
            format!(
                "the rows of the images are {:.2} px (+- {:.2}) off, over 0.25 px costs answers; {turned}, \
                 roll {:+.2} degrees; calibrate anew or rectify",
                self.error_px, self.sigma_px, self.roll_deg
            )
        })
    }
}
