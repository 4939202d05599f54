//! The program `rectify` on one core: raw lines rectified behind three lenses, and depth from them, measured,
//! and held to the host's own run.

use super::plain::Tabled;
use super::program::Optimised;
use super::results::{Ran, Taken};
use crate::steps::{Failure, Outcome};
use firmware_boards::{self as board, Board};
use firmware_scenes::raw_pair::{Broken, Lens, Lowered, RawPair, SCENE, on_board};
use firmware_scenes::scene::SceneCamera;
use serde::Serialize;
use std::convert::Infallible;
use stereopsis::matching::Row;

/// The most instructions for a rectified pixel on these cores, whatever the lens.
const MOST_PER_PIXEL: f64 = 34.0;
/// The cores that this is for.
const HELD: [&str; 2] = ["m4", "m7"];
/// The most state of both remaps beside the lines, bytes.
const MOST_STATE: u64 = 12 * 1024;
/// The most stack, bytes.
const MOST_STACK: u64 = 4 * 1024;
/// The least of the board's pixels that have to be near the truth, in 100.
const LEAST_RIGHT: u32 = 90;

/// What came of it. Names and units of the fields are a contract with programs that read `summary.json`.
#[derive(Serialize)]
pub struct Rectify {
    #[serde(flatten)]
    taken: Taken,
    width: u16,
    height: u16,
    /// Of one camera, without a lens, with a mild and with a strong one.
    instructions_per_pixel: [f64; 3],
    /// A frame of depth from raw lines.
    depth_instructions: u64,
    /// Both remaps, beside the lines that they hold.
    state_bytes: u64,
    band_bytes: u64,
    /// Of the pixels that show the board, those whose disparity is near the truth.
    right_percent: f64,
}

/// Builds the program and runs it; fails when what it finds is not what the host finds, to the bit, or far
/// from the truth, and when it takes more than it may.
pub fn run(board: Board, optimised: Optimised) -> Outcome<Rectify> {
    let ran = Ran::of(board, "rectify", optimised, &of_host()?)?;
    let state_bytes = ran.figure("state_bytes")?;
    ran.within(&[
        ("bytes of state", state_bytes, MOST_STATE),
        ("bytes of stack", ran.taken.stack_bytes, MOST_STACK),
    ])?;
    let pixels = 2.0 * f64::from(SCENE.width) * f64::from(SCENE.height);
    let mut instructions_per_pixel = [0.0; 3];
    for (per_pixel, ticks) in
        instructions_per_pixel.iter_mut().zip(["none_ticks", "mild_ticks", "strong_ticks"])
    {
        *per_pixel = ran.instructions(ticks)? as f64 / pixels;
        if HELD.contains(&board.core) && *per_pixel > MOST_PER_PIXEL {
            let what =
                format!("{ticks}: {per_pixel:.1} instructions for a pixel, at most {MOST_PER_PIXEL} may be");
            return Err(ran.failed(what));
        }
    }
    Ok(Rectify {
        width: SCENE.width,
        height: SCENE.height,
        instructions_per_pixel,
        depth_instructions: ran.instructions("depth_ticks")?,
        state_bytes,
        band_bytes: ran.figure("band_bytes")?,
        right_percent: 100.0 * ran.figure("right")? as f64 / ran.figure("shown")?.max(1) as f64,
        taken: ran.taken,
    })
}

/// The bytes of `rectify.bin`: behind each lens the left and the right line of each row and which of their
/// pixels are valid; then the disparity and the flags of each pixel.
fn of_host() -> Outcome<Vec<u8>> {
    let mut pair = Box::new(RawPair::new());
    let failed = |e: Broken<Infallible>| Failure::new(format!("the host rectifies nothing: {e:?}"));
    let mut bytes = Vec::new();
    for lens in [Lens::None, Lens::Mild, Lens::Strong] {
        let take = |lines: [&[u8]; 4]| {
            bytes.extend(lines.concat());
            Ok(())
        };
        pair.remap(lens, SceneCamera::new(SCENE), || 0, take).map_err(failed)?;
    }
    let (mut shown, mut right) = (0, 0);
    let take = |row: &Row<'_>| {
        let (more_shown, more_right) = on_board(row);
        (shown, right) = (shown + more_shown, right + more_right);
        for (disparity, flags) in row.disparities().iter().zip(row.flags()) {
            bytes.extend(disparity.raw().to_le_bytes());
            bytes.push(flags.bits());
        }
        Ok(())
    };
    pair.depth(Lowered::new(), || 0, take).map_err(failed)?;
    if right * 100 < shown * LEAST_RIGHT {
        return Err(Failure::new(format!("of {shown} pixels that show the board the host finds {right}")));
    }
    Ok(bytes)
}

impl Tabled for Rectify {
    const NAME: &'static str = "rectify";
    /// The dense path is made for speed.
    const CASES: &'static [(Board, Optimised)] =
        &[(board::M4, Optimised::Speed), (board::M7, Optimised::Speed)];
    const COLUMNS: &'static [&'static str] =
        &["no lens", "mild lens", "strong lens", "depth", "state", "raw lines"];

    fn cells(&self) -> Vec<String> {
        let numbers = [self.depth_instructions, self.state_bytes, self.band_bytes].map(|n| n.to_string());
        self.instructions_per_pixel.map(|n| format!("{n:.1}")).into_iter().chain(numbers).collect()
    }

    fn taken(&self) -> &Taken {
        &self.taken
    }
}

impl Rectify {
    /// In a line.
    pub fn summary(&self) -> String {
        let [none, mild, strong] = self.instructions_per_pixel;
        let line = format!(
            "{none:.1} instructions for a pixel without a lens, {mild:.1} with a mild and {strong:.1} with \
             a strong one; {} for a frame of depth, {:.1} % right; state {} bytes beside {} of lines",
            self.depth_instructions, self.right_percent, self.state_bytes, self.band_bytes
        );
        self.taken.summary("rectify", &line)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_host_finds_the_board() {
        let (pixels, lenses) = (usize::from(SCENE.width) * usize::from(SCENE.height), 3);
        assert_eq!(of_host().expect("lines").len(), (4 * lenses + 3) * pixels);
    }
}
