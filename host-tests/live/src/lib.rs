//! The core in a browser: what the page of `stereo view` runs.
//!
//! * [`settings`]: a row of numbers, one for each control of the page, as a configuration of the core.
//! * [`pair`]: two pictures in memory as a camera.
//! * [`session`]: a pipeline for each method; measures, matches, and tells depth.
//! * `exports`: the functions that the page calls, on WebAssembly alone, and the only ones that look at raw
//!   memory.
#![cfg_attr(target_arch = "wasm32", no_std)]

pub mod settings;

pub mod pair;

pub mod session;

#[cfg(target_arch = "wasm32")]
mod exports;

#[cfg(target_arch = "wasm32")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    core::arch::wasm32::unreachable()
}
