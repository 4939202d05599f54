//! Nanoseconds on this machine: the best of several frames, for every method and kernel.

use super::sizes::{Column, Size, series};
use super::table;
use crate::steps::{Failure, Outcome};
use stereopsis::matching::Kernel;
use stereopsis_host::run::{MemoryPair, MethodName, RunOptions, time_frames};
use stereopsis_host::scene::Scene;

const WIDTHS: [u16; 6] = [160, 320, 639, 640, 1280, 2560];
const HEIGHTS: [u16; 5] = [60, 120, 240, 480, 960];
const DISPARITIES: [u16; 8] = [32, 64, 80, 96, 128, 160, 192, 256];

/// Evaluations that are timed at a size, in frames: at least [`FEWEST`].
const EVALUATIONS: u64 = 100_000_000;
const FEWEST: u64 = 3;

/// Times all of it and prints it.
pub fn run() -> Outcome {
    let series = series(&WIDTHS, &HEIGHTS, &DISPARITIES);
    let sizes: Vec<Size> = series.iter().flat_map(|(_, sizes)| sizes.iter().copied()).collect();
    let kernels: Vec<(MethodName, Kernel)> = MethodName::ALL
        .into_iter()
        .flat_map(|method| Kernel::available().map(move |kernel| (method, kernel)))
        .collect();
    let mut columns: Vec<Column> = kernels
        .iter()
        .map(|(method, kernel)| Column { on: kernel.name().to_owned(), method: *method, costs: Vec::new() })
        .collect();
    for size in sizes {
        let (left, right) = Scene::small(size.width, size.height).render();
        let camera = MemoryPair::new(size.width, left.into_raw(), right.into_raw());
        let mut camera = camera.ok_or_else(|| Failure::new("the pictures are empty"))?;
        for (column, &(method, kernel)) in columns.iter_mut().zip(&kernels) {
            let config = method.config(size.width, size.height, size.disparities);
            let options = RunOptions { kernel: Some(kernel), ..method.into() };
            let frames = (EVALUATIONS / size.evaluations()).max(FEWEST);
            let timed = time_frames(options, &config, &mut camera, frames as usize);
            let (times_ms, _) = timed.map_err(|e| Failure::new(format!("{method} on the host: {e}")))?;
            let best_ms = times_ms.into_iter().fold(f64::INFINITY, f64::min);
            column.costs.push(best_ms * 1e6 / size.evaluations() as f64);
        }
        println!("{size} disparities are timed");
    }
    println!("\nNanoseconds for an evaluation:\n\n{}", table::text(&series, &columns));
    Ok(())
}
