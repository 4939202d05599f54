//! The files of one frame: `disparity.pfm` and `summary.json`.

use super::frame::Frame;
use crate::steps::{Failure, Outcome};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;
use stereopsis_host::output::{OutputError, Staging};
use stereopsis_host::pfm;

/// `summary.json`. Names and units are a contract with programs that read it.
#[derive(Serialize)]
struct Summary<'a> {
    core: &'a str,
    board: &'a str,
    target: &'a str,
    method: &'a str,
    width: u16,
    height: u16,
    disparities: u16,
    noise: &'a str,
    /// From the camera's lines to checked rows; neither the camera nor the writing of the rows is in it.
    instructions: u64,
    instructions_per_evaluation: f64,
    static_ram_bytes: u64,
    stack_bytes: u64,
    flash_bytes: u64,
    flash_sections: &'a BTreeMap<String, u64>,
    dense_path_flash_bytes: u64,
    panic_symbols: usize,
    allocation_symbols: usize,
    state_bytes: usize,
    pipeline_bytes: u64,
    density: f64,
    crc32: String,
}

/// Writes both files, or none.
pub fn write(out: &Path, frame: &Frame) -> Outcome {
    let write = || -> Result<(), OutputError> {
        let mut staging = Staging::new(out)?;
        staging.write("disparity.pfm", |file| pfm::write(file, frame.map.width, &frame.map.pixels()))?;
        staging.write("summary.json", |file| {
            serde_json::to_writer_pretty(&mut *file, &summary(frame))?;
            file.write_all(b"\n")
        })?;
        staging.commit(&[])
    };
    write().map_err(|e| Failure::new(format!("--out: {e}")))
}

fn summary(frame: &Frame) -> Summary<'_> {
    let (program, sizes) = (&frame.program, &frame.sizes);
    Summary {
        core: program.board.core,
        board: program.board.machine,
        target: program.board.target,
        method: program.method.name(),
        width: program.width,
        height: program.height,
        disparities: program.disparities,
        noise: program.noise.name(),
        instructions: frame.instructions,
        instructions_per_evaluation: frame.per_evaluation(),
        static_ram_bytes: sizes.static_ram,
        stack_bytes: frame.stack,
        flash_bytes: sizes.flash(),
        flash_sections: &sizes.flash_sections,
        dense_path_flash_bytes: sizes.dense_flash,
        panic_symbols: sizes.panics.len(),
        allocation_symbols: sizes.allocations.len(),
        state_bytes: program.method.state_bytes(program.width, program.disparities),
        pipeline_bytes: frame.pipeline,
        density: frame.map.density(),
        crc32: format!("{:08x}", frame.crc32),
    }
}
