//! The program `drive` on one core: a robot that drives by its obstacles, measured beside the matcher, and
//! held to the host's own run.

use super::plain::Tabled;
use super::program::Optimised;
use super::results::{Ran, Taken};
use crate::steps::{Failure, Outcome};
use firmware_boards::{self as board, Board};
use firmware_scenes::drive::{BOARD, HEIGHT, Robot, Step, Ticks, WIDTH};
use serde::Serialize;
use stereopsis::obstacles::Decision;

/// The most instructions of obstacles, of those of the matcher (`block`) in the same frames, where both are
/// made for speed, percent.
const MOST_PERCENT: f64 = 10.0;
/// The most state of the obstacles, bytes.
const MOST_STATE: u64 = 4 * 1024;
/// The most stack, bytes.
const MOST_STACK: u64 = 2 * 1024;

/// What came of it. Names and units of the fields are a contract with programs that read `summary.json`.
#[derive(Serialize)]
pub struct Drive {
    #[serde(flatten)]
    taken: Taken,
    width: usize,
    height: usize,
    frames: u64,
    /// Rows to a decision, a frame.
    instructions_per_frame: u64,
    /// Lines to rows, a frame.
    matching_instructions_per_frame: u64,
    /// The finder.
    state_bytes: u64,
    /// The matcher before it.
    matcher_bytes: u64,
    /// What was decided, frame by frame.
    decisions: Vec<String>,
    crc32: String,
}

/// Builds the program and runs it; fails when what it decides is not what the host decides, to the bit, when
/// the robot does not go from clear over slow to stop, and when it takes more than it may.
pub fn run(board: Board, optimised: Optimised) -> Outcome<Drive> {
    let steps = of_host()?;
    let found: Vec<_> = steps.iter().flat_map(Step::bytes).collect();
    let ran = Ran::of(board, "drive", optimised, &found)?;
    let order = steps.iter().map(|step| match step.decision {
        Decision::Clear => 0,
        Decision::Slow(_) => 1,
        Decision::Stop(_) => 2,
        _ => 3,
    });
    let order: Vec<_> = order.collect();
    if !order.is_sorted() || order.first() != Some(&0) || order.last() != Some(&2) || !order.contains(&1) {
        return Err(ran.failed(format!("the decisions are not clear, slow, stop: {steps:?}")));
    }
    let state_bytes = ran.figure("state_bytes")?;
    ran.within(&[
        ("bytes of state", state_bytes, MOST_STATE),
        ("bytes of stack", ran.taken.stack_bytes, MOST_STACK),
    ])?;
    let frames = ran.figure("frames")?.max(1);
    let [row, decision] = ["row_ticks", "decision_ticks"].map(|name| ran.instructions(name));
    let instructions_per_frame = (row? + decision?) / frames;
    let matching_instructions_per_frame = ran.instructions("matching_ticks")? / frames;
    let percent = 100.0 * instructions_per_frame as f64 / matching_instructions_per_frame as f64;
    if optimised == Optimised::Speed && percent > MOST_PERCENT {
        return Err(ran.failed(format!(
            "{instructions_per_frame} instructions a frame are {percent:.1} % of the matcher's, at most \
             {MOST_PERCENT} % may be"
        )));
    }
    Ok(Drive {
        width: WIDTH,
        height: HEIGHT,
        frames,
        instructions_per_frame,
        matching_instructions_per_frame,
        state_bytes,
        matcher_bytes: ran.figure("matcher_bytes")?,
        decisions: steps.iter().map(|step| format!("{:?}", step.decision)).collect(),
        crc32: format!("{:08x}", crc32fast::hash(&found)),
        taken: ran.taken,
    })
}

/// What the host decides in the same frames.
fn of_host() -> Outcome<Vec<Step>> {
    let failed = |e| Failure::new(format!("the host drives nowhere: {e:?}"));
    let mut robot = Box::new(Robot::new());
    robot.start().map_err(failed)?;
    let (mut rule, mut ticks) = (Robot::rule(), Ticks::default());
    BOARD.iter().map(|&board| robot.frame(&mut rule, board, || 0, &mut ticks).map_err(failed)).collect()
}

impl Tabled for Drive {
    const NAME: &'static str = "drive";
    /// The dense path is made for speed.
    const CASES: &'static [(Board, Optimised)] =
        &[(board::M4, Optimised::Speed), (board::M7, Optimised::Speed)];
    const COLUMNS: &'static [&'static str] =
        &["instructions a frame", "of the matcher's", "state", "matcher's state"];

    fn cells(&self) -> Vec<String> {
        let share =
            100.0 * self.instructions_per_frame as f64 / self.matching_instructions_per_frame.max(1) as f64;
        vec![
            self.instructions_per_frame.to_string(),
            format!("{share:.1} %"),
            self.state_bytes.to_string(),
            self.matcher_bytes.to_string(),
        ]
    }

    fn taken(&self) -> &Taken {
        &self.taken
    }
}

impl Drive {
    /// In a line.
    pub fn summary(&self) -> String {
        let line = format!(
            "{} instructions a frame beside {} of the matcher; state {} bytes; {}, crc32 {}",
            self.instructions_per_frame,
            self.matching_instructions_per_frame,
            self.state_bytes,
            self.decisions.join(" "),
            self.crc32
        );
        self.taken.summary(Self::NAME, &line)
    }
}
