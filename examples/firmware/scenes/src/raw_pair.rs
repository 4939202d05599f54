//! Raw lines of two cameras, rectified as they come: what that costs behind different lenses, and depth from
//! them.
//!
//! It knows no hardware: the same runs on the host, which compares. In a product the lines are those of two
//! cameras, and the rig is read from flash with `StereoRig::from_record`.

use super::scene::{Scene, SceneCamera};
use core::convert::Infallible;
use nalgebra::{Matrix3, Vector3};
use stereopsis::camera::{CameraError, ErrorType, FrameStart, LineFormat, LineStart, StereoSource};
use stereopsis::geometry::{
    camera::{Camera, Distortion, ImageSize, Pose, StereoRig},
    rectify::{Crop, Rectification, RectifyError},
};
use stereopsis::imaging::{RectifiedPair, RectifiedPairError, RemapError, RemapPair, RemapTable};
use stereopsis::matching::{Block, Config, ConfigError, Row};
use stereopsis::pipeline::{Pipeline, PipelineError};

/// What the cameras see.
pub const SCENE: Scene = Scene { width: 320, height: 240 };
/// The size of raw and of rectified images.
const SIZE: ImageSize = ImageSize { width: SCENE.width, height: SCENE.height };
/// Pixels in a line.
const WIDTH: usize = SCENE.width as usize;
/// Raw lines that are held of a camera, one of them twice: the strong lens needs 22 at once, and powers of
/// two are faster.
pub const LINES: usize = 33;
/// Room for lattices of 32 px.
const SLOTS: usize = RemapTable::<0>::slots(SIZE, 5);
/// Disparities that are searched.
const DISPARITIES: usize = 48;
/// The right camera of the rig that depth is from sees all so many rows lower.
const LOWER: u16 = 4;

/// Both cameras' remaps.
pub type Remaps = RemapPair<WIDTH, LINES, SLOTS>;
/// Where lines come from when they are rectified.
type Source<'a, C> = RectifiedPair<'a, C, WIDTH, LINES, SLOTS>;
/// Why there is no next line.
type LinesError = CameraError<RectifiedPairError<Infallible>>;

/// Two cameras whose images are turned by a degree, behind these lenses.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Lens {
    /// None: 56 degrees from left to right.
    None,
    /// k1 = -0.1, k2 = 0.02: as many degrees.
    Mild,
    /// k1 = -0.28, k2 = 0.07, off its axis: a barrel of 85 degrees.
    Strong,
}

/// All that it takes.
pub struct RawPair {
    remaps: Remaps,
    pipeline: Pipeline<Block, WIDTH, DISPARITIES>,
    lines: [[u8; WIDTH]; 2],
}

/// Why there are no lines; which there are.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Broken<E> {
    /// The numbers are no cameras.
    Numbers,
    /// They have no rectified images.
    Rectify(RectifyError),
    /// The remap does not have the room.
    Remap(RemapError),
    /// The raw lines are not those of the rig.
    Pair(RectifiedPairError<Infallible>),
    /// A line did not come.
    Lines(LinesError),
    /// The pipeline cannot do what is asked.
    Config(ConfigError),
    /// The frame broke off.
    Frame(PipelineError<RectifiedPairError<Infallible>>),
    /// The results were not taken.
    Taker(E),
}

impl Default for RawPair {
    fn default() -> Self {
        Self::new()
    }
}

impl RawPair {
    /// Nothing yet.
    pub const fn new() -> Self {
        Self { remaps: RemapPair::empty(), pipeline: Pipeline::new(), lines: [[0; WIDTH]; 2] }
    }

    /// A frame of a camera behind such lenses: a taker gets both rectified lines of each row, and which of
    /// their pixels are valid. The ticks by the clock that the pair took, those of the camera among them.
    pub fn remap<C: StereoSource<Error = Infallible>, E>(
        &mut self,
        lens: Lens,
        camera: C,
        clock: impl Fn() -> u64,
        mut take: impl FnMut([&[u8]; 4]) -> Result<(), E>,
    ) -> Result<u64, Broken<E>> {
        self.remaps.set(&turned(lens)?).map_err(Broken::Remap)?;
        let mut pair = Source::new(camera, &mut self.remaps).map_err(Broken::Pair)?;
        let start = clock();
        pair.start_frame().map_err(Broken::Lines)?;
        let mut ticks = clock() - start;
        let [left, right] = &mut self.lines;
        for _ in 0..SCENE.height {
            let start = clock();
            pair.next_lines(left, right).map_err(Broken::Lines)?;
            ticks += clock() - start;
            let [left_valid, right_valid] = pair.valid();
            take([left, right, left_valid, right_valid]).map_err(Broken::Taker)?;
        }
        Ok(ticks)
    }

    /// A frame of depth from raw lines as [`Lowered`] gives them: camera, remap, census and matching in one
    /// loop over the rows. A taker gets each row; the ticks are counted as in [`Self::remap`].
    pub fn depth<C: StereoSource<Error = Infallible>, E>(
        &mut self,
        camera: C,
        clock: impl Fn() -> u64,
        mut take: impl FnMut(&Row<'_>) -> Result<(), E>,
    ) -> Result<u64, Broken<E>> {
        self.remaps.set(&level()?).map_err(Broken::Remap)?;
        let mut pair = Source::new(camera, &mut self.remaps).map_err(Broken::Pair)?;
        let config = Config::for_method::<Block>(SCENE.width, SCENE.height, DISPARITIES as u16);
        self.pipeline.start(&config).map_err(Broken::Config)?;
        let start = clock();
        self.pipeline.begin_frame(&mut pair).map_err(Broken::Frame)?;
        let mut ticks = clock() - start;
        loop {
            let start = clock();
            let row = self.pipeline.next_row(&mut pair).map_err(Broken::Frame)?;
            ticks += clock() - start;
            match row {
                Some(row) => take(&row).map_err(Broken::Taker)?,
                None => return Ok(ticks),
            }
        }
    }
}

/// The rectification of two cameras that are turned by a degree.
fn turned<E>(lens: Lens) -> Result<Rectification<f32>, Broken<E>> {
    let (focal_px, lens) = match lens {
        Lens::None => (300.0, [0.0; 5]),
        Lens::Mild => (300.0, [-0.1, 0.02, 0.0, 0.0, 0.0]),
        Lens::Strong => (220.0, [-0.28, 0.07, 0.001, -0.0005, 0.0]),
    };
    let camera = Camera::new(focal_px, focal_px, 160.5, 119.0).map_err(|_| Broken::Numbers)?;
    let lens = Distortion::from_opencv(lens);
    let camera = camera.with_distortion(lens).map_err(|_| Broken::Numbers)?;
    // The second one stands a degree lower than beside the first: 0.06 m at 1 : 57.29.
    rectification([camera; 2], Vector3::new(0.06, 0.001_047, 0.0))
}

/// That of two cameras of which the right one sees all lower.
fn level<E>() -> Result<Rectification<f32>, Broken<E>> {
    let camera = |row| Camera::new(300.0, 300.0, 159.5, row).map_err(|_| Broken::Numbers);
    rectification([camera(119.5)?, camera(119.5 + f32::from(LOWER))?], Vector3::new(0.06, 0.0, 0.0))
}

fn rectification<E>(
    cameras: [Camera<f32>; 2],
    to_second: Vector3<f32>,
) -> Result<Rectification<f32>, Broken<E>> {
    let pose = Pose::new(Matrix3::identity(), to_second).map_err(|_| Broken::Numbers)?;
    let rig = StereoRig::new(cameras, pose, [SIZE; 2]).map_err(|_| Broken::Numbers)?;
    Rectification::new(&rig, Crop::Natural, SIZE).map_err(Broken::Rectify)
}

/// Cameras that see the built-in scene, the right one all of it some rows lower than the left one.
pub struct Lowered {
    left: SceneCamera,
    right: SceneCamera,
    unused: [u8; WIDTH],
}

impl Lowered {
    /// Cameras that have not begun a frame yet.
    pub const fn new() -> Self {
        Self { left: SceneCamera::new(SCENE), right: SceneCamera::new(SCENE), unused: [0; WIDTH] }
    }
}

impl Default for Lowered {
    fn default() -> Self {
        Self::new()
    }
}

impl ErrorType for Lowered {
    type Error = Infallible;
}

impl StereoSource for Lowered {
    fn format(&self) -> LineFormat {
        self.left.format()
    }

    fn max_row_skew_us(&self) -> u32 {
        0
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Infallible>> {
        self.right.start_frame()?;
        self.left.start_frame()
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Infallible>> {
        let start = self.left.next_lines(left, right)?;
        if start.row < LOWER {
            right.fill(0);
        } else {
            self.right.next_lines(&mut self.unused, right)?;
        }
        Ok(start)
    }
}

/// How many pixels of a rectified row show the board, and how many of them are said to be within half a pixel
/// of where it is.
pub fn on_board(row: &Row<'_>) -> (u32, u32) {
    let (mut shown, mut right) = (0, 0);
    for (u, disparity) in (0..).zip(row.disparities()) {
        // Both cameras are moved by half of what the right one is lower.
        if !SCENE.on_board(u, i32::from(row.index()) - i32::from(LOWER / 2)) {
            continue;
        }
        shown += 1;
        let is_near = |px: f32| (px - f32::from(SCENE.board_disparity())).abs() <= 0.5;
        right += u32::from(disparity.to_f32().is_some_and(is_near));
    }
    (shown, right)
}
