//! The program `features` on one core: two pictures to features and their matches, measured, and held to the
//! host's own run.

use super::plain::Tabled;
use super::program::Optimised;
use super::results::{Ran, Taken};
use crate::steps::{Failure, Outcome};
use firmware_boards::{self as board, Board};
use firmware_scenes::scene::{Scene, SceneCamera};
use firmware_scenes::two_pictures::{HEIGHT, TwoPictures, WIDTH};
use serde::Serialize;
use std::fmt::Debug;
use stereopsis::camera::StereoSource;
use stereopsis::features::{Feature, Match};

/// What the cameras see.
const SCENE: Scene = Scene { width: WIDTH as u16, height: HEIGHT as u16 };
/// The most static RAM, bytes: both detectors, both lists and the matcher.
const MOST_RAM: u64 = 32 * 1024;
/// The most stack, bytes.
const MOST_STACK: u64 = 8 * 1024;
/// A right match lies so near to where the scene says, px.
const NEAR_PX: f32 = 1.5;
/// Of so many matches one may be wrong.
const ONE_WRONG_OF: usize = 10;

/// What came of it. Names and units of the fields are a contract with programs that read `summary.json`.
#[derive(Serialize)]
pub struct Features {
    #[serde(flatten)]
    taken: Taken,
    width: usize,
    height: usize,
    /// Both pictures' features.
    detection_instructions: u64,
    detection_instructions_per_pixel: f64,
    /// All features of the one picture with all of the other.
    matching_instructions: u64,
    left: u64,
    right: u64,
    matches: u64,
    right_matches: usize,
    crc32: String,
}

/// Builds the program and runs it; fails when what it finds is not what the host finds, to the bit, or not
/// what the scene shows, and when it takes more than it may.
pub fn run(board: Board, optimised: Optimised) -> Outcome<Features> {
    let pictures = of_host()?;
    let found = bytes(&pictures);
    let ran = Ran::of(board, "features", optimised, &found)?;
    let right_matches = pictures.matches.iter().filter(|found| is_right(&pictures, found)).count();
    if right_matches * ONE_WRONG_OF < pictures.matches.len() * (ONE_WRONG_OF - 1) || right_matches == 0 {
        return Err(ran.failed(format!("{right_matches} of {} matches are right", pictures.matches.len())));
    }
    ran.within(&[
        ("bytes of static RAM", ran.taken.static_ram_bytes, MOST_RAM),
        ("bytes of stack", ran.taken.stack_bytes, MOST_STACK),
    ])?;
    let detection_instructions = ran.instructions("detection_ticks")?;
    Ok(Features {
        width: WIDTH,
        height: HEIGHT,
        detection_instructions,
        detection_instructions_per_pixel: detection_instructions as f64 / ran.figure("pixels")?.max(1) as f64,
        matching_instructions: ran.instructions("matching_ticks")?,
        left: ran.figure("left")?,
        right: ran.figure("right")?,
        matches: ran.figure("matches")?,
        right_matches,
        crc32: format!("{:08x}", crc32fast::hash(&found)),
        taken: ran.taken,
    })
}

/// What the host finds in the same lines.
fn of_host() -> Outcome<Box<TwoPictures>> {
    let failed = |what: &dyn Debug| Failure::new(format!("the host finds no features: {what:?}"));
    let (mut pictures, mut left, mut right) = (Box::new(TwoPictures::new()), [0; WIDTH], [0; WIDTH]);
    let mut camera = SceneCamera::new(SCENE);
    camera.start_frame().map_err(|e| failed(&e))?;
    pictures.start().map_err(|e| failed(&e))?;
    for _ in 0..HEIGHT {
        camera.next_lines(&mut left, &mut right).map_err(|e| failed(&e))?;
        pictures.push(&left, &right).map_err(|e| failed(&e))?;
    }
    pictures.pair().map_err(|e| failed(&e))?;
    Ok(pictures)
}

/// Whether a match is where the scene says: as far to the left as its surface is away, in the same row.
fn is_right(pictures: &TwoPictures, found: &Match) -> bool {
    let (left, right) = (&pictures.left.features, &pictures.right.features);
    let ends = left.get(usize::from(found.left)).zip(right.get(usize::from(found.right)));
    ends.is_some_and(|(left, right)| {
        let (u, v) = (left.x_px.round() as i32, left.y_px.round() as i32);
        let disparity = if SCENE.on_board(u, v) {
            f32::from(SCENE.board_disparity())
        } else {
            SCENE.floor_disparity(v) as f32 / 16.0
        };
        (left.x_px - right.x_px - disparity).abs() <= NEAR_PX && (left.y_px - right.y_px).abs() <= NEAR_PX
    })
}

/// The bytes of `features.bin`: features of the left picture, of the right one, matches, with their numbers.
fn bytes(pictures: &TwoPictures) -> Vec<u8> {
    let mut bytes = Vec::new();
    for features in [&pictures.left.features, &pictures.right.features] {
        bytes.extend((features.len() as u16).to_le_bytes());
        for Feature { x_px, y_px, score, level, descriptor } in features {
            bytes.extend([x_px, y_px].iter().flat_map(|x| x.to_le_bytes()));
            bytes.extend([score, level]);
            bytes.extend(descriptor.0.iter().flat_map(|word| word.to_le_bytes()));
        }
    }
    bytes.extend((pictures.matches.len() as u16).to_le_bytes());
    bytes.extend(
        pictures.matches.iter().flat_map(|m| [m.left, m.right, m.different]).flat_map(u16::to_le_bytes),
    );
    bytes
}

impl Tabled for Features {
    const NAME: &'static str = "features";
    const CASES: &'static [(Board, Optimised)] = &[
        (board::M4, Optimised::Speed),
        (board::M7, Optimised::Speed),
        (board::M55, Optimised::Speed),
        (board::M7, Optimised::Size),
    ];
    const COLUMNS: &'static [&'static str] =
        &["detection, for a pixel", "matching", "features", "matches", "of them right"];

    fn cells(&self) -> Vec<String> {
        vec![
            format!("{:.1}", self.detection_instructions_per_pixel),
            self.matching_instructions.to_string(),
            format!("{} and {}", self.left, self.right),
            self.matches.to_string(),
            self.right_matches.to_string(),
        ]
    }

    fn taken(&self) -> &Taken {
        &self.taken
    }
}

impl Features {
    /// In a line.
    pub fn summary(&self) -> String {
        let line = format!(
            "{:.1} instructions for a pixel, {} for matching {} with {} features; {} of {} matches are \
             right, crc32 {}",
            self.detection_instructions_per_pixel,
            self.matching_instructions,
            self.left,
            self.right,
            self.right_matches,
            self.matches,
            self.crc32
        );
        self.taken.summary("features", &line)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_that_was_found_is_in_the_file() {
        let pictures = of_host().expect("features");
        let features = pictures.left.features.len() + pictures.right.features.len();
        assert_eq!(bytes(&pictures).len(), 6 + 42 * features + 6 * pictures.matches.len());
    }

    #[test]
    fn a_match_elsewhere_is_wrong() {
        let mut pictures = of_host().expect("features");
        let right =
            |pictures: &TwoPictures| pictures.matches.iter().filter(|m| is_right(pictures, m)).count();
        let before = right(&pictures);
        assert!(before > 0);
        pictures.right.features.iter_mut().for_each(|feature| feature.y_px += 2.0 * NEAR_PX + 0.1);
        assert_eq!(right(&pictures), 0);
    }
}
