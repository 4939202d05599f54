//! How well the rows of a pair agree: features of both pictures, and by how much the right camera is turned
//! by them.

use crate::correspond::{Plan, correspond};
use image::GrayImage;
use nalgebra::Point2;
use serde::Serialize;
use stereopsis::features::Orientation;
use stereopsis::geometry::{
    camera::{Camera, ImageSize},
    rectify::{RowAlignment, RowHealth, RowMeter},
    two_view::Correspondence,
};

/// Corners that are looked for: enough for a few hundredths of a pixel, in a few milliseconds.
const CORNERS: u16 = 600;
/// Partners are at most so many rows apart, px: what is more is another corner, or no pair to be matched.
const ROWS_APART: f64 = 12.0;
/// Corners are so far from what a camera did not see, px: its border is none.
const MARGIN: i64 = 6;

/// How far rows are off. Names are those of `summary.json`.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Rows {
    /// The root mean square over the image of how far the right image's rows are from the left one's, px.
    pub error_px: f64,
    /// Its standard deviation.
    pub sigma_px: f64,
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
    /// it; `valid` is 0 where a picture shows nothing. `None` where too few features match.
    pub fn measure(
        pictures: [&GrayImage; 2],
        valid: Option<[&GrayImage; 2]>,
        camera: Option<&Camera<f64>>,
    ) -> Option<Self> {
        let (width, height) = pictures[0].dimensions();
        let size = ImageSize { width: u16::try_from(width).ok()?, height: u16::try_from(height).ok()? };
        // Without a calibration: a field of view of 53 degrees. Rows and the roll are the same by any other.
        let (w, h) = (f64::from(width), f64::from(height));
        let assumed = Camera::new(w, w, (w - 1.0) / 2.0, (h - 1.0) / 2.0).ok()?;
        let by = camera.unwrap_or(&assumed);
        let plan =
            Plan { corners: CORNERS, levels: 1, orientation: Some(Orientation::Upright), ..Plan::default() };
        let found = correspond(&plan, pictures[0], pictures[1]).ok()?;
        let seen = found.points().map(|[x1, y1, x2, y2]| Correspondence {
            first: Point2::new(x1, y1).cast::<f64>(),
            second: Point2::new(x2, y2).cast(),
        });
        let is_shown = |s: &Correspondence<f64>| {
            valid.is_none_or(|[left, right]| is_within(left, &s.first) && is_within(right, &s.second))
        };
        let seen: Vec<_> =
            seen.filter(|s| (s.first.y - s.second.y).abs() < ROWS_APART && is_shown(s)).collect();
        let mut meter = RowMeter::new();
        meter.add(by, &seen).ok()?;
        Some(Self::of(&meter.alignment().ok()?, by, camera.is_some(), size, seen.len()))
    }

    fn of(
        found: &RowAlignment<f64>,
        camera: &Camera<f64>,
        is_calibrated: bool,
        size: ImageSize,
        matches: usize,
    ) -> Self {
        // What each angle's deviation alone would be in rows.
        let alone = |axis: usize| {
            let mut rotation_rad = [0.0; 3];
            rotation_rad[axis] = found.sigma_rad[axis];
            RowAlignment { rotation_rad, sigma_rad: [0.0; 3] }.row_error_px(camera, size)
        };
        let degrees = |rad: f64| is_calibrated.then(|| rad.to_degrees());
        Self {
            error_px: found.row_error_px(camera, size),
            sigma_px: (0..3).map(|axis| alone(axis).powi(2)).sum::<f64>().sqrt(),
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
        format!("{:.2} px off (+- {:.2}), {}", self.error_px, self.sigma_px, self.health)
    }

    /// What is wrong, where it is surely more than matching bears.
    pub fn warning(&self) -> Option<String> {
        let is_off = self.health != "good" && self.error_px - 3.0 * self.sigma_px > 0.25;
        let turned = match self.pitch_deg {
            Some(pitch) => format!("pitch {pitch:+.2} degrees, roll {:+.2} degrees", self.roll_deg),
            None => format!("roll {:+.2} degrees", self.roll_deg),
        };
        is_off.then(|| {
            format!(
                "the rows of the images are {:.2} px (+- {:.2}) off, over 0.25 px costs answers; the right \
                 camera seems turned: {turned}; calibrate anew or rectify",
                self.error_px, self.sigma_px
            )
        })
    }
}

/// Whether a place and what is around it is shown.
fn is_within(valid: &GrayImage, place: &Point2<f64>) -> bool {
    let at = |dx: i64, dy: i64| {
        let (x, y) = (place.x.round() as i64 + dx, place.y.round() as i64 + dy);
        let pixel = u32::try_from(x).ok().zip(u32::try_from(y).ok());
        pixel.and_then(|(x, y)| valid.get_pixel_checked(x, y)).is_some_and(|pixel| pixel.0[0] != 0)
    };
    [(-MARGIN, -MARGIN), (MARGIN, -MARGIN), (-MARGIN, MARGIN), (MARGIN, MARGIN)]
        .into_iter()
        .all(|(x, y)| at(x, y))
}
