//! Depth on a Cortex-M4: the pipeline stands in a `static`, a camera gives lines, rows of disparity come out.
//!
//! `cargo run --release` in this folder runs it in QEMU's mps2-an386 and prints one frame's figures by semihosting. The
//! exit status is 0 when the frame came through. `expected.txt` holds what it prints; the host gets the same text from
//! the same camera, bit for bit.

#![no_std]
#![no_main]

mod camera;
mod report;

use camera::BoardCamera;
use core::panic::PanicInfo;
use cortex_m_rt::entry;
use cortex_m_semihosting::{debug, hprint, hprintln};
use report::{BoardPipeline, Report};
use static_cell::ConstStaticCell;

/// All the memory that the matcher takes, at an address fixed by the linker.
static PIPELINE: ConstStaticCell<BoardPipeline> = ConstStaticCell::new(BoardPipeline::new());

#[entry]
fn main() -> ! {
    // Only the first call gets it; there is no second one.
    let Some(pipeline) = PIPELINE.try_take() else { end(debug::EXIT_FAILURE) };
    let mut camera = BoardCamera::new();
    match Report::take_frame(pipeline, &mut camera) {
        Ok(report) => {
            hprint!("{}", report);
            end(debug::EXIT_SUCCESS)
        }
        Err(failure) => {
            hprintln!("error: {}", failure);
            end(debug::EXIT_FAILURE)
        }
    }
}

/// Ends the emulation with an exit status; on a board without a debugger it stops here.
fn end(status: debug::ExitStatus) -> ! {
    loop {
        debug::exit(status);
    }
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    hprintln!("{}", info);
    end(debug::EXIT_FAILURE)
}
