//! The program `focus` on one core: frames of a lens that moves to where each tile is in focus, measured, and
//! held to the host's own run.

use super::plain::Tabled;
use super::program::Optimised;
use super::results::{Ran, Taken};
use crate::steps::{Failure, Outcome};
use firmware_boards::Board;
use firmware_scenes::sweep::{CONFIG, FRAMES, HEIGHT, Map, Sweep, WIDTH, in_focus_q8};
use serde::Serialize;

/// The most instructions for a pixel of a frame on these cores, made for speed.
const MOST_PER_PIXEL: f64 = 60.0;
/// The cores that this is for.
const HELD: [&str; 2] = ["m4", "m7"];
/// The most state, bytes.
const MOST_STATE: u64 = 24 * 1024;
/// The most stack, bytes.
const MOST_STACK: u64 = 2 * 1024;
/// The median of the tiles' distances from the truth may be so much, in 1/256 frame: a tenth of a frame.
const MOST_ERROR_Q8: u32 = 25;

/// What came of it. Names and units of the fields are a contract with programs that read `summary.json`.
#[derive(Serialize)]
pub struct Focus {
    #[serde(flatten)]
    taken: Taken,
    width: usize,
    height: usize,
    frames: u32,
    /// All frames through the map, and the end of the sweep.
    instructions: u64,
    instructions_per_pixel: f64,
    /// The map.
    state_bytes: u64,
    tiles: u64,
    in_focus: u64,
    median_error_frames: f64,
    crc32: String,
}

/// Builds the program and runs it; fails when what it finds is not what the host finds, to the bit, or far
/// from the truth, and when it takes more than it may.
pub fn run(board: Board, optimised: Optimised) -> Outcome<Focus> {
    let sweep = of_host()?;
    let found = bytes(&sweep.map);
    let ran = Ran::of(board, "focus", optimised, &found)?;
    let error = median_error_q8(&sweep.map).ok_or_else(|| ran.failed("nothing is in focus".into()))?;
    let state_bytes = ran.figure("state_bytes")?;
    ran.within(&[
        ("bytes of state", state_bytes, MOST_STATE),
        ("bytes of stack", ran.taken.stack_bytes, MOST_STACK),
        ("1/256 frame from the truth in the median", error.into(), MOST_ERROR_Q8.into()),
    ])?;
    let instructions = ran.instructions("ticks")?;
    let instructions_per_pixel = instructions as f64 / ran.figure("pixels")?.max(1) as f64;
    let is_held = HELD.contains(&board.core) && optimised == Optimised::Speed;
    if is_held && instructions_per_pixel > MOST_PER_PIXEL {
        let what =
            format!("{instructions_per_pixel:.1} instructions for a pixel, at most {MOST_PER_PIXEL} may be");
        return Err(ran.failed(what));
    }
    Ok(Focus {
        width: WIDTH,
        height: HEIGHT,
        frames: FRAMES,
        instructions,
        instructions_per_pixel,
        state_bytes,
        tiles: ran.figure("tiles")?,
        in_focus: ran.figure("in_focus")?,
        median_error_frames: f64::from(error) / 256.0,
        crc32: format!("{:08x}", crc32fast::hash(&found)),
        taken: ran.taken,
    })
}

/// What the host finds in the same frames.
fn of_host() -> Outcome<Box<Sweep>> {
    let mut sweep = Box::new(Sweep::new());
    sweep.run(|| 0).map_err(|e| Failure::new(format!("the host finds no focus: {e:?}")))?;
    Ok(sweep)
}

/// All tiles, row by row: column and row.
fn tiles() -> impl Iterator<Item = (usize, usize)> {
    (0..CONFIG.rows()).flat_map(|row| (0..CONFIG.columns()).map(move |column| (column, row)))
}

/// The bytes of `focus.bin`: of every tile the frame, its deviation and the confidence; all ones where none
/// is sharpest.
fn bytes(map: &Map) -> Vec<u8> {
    let one = |(column, row)| match map.peak(column, row) {
        Ok(peak) => {
            let [a, b, c, d] = peak.position_q8.to_le_bytes();
            let [e, f, g, h] = peak.sigma_q8.to_le_bytes();
            [a, b, c, d, e, f, g, h, peak.confidence]
        }
        Err(_) => [0xff; 9],
    };
    tiles().flat_map(one).collect()
}

/// The median of the tiles' distances from the frame in which their middle is in focus, in 1/256.
fn median_error_q8(map: &Map) -> Option<u32> {
    let side = usize::from(CONFIG.cell_px);
    let error = |(column, row)| {
        Some(map.peak(column, row).ok()?.position_q8.abs_diff(in_focus_q8(column * side + side / 2)))
    };
    let mut errors: Vec<u32> = tiles().filter_map(error).collect();
    errors.sort_unstable();
    errors.get(errors.len() / 2).copied()
}

impl Tabled for Focus {
    const NAME: &'static str = "focus";
    const COLUMNS: &'static [&'static str] = &["instructions for a pixel of a frame", "state"];

    fn cells(&self) -> Vec<String> {
        vec![format!("{:.1}", self.instructions_per_pixel), self.state_bytes.to_string()]
    }

    fn taken(&self) -> &Taken {
        &self.taken
    }
}

impl Focus {
    /// In a line.
    pub fn summary(&self) -> String {
        let line = format!(
            "{:.1} instructions for a pixel of a frame; state {} bytes; {} of {} tiles are in focus, {:.3} \
             frames from the truth in the median, crc32 {}",
            self.instructions_per_pixel,
            self.state_bytes,
            self.in_focus,
            self.tiles,
            self.median_error_frames,
            self.crc32
        );
        self.taken.summary("focus", &line)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slope_is_found() {
        let sweep = of_host().expect("a sweep");
        assert_eq!(bytes(&sweep.map).len(), 9 * CONFIG.cells());
        assert!(median_error_q8(&sweep.map).is_some_and(|error| error <= MOST_ERROR_Q8));
        // Nothing is in focus before the lens has moved.
        assert_eq!(median_error_q8(&Sweep::new().map), None);
    }
}
