//! A pair of cameras whose view moves, and the motion from frame to frame.
//!
//! It knows no hardware: the same runs on the host, which compares. The pictures are a window of the built-in
//! scene that moves two columns with every frame, as if the cameras turned; in a product they are a camera's.

use super::scene::{Scene, SceneCamera};
use core::convert::Infallible;
use heapless::Vec;
use stereopsis::camera::{CameraError, StereoSource};
use stereopsis::features::{Feature, FeatureConfig, FeatureConfigError, FeatureDetector, FeatureLineError};
use stereopsis::geometry::camera::{RectifiedRig, RigError};
use stereopsis::imaging::{Picture, PictureError};
use stereopsis::motion::odometry::{
    Frame, OdometryConfig, OdometryError, OdometryRigError, State, Step, StereoOdometry,
};

/// What the cameras see.
const SCENE: Scene = Scene { width: 160, height: 96 };
/// Columns of the window that is looked at.
pub const WIDTH: usize = 128;
/// Its rows.
pub const HEIGHT: usize = 96;
/// Frames.
pub const FRAMES: usize = 4;
/// Columns that the window moves from one to the next.
const COLUMNS: usize = 2;
/// Points that are followed.
const POINTS: usize = 40;
/// The cameras' focal length, px.
const FOCAL_PX: f32 = 120.0;
/// How far all turns together may be from those of the window, of which the middle alone moves as a turn
/// does, radians.
const NEAR_RAD: f32 = 0.01;
/// What is looked for.
const CONFIG: FeatureConfig =
    FeatureConfig { cell_px: 24, per_cell: 2, ..FeatureConfig::new(WIDTH as u16, HEIGHT as u16) };

/// The odometry: the state that stays from frame to frame.
pub type Odometry = StereoOdometry<f32, POINTS>;

/// All that it takes.
pub struct Walk {
    odometry: Odometry,
    detector: FeatureDetector<WIDTH, { CONFIG.slots() }>,
    features: Vec<Feature, POINTS>,
    left: [u8; WIDTH * HEIGHT],
    right: [u8; WIDTH * HEIGHT],
    lines: [[u8; SCENE.width as usize]; 2],
}

/// Why there is no motion.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Broken {
    /// The camera gave no lines.
    Camera(CameraError<Infallible>),
    /// The detector cannot do what is asked.
    Config(FeatureConfigError),
    /// A line is not what is due.
    Line(FeatureLineError),
    /// The numbers are no rig.
    Rig(RigError),
    /// Nor one of an odometry.
    OdometryRig(OdometryRigError),
    /// The pixels are no picture.
    Picture(PictureError),
    /// The frame was not taken.
    Odometry(OdometryError),
}

impl Default for Walk {
    fn default() -> Self {
        Self::new()
    }
}

impl Walk {
    /// Nothing yet.
    pub const fn new() -> Self {
        Self {
            odometry: StereoOdometry::new(),
            detector: FeatureDetector::new(),
            features: Vec::new(),
            left: [0; WIDTH * HEIGHT],
            right: [0; WIDTH * HEIGHT],
            lines: [[0; SCENE.width as usize]; 2],
        }
    }

    /// Begins a walk.
    pub fn start(&mut self) -> Result<(), Broken> {
        let rig = RectifiedRig::new(FOCAL_PX, 0.1, 63.5, 47.5).map_err(Broken::Rig)?;
        self.odometry.start(&rig, OdometryConfig::new(WIDTH as u16)).map_err(Broken::OdometryRig)
    }

    /// Takes both pictures of a frame, and the features of the left one.
    pub fn take(&mut self, frame: usize) -> Result<(), Broken> {
        let mut camera = SceneCamera::new(SCENE);
        camera.start_frame().map_err(Broken::Camera)?;
        self.detector.start(&CONFIG).map_err(Broken::Config)?;
        self.features.clear();
        let rows = self.left.chunks_exact_mut(WIDTH).zip(self.right.chunks_exact_mut(WIDTH));
        for (left, right) in rows {
            let [line, other] = &mut self.lines;
            camera.next_lines(line, other).map_err(Broken::Camera)?;
            for (to, line) in [(left, &*line), (right, &*other)] {
                to.iter_mut().zip(line.iter().skip(frame * COLUMNS)).for_each(|(to, &pixel)| *to = pixel);
            }
        }
        for line in self.left.chunks_exact(WIDTH) {
            self.detector.push(line, self.features.as_mut_view()).map_err(Broken::Line)?;
        }
        Ok(())
    }

    /// The left and the right picture that were taken last, row by row.
    pub fn pictures(&self) -> [&[u8]; 2] {
        [&self.left, &self.right]
    }

    /// The features of the left one.
    pub fn features(&self) -> &[Feature] {
        &self.features
    }

    /// The motion since the frame before.
    pub fn step(&mut self) -> Result<Step<f32>, Broken> {
        let picture = |pixels| Picture::new(pixels, WIDTH as u16, HEIGHT as u16).map_err(Broken::Picture);
        let frame = Frame {
            left: picture(&self.left)?,
            right: Some(picture(&self.right)?),
            features: &self.features,
        };
        self.odometry.step(&frame).map_err(Broken::Odometry)
    }
}

/// How far the view turned to the right by these steps, radians; or none where a motion is not known.
pub fn turned(steps: &[Step<f32>]) -> Option<f32> {
    let is_known = |(frame, step): (usize, &Step<f32>)| {
        matches!((frame, step.state), (0, State::First)) || matches!(step.state, State::Tracked)
    };
    // A window that moves to the right is a turn to the right, about the axis that points down.
    steps.iter().enumerate().all(is_known).then(|| steps.iter().map(|step| step.motion.rotation().m13).sum())
}

/// Whether they turned as the window moved.
pub fn is_right(turned: f32) -> bool {
    (turned - (COLUMNS * (FRAMES - 1)) as f32 / FOCAL_PX).abs() <= NEAR_RAD
}
