//! Two views of a known world and the points that they see, from a guess to the truth by bundle adjustment.
//!
//! It knows no hardware: the same runs on the host, which compares. In a product the guess is what
//! `two_views` finds, or the last pose of an odometry, and what is here of the truth is not.

use super::two_views::{Cameras, MATCHES, Missing, World, is_right};
use core::ops::ControlFlow;
use nalgebra::{Matrix3, Vector3};
use stereopsis::geometry::camera::{Pose, PoseError, ProjectionError};
use stereopsis::motion::bundle::{
    BundleConfig, BundleError, BundleReport, CameraView, Gauge, View, Window, WindowError,
};

/// What the world begins with.
const SEED: u32 = 9;

/// The window: two views, and all points seen by both.
pub type TwoViews = Window<CameraView<f32>, f32, 6, 2, MATCHES, { 2 * MATCHES }>;

/// The world, and the window on it.
pub struct Adjusted {
    /// The world.
    pub world: World,
    /// The window.
    pub window: TwoViews,
}

/// Why there was nothing to adjust.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Broken {
    /// The world cannot be.
    World(Missing),
    /// The guess is no pose.
    Guess(PoseError),
    /// A point is not seen.
    NotSeen(ProjectionError),
    /// The window is too small.
    Window(WindowError),
    /// The window is no problem.
    Bundle(BundleError),
}

/// What came of it.
pub struct Outcome {
    /// Costs, steps and why it stopped.
    pub report: BundleReport<f32>,
    /// How far the second camera's centre is from the truth, of the baseline.
    pub centre_off: f32,
    /// How far it is turned from the truth, radians.
    pub turned_off: f32,
}

impl Default for Adjusted {
    fn default() -> Self {
        Self::new()
    }
}

impl Adjusted {
    /// Nothing yet.
    pub const fn new() -> Self {
        Self { world: World::new(), window: Window::new() }
    }

    /// Fills the window with a guess: the second camera a degree and a half and a tenth of the baseline off,
    /// the points a twentieth too near or too far. Then adjusts it, the first view and the baseline held,
    /// and compares with the truth. Returns the ticks of all iterations too.
    ///
    /// # Errors
    /// When the world or its window cannot be; which they can.
    #[inline(never)]
    pub fn run(&mut self, mut now: impl FnMut() -> u64) -> Result<(Outcome, u64), Broken> {
        let cameras = Cameras::new().map_err(Broken::World)?;
        self.world.fill(&cameras, SEED).map_err(Broken::World)?;
        self.fill(&cameras)?;
        let start = now();
        let config = BundleConfig::new(Gauge::Baseline { held: 0, other: 1 });
        let most = config.most_iterations;
        let mut adjustment = self.window.start(config).map_err(Broken::Bundle)?;
        let mut report = adjustment.report(stereopsis::motion::bundle::StopReason::Iterations);
        for _ in 0..=most {
            if let ControlFlow::Break(stop) = self.window.iterate(&mut adjustment) {
                report = adjustment.report(stop);
                break;
            }
        }
        let ticks = now() - start;
        let truth = &cameras.pose;
        let found = self.window.views().get(1).map_or(Pose::identity(), |view| view.pose);
        let off = (found.translation() - truth.translation()).norm() / truth.translation().norm();
        // The distance of two rotations is the root of two times their angle, while it is small.
        let turned = (found.rotation() - truth.rotation()).norm() * core::f32::consts::FRAC_1_SQRT_2;
        Ok((Outcome { report, centre_off: off, turned_off: turned }, ticks))
    }

    #[inline(never)]
    fn fill(&mut self, Cameras { camera, pose }: &Cameras) -> Result<(), Broken> {
        let (world, window) = (&self.world, &mut self.window);
        window.clear();
        // The baseline turned by a tenth: its length is what is known.
        let centre = pose.translation();
        let beside = centre + Vector3::new(-0.1 * centre.y, 0.1 * centre.x, 0.1 * centre.norm());
        let beside = beside * (centre.norm() / beside.norm());
        let turn = Matrix3::new(1.0, -0.015, 0.02, 0.015, 1.0, -0.01, -0.02, 0.01, 1.0);
        let guess = Pose::new(nearest(&(pose.rotation() * turn)), beside).map_err(Broken::Guess)?;
        for pose in [Pose::identity(), guess] {
            window.add_view(CameraView { camera: *camera, pose }).map_err(Broken::Window)?;
        }
        let second = CameraView { camera: *camera, pose: *pose };
        for (at, (point, seen)) in world.points.iter().zip(&world.seen).enumerate() {
            let by = if at % 2 == 0 { 1.05 } else { 0.95 };
            window.add_point(*point * by).map_err(Broken::Window)?;
            // A wrong match is not what is adjusted: it is where it should be.
            let there =
                if is_right(at) { seen.second } else { second.project(0, point).map_err(Broken::NotSeen)? };
            window.add_observation(0, 0, seen.first).map_err(Broken::Window)?;
            window.add_observation(1, 0, there).map_err(Broken::Window)?;
        }
        Ok(())
    }
}

impl Outcome {
    /// Whether it is as good as the noise allows.
    pub fn is_good(&self) -> bool {
        self.centre_off < 0.03 && self.turned_off < 0.006 && self.report.cost < 60.0
    }
}

/// The rotation that a matrix near one means: its columns made orthogonal, one after the other.
fn nearest(m: &Matrix3<f32>) -> Matrix3<f32> {
    let x = Vector3::new(m.m11, m.m21, m.m31);
    let x = x * (1.0 / x.norm());
    let y = Vector3::new(m.m12, m.m22, m.m32);
    let y = y - x * x.dot(&y);
    let y = y * (1.0 / y.norm());
    let z = x.cross(&y);
    Matrix3::new(x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z)
}
