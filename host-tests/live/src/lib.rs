//! The core in a browser: what the page of `stereo view` runs.
//!
//! * [`settings`]: a row of numbers, one for each control of the page, as a configuration of the core.
//! * [`pair`]: two pictures in memory as a camera.
//! * [`cameras`]: calibration files, as the program reads them. [`rig_plan`]: `stereo plan`.
//! * [`message`]: what was wrong.
//! * [`session`]: a pipeline for each method; rectifies, measures, matches, and tells depth.
//! * `exports`: the functions that the page calls, on WebAssembly alone, and the only ones that look at raw
//!   memory.

pub mod message;

pub mod settings;

pub mod pair;

pub mod cameras;

pub mod rig_plan;

pub mod session;

#[cfg(target_arch = "wasm32")]
mod exports;
