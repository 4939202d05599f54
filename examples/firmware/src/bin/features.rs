//! What two cameras see to matches: corners with descriptors, found line by line in both pictures, and which
//! is which.
//!
//! 1. [`SceneCamera`]: lines of the built-in scene, 160x120.
//! 2. [`TwoPictures`]: features of both pictures, their matches.
//! 3. What it took on the console, what was found in `features.bin`.

#![no_std]
#![no_main]

use core::convert::Infallible;
use static_cell::ConstStaticCell;
use stereopsis::camera::{CameraError, StereoSource};
use stereopsis::features::{Feature, FeatureConfigError, FeatureLineError, MatchConfigError};
use stereopsis_firmware::camera::scene::{Scene, SceneCamera};
use stereopsis_firmware::choice::BOARD;
use stereopsis_firmware::clock::Clock;
use stereopsis_firmware::console::Console;
use stereopsis_firmware::host::{HostError, HostFile};
use stereopsis_firmware::two_pictures::{HEIGHT, TwoPictures, WIDTH};
use stereopsis_firmware::{runtime, stack};

/// What the cameras see.
const SCENE: Scene = Scene { width: WIDTH as u16, height: HEIGHT as u16 };

/// All the memory that it takes besides the stack, at an address fixed by the linker.
struct Memory {
    pictures: TwoPictures,
    left: [u8; WIDTH],
    right: [u8; WIDTH],
}

static MEMORY: ConstStaticCell<Memory> =
    ConstStaticCell::new(Memory { pictures: TwoPictures::new(), left: [0; WIDTH], right: [0; WIDTH] });

#[runtime::entry]
fn main() -> ! {
    runtime::run(&MEMORY, run)
}

/// Why there are no matches.
#[derive(defmt::Format)]
enum Failure {
    /// The camera gave no lines.
    Camera(CameraError<Infallible>),
    /// The detectors cannot do what is asked.
    Config(FeatureConfigError),
    /// A line is not what is due.
    Line(FeatureLineError),
    /// The features cannot be matched.
    Match(MatchConfigError),
    /// The host did not take the results.
    Host(HostError),
}

fn run(Memory { pictures, left, right }: &mut Memory) -> Result<(), Failure> {
    let clock = Clock::start();
    defmt::info!("{=usize}x{=usize} on {=str}", WIDTH, HEIGHT, BOARD.core);
    let calibration = clock.calibrate();
    let mut camera = SceneCamera::new(SCENE);
    camera.start_frame().map_err(Failure::Camera)?;
    pictures.start().map_err(Failure::Config)?;
    let mut detection = 0;
    for _ in 0..HEIGHT {
        camera.next_lines(left, right).map_err(Failure::Camera)?;
        let start = clock.now();
        pictures.push(left, right).map_err(Failure::Line)?;
        detection += clock.now() - start;
    }
    let start = clock.now();
    pictures.pair().map_err(Failure::Match)?;
    let matching = clock.now() - start;

    let stack = stack::used();
    write(pictures).map_err(Failure::Host)?;
    let mut console = Console::open();
    console.figure("calibration_ticks", calibration);
    console.figure("pixels", 2 * (WIDTH * HEIGHT) as u64);
    console.figure("detection_ticks", detection);
    console.figure("matching_ticks", matching);
    console.figure("left", pictures.left.features.len() as u64);
    console.figure("right", pictures.right.features.len() as u64);
    console.figure("matches", pictures.matches.len() as u64);
    console.figure("stack_bytes", stack as u64);
    Ok(())
}

/// What was found, the low byte first: the features of the left picture, of the right one, the matches;
/// before each list how many there are in two bytes. A feature is x and y in `f32`, score, level, the words
/// of its descriptor; a match is the places of its features and how many bits differ.
fn write(pictures: &TwoPictures) -> Result<(), HostError> {
    let file = HostFile::create(c"features.bin")?;
    for features in [&pictures.left.features, &pictures.right.features] {
        half(&file, features.len() as u16)?;
        features.iter().try_for_each(|feature| write_feature(&file, feature))?;
    }
    half(&file, pictures.matches.len() as u16)?;
    for found in &pictures.matches {
        [found.left, found.right, found.different].into_iter().try_for_each(|x| half(&file, x))?;
    }
    Ok(())
}

fn write_feature(file: &HostFile, feature: &Feature) -> Result<(), HostError> {
    file.write(&feature.x_px.to_le_bytes())?;
    file.write(&feature.y_px.to_le_bytes())?;
    file.write(&[feature.score, feature.level])?;
    feature.descriptor.0.iter().try_for_each(|word| file.write(&word.to_le_bytes()))
}

fn half(file: &HostFile, number: u16) -> Result<(), HostError> {
    file.write(&number.to_le_bytes())
}
