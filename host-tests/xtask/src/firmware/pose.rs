//! The program `pose` on one core: two views, measured, and held to the host's own run.

use super::board::Board;
use super::frame::{calibrated, figures, instructions};
use super::program::{Optimised, build_plain};
use super::two_views::{Cameras, Found, MATCHES, Missing, World};
use super::{emulate, log, results};
use crate::elf::Sizes;
use crate::steps::{Failure, Outcome};
use nalgebra::Point3;
use serde::Serialize;
use std::fs;

/// What the program begins its world with.
const SEED: u32 = 5;
/// The most stack that it may take, bytes.
const MOST_STACK: u64 = 8 * 1024;
/// The most static RAM, bytes.
const MOST_RAM: u64 = 16 * 1024;
/// The most flash when it is made for size, bytes.
const MOST_FLASH: u64 = 40 * 1024;
/// The most instructions of eight points on a core that has floating-point instructions, made for speed.
const MOST_EIGHT_POINT: u64 = 8500;
/// The cores that have them.
const WITH_FLOATS: [&str; 4] = ["m4", "m7", "m33", "m55"];

/// What came of it. Names and units of the fields are a contract with programs that read `summary.json`.
#[derive(Serialize)]
pub struct Pose {
    pub core: &'static str,
    board: &'static str,
    target: &'static str,
    /// `release` is made for speed, `small` for size.
    pub profile: &'static str,
    matches: u64,
    /// F of eight correspondences.
    pub eight_point_instructions: u64,
    /// F of all matches, wrong ones among them.
    pub robust_instructions: u64,
    /// That, the pose and the points.
    pub instructions: u64,
    pub static_ram_bytes: u64,
    pub stack_bytes: u64,
    pub flash_bytes: u64,
    pub panic_symbols: usize,
    allocation_symbols: usize,
    /// Samples of seven.
    pub samples: u64,
    inliers: u64,
    points: u64,
    right_lost: u64,
    wrong_kept: u64,
    rotation_off_urad: u64,
    direction_off_urad: u64,
    points_off_ppm: u64,
}

/// Builds the program and runs it; fails when what it finds is not what the host finds, to the bit, or not the truth, and
/// when it takes more than it may.
pub fn run(board: Board, optimised: Optimised) -> Outcome<Pose> {
    let name = format!("{}-pose-{}", board.core, optimised.profile());
    let failed = |what: String| Failure::new(format!("{name}: {what}"));
    let elf = build_plain(board, "pose", optimised, "")?;
    let folder = tempfile::tempdir().map_err(|e| failed(e.to_string()))?;
    let printed = emulate::run_elf(board, &elf, &name, folder.path())?;
    for line in log::read(&elf, &name, folder.path())? {
        println!("{name}: {line}");
    }
    let there = fs::read(folder.path().join("pose.bin")).map_err(|e| failed(format!("pose.bin: {e}")))?;
    results::same("pose.bin", &there, &of_host()?).map_err(failed)?;

    let figures = figures(&printed);
    let figure = |name: &str| figures.get(name).copied().ok_or_else(|| failed(format!("it prints no {name}")));
    calibrated(board, figure("calibration_ticks")?).map_err(failed)?;
    let ticks = |name: &str| Ok(instructions(board, figure(name)?));
    let sizes = Sizes::of(&elf)?;
    sizes.without_panics()?;
    let pose = Pose {
        core: board.core,
        board: board.machine,
        target: board.target,
        profile: optimised.profile(),
        matches: figure("matches")?,
        eight_point_instructions: ticks("eight_point_ticks")? / figure("eight_point_rounds")?.max(1),
        robust_instructions: ticks("robust_ticks")?,
        instructions: ticks("ticks")?,
        static_ram_bytes: sizes.static_ram,
        stack_bytes: figure("stack_bytes")?,
        flash_bytes: sizes.flash(),
        panic_symbols: sizes.panics.len(),
        allocation_symbols: sizes.allocations.len(),
        samples: figure("samples")?,
        inliers: figure("inliers")?,
        points: figure("points")?,
        right_lost: figure("right_lost")?,
        wrong_kept: figure("wrong_kept")?,
        rotation_off_urad: figure("rotation_off_urad")?,
        direction_off_urad: figure("direction_off_urad")?,
        points_off_ppm: figure("points_off_ppm")?,
    };
    let has_floats = WITH_FLOATS.contains(&board.core);
    let limits = [
        ("bytes of stack", pose.stack_bytes, MOST_STACK, true),
        ("bytes of static RAM", pose.static_ram_bytes, MOST_RAM, true),
        ("bytes of flash", pose.flash_bytes, MOST_FLASH, has_floats && optimised == Optimised::Size),
        (
            "instructions for eight points",
            pose.eight_point_instructions,
            MOST_EIGHT_POINT,
            has_floats && optimised == Optimised::Speed,
        ),
    ];
    match limits.iter().find(|(_, is, most, holds)| *holds && is > most) {
        Some((what, is, most, _)) => Err(failed(format!("{is} {what}, at most {most} may be"))),
        None => Ok(pose),
    }
}

/// The bytes of `pose.bin` by the host: F, R and t row by row, then of every match whether it agrees, and its point.
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

impl Pose {
    /// In a line.
    pub fn told(&self) -> String {
        format!(
            "{}-pose-{}: {} instructions, of them {} for F with {} samples; {} for eight points alone; RAM {} bytes, stack {}, \
             flash {}",
            self.core,
            self.profile,
            self.instructions,
            self.robust_instructions,
            self.samples,
            self.eight_point_instructions,
            self.static_ram_bytes,
            self.stack_bytes,
            self.flash_bytes
        )
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
