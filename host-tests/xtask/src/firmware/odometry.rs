//! The program `odometry` on one core: the motion of a pair from frame to frame, measured, and held to the
//! host's own run.

use super::plain::Tabled;
use super::program::Optimised;
use super::results::{Ran, Taken};
use crate::steps::{Failure, Outcome};
use firmware_boards::Board;
use firmware_scenes::walk::{FRAMES, Walk, is_right, turned};
use serde::Serialize;
use stereopsis::motion::odometry::Step;

/// The most static RAM, bytes: both pictures, the detector and the odometry.
const MOST_RAM: u64 = 52 * 1024;
/// The most stack, bytes.
const MOST_STACK: u64 = 13 * 1024;

/// What came of it. Names and units of the fields are a contract with programs that read `summary.json`.
#[derive(Serialize)]
pub struct Odometry {
    #[serde(flatten)]
    taken: Taken,
    frames: u64,
    /// The mean of all frames, and the most of one; without the features.
    instructions_per_frame: u64,
    worst_frame_instructions: u64,
    /// The odometry alone.
    state_bytes: u64,
    inliers: u64,
    turned_urad: u64,
}

/// Builds the program and runs it; fails when what it finds is not what the host finds, to the bit, or not
/// the motion, and when it takes more than it may.
pub fn run(board: Board, optimised: Optimised) -> Outcome<Odometry> {
    let ran = Ran::of(board, "odometry", optimised, &bytes(&of_host()?))?;
    ran.within(&[
        ("bytes of static RAM", ran.taken.static_ram_bytes, MOST_RAM),
        ("bytes of stack", ran.taken.stack_bytes, MOST_STACK),
    ])?;
    let frames = ran.figure("frames")?;
    Ok(Odometry {
        frames,
        instructions_per_frame: ran.instructions("ticks")? / frames.max(1),
        worst_frame_instructions: ran.instructions("worst_frame_ticks")?,
        state_bytes: ran.figure("state_bytes")?,
        inliers: ran.figure("inliers")?,
        turned_urad: ran.figure("turned_urad")?,
        taken: ran.taken,
    })
}

/// What the host finds in the same pictures.
fn of_host() -> Outcome<Vec<Step<f32>>> {
    let mut walk = Box::new(Walk::new());
    let mut all = || {
        walk.start()?;
        (0..FRAMES).map(|frame| walk.take(frame).and_then(|()| walk.step())).collect::<Result<Vec<_>, _>>()
    };
    let steps = all().map_err(|e| Failure::new(format!("the host finds no motion: {e:?}")))?;
    match turned(&steps) {
        Some(turned) if is_right(turned) => Ok(steps),
        turned => Err(Failure::new(format!("what the host finds is not the motion: {turned:?} rad"))),
    }
}

/// The bytes of `odometry.bin`: R, column by column, and t of every motion.
fn bytes(steps: &[Step<f32>]) -> Vec<u8> {
    let motions = steps.iter().map(|step| &step.motion);
    let numbers = motions.flat_map(|motion| motion.rotation().iter().chain(motion.translation().iter()));
    numbers.flat_map(|x| x.to_le_bytes()).collect()
}

impl Tabled for Odometry {
    const NAME: &'static str = "odometry";
    const COLUMNS: &'static [&'static str] = &["instructions for a frame", "at most", "state"];

    fn cells(&self) -> Vec<String> {
        [self.instructions_per_frame, self.worst_frame_instructions, self.state_bytes]
            .map(|n| n.to_string())
            .into()
    }

    fn taken(&self) -> &Taken {
        &self.taken
    }
}

impl Odometry {
    /// In a line.
    pub fn summary(&self) -> String {
        let line = format!(
            "{} instructions for a frame, {} at most; {} points agree in the last, {} urad turned; state {} \
             bytes",
            self.instructions_per_frame,
            self.worst_frame_instructions,
            self.inliers,
            self.turned_urad,
            self.state_bytes
        );
        self.taken.summary("odometry", &line)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_host_finds_the_motion() {
        assert_eq!(bytes(&of_host().expect("motions")).len(), 4 * 12 * FRAMES);
    }
}
