//! One frame after the other, with faults and changes in between.

use super::{Any, Twin, difference, pipeline, rows};
use stereopsis::camera::{CameraError, ErrorType, FrameStart, LineFormat, LineStart, StereoSource};
use stereopsis::matching::{Block, Checks, Config, Fast, Kernel, MatchError, Sgm, SgmEdge};
use stereopsis::pipeline::PipelineError;
use stereopsis_model::scene::SceneCamera;
use stereopsis_model::scene::pattern::Pattern;
use stereopsis_model::twin::match_pair;

pub const LIVE: Pattern = Pattern::Shifted { most: 12, noise_grey: 4.0 };

fn camera(pattern: Pattern, width: u32, height: u32, seed: u64) -> SceneCamera {
    let (left, right) = pattern.pair(width, height, seed);
    SceneCamera::new(left, right)
}

/// A camera whose line `at` is another than it should be.
struct Faulty {
    inner: SceneCamera,
    at: u16,
    fault: Fault,
    due: u16,
}

#[derive(Clone, Copy, PartialEq)]
enum Fault {
    Bus,
    RowSkipped,
}

impl ErrorType for Faulty {
    type Error = &'static str;
}

impl StereoSource for Faulty {
    fn format(&self) -> LineFormat {
        self.inner.format()
    }

    fn max_row_skew_us(&self) -> u32 {
        self.inner.max_row_skew_us()
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<&'static str>> {
        self.due = 0;
        self.inner.start_frame().map_err(|e| e.map_hardware(|never| match never {}))
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<&'static str>> {
        let due = self.due;
        self.due += 1;
        let mut start =
            self.inner.next_lines(left, right).map_err(|e| e.map_hardware(|never| match never {}))?;
        if due == self.at {
            match self.fault {
                Fault::Bus => return Err(CameraError::Hardware("bus fault")),
                Fault::RowSkipped => start.row += 1,
            }
        }
        Ok(start)
    }
}

#[test]
fn a_frame_does_not_influence_the_next() {
    let config =
        Config { checks: Checks::STRICT, confidence: true, ..Config::for_method::<Block>(90, 30, 32) };
    let mut pipeline = pipeline::<Block>();
    pipeline.start(&config).expect("the configuration is valid");
    let frames: Vec<_> = [LIVE, Pattern::Noise, Pattern::Constant(0), Pattern::Saturated, LIVE]
        .into_iter()
        .map(|pattern| {
            let mut camera = camera(pattern, 90, 30, 9);
            let (left, right) = camera.pictures();
            let expected = match_pair(&Block::TWIN, &config, left, right);
            let map = rows(&mut pipeline, &mut camera).expect("the camera works");
            assert_eq!(difference(&map, &expected), None, "{pattern:?}");
            map
        })
        .collect();
    assert!(frames[0].disparity.iter().any(|d| d.is_some()));
    assert_eq!(frames[0], frames[4]);
}

#[test]
fn a_frame_that_broke_off_leaves_nothing_behind() {
    let config = Config::for_method::<Block>(70, 26, 32);
    let mut pipeline = pipeline::<Fast>();
    pipeline.start(&config).expect("the configuration is valid");
    for at in 0..26 {
        for fault in [Fault::Bus, Fault::RowSkipped] {
            let mut faulty = Faulty { inner: camera(Pattern::Saturated, 70, 26, 1), at, fault, due: 0 };
            match rows(&mut pipeline, &mut faulty).expect_err("line `at` is faulty") {
                PipelineError::Camera(CameraError::Hardware(e)) if fault == Fault::Bus => {
                    assert_eq!(e, "bus fault")
                }
                PipelineError::RowOrder { expected, given } if fault == Fault::RowSkipped => {
                    assert_eq!((expected, given), (at, at + 1));
                }
                e => panic!("line {at}: {e}"),
            }
            assert!(matches!(pipeline.next_row(&mut faulty), Ok(None)), "the frame is over");
            let mut good = camera(LIVE, 70, 26, 2);
            let (left, right) = good.pictures();
            let expected = match_pair(&Fast::TWIN, &config, left, right);
            let map = rows(&mut pipeline, &mut good).expect("the camera works");
            assert_eq!(difference(&map, &expected), None, "after a fault at line {at}");
        }
    }
}

#[test]
fn a_frame_or_a_size_may_change_at_any_row() {
    let mut pipeline = pipeline::<Block>();
    let mut width = 120;
    for rows_taken in [0, 1, 5, 11, 24, 25] {
        width = if width == 120 { 37 } else { 120 };
        let config = Config {
            checks: Checks::STRICT,
            confidence: true,
            ..Config::for_method::<Block>(width, 25, if width == 120 { 64 } else { 16 })
        };
        pipeline.start(&config).expect("the configuration is valid");
        let mut camera = camera(LIVE, u32::from(width), 25, 3);
        let (left, right) = camera.pictures();
        let expected = match_pair(&Block::TWIN, &config, left, right);
        let map = rows(&mut pipeline, &mut camera).expect("the camera works");
        assert_eq!(difference(&map, &expected), None);
        // The next frame is given up after some rows: by the frame begun above, or by the size of the next
        // round.
        pipeline.begin_frame(&mut camera).expect("the camera works");
        for _ in 0..rows_taken {
            assert!(pipeline.next_row(&mut camera).expect("the camera works").is_some());
        }
        let map = rows(&mut pipeline, &mut camera).expect("the camera works");
        assert_eq!(difference(&map, &expected), None, "after {rows_taken} rows of a frame");
        pipeline.begin_frame(&mut camera).expect("the camera works");
        for _ in 0..rows_taken {
            pipeline.next_row(&mut camera).expect("the camera works");
        }
    }
}

fn frames_along_paths<S: Twin>() {
    let config = Config {
        checks: Checks::STRICT,
        penalties: S::PENALTIES,
        confidence: true,
        ..Config::for_method::<Block>(90, 30, 32)
    };
    let mut pipeline = pipeline::<S>();
    pipeline.start(&config).expect("the configuration is valid");
    for (rows_taken, pattern) in
        [(0, LIVE), (7, Pattern::Noise), (29, Pattern::Saturated), (30, LIVE), (3, LIVE)]
    {
        let mut camera = camera(pattern, 90, 30, 9);
        let (left, right) = camera.pictures();
        let expected = match_pair(&S::TWIN, &config, left, right);
        let map = rows(&mut pipeline, &mut camera).expect("the camera works");
        assert_eq!(difference(&map, &expected), None, "{pattern:?}");
        // The next frame is given up after some rows.
        pipeline.begin_frame(&mut camera).expect("the camera works");
        for _ in 0..rows_taken {
            assert!(pipeline.next_row(&mut camera).expect("the camera works").is_some());
        }
    }
}

#[test]
fn paths_of_a_frame_do_not_reach_into_the_next() {
    frames_along_paths::<Sgm>();
    frames_along_paths::<SgmEdge>();
}

#[test]
fn a_kernel_chosen_within_a_frame_waits_for_the_next() {
    let (left, right) = LIVE.pair(90, 25, 12);
    let config = Config::for_method::<Block>(90, 25, 32);
    let expected = match_pair(&Block::TWIN, &config, &left, &right);
    let kernels: Vec<_> = Kernel::available().collect();
    let mut pipeline = pipeline::<Block>();
    for (&first, &then) in kernels.iter().flat_map(|first| kernels.iter().map(move |then| (first, then))) {
        pipeline.set_kernel(first).expect("an available kernel");
        pipeline.start(&config).expect("a good configuration");
        let mut source = SceneCamera::new(left.clone(), right.clone());
        pipeline.begin_frame(&mut source).expect("a frame");
        let mut disparity = Vec::new();
        while let Some(row) = pipeline.next_row(&mut source).expect("no fault") {
            disparity.extend_from_slice(row.disparities());
            pipeline.set_kernel(then).expect("an available kernel");
        }
        assert_eq!(pipeline.kernel(), first);
        assert_eq!(disparity, expected.disparity, "{} and then {}", first.name(), then.name());
        let map = rows(&mut pipeline, &mut source).expect("a second frame");
        assert_eq!(pipeline.kernel(), then);
        assert_eq!(difference(&map, &expected), None);
    }
}

#[test]
fn what_cannot_run_says_why() {
    let mut pipeline = pipeline::<Fast>();
    let mut source = camera(LIVE, 70, 26, 2);
    assert_eq!(pipeline.begin_frame(&mut source), Err(PipelineError::Matcher(MatchError::NotStarted)));
    assert!(matches!(pipeline.next_row(&mut source), Ok(None)));
    pipeline.start(&Config::for_method::<Block>(71, 26, 32)).expect("the configuration is valid");
    assert!(matches!(pipeline.next_row(&mut source), Ok(None)), "no frame was begun");
    let refused = pipeline.begin_frame(&mut source).expect_err("the camera is 70 wide");
    assert_eq!(refused.to_string(), "the camera gives 70x26 in Grey8; needed is 71x26 in Grey8");
    assert!(matches!(pipeline.next_row(&mut source), Ok(None)));
}

/// Counts the lines that were taken.
struct Counted {
    inner: SceneCamera,
    lines: usize,
}

impl ErrorType for Counted {
    type Error = core::convert::Infallible;
}

impl StereoSource for Counted {
    fn format(&self) -> LineFormat {
        self.inner.format()
    }

    fn max_row_skew_us(&self) -> u32 {
        self.inner.max_row_skew_us()
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Self::Error>> {
        self.lines = 0;
        self.inner.start_frame()
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Self::Error>> {
        self.lines += 1;
        self.inner.next_lines(left, right)
    }
}

fn latency<S: Twin>(height: u16) {
    // Half of the census, half of the window, the look-ahead of the speckle filter.
    let lines_behind = 2 + S::TWIN.radius_y + 4;
    assert_eq!(Any::<S>::LATENCY, lines_behind);
    let mut pipeline = pipeline::<S>();
    pipeline.start(&Config::for_method::<Block>(40, height, 16)).expect("the configuration is valid");
    let mut camera = Counted { inner: camera(LIVE, 40, u32::from(height), 2), lines: 0 };
    pipeline.begin_frame(&mut camera).expect("the camera works");
    let height = usize::from(height);
    for y in 0..height {
        assert!(pipeline.next_row(&mut camera).expect("the camera works").is_some());
        assert_eq!(camera.lines, (y + lines_behind + 1).min(height), "row {y}");
    }
}

#[test]
fn a_row_comes_as_many_lines_late_as_promised() {
    for height in [1, 2, 5, 9, 10, 11, 30] {
        latency::<Fast>(height);
        latency::<Block>(height);
        latency::<Sgm>(height);
        latency::<SgmEdge>(height);
    }
}
