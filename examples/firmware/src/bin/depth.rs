//! Rows in, depth rows out: the pipeline stands in a `static`, a camera gives lines, rows of disparity come
//! out.
//!
//! `cargo run --release` runs it in QEMU. It takes `left.pgm` and `right.pgm` from the working directory, or
//! the built-in scene when neither is there, writes `rows.bin` and `log.defmt`, and prints figures. The exit
//! status is 0 when the frame came through. `cargo xtask firmware` runs it on any pictures and compares every
//! bit with the host.
#![no_std]
#![no_main]

use static_cell::ConstStaticCell;
use stereopsis::camera::{FrameStart, StereoSource};
use stereopsis::matching::{Block, Config, ConfigError, Filter, Row};
use stereopsis::pipeline::PipelineError;
use stereopsis_firmware::camera::files::FileError;
use stereopsis_firmware::camera::scene::Scene;
use stereopsis_firmware::camera::{Camera, timed::Timed};
use stereopsis_firmware::choice::{BOARD, BoardPipeline, DISPARITIES, HEIGHT, METHOD, Method, NOISE, WIDTH};
use stereopsis_firmware::clock::Clock;
use stereopsis_firmware::console::Console;
use stereopsis_firmware::host::HostError;
use stereopsis_firmware::rows::Rows;
use stereopsis_firmware::{runtime, stack};

/// All the memory that the matcher takes, at an address fixed by the linker.
static PIPELINE: ConstStaticCell<BoardPipeline> = ConstStaticCell::new(BoardPipeline::new());

#[runtime::entry]
fn main() -> ! {
    #[cfg(feature = "panics")]
    core::hint::black_box([1u8; 2][core::hint::black_box(2)]);
    runtime::run(&PIPELINE, run)
}

/// Why there is no frame.
#[derive(defmt::Format)]
enum Failure {
    /// The camera could not be opened.
    Camera(FileError),
    /// The pipeline cannot do what is asked.
    Config(ConfigError),
    /// The frame broke off.
    Frame(PipelineError<FileError>),
    /// The host did not take the rows.
    Rows(HostError),
}

/// One frame, and what it took.
fn run(pipeline: &mut BoardPipeline) -> Result<(), Failure> {
    let clock = Clock::start();
    let camera = Camera::open(Scene { width: WIDTH, height: HEIGHT }).map_err(Failure::Camera)?;
    let mut camera = Timed::new(camera, &clock);
    let format = camera.format();
    defmt::info!("{=str} on {=str}: {=u16}x{=u16}", METHOD, BOARD.core, format.width, format.height);
    let config =
        Config { noise: NOISE, ..Config::for_method::<Block>(format.width, format.height, DISPARITIES) };
    let config = config.with_filter::<Method>(Filter::Default);
    pipeline.start(&config).map_err(Failure::Config)?;
    let mut rows = Rows::create().map_err(Failure::Rows)?;
    let calibration = clock.calibrate();
    let ticks = frame(pipeline, &clock, &mut camera, &mut rows)?;
    defmt::info!("{=u16} rows, crc32 {=u32:08x}", rows.count(), rows.crc32());

    let mut console = Console::open();
    console.figure("width", format.width.into());
    console.figure("height", format.height.into());
    console.figure("disparities", DISPARITIES.into());
    console.figure("rows", rows.count().into());
    console.figure("crc32", rows.crc32().into());
    console.figure("ticks", ticks - camera.ticks());
    console.figure("camera_ticks", camera.ticks());
    console.figure("calibration_ticks", calibration);
    console.figure("pipeline_bytes", size_of::<BoardPipeline>() as u64);
    console.figure("stack_bytes", stack::used() as u64);
    Ok(())
}

/// All rows of a frame into the file; the ticks that the pipeline took for them, the camera's among them.
fn frame(
    pipeline: &mut BoardPipeline,
    clock: &Clock,
    camera: &mut Timed<'_, Camera>,
    rows: &mut Rows,
) -> Result<u64, Failure> {
    let start = clock.now();
    begin(pipeline, camera)?;
    let mut ticks = clock.now() - start;
    loop {
        let start = clock.now();
        let row = next(pipeline, camera)?;
        ticks += clock.now() - start;
        match row {
            Some(row) => rows.write(&row).map_err(Failure::Rows)?,
            None => return Ok(ticks),
        }
    }
}

// Not inlined: what these two become is the dense path, and its size is told from the rest of the program's.

#[inline(never)]
fn begin(pipeline: &mut BoardPipeline, camera: &mut Timed<'_, Camera>) -> Result<FrameStart, Failure> {
    pipeline.begin_frame(camera).map_err(Failure::Frame)
}

#[inline(never)]
fn next<'p>(
    pipeline: &'p mut BoardPipeline,
    camera: &mut Timed<'_, Camera>,
) -> Result<Option<Row<'p>>, Failure> {
    pipeline.next_row(camera).map_err(Failure::Frame)
}
