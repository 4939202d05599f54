//! `cargo xtask soak`: many frames of a camera with every fault, each row held to the frame without one.
//!
//! * [`direct`]: the camera before the pipeline. [`replayed`]: a recording of it, through what plays
//!   recordings in `stereo replay`. [`board`]: such a recording on an emulated Cortex-M4.
//! * [`source`]: what the camera sees, and what was done to each of its frames. [`held`]: a frame's rows
//!   beside that.

mod board;
mod direct;
mod held;
mod replayed;
mod source;

use crate::steps::{Failure, Outcome};
use clap::Args;
use std::fs;
use std::time::Instant;
use stereopsis::matching::{Block, Config, Fast, Method, Sgm};

const WIDTH: u16 = 320;
const HEIGHT: u16 = 240;
const DISPARITIES: u16 = 32;
/// The probability of a fault in a line, and in a frame.
const RATES: [f64; 5] = [1e-4, 1e-3, 1e-2, 1e-1, 0.5];
/// What the program's memory may grow by after the first quarter of the frames at a rate, KB: what is touched
/// for the first time in a short run. Nine bytes kept of each row would be more in 10 000 frames.
const MOST_GROWTH_KB: u64 = 1024;

/// What is run.
#[derive(Args)]
pub struct Arguments {
    /// Frames in all, shared by five rates of faults and three methods: as many from the camera, and as many
    /// from recordings.
    #[arg(long, value_name = "N", default_value_t = 10_000)]
    frames: u32,
    /// Frames on an emulated Cortex-M4, shared by the rates; 0 leaves it out.
    #[arg(long, value_name = "N", default_value_t = 200)]
    emulated: u32,
}

/// Runs the frames, and names the first row that is wrong without a flag, or flagged without a fault.
pub fn run(arguments: &Arguments) -> Outcome {
    let rates = RATES.len() as u32;
    let each = arguments.frames.div_ceil(3 * rates).max(1);
    println!("from      method  rate     frames  rows      flagged   damaged frames  KB      grown  s");
    direct::soak::<Fast>(each)?;
    direct::soak::<Block>(each)?;
    direct::soak::<Sgm>(each)?;
    replayed::soak::<Fast>(each)?;
    replayed::soak::<Block>(each)?;
    replayed::soak::<Sgm>(each)?;
    match arguments.emulated {
        0 => Ok(()),
        emulated => board::soak(emulated.div_ceil(rates)),
    }
}

fn config<S: Method>() -> Config {
    Config { confidence: true, ..Config::for_method::<S>(WIDTH, HEIGHT, DISPARITIES) }
}

/// What came of the frames at one rate.
struct Sums {
    /// Frames that are run.
    due: u32,
    /// Those that were.
    frames: u32,
    rows: u64,
    flagged: u64,
    /// Frames with a flagged row, or without the last rows.
    damaged_frames: u64,
    /// The memory after the first quarter of the frames, KB.
    settled_kb: u64,
    began: Instant,
}

impl Sums {
    /// Before the first of so many frames.
    fn new(due: u32) -> Self {
        Self { due, frames: 0, rows: 0, flagged: 0, damaged_frames: 0, settled_kb: 0, began: Instant::now() }
    }

    /// What the program's memory grew by since the first quarter of the frames, KB.
    fn grown_kb(&self) -> Outcome<u64> {
        resident_kb().map(|kb| kb.saturating_sub(self.settled_kb)).map_err(Failure::new)
    }

    /// Fails when the memory grew.
    fn is_flat(&self, from: &str, method: &str) -> Outcome {
        match self.grown_kb()? {
            0..=MOST_GROWTH_KB => Ok(()),
            grown_kb => Err(Failure::new(format!(
                "{from}, {method}: memory grew by {grown_kb} KB, {MOST_GROWTH_KB} at most may be"
            ))),
        }
    }

    /// A line of the table.
    fn tell(&self, from: &str, method: &str, rate: f64) -> Outcome {
        let Self { frames, rows, flagged, damaged_frames, settled_kb, .. } = *self;
        let grown_kb = self.grown_kb()?;
        println!(
            "{from:8}  {method:6}  {rate:<7}  {frames:6}  {rows:8}  {flagged:8}  {damaged_frames:14}  \
             {settled_kb:6}  {grown_kb:5}  {:.0}",
            self.began.elapsed().as_secs_f64()
        );
        Ok(())
    }
}

/// The memory that the program has written to, KB, which Linux tells: without it nothing is known of growth.
fn resident_kb() -> Result<u64, String> {
    const STATUS: &str = "/proc/self/status";
    let status = fs::read_to_string(STATUS).map_err(|e| format!("{STATUS}: {e}"))?;
    rss_kb(&status).ok_or_else(|| format!("{STATUS} has no memory in a line RssAnon"))
}

/// The memory that a status names; some is always written to.
fn rss_kb(status: &str) -> Option<u64> {
    let line = status.lines().find_map(|line| line.strip_prefix("RssAnon:"))?;
    line.split_whitespace().next()?.parse().ok().filter(|&kb| kb > 0)
}

#[cfg(test)]
mod tests {
    use super::rss_kb;

    #[test]
    fn memory_that_is_not_told_is_not_none() {
        assert_eq!(rss_kb("Name:\tsoak\nRssAnon:\t    1234 kB\nRssFile:\t 9 kB\n"), Some(1234));
        for status in ["", "RssFile: 9 kB\n", "RssAnon:\n", "RssAnon: 0 kB\n"] {
            assert_eq!(rss_kb(status), None, "{status}");
        }
    }
}
