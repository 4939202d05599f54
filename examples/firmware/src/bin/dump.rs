//! Rows of all stages as this core makes them, in the bytes that `stereo dump` writes: `winner.bin`,
//! `left-right.bin`, `subpixel.bin`, `smoothed.bin`, `checked.bin` and `final.bin` are the matcher's,
//! `census.bin`, `cost.bin` and `aggregated.bin` those of the equations.
#![no_std]
#![no_main]

use static_cell::ConstStaticCell;
use stereopsis::camera::{CameraError, StereoSource};
use stereopsis::imaging::LineWindow;
use stereopsis::matching::{Config, ConfigError, Filter, MatchError};
use stereopsis_firmware::camera::Camera;
use stereopsis_firmware::camera::files::FileError;
use stereopsis_firmware::camera::scene::Scene;
use stereopsis_firmware::choice::{BoardMatcher, DISPARITIES, HEIGHT, Method, NOISE, ROOM, WIDTH};
use stereopsis_firmware::console::Console;
use stereopsis_firmware::first_half::{Files, FirstHalf};
use stereopsis_firmware::host::HostError;
use stereopsis_firmware::stage_files::StageFiles;
use stereopsis_firmware::{runtime, stack};

/// What stands in memory: the matcher, what its first half is worked out with, and five lines of each camera.
struct Memory {
    matcher: BoardMatcher,
    first_half: FirstHalf,
    lines: [LineWindow<ROOM>; 2],
}

static MEMORY: ConstStaticCell<Memory> = ConstStaticCell::new(Memory {
    matcher: BoardMatcher::new(),
    first_half: FirstHalf::new(),
    lines: [const { LineWindow::new() }; 2],
});

#[runtime::entry]
fn main() -> ! {
    runtime::run(&MEMORY, run)
}

/// Why there are no rows.
#[derive(defmt::Format)]
enum Failure {
    /// The camera could not be opened.
    Camera(FileError),
    /// A line is missing.
    Line(CameraError<FileError>),
    /// The matcher cannot do what is asked.
    Config(ConfigError),
    /// A line was not due.
    Match(MatchError),
    /// The host did not take the rows.
    Rows(HostError),
}

/// One frame.
fn run(Memory { matcher, first_half, lines: [left, right] }: &mut Memory) -> Result<(), Failure> {
    let mut camera = Camera::open(Scene { width: WIDTH, height: HEIGHT }).map_err(Failure::Camera)?;
    let format = camera.format();
    let search =
        Config { noise: NOISE, ..Config::for_method::<Method>(format.width, format.height, DISPARITIES) };
    let search = search.with_filter::<Method>(Filter::Default);
    matcher.start(&search).map_err(Failure::Config)?;
    camera.start_frame().map_err(Failure::Line)?;
    left.begin(format.width.into());
    right.begin(format.width.into());
    let mut files = StageFiles::create().map_err(Failure::Rows)?;
    let first_files = Files::create().map_err(Failure::Rows)?;
    let height = usize::from(format.height);
    for y in 0..height + BoardMatcher::DELAY {
        while left.count() < height.min(y + 3) {
            camera.next_lines(left.next_line(), right.next_line()).map_err(Failure::Line)?;
            left.accept();
            right.accept();
        }
        let lines = [left.around(y), right.around(y)];
        let [left, right] = &lines;
        let lines = (y < height).then_some([left, right]);
        first_half.step(y, lines, &search, &first_files).map_err(Failure::Rows)?;
        matcher.step_traced(lines, &mut files).map_err(Failure::Match)?;
        if let Some(row) = matcher.row() {
            files.finished(&row);
        }
    }
    files.end().map_err(Failure::Rows)?;
    let mut console = Console::open();
    console.figure("stack_bytes", stack::used() as u64);
    Ok(())
}
