//! One pair of pictures through the block, with its results in a folder.

use super::block::{Block, LEAST_ROOM, LEAST_WIDTH, MOST_WIDTH};
use super::frame::Halves;
use crate::pictures::Pictures;
use crate::setup;
use crate::steps::{Failure, Outcome};
use serde::Serialize;
use std::path::{Path, PathBuf};
use stereopsis::matching::Config;
use stereopsis_host::map::DisparityMap;
use stereopsis_host::output::{OutputError, Staging};
use stereopsis_host::pfm;
use stereopsis_host::run::{MethodName, NoiseChoice};

/// Percent of clocks without a pixel, and of those in which no record is taken, in the second frame.
const PAUSES: [u8; 2] = [20, 20];

/// What is asked for.
pub struct OnePair<'a> {
    /// Left and right image.
    pub pair: [&'a PathBuf; 2],
    /// Disparities that are searched.
    pub disparities: u16,
    /// The smallest of them, px.
    pub min_disparity: u16,
    /// The method.
    pub method: MethodName,
    /// Disparities in a clock; all where none is given.
    pub parallel: Option<u16>,
    /// The images' noise.
    pub noise: NoiseChoice,
    /// The folder.
    pub out: &'a Path,
}

/// `summary.json`. Names and units are a contract with programs that read it.
#[derive(Serialize)]
struct Summary {
    method: &'static str,
    width: u16,
    height: u16,
    disparities: u16,
    min_disparity: u16,
    noise: &'static str,
    /// Disparities in a clock.
    parallel: u16,
    /// From the frame's first pixel to its last record, without a pause of either stream.
    clocks: u64,
    clocks_per_pixel: f64,
    /// From the first pixel to the first record, in lines of the block's walk.
    latency_lines: f64,
    /// The same frame again, with random pauses of both streams.
    clocks_with_pauses: u64,
    density: f64,
}

impl OnePair<'_> {
    /// Writes the results.
    pub fn run(&self) -> Outcome {
        let pictures = Pictures::open(self.pair[0], self.pair[1])?;
        let (width, height, disparities) = (pictures.width, pictures.height, self.disparities);
        if !(LEAST_WIDTH..=MOST_WIDTH).contains(&width) {
            return Err(Failure::new(format!(
                "--left: the images are {width} px wide; the block takes {LEAST_WIDTH} to {MOST_WIDTH}"
            )));
        }
        let least = self.min_disparity;
        if disparities + least > width {
            let asked = format!("--min-disparity {least} and --disparities {disparities}");
            return Err(Failure::new(format!("{asked}: the images are {width} px wide")));
        }
        let room = disparities.next_multiple_of(16);
        let parallel = self.parallel.unwrap_or(room);
        if parallel == 0 || !room.is_multiple_of(parallel) {
            return Err(Failure::new(format!("--parallel {parallel}: a divisor of {room} is needed")));
        }
        Staging::probe(self.out).map_err(|e| Failure::new(format!("--out: {e}")))?;
        setup::gates()?;
        let noise = pictures.noise(self.noise)?;
        let search = pictures.search(self.method, disparities, noise);
        let config = Config { min_disparity: self.min_disparity, ..search };
        let expected = pictures.matched_by(self.method, &config)?;

        let block = Block {
            width: width.max(LEAST_ROOM),
            disparities: room,
            parallel,
            method: self.method,
            second_best: config.checks.uniqueness_percent.is_some(),
        };
        println!("building the simulation of {}", block.name());
        let mut halves = Halves::new(&block)?;
        let [left, right] = pictures.camera()?.pictures();
        let mut clocks = [0; 2];
        let mut latency = 0;
        for (clocks, [gaps, stalls]) in clocks.iter_mut().zip([[0, 0], PAUSES]) {
            let failed = |e| Failure::new(format!("the simulation: {e}"));
            halves.simulation().pause(1, gaps, stalls).map_err(failed)?;
            let map = halves.frames(1, &config, [&left, &right])?;
            if let Some(at) = difference(&map, &expected) {
                return Err(Failure::new(format!("the block differs from the host: {at}")));
            }
            let passed = halves.simulation().clocks().map_err(failed)?;
            *clocks = passed.last_record + 1 - passed.first_pixel;
            if gaps == 0 {
                latency = passed.first_record - passed.first_pixel;
            }
        }
        let pixels = f64::from(width) * f64::from(height);
        let summary = Summary {
            method: self.method.name(),
            width,
            height,
            disparities,
            min_disparity: self.min_disparity,
            noise: noise.name(),
            parallel,
            clocks: clocks[0],
            clocks_per_pixel: clocks[0] as f64 / pixels,
            latency_lines: latency as f64 / block.clocks_of_line(width) as f64,
            clocks_with_pauses: clocks[1],
            density: expected.density(),
        };
        write(self.out, &expected, &summary).map_err(|e| Failure::new(format!("--out: {e}")))?;
        println!(
            "{}: {} clocks, {:.3} a pixel, first winner after {:.2} lines; with pauses {} clocks",
            block.name(),
            summary.clocks,
            summary.clocks_per_pixel,
            summary.latency_lines,
            summary.clocks_with_pauses
        );
        println!("results are in {}, equal to the host's to the bit", self.out.display());
        Ok(())
    }
}

/// Where two maps differ first.
pub fn difference(found: &DisparityMap, expected: &DisparityMap) -> Option<String> {
    let pixels = found.disparity.len();
    let at = (0..pixels)
        .find(|&i| (found.disparity[i], found.flags[i]) != (expected.disparity[i], expected.flags[i]))?;
    Some(format!("column {}, row {}", at % found.width, at / found.width))
}

fn write(out: &Path, map: &DisparityMap, summary: &Summary) -> Result<(), OutputError> {
    let mut staging = Staging::new(out)?;
    staging.write("disparity.pfm", |file| pfm::write(file, map.width, &map.pixels()))?;
    staging.write("summary.json", |file| {
        serde_json::to_writer_pretty(&mut *file, summary)?;
        file.write_all(b"\n")
    })?;
    staging.commit(&[])
}
