//! The program `pose` on one core: two views, measured, and held to the host's own run.

use super::plain::Tabled;
use super::program::Optimised;
use super::results::{Ran, Taken};
use crate::steps::{Failure, Outcome};
use firmware_boards::{self as board, Board};
use firmware_scenes::two_views::{Cameras, Found, MATCHES, Missing, World};
use nalgebra::Point3;
use serde::Serialize;

/// What the program begins its world with.
const SEED: u32 = 5;
/// The most stack that it may take, bytes.
const MOST_STACK: u64 = 8 * 1024;
/// The most static RAM, bytes.
const MOST_RAM: u64 = 16 * 1024;
/// The most flash when it is made for size, bytes.
const MOST_FLASH: u64 = 48 * 1024;
/// The most instructions of eight points on a core that has floating-point instructions, made for speed.
const MOST_EIGHT_POINT: u64 = 8500;
/// The cores that have them.
const WITH_FLOATS: [&str; 4] = ["m4", "m7", "m33", "m55"];

/// What came of it. Names and units of the fields are a contract with programs that read `summary.json`.
#[derive(Serialize)]
pub struct Pose {
    #[serde(flatten)]
    taken: Taken,
    matches: u64,
    /// F of eight correspondences.
    eight_point_instructions: u64,
    /// F of all matches, wrong ones among them.
    robust_instructions: u64,
    /// That, the pose and the points.
    instructions: u64,
    /// Samples of seven.
    samples: u64,
    inliers: u64,
    points: u64,
    right_lost: u64,
    wrong_kept: u64,
    rotation_off_urad: u64,
    direction_off_urad: u64,
    points_off_ppm: u64,
}

/// Builds the program and runs it; fails when what it finds is not what the host finds, to the bit, or not
/// the truth, and when it takes more than it may.
pub fn run(board: Board, optimised: Optimised) -> Outcome<Pose> {
    let ran = Ran::of(board, "pose", optimised, &of_host()?)?;
    let (stack, ram, flash) = (ran.taken.stack_bytes, ran.taken.static_ram_bytes, ran.taken.flash_bytes);
    let eight_point_instructions =
        ran.instructions("eight_point_ticks")? / ran.figure("eight_point_rounds")?.max(1);
    ran.within(&[("bytes of stack", stack, MOST_STACK), ("bytes of static RAM", ram, MOST_RAM)])?;
    if WITH_FLOATS.contains(&board.core) {
        ran.within(&[match optimised {
            Optimised::Size => ("bytes of flash", flash, MOST_FLASH),
            Optimised::Speed => ("instructions for eight points", eight_point_instructions, MOST_EIGHT_POINT),
        }])?;
    }
    Ok(Pose {
        matches: ran.figure("matches")?,
        eight_point_instructions,
        robust_instructions: ran.instructions("robust_ticks")?,
        instructions: ran.instructions("ticks")?,
        samples: ran.figure("samples")?,
        inliers: ran.figure("inliers")?,
        points: ran.figure("points")?,
        right_lost: ran.figure("right_lost")?,
        wrong_kept: ran.figure("wrong_kept")?,
        rotation_off_urad: ran.figure("rotation_off_urad")?,
        direction_off_urad: ran.figure("direction_off_urad")?,
        points_off_ppm: ran.figure("points_off_ppm")?,
        taken: ran.taken,
    })
}

/// The bytes of `pose.bin` by the host: F, R and t row by row, then of every match whether it agrees, and its
/// point.
fn of_host() -> Outcome<Vec<u8>> {
    let (mut world, mut inliers, mut points) = (Box::new(World::new()), [false; MATCHES], [None; MATCHES]);
    let mut find = || {
        let cameras = Cameras::new()?;
        world.fill(&cameras, SEED)?;
        let robust = world.fundamental(&mut inliers)?;
        let found = world.pose(&cameras, robust, &inliers, &mut points)?;
        let errors = world.errors(&cameras, &found, &inliers, &points);
        Ok((found, errors))
    };
    let (found, errors) =
        find().map_err(|missing: Missing| Failure::new(format!("the host finds no pose: {missing:?}")))?;
    if found.points == 0 || !errors.are_small() {
        return Err(Failure::new("what the host finds is not the truth"));
    }
    let Found { robust, recovered, .. } = found;
    let rows = [robust.fundamental.matrix().transpose(), recovered.pose.rotation().transpose()];
    let numbers = rows.iter().flatten().chain(recovered.pose.direction().iter());
    let mut bytes: Vec<u8> = numbers.flat_map(|x| x.to_le_bytes()).collect();
    for (&inlier, point) in inliers.iter().zip(&points) {
        bytes.push(u8::from(inlier));
        bytes.extend(point.unwrap_or(Point3::origin()).iter().flat_map(|x| x.to_le_bytes()));
    }
    Ok(bytes)
}

impl Tabled for Pose {
    const NAME: &'static str = "pose";
    /// The smallest board, which has too little RAM, left out. One core of each kind made for size is enough:
    /// the others take as much.
    const CASES: &'static [(Board, Optimised)] = &[
        (board::M3, Optimised::Speed),
        (board::M4, Optimised::Speed),
        (board::M7, Optimised::Speed),
        (board::M7, Optimised::Size),
        (board::M33, Optimised::Speed),
        (board::M55, Optimised::Speed),
        (board::RV32, Optimised::Speed),
    ];
    const COLUMNS: &'static [&'static str] = &["F of 8", "F of 128, a third wrong", "and pose and points"];

    fn cells(&self) -> Vec<String> {
        [self.eight_point_instructions, self.robust_instructions, self.instructions]
            .map(|n| n.to_string())
            .into()
    }

    fn taken(&self) -> &Taken {
        &self.taken
    }
}

impl Pose {
    /// In a line.
    pub fn summary(&self) -> String {
        let line = format!(
            "{} instructions, of them {} for F with {} samples; {} for eight points alone",
            self.instructions, self.robust_instructions, self.samples, self.eight_point_instructions
        );
        self.taken.summary("pose", &line)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_that_was_found_is_in_the_file() {
        assert_eq!(of_host().expect("a pose").len(), 4 * 21 + 13 * MATCHES);
    }
}
