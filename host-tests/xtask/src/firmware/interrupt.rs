//! The program `interrupt` on one core: lines that a timer brings while the matcher works, held to the host's
//! own rows; none lost at the rate that the matcher's instructions allow, and losses reported at twice that
//! rate.

use super::program::Optimised;
use super::results::{Ran, Taken};
use crate::pictures::block_rows;
use crate::steps::Outcome;
use firmware_boards::Board;
use firmware_scenes::scene::{Scene, SceneCamera};
use serde::Serialize;

const SCENE: Scene = Scene { width: 160, height: 120 };
const DISPARITIES: u16 = 32;
/// The most stack, bytes.
const MOST_STACK: u64 = 3 * 1024;

/// What came of it. Names and units of the fields are a contract with programs that read `summary.json`.
#[derive(Serialize)]
pub struct Interrupt {
    #[serde(flatten)]
    taken: Taken,
    width: u16,
    height: u16,
    disparities: u16,
    /// A frame without an interrupt.
    instructions: u64,
    /// From line to line, at the rate that they allow.
    instructions_per_line: u64,
    rows: u64,
    lost_lines: u64,
    /// At twice the rate: rows, lines that found no slot, rows flagged for that, and rows that are wrong
    /// without a flag.
    rows_at_twice: u64,
    lost_lines_at_twice: u64,
    damaged_rows_at_twice: u64,
    wrong_rows_at_twice: u64,
    crc32: String,
}

/// Builds the program and runs it; fails when its rows are not the host's, to the bit, when a line is lost
/// that need not be, and when one is lost untold.
pub fn run(board: Board, optimised: Optimised) -> Outcome<Interrupt> {
    let found = of_host()?;
    let ran = Ran::of(board, "interrupt", optimised, &found)?;
    let figure = |name: &str| ran.figure(name);
    ran.within(&[
        ("bytes of stack", ran.taken.stack_bytes, MOST_STACK),
        ("lines found no slot at the rate that is allowed", figure("overruns_allowed")?, 0),
        ("lines were lost there", figure("lost_allowed")?, 0),
        ("rows were flagged there", figure("damaged_allowed")?, 0),
        ("rows were wrong there", figure("wrong_allowed")?, 0),
        ("rows were wrong without a flag at twice the rate", figure("wrong_twice")?, 0),
    ])?;
    let (overruns, lost, damaged) =
        (figure("overruns_twice")?, figure("lost_twice")?, figure("damaged_twice")?);
    if overruns == 0 || lost == 0 || damaged == 0 {
        let line = format!(
            "{overruns} overruns, {lost} lines lost, {damaged} rows flagged at twice the rate: none may be 0"
        );
        return Err(ran.failed(line));
    }
    Ok(Interrupt {
        width: SCENE.width,
        height: SCENE.height,
        disparities: DISPARITIES,
        instructions: ran.instructions("ticks")?,
        instructions_per_line: ran.instructions("line_ticks")?,
        rows: figure("rows_allowed")?,
        lost_lines: 0,
        rows_at_twice: figure("rows_twice")?,
        lost_lines_at_twice: lost,
        damaged_rows_at_twice: damaged,
        wrong_rows_at_twice: 0,
        crc32: format!("{:08x}", crc32fast::hash(&found)),
        taken: ran.taken,
    })
}

/// The bytes of `interrupt.bin`.
fn of_host() -> Outcome<Vec<u8>> {
    block_rows(&mut SceneCamera::new(SCENE), DISPARITIES)
}

impl Interrupt {
    /// In a line.
    pub fn summary(&self) -> String {
        let line = format!(
            "a line every {} instructions, {} rows and no line lost; at twice the rate {} lines lost and \
             told, {} of {} rows flagged, none wrong without a flag; crc32 {}",
            self.instructions_per_line,
            self.rows,
            self.lost_lines_at_twice,
            self.damaged_rows_at_twice,
            self.rows_at_twice,
            self.crc32
        );
        self.taken.summary("interrupt", &line)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_host_finds_rows() {
        let found = of_host().expect("rows");
        assert_eq!(found.len(), 3 * 160 * 120);
        let answers = found.chunks(3).filter(|pixel| pixel[..2] != [0xff, 0xff]).count();
        assert!(answers > 160 * 120 / 2, "{answers}");
    }
}
