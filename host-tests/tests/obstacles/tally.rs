//! What came of many frames beside their truth.
//!
//! A surface is a false alarm if it is three deviations and a fifth nearer than anything that stands or drops
//! in its columns, or half a window beside them.

use nalgebra::{Rotation3, Vector3};
use stereopsis::obstacles::{Decision, DriveConfig, DriveRule, Ground, ObstaclesView, StixelKind};
use stereopsis_host::scene::{RobotScene, Scene};

/// Speed of the robot, mm/s: it looks 1.03 m ahead.
const SPEED: u16 = 700;
/// What is below this height above the ground, m, is ground: half of what an obstacle has at least.
const GROUND_M: f64 = 0.025;
/// Columns beside a surface that a window of it reaches.
pub const REACH: usize = 6;

/// The direction down in a camera that is rolled.
pub fn down(roll_rad: f64) -> Vector3<f64> {
    let (sin, cos) = RobotScene::PITCH_RAD.sin_cos();
    Rotation3::from_axis_angle(&Vector3::z_axis(), -roll_rad) * Vector3::new(0.0, cos, sin)
}

/// Depth of the nearest that is no ground, mm, of each column of pixels: of a drop that of its edge.
pub fn nearest(scene: &Scene, down: Vector3<f64>) -> Vec<f64> {
    let (rig, truth) = (scene.rig(), scene.truth());
    let (cx, cy) = rig.principal_point();
    let mut found = vec![f64::INFINITY; truth.width];
    for (i, &depth) in truth.depth_m.iter().enumerate().filter(|(_, depth)| depth.is_finite()) {
        let (u, v) = ((i % truth.width) as f64, (i / truth.width) as f64);
        let along = |at: f64, centre: f32| (at - f64::from(centre)) / f64::from(rig.focal_px());
        let falls = Vector3::new(along(u, cx), along(v, cy), 1.0).dot(&down);
        let depth = f64::from(depth);
        let height = RobotScene::HEIGHT_M - depth * falls;
        let at = match height {
            _ if height > GROUND_M => depth,
            _ if height < -GROUND_M => RobotScene::HEIGHT_M / falls,
            _ => continue,
        };
        let column = &mut found[i % truth.width];
        *column = column.min(1000.0 * at);
    }
    found
}

/// Whether a frame shows a surface where there is none.
fn is_alarm(frame: &ObstaclesView<'_>, nearest: &[f64]) -> bool {
    (0..frame.columns()).any(|x| {
        let stixel = frame.stixel(x);
        let columns = (4 * x).saturating_sub(REACH)..(4 * x + 4 + REACH).min(nearest.len());
        let truth = nearest[columns].iter().copied().fold(f64::INFINITY, f64::min);
        let (depth, steps) = (f64::from(stixel.depth_mm), f64::from(stixel.disparity.raw()).max(1.0));
        let sigma = depth * f64::from(stixel.sigma_steps) / steps;
        stixel.kind != StixelKind::Nothing && depth + 3.0 * sigma < truth && depth < 0.8 * truth
    })
}

/// How far a plane's pitch is off, degrees.
fn tilt_deg(plane: &Ground) -> f64 {
    (f64::from(plane.pitch_rad()) - RobotScene::PITCH_RAD).to_degrees().abs()
}

/// What came of many frames of a scene.
#[derive(Default, Debug)]
pub struct Tally {
    pub frames: usize,
    pub alarms: usize,
    /// How far the pitches are off of the grounds that were told, and of all planes, degrees.
    pub told: Vec<f64>,
    pub planes: Vec<f64>,
    /// Clear, slow, stop, blind.
    pub decisions: [usize; 4],
}

impl Tally {
    pub fn take(&mut self, frame: &ObstaclesView<'_>, nearest: &[f64]) {
        self.frames += 1;
        self.alarms += usize::from(is_alarm(frame, nearest));
        self.told.extend(frame.ground().as_ref().map(tilt_deg));
        self.planes.extend(frame.plane().as_ref().map(tilt_deg));
        let place = match DriveRule::new(DriveConfig::default()).decide(frame, SPEED).decision {
            Decision::Clear => 0,
            Decision::Slow(_) => 1,
            Decision::Stop(_) => 2,
            Decision::Blind(_) => 3,
        };
        self.decisions[place] += 1;
    }

    /// The most that a ground which was told is off, degrees.
    pub fn most_tilt(&self) -> f64 {
        self.told.iter().copied().fold(0.0, f64::max)
    }

    /// How many pitches are within half a degree.
    pub fn within(tilts: &[f64]) -> usize {
        tilts.iter().filter(|tilt| **tilt <= 0.5).count()
    }
}
