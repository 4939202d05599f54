//! How well the rows of a pair agree: features of both pictures, and by how much the right camera is turned
//! by them.

use crate::pair::{PairMatches, RowFit};
use serde::Serialize;
use stereopsis::geometry::{
    camera::{Camera, ImageSize},
    rectify::{RowAlignment, RowHealth},
};

/// How far rows may be off before answers are lost, px.
pub const BORNE_PX: f64 = 0.25;
/// Standard deviations below its mean that a normal variable stays above with a probability of 95 %.
const ONE_SIDED_95: f64 = 1.645;

/// How far rows are off. Names are those of `summary.json`.
#[derive(Clone, Copy, PartialEq, Debug, Serialize)]
pub struct Rows {
    /// The root mean square over the image of how far the right image's rows are from the left one's, px, by
    /// these angles and that scale.
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
    /// By how much it is turned about the axis that points down, degrees, as far as rows show it, which is
    /// little; absent when no calibration tells the focal length.
    pub yaw_deg: Option<f64>,
    /// Its standard deviation.
    pub yaw_sigma_deg: Option<f64>,
    /// Features that were matched.
    pub matches: usize,
    /// The share of them whose rows these angles explain, up to a pixel.
    pub agreeing: f64,
    /// How many times as large as the left image the right one is, where that moves rows by more than 0.25
    /// px; else 1.
    pub scale: f64,
    /// `good`: under 0.25 px; `worn`: up to 0.5 px, answers are lost; `bad`: more.
    pub health: &'static str,
    /// The turn of the right camera.
    #[serde(skip)]
    pub alignment: RowAlignment<f64>,
    /// What the angles do to rows, px.
    #[serde(skip)]
    turned_px: f64,
    /// What the yaw does to rows, and its standard deviation, px.
    #[serde(skip)]
    by_yaw_px: [f64; 2],
    /// Whether most of the matches say so: where most are wrong, any angle explains some of them.
    #[serde(skip)]
    is_agreed: bool,
}

impl Rows {
    /// Measures a pair with aligned rows by the camera that both pictures are of, where a calibration tells
    /// it. `None` where too few features match.
    pub fn measure(matches: &PairMatches, size: ImageSize, camera: Option<&Camera<f64>>) -> Option<Self> {
        // Without a calibration: a field of view of 53 degrees. Rows and the roll are the same by any other.
        let (w, h) = (f64::from(size.width), f64::from(size.height));
        let assumed = Camera::new(w, w, (w - 1.0) / 2.0, (h - 1.0) / 2.0).ok()?;
        let by = camera.unwrap_or(&assumed);
        let fit = RowFit::of(&matches.in_rows, by)?;
        // What is turned far, or larger, has many matches in other rows, and rows that no small turn
        // explains.
        let of_all = || RowFit::of(&matches.all, by).filter(RowFit::is_agreed);
        let is_scaled = |scaled: &RowFit| {
            let [px, sigma] = scaled.by_scale_px(size.height);
            scaled.is_agreed() && scaled.agreeing >= fit.agreeing && px > BORNE_PX && px > 3.0 * sigma
        };
        let scaled = || fit.with_scale(&matches.in_rows, by).filter(is_scaled);
        let fit =
            if fit.is_agreed() { scaled().unwrap_or(fit) } else { of_all().or_else(scaled).unwrap_or(fit) };
        Some(Self::of(&fit, by, camera.is_some(), size))
    }

    fn of(fit: &RowFit, camera: &Camera<f64>, is_calibrated: bool, size: ImageSize) -> Self {
        let found = &fit.alignment;
        // What an angle alone does to rows.
        let alone = |axis: usize, rad: [f64; 3]| {
            let mut rotation_rad = [0.0; 3];
            rotation_rad[axis] = rad[axis];
            RowAlignment { rotation_rad, sigma_rad: [0.0; 3] }.row_error_px(camera, size)
        };
        let (turned_px, [scaled_px, scale_sigma_px]) =
            (found.row_error_px(camera, size), fit.by_scale_px(size.height));
        let error_px = turned_px.hypot(scaled_px);
        let degrees = |rad: f64| is_calibrated.then(|| rad.to_degrees());
        Self {
            error_px,
            sigma_px: (0..3).map(|axis| alone(axis, found.sigma_rad)).fold(scale_sigma_px, f64::hypot),
            lower_px: alone(0, found.rotation_rad).copysign(-found.rotation_rad[0]),
            pitch_deg: degrees(found.rotation_rad[0]),
            pitch_sigma_deg: degrees(found.sigma_rad[0]),
            roll_deg: found.rotation_rad[2].to_degrees(),
            roll_sigma_deg: found.sigma_rad[2].to_degrees(),
            yaw_deg: degrees(found.rotation_rad[1]),
            yaw_sigma_deg: degrees(found.sigma_rad[1]),
            by_yaw_px: [alone(1, found.rotation_rad), alone(1, found.sigma_rad)],
            matches: fit.matches,
            agreeing: fit.agreeing,
            scale: fit.scale,
            alignment: *found,
            is_agreed: fit.is_agreed(),
            turned_px,
            health: match RowHealth::of_error_px(error_px) {
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
        self.is_agreed && (self.error_px - BORNE_PX).abs() >= ONE_SIDED_95 * self.sigma_px
    }

    /// What is wrong, where with a probability of 95 % it is more than matching bears.
    pub fn warning(&self) -> Option<String> {
        if !(self.error_px > BORNE_PX && self.is_sure()) {
            return None;
        }
        let mut turned = match self.pitch_deg {
            Some(pitch) => format!("the right camera seems turned: pitch {pitch:+.2} degrees"),
            None => {
                let side = if self.lower_px < 0.0 { "higher" } else { "lower" };
                format!("the right image stands {:.2} px {side} than the left one", self.lower_px.abs())
            }
        };
        turned += &format!(", roll {:+.2} degrees", self.roll_deg);
        let [by_yaw, sigma] = self.by_yaw_px;
        if by_yaw > BORNE_PX && by_yaw > 3.0 * sigma {
            turned += &match self.yaw_deg {
                Some(yaw) => format!(", yaw {yaw:+.2} degrees"),
                None => format!(", and {by_yaw:.2} px are of a turn about the vertical or another scale"),
            };
        }
        let share = 100.0 * (self.scale - 1.0);
        let size = if share > 0.0 { "larger" } else { "smaller" };
        let scaled = format!(
            "the right image is {:.1} % {size} than the left one: the focal lengths differ, or the pair is \
             not rectified",
            share.abs()
        );
        let why = match (self.scale != 1.0, self.turned_px > BORNE_PX) {
            (false, _) => turned,
            (true, false) => scaled,
            (true, true) => format!("{scaled}; {turned}"),
        };
        Some(format!(
            "the rows of the images are {:.2} px (+- {:.2}) off, over 0.25 px costs answers; {why}; \
             calibrate anew or rectify",
            self.error_px, self.sigma_px
        ))
    }
}
