//! One frame on one core, measured, and held to the host's own run.

use super::program::{Built, Program};
use super::{emulate, log};
use crate::elf::Sizes;
use crate::pictures::Pictures;
use crate::steps::{Failure, Outcome};
use firmware_boards::Board;
use std::collections::HashMap;
use std::fs;
use stereopsis::units::{Disparity, PixelFlags};
use stereopsis_host::map::DisparityMap;

/// The most stack that a run may take, bytes.
pub const MOST_STACK: u64 = 2048;
/// Instructions of the firmware's known work.
const KNOWN: f64 = 2_000_000.0;
/// The share that they may be counted wrong by: the counter's step and the reading of it.
const KNOWN_WITHIN: f64 = 0.001;
/// Bytes of a pixel in the firmware's rows.
const PIXEL: usize = 3;

/// What came of a frame.
pub struct Frame {
    /// What ran.
    pub program: Program,
    /// Disparities and flags, equal to the host's.
    pub map: DisparityMap,
    /// Instructions from the camera's lines to checked rows, the camera's own taken off.
    pub instructions: u64,
    /// The most stack in use, bytes.
    pub stack: u64,
    /// Bytes of the pipeline on this core.
    pub pipeline: u64,
    /// What the program takes.
    pub sizes: Sizes,
    /// CRC-32 over disparity and flags of every pixel.
    pub crc32: u32,
    /// The firmware's log.
    pub log: Vec<String>,
}

/// Runs a frame, compares it with the host's, and holds its stack to the limit. `is_scene` leaves the
/// pictures to the firmware's own scene.
pub fn run(built: &Built, pictures: &Pictures, is_scene: bool) -> Outcome<Frame> {
    let frame = with_any_stack(built, pictures, is_scene)?;
    if frame.stack > MOST_STACK {
        let (program, stack) = (frame.program, frame.stack);
        return Err(Failure::new(format!(
            "{program}: {stack} bytes of stack are in use, at most {MOST_STACK} may be"
        )));
    }
    Ok(frame)
}

/// [`run`] for what is larger than the sizes that the limit is for.
pub fn with_any_stack(built: &Built, pictures: &Pictures, is_scene: bool) -> Outcome<Frame> {
    let program = built.program;
    let failed = |what: String| Failure::new(format!("{program}: {what}"));
    let folder = tempfile::tempdir().map_err(|e| failed(e.to_string()))?;
    if !is_scene {
        pictures.write(folder.path())?;
    }
    let printed = emulate::run(built, folder.path())?;
    let figures = figures(&printed);
    let figure =
        |name: &str| figures.get(name).copied().ok_or_else(|| failed(format!("it prints no {name}")));
    let log = log::read(&built.elf, &program.to_string(), folder.path())?;
    let rows = fs::read(folder.path().join("rows.bin")).map_err(|e| failed(format!("rows.bin: {e}")))?;

    let map = pictures.matched(program.method, program.disparities, program.noise)?;
    if let Some(what) = difference(&map, &rows) {
        return Err(failed(what));
    }
    let crc32 = crc32fast::hash(&rows);
    if u64::from(crc32) != figure("crc32")? {
        return Err(failed(format!(
            "its checksum is {:08x}, that of its rows {crc32:08x}",
            figure("crc32")?
        )));
    }
    calibrated(program.board, figure("calibration_ticks")?).map_err(failed)?;
    let stack = figure("stack_bytes")?;
    let sizes = Sizes::of(&built.elf)?;
    sizes.without_panics()?;
    let (instructions, pipeline) = (instructions(program.board, figure("ticks")?), figure("pipeline_bytes")?);
    Ok(Frame { program, map, instructions, stack, pipeline, sizes, crc32, log })
}

impl Frame {
    /// Instructions for each disparity of each pixel.
    pub fn per_evaluation(&self) -> f64 {
        self.instructions as f64 / self.program.evaluations() as f64
    }

    /// The frame in a line.
    pub fn summary(&self) -> String {
        format!(
            "{}: {} instructions, {:.2} for each of {} evaluations; RAM {} bytes, stack {}, flash {}, crc32 \
             {:08x}",
            self.program,
            self.instructions,
            self.per_evaluation(),
            self.program.evaluations(),
            self.sizes.static_ram,
            self.stack,
            self.sizes.flash(),
            self.crc32
        )
    }
}

/// The instructions of so many ticks.
pub fn instructions(board: Board, ticks: u64) -> u64 {
    (ticks as f64 * 1e9 / f64::from(board.ticks_per_second)).round() as u64
}

/// Whether a board counts known work right; else what is wrong.
pub fn calibrated(board: Board, ticks: u64) -> Result<(), String> {
    let known = instructions(board, ticks) as f64;
    if (known - KNOWN).abs() > KNOWN * KNOWN_WITHIN {
        return Err(format!("{KNOWN} instructions are counted as {known}: the board's clock is another"));
    }
    Ok(())
}

/// The firmware's lines of a name and a number.
pub fn figures(printed: &str) -> HashMap<&str, u64> {
    let words = printed.lines().filter_map(|line| line.trim().split_once(' '));
    words.filter_map(|(name, number)| Some((name, number.parse().ok()?))).collect()
}

/// Where the firmware's rows differ from the host's map, if they do.
fn difference(map: &DisparityMap, rows: &[u8]) -> Option<String> {
    let pixels = rows.as_chunks::<PIXEL>().0;
    if rows.len() != map.disparity.len() * PIXEL {
        return Some(format!("it gave {} pixels, the host {}", pixels.len(), map.disparity.len()));
    }
    let board = pixels.iter().map(|&[low, high, flags]| {
        (Disparity::from_raw(u16::from_le_bytes([low, high])), PixelFlags::from_bits(flags))
    });
    let host = map.disparity.iter().copied().zip(map.flags.iter().copied());
    let (at, (board, host)) = board.zip(host).enumerate().find(|(_, (board, host))| board != host)?;
    let (x, y) = (at % map.width, at / map.width);
    let told = |(d, flags): (Disparity, PixelFlags)| format!("{d}, flags {:#04x}", flags.bits());
    Some(format!("column {x}, row {y}: {} on the board, {} on the host", told(board), told(host)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_read() {
        let figures = figures("rows 120\r\nnote: none\nticks 7\n");
        assert_eq!(figures, HashMap::from([("rows", 120), ("ticks", 7)]));
    }

    #[test]
    fn one_bit_makes_a_difference() {
        let mut map = DisparityMap::new(2, 1);
        map.disparity[1] = Disparity::from_raw(0x0102);
        let rows = [0xff, 0xff, 0, 2, 1, 0];
        assert_eq!(difference(&map, &rows), None);
        for bit in 0..8 * rows.len() {
            let mut other = rows;
            other[bit / 8] ^= 1 << (bit % 8);
            assert!(difference(&map, &other).is_some(), "bit {bit}");
        }
        assert!(difference(&map, &rows[..3]).is_some());
    }
}
