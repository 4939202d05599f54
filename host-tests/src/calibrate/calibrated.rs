//! A calibrated rig, what its views fit, and why there is none.

use super::board::Board;
use nalgebra::{Point2, Vector2};
use std::fmt::Write;
use stereopsis::geometry::camera::{StereoRig, StereoRigError};

/// The corners of one board in both pictures of a moment, px.
#[derive(Clone, PartialEq, Debug)]
pub struct View {
    /// In the left and in the right picture.
    pub corners: [Vec<Point2<f64>>; 2],
    /// Which of [`Pattern::places`](super::board::Pattern::places) each of them is.
    pub numbers: [Vec<usize>; 2],
}

impl View {
    /// Boards of which all corners are seen, in their order.
    pub fn whole(corners: [Vec<Point2<f64>>; 2]) -> Self {
        let numbers = corners.each_ref().map(|corners| (0..corners.len()).collect());
        Self { corners, numbers }
    }

    /// What is seen of a board in the left and in the right picture.
    pub fn new([left, right]: [Board; 2]) -> Self {
        Self { corners: [left.corners, right.corners], numbers: [left.numbers, right.numbers] }
    }
}

/// What is left of a view.
#[derive(Clone, PartialEq, Debug)]
pub struct ViewFigures {
    /// For the left and the right picture, corner by corner what is seen less what is expected, px.
    pub residuals: [Vec<Vector2<f64>>; 2],
    /// Their root mean square, of each picture, px.
    pub rms_px: [f64; 2],
    /// How far away the middle of the board was, m.
    pub distance_m: f64,
    /// How far the board was turned about the left picture's upright axis and about its level one, degrees: 0
    /// of a board that faces the camera.
    pub tilt_deg: [f64; 2],
}

/// A rig from views of a board. Its standard deviations hold where residuals of one view go together, as
/// those of a board that is not flat do.
#[derive(Clone, PartialEq, Debug)]
pub struct Calibrated {
    /// The rig, metres.
    pub rig: StereoRig<f64>,
    /// The root mean square of all residuals, px: as OpenCV counts it, of points and not of coordinates.
    pub rms_px: f64,
    /// The same of each camera when it is found by itself: where both together are much worse, the pictures
    /// of a pair are not of one moment, or the cameras moved against each other.
    pub alone_px: [f64; 2],
    /// Of each view.
    pub views: Vec<ViewFigures>,
    /// Standard deviation of the focal length of each camera, px, the greater of fx and fy.
    pub focal_sigma_px: [f64; 2],
    /// Standard deviation of the baseline, m.
    pub baseline_sigma_m: f64,
    /// How far the right camera is turned along the baseline against the left one (yaw, of cameras side by
    /// side), and its standard deviation, radians.
    pub yaw_rad: [f64; 2],
    /// Standard deviation of what is added to all disparities by an error of that turn and of both principal
    /// points together, px: what of it is in the one is taken from the other.
    pub disparity_sigma_px: f64,
}

/// Why there is no rig.
#[derive(Clone, Copy, PartialEq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SolveError {
    /// Too few views.
    #[error(
        "{views} views are too few; at least {} with the board turned each time are needed",
        Calibrated::LEAST_VIEWS
    )]
    TooFew {
        /// How many there are.
        views: usize,
    },
    /// No camera explains what the left or the right one saw.
    #[error(
        "the {0} camera cannot be found from these views; turn the board more, about two axes, in some of \
         them"
    )]
    Camera(&'static str),
    /// The two pictures of too many views are not of one moment.
    #[error(
        "each camera by itself fits {alone_px:.2} px, and both together {together_px:.1} px: the images of \
         too many pairs are not of one moment, or one camera's are upside down or mirrored; are both lists \
         in the same order, without gaps?"
    )]
    NotPaired {
        /// The re-projection error of the worse camera by itself, px.
        alone_px: f64,
        /// That of both together.
        together_px: f64,
    },
    /// The result is no rig.
    #[error("{0}")]
    Rig(StereoRigError),
}

impl Calibrated {
    /// The fewest views.
    pub const LEAST_VIEWS: usize = 3;
    /// Boards that are tilted less, root mean square, hardly tell a focal length from a distance.
    pub const LEAST_TILT_DEG: f64 = 8.0;
    /// Deviation of all disparities above which what is far is not where it is said to be.
    pub const MOST_DISPARITY_SIGMA_PX: f64 = 0.2;

    /// The root mean square over the views of how far boards are tilted about the upright and about the level
    /// axis, degrees.
    pub fn tilts_deg(&self) -> [f64; 2] {
        [0, 1].map(|axis| {
            let sum = self.views.iter().map(|view| view.tilt_deg[axis].powi(2)).sum::<f64>();
            (sum / self.views.len().max(1) as f64).sqrt()
        })
    }

    /// What was found, a line for each part.
    pub fn words(&self) -> String {
        let [left, right] = self.alone_px;
        let mut text = format!(
            "re-projection {:.3} px (by themselves: left {left:.3}, right {right:.3})\n",
            self.rms_px
        );
        for ((name, camera), sigma) in
            ["left", "right"].iter().zip(self.rig.cameras()).zip(self.focal_sigma_px)
        {
            let ((fx, fy), (cx, cy)) = (camera.focal_px(), camera.principal_point());
            let _ =
                writeln!(text, "{name:<13} f {fx:.2} x {fy:.2} px (+- {sigma:.2}), centre {cx:.2}, {cy:.2}");
        }
        let (b, sigma) = (1000.0 * self.rig.baseline_m(), 1000.0 * self.baseline_sigma_m);
        let angle = self.rig.pose().angle_rad().to_degrees();
        let _ = writeln!(
            text,
            "baseline      {b:.2} mm (+- {sigma:.2}), cameras turned against each other by {angle:.2} degrees"
        );
        let [yaw, sigma] = self.yaw_rad.map(f64::to_degrees);
        let _ = writeln!(
            text,
            "yaw           {yaw:.3} degrees (+- {sigma:.3}); disparities are uncertain by {:.2} px",
            self.disparity_sigma_px
        );
        text
    }

    /// Views that fit much worse than most: over two and a half times the middle one, and by more than a
    /// tenth of a pixel.
    pub fn outliers(&self) -> Vec<usize> {
        let worst = |view: &ViewFigures| view.rms_px[0].max(view.rms_px[1]);
        let middle = self.middle_rms_px();
        let is_out = |view: &ViewFigures| worst(view) > 2.5 * middle && worst(view) > middle + 0.1;
        (0..self.views.len()).filter(|&i| is_out(&self.views[i])).collect()
    }

    /// What the middle one of the views has, the worse of its pictures, px.
    pub fn middle_rms_px(&self) -> f64 {
        let mut all: Vec<_> = self.views.iter().map(|view| view.rms_px[0].max(view.rms_px[1])).collect();
        all.sort_by(f64::total_cmp);
        all.get(all.len() / 2).copied().unwrap_or(0.0)
    }
}
