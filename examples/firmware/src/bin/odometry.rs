//! Where a pair of cameras goes: both pictures of a moment in memory, the left one's features, and the motion since the last.
//!
//! 1. [`SceneCamera`]: lines of the built-in scene, of which the pictures are a window that moves two columns with every frame, as
//!    if the cameras turned.
//! 2. [`Detector`]: features of the left picture, line by line.
//! 3. [`StereoOdometry`]: the motion. What it took and what came out, on the console.

#![no_std]
#![no_main]

use core::convert::Infallible;
use heapless::Vec;
use static_cell::ConstStaticCell;
use stereopsis::camera::{CameraError, StereoSource};
use stereopsis::features::{Feature, FeatureConfig, FeatureConfigError, FeatureDetector, FeatureLineError};
use stereopsis::geometry::{RectifiedRig, RigError};
use stereopsis::imaging::{Picture, PictureError};
use stereopsis::motion::odometry::{Frame, OdometryConfig, OdometryError, OdometryRigError, State, StereoOdometry};
use stereopsis_firmware::camera::scene::{Scene, SceneCamera};
use stereopsis_firmware::choice::BOARD;
use stereopsis_firmware::clock::Clock;
use stereopsis_firmware::console::Console;
use stereopsis_firmware::{runtime, stack};

/// What the cameras see, and the window that is looked at.
const SCENE: Scene = Scene { width: 160, height: 96 };
const WIDTH: usize = 128;
const HEIGHT: usize = 96;
/// Frames, and columns from one to the next.
const FRAMES: usize = 4;
const COLUMNS: usize = 2;
/// Points that are followed.
const POINTS: usize = 40;
/// The cameras' focal length, px.
const FOCAL_PX: f32 = 120.0;
/// What is looked for.
const CONFIG: FeatureConfig =
    FeatureConfig { cell_px: 24, per_cell: 2, ..FeatureConfig::new(WIDTH as u16, HEIGHT as u16) };

/// Corners of a picture.
type Detector = FeatureDetector<WIDTH, { CONFIG.slots() }>;

/// All the memory that it takes besides the stack, at an address fixed by the linker.
struct Memory {
    odometry: StereoOdometry<f32, POINTS>,
    detector: Detector,
    features: Vec<Feature, POINTS>,
    left: [u8; WIDTH * HEIGHT],
    right: [u8; WIDTH * HEIGHT],
    lines: [[u8; 160]; 2],
}

static MEMORY: ConstStaticCell<Memory> = ConstStaticCell::new(Memory {
    odometry: StereoOdometry::new(),
    detector: Detector::new(),
    features: Vec::new(),
    left: [0; WIDTH * HEIGHT],
    right: [0; WIDTH * HEIGHT],
    lines: [[0; 160]; 2],
});

#[runtime::entry]
fn main() -> ! {
    runtime::run(&MEMORY, run)
}

/// Why there is no motion.
#[derive(defmt::Format)]
enum Failure {
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
    /// The motion is not known.
    NotTracked,
}

fn run(memory: &mut Memory) -> Result<(), Failure> {
    let clock = Clock::start();
    defmt::info!("{=usize}x{=usize} on {=str}", WIDTH, HEIGHT, BOARD.core);
    let calibration = clock.calibrate();
    let rig = RectifiedRig::new(FOCAL_PX, 0.1, 63.5, 47.5).map_err(Failure::Rig)?;
    memory.odometry.start(&rig, OdometryConfig::new(WIDTH as u16)).map_err(Failure::OdometryRig)?;
    let (mut ticks, mut worst, mut turned, mut moved, mut inliers, mut bad) = (0, 0, 0.0_f32, 0.0_f32, 0, 0);
    for frame in 0..FRAMES {
        take(memory, frame * COLUMNS)?;
        let picture = |pixels| Picture::new(pixels, WIDTH as u16, HEIGHT as u16).map_err(Failure::Picture);
        let frame =
            Frame { left: picture(&memory.left)?, right: Some(picture(&memory.right)?), features: &memory.features };
        let start = clock.now();
        let step = memory.odometry.step(&frame).map_err(Failure::Odometry)?;
        let took = clock.now() - start;
        ticks += took;
        worst = took.max(worst);
        // A window that moves to the right is a turn to the right, about the axis that points down.
        turned += step.motion.rotation().m13;
        moved += step.motion.translation().z;
        inliers = step.inliers;
        bad += u64::from(!matches!(step.state, State::First | State::Tracked));
        defmt::info!("{=usize} points, {=usize} found, {=usize} agree", step.points, step.found, step.inliers);
    }
    let expected = (COLUMNS * (FRAMES - 1)) as f32 / FOCAL_PX;
    let stack = stack::used();
    let mut console = Console::open();
    console.figure("calibration_ticks", calibration);
    console.figure("frames", FRAMES as u64);
    console.figure("ticks", ticks);
    console.figure("worst_frame_ticks", worst);
    console.figure("inliers", inliers as u64);
    console.figure("turned_urad", (turned * 1e6) as u64);
    console.figure("expected_urad", (expected * 1e6) as u64);
    console.figure("moved_um", (moved.abs() * 1e6) as u64);
    console.figure("state_bytes", size_of::<StereoOdometry<f32, POINTS>>() as u64);
    console.figure("stack_bytes", stack as u64);
    if bad > 0 { Err(Failure::NotTracked) } else { Ok(()) }
}

/// A frame: both pictures, and the features of the left one.
fn take(memory: &mut Memory, from: usize) -> Result<(), Failure> {
    let mut camera = SceneCamera::new(SCENE);
    camera.start_frame().map_err(Failure::Camera)?;
    memory.detector.start(&CONFIG).map_err(Failure::Config)?;
    memory.features.clear();
    let rows = memory.left.chunks_exact_mut(WIDTH).zip(memory.right.chunks_exact_mut(WIDTH));
    for (left, right) in rows {
        let [line, other] = &mut memory.lines;
        camera.next_lines(line, other).map_err(Failure::Camera)?;
        for (to, line) in [(left, &*line), (right, &*other)] {
            to.iter_mut().zip(line.iter().skip(from)).for_each(|(to, &pixel)| *to = pixel);
        }
    }
    for line in memory.left.chunks_exact(WIDTH) {
        memory.detector.push(line, memory.features.as_mut_view()).map_err(Failure::Line)?;
    }
    Ok(())
}
