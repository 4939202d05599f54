//! Winners from gates, the rest on this core: it starts the block of `examples/fpga`, sends it the cameras'
//! lines, takes its records and writes rows of disparity.
//!
//! The block is a simulation behind two pipes, which `cargo xtask rtl --system` starts beside QEMU.
#![no_std]
#![no_main]

use static_cell::ConstStaticCell;
use stereopsis::camera::{CameraError, StereoSource};
use stereopsis::matching::{Config, Filter};
use stereopsis::pipeline::winners::{WinnerPipelineError, WinnerRegisters};
use stereopsis_firmware::block::Block;
use stereopsis_firmware::camera::Camera;
use stereopsis_firmware::camera::files::FileError;
use stereopsis_firmware::camera::scene::Scene;
use stereopsis_firmware::choice::{BoardWinners, DISPARITIES, HEIGHT, Method, NOISE, WIDTH};
use stereopsis_firmware::console::Console;
use stereopsis_firmware::host::HostError;
use stereopsis_firmware::rows::Rows;
use stereopsis_firmware::{runtime, stack};

/// What stands in memory: the second half of the path, and a line of each camera.
struct Memory {
    pipeline: BoardWinners,
    lines: [[u8; WIDTH as usize]; 2],
}

static MEMORY: ConstStaticCell<Memory> =
    ConstStaticCell::new(Memory { pipeline: BoardWinners::new(), lines: [[0; WIDTH as usize]; 2] });

#[runtime::entry]
fn main() -> ! {
    runtime::run(&MEMORY, run)
}

/// Why there is no frame.
#[derive(defmt::Format)]
enum Failure {
    /// The camera could not be opened.
    Camera(FileError),
    /// A line is missing, or longer than the program was built for.
    Line(CameraError<FileError>),
    /// The block gave no winners.
    Block(WinnerPipelineError<HostError>),
    /// The host did not take the rows, or has no block.
    Host(HostError),
}

/// One frame.
fn run(Memory { pipeline, lines: [left, right] }: &mut Memory) -> Result<(), Failure> {
    let mut camera = Camera::open(Scene { width: WIDTH, height: HEIGHT }).map_err(Failure::Camera)?;
    let format = camera.format();
    let search =
        Config { noise: NOISE, ..Config::for_method::<Method>(format.width, format.height, DISPARITIES) };
    let config = search.with_filter::<Method>(Filter::Default);
    let mut block = WinnerRegisters::new(Block::open().map_err(Failure::Host)?);
    pipeline.start(&config, &mut block).map_err(Failure::Block)?;
    let mut rows = Rows::create().map_err(Failure::Host)?;
    let width = usize::from(format.width);
    let no_line = Failure::Line(CameraError::NoLineLeft);
    let (Some(left), Some(right)) = (left.get_mut(..width), right.get_mut(..width)) else {
        return Err(no_line);
    };
    camera.start_frame().map_err(Failure::Line)?;
    pipeline.begin_frame(&mut block).map_err(Failure::Block)?;
    for _ in 0..format.height {
        camera.next_lines(left, right).map_err(Failure::Line)?;
        if let Some(row) = pipeline.push(left, right, &mut block).map_err(Failure::Block)? {
            rows.write(&row).map_err(Failure::Host)?;
        }
    }
    while let Some(row) = pipeline.flush(&mut block).map_err(Failure::Block)? {
        rows.write(&row).map_err(Failure::Host)?;
    }
    block.bus().end().map_err(Failure::Host)?;

    let mut console = Console::open();
    console.figure("rows", rows.count().into());
    console.figure("crc32", rows.crc32().into());
    console.figure("pipeline_bytes", size_of::<BoardWinners>() as u64);
    console.figure("stack_bytes", stack::used() as u64);
    Ok(())
}
