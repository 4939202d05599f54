//! `cargo xtask soak`: many frames of a camera with every fault, each row held to the frame without one.

use crate::steps::{Failure, Outcome};
use clap::Args;
use std::convert::Infallible;
use std::fs;
use std::time::Instant;
use stereopsis::camera::{CameraError, ErrorType, FrameStart, LineFormat, LineStart, StereoSource};
use stereopsis::matching::{Block, Config, Fast, Method, Row, Sgm};
use stereopsis::pipeline::{Guarded, Pipeline};
use stereopsis::units::{Disparity, PixelFlags};
use stereopsis_host::fault::{Fault, Faulty};
use stereopsis_host::run::MemoryPair;
use stereopsis_host::scene::pattern::Pattern;

const WIDTH: u16 = 320;
const HEIGHT: u16 = 240;
const DISPARITIES: u16 = 32;
/// The probability of a fault in a line, and in a frame.
const RATES: [f64; 5] = [1e-4, 1e-3, 1e-2, 1e-1, 0.5];
/// What the program's memory may grow by, KB: the largest record of a frame's faults.
const MOST_GROWTH_KB: u64 = 1024;

/// What is run.
#[derive(Args)]
pub struct Arguments {
    /// Frames in all, shared by five rates of faults and three methods.
    #[arg(long, value_name = "N", default_value_t = 10_000)]
    frames: u32,
}

/// Runs the frames, and names the first row that is wrong without a flag, or flagged without a fault.
pub fn run(arguments: &Arguments) -> Outcome {
    let each = arguments.frames.div_ceil(3 * RATES.len() as u32).max(1);
    println!("method  rate     frames  rows      flagged   damaged frames  KB");
    soak::<Fast>(each)?;
    soak::<Block>(each)?;
    soak::<Sgm>(each)
}

/// Two pairs by turns, so that a line of the frame before is another line.
struct ByTurns {
    pairs: [MemoryPair; 2],
    frames: u32,
}

impl ByTurns {
    fn new() -> Outcome<Self> {
        let pair = |seed| {
            let pattern = Pattern::Shifted { most: 20, noise_grey: 3.0 };
            let (left, right) = pattern.pair(WIDTH.into(), HEIGHT.into(), seed);
            let pair = MemoryPair::new(WIDTH, left.into_raw(), right.into_raw());
            pair.ok_or_else(|| Failure::new("the pictures are empty"))
        };
        Ok(Self { pairs: [pair(1)?, pair(2)?], frames: 0 })
    }

    fn pair(&mut self) -> &mut MemoryPair {
        &mut self.pairs[self.frames as usize % 2]
    }
}

impl ErrorType for ByTurns {
    type Error = Infallible;
}

impl StereoSource for ByTurns {
    fn format(&self) -> LineFormat {
        self.pairs[0].format()
    }

    fn max_row_skew_us(&self) -> u32 {
        0
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Infallible>> {
        self.frames += 1;
        let sequence = self.frames;
        self.pair().start_frame()?;
        Ok(FrameStart { sequence, timestamp_us: u64::from(sequence) * 1000, exposure_us: 10 })
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Infallible>> {
        let frame_us = u64::from(self.frames) * 1000;
        let line = self.pair().next_lines(left, right)?;
        Ok(LineStart { row: line.row, timestamp_us: frame_us + u64::from(line.row) })
    }
}

/// A row as it came.
#[derive(PartialEq)]
struct Kept(Vec<Disparity>, Vec<PixelFlags>, Vec<u8>);

impl From<Row<'_>> for Kept {
    fn from(row: Row<'_>) -> Self {
        Self(row.disparities().to_vec(), row.flags().to_vec(), row.confidences().to_vec())
    }
}

fn config<S: Method>() -> Config {
    Config { confidence: true, ..Config::for_method::<S>(WIDTH, HEIGHT, DISPARITIES) }
}

/// The rows of even frames and of odd ones, without a fault.
fn reference<S: Method>() -> Outcome<[Vec<Kept>; 2]> {
    let mut source = ByTurns::new()?;
    let mut pipeline = Box::new(Pipeline::<S, 320, 32>::new());
    let failed = |e: &dyn std::fmt::Display| Failure::new(format!("{}: {e}", S::NAME));
    pipeline.start(&config::<S>()).map_err(|e| failed(&e))?;
    let mut frame = || {
        pipeline.begin_frame(&mut source).map_err(|e| failed(&e))?;
        let mut rows = Vec::new();
        while let Some(row) = pipeline.next_row(&mut source).map_err(|e| failed(&e))? {
            rows.push(Kept::from(row));
        }
        Outcome::Ok(rows)
    };
    let (odd, even) = (frame()?, frame()?);
    Ok([even, odd])
}

/// Frames at each rate with one method.
fn soak<S: Method>(frames: u32) -> Outcome {
    let reference = reference::<S>()?;
    let mut before_kb = None;
    for (seed, rate) in RATES.into_iter().enumerate() {
        let began = Instant::now();
        let mut source = Faulty::new(ByTurns::new()?, &Fault::ALL, rate, seed as u64 + 1);
        let mut guarded = Box::new(Guarded::<S, 320, 32>::new());
        guarded.start(&config::<S>()).map_err(|e| Failure::new(format!("{}: {e}", S::NAME)))?;
        let (mut rows, mut flagged) = (0_u64, 0_u64);
        for number in 0..frames {
            let failed =
                |what: String| Failure::new(format!("{}, rate {rate}, frame {number}: {what}", S::NAME));
            let (more, of_them) = frame(&mut guarded, &mut source, &reference).map_err(failed)?;
            (rows, flagged) = (rows + more, flagged + of_them);
        }
        let counters = guarded.counters();
        if u64::from(counters.rows) != rows || u64::from(counters.rows_damaged) != flagged {
            return Err(Failure::new(format!("{}, rate {rate}: {counters:?} are not its rows", S::NAME)));
        }
        let used_kb = resident_kb()?;
        println!(
            "{:7} {rate:<8} {frames:6}  {rows:8}  {flagged:8}  {:14}  {used_kb}  ({:.0} s)",
            S::NAME,
            counters.frames_damaged + counters.frames_broken,
            began.elapsed().as_secs_f64()
        );
        let first_kb = *before_kb.get_or_insert(used_kb);
        if used_kb > first_kb + MOST_GROWTH_KB {
            let name = S::NAME;
            return Err(Failure::new(format!("{name}: memory grew from {first_kb} to {used_kb} KB")));
        }
    }
    Ok(())
}

/// One frame: its rows, and how many are flagged.
fn frame<S: Method>(
    guarded: &mut Guarded<S, 320, 32>,
    source: &mut Faulty<ByTurns>,
    reference: &[Vec<Kept>; 2],
) -> Result<(u64, u64), String> {
    if guarded.begin_frame(source).is_err() {
        return Ok((0, 0));
    }
    let reach_down = guarded.reach_down();
    let mut rows = Vec::new();
    while let Ok(Some(row)) = guarded.next_row(source) {
        rows.push(Kept::from(row));
    }
    let record = source.record();
    let right = &reference[source.inner().frames as usize % 2];
    let mut flagged = 0;
    for (y, (row, right)) in rows.iter().zip(right).enumerate() {
        let is_flagged = row.1.iter().all(|flags| flags.contains(PixelFlags::DAMAGED));
        let reaches = |&(line, _): &(u16, Fault)| {
            let line = usize::from(line);
            y + Pipeline::<S, 320, 32>::LATENCY >= line && y <= line.saturating_add(reach_down)
        };
        let has_cause = record.lost.iter().any(reaches);
        if !is_flagged && row != right {
            return Err(format!("row {y} is wrong and not flagged: {record:?}"));
        }
        if is_flagged != has_cause {
            return Err(format!("row {y} is flagged without a fault, or not in spite of one: {record:?}"));
        }
        flagged += u64::from(is_flagged);
    }
    Ok((rows.len() as u64, flagged))
}

/// The memory that the program has, KB; 0 where the system does not say so.
fn resident_kb() -> Outcome<u64> {
    let Ok(status) = fs::read_to_string("/proc/self/status") else { return Ok(0) };
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let number = line.and_then(|line| line.split_whitespace().next()?.parse().ok());
    number.ok_or_else(|| Failure::new("/proc/self/status has no VmRSS"))
}
