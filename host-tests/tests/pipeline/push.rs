//! Lines that the caller pushes give the rows that lines pulled from a camera give, and every misuse has its
//! error.

mod masked;

use image::GrayImage;
use stereopsis::camera::LineFault;
use stereopsis::matching::{
    Block, Checks, Config, Fast, Kernel, MatchError, Method, Row, Sgm, SgmEdge, SgmLean,
};
use stereopsis::pipeline::{Guarded, Pipeline, PushError};
use stereopsis::units::{Disparity, PixelFlags};
use stereopsis_host::scene::SceneCamera;
use stereopsis_host::scene::pattern::Pattern;

const W: usize = 96;
const D: usize = 32;
type Any<S> = Pipeline<S, W, D>;

/// A row that was kept.
#[derive(PartialEq, Debug)]
struct Kept {
    index: u16,
    disparities: Vec<Disparity>,
    flags: Vec<PixelFlags>,
    sigma_px: Vec<Option<u32>>,
    confidences: Vec<u8>,
}

impl From<Row<'_>> for Kept {
    fn from(row: Row<'_>) -> Self {
        let sigma = |x| row.sigma_px(x).map(f32::to_bits);
        Self {
            index: row.index(),
            disparities: row.disparities().to_vec(),
            flags: row.flags().to_vec(),
            sigma_px: (0..row.disparities().len()).map(sigma).collect(),
            confidences: row.confidences().to_vec(),
        }
    }
}

fn pair(width: u16, height: u16) -> (GrayImage, GrayImage) {
    Pattern::Shifted { most: 12, noise_grey: 4.0 }.pair(width.into(), height.into(), 5)
}

fn started<S: Method>(config: &Config) -> Box<Any<S>> {
    let mut pipeline = Box::new(Any::<S>::new());
    pipeline.start(config).expect("the configuration is valid");
    pipeline
}

fn pulled<S: Method>(pipeline: &mut Any<S>, pair: &(GrayImage, GrayImage)) -> Vec<Kept> {
    let mut camera = SceneCamera::new(pair.0.clone(), pair.1.clone());
    pipeline.begin_frame(&mut camera).expect("a frame");
    let mut rows = Vec::new();
    while let Some(row) = pipeline.next_row(&mut camera).expect("the camera works") {
        rows.push(row.into());
    }
    rows
}

/// The lines of both pictures, in order.
fn lines(pair: &(GrayImage, GrayImage)) -> impl Iterator<Item = (&[u8], &[u8])> {
    let width = pair.0.width() as usize;
    pair.0.as_raw().chunks(width).zip(pair.1.as_raw().chunks(width))
}

fn pushed<S: Method>(pipeline: &mut Any<S>, pair: &(GrayImage, GrayImage)) -> Vec<Kept> {
    pipeline.begin().expect("it is started");
    let mut rows = Vec::new();
    for (y, (left, right)) in lines(pair).enumerate() {
        let row = pipeline.push(left, right).expect("a line of the frame");
        assert_eq!(row.is_some(), y >= Any::<S>::LATENCY, "line {y}");
        rows.extend(row.map(Kept::from));
    }
    while let Some(row) = pipeline.flush().expect("all lines are in") {
        rows.push(row.into());
    }
    assert_eq!(pipeline.flush().expect("the frame stays over").map(Kept::from), None);
    rows
}

fn compare<S: Method>(width: u16, height: u16, checks: Checks) {
    let config = Config { checks, confidence: true, ..Config::for_method::<Block>(width, height, 16) };
    let pair = pair(width, height);
    let mut pipeline = started::<S>(&config);
    let expected = pulled(&mut pipeline, &pair);
    assert_eq!(expected.len(), usize::from(height));
    // Twice: a frame leaves nothing behind for the next.
    for _ in 0..2 {
        assert!(pushed(&mut pipeline, &pair) == expected, "{} {width}x{height}", S::NAME);
    }
    assert!(pulled(&mut pipeline, &pair) == expected, "{} {width}x{height}, pulled after pushed", S::NAME);
}

#[test]
fn pushed_rows_are_the_pulled_rows_at_every_height() {
    for height in (1..=24).chain([41]) {
        compare::<Fast>(37, height, Checks::STRICT);
        compare::<Block>(37, height, Checks::DEFAULT);
        compare::<Sgm>(37, height, Checks::DEFAULT);
        compare::<SgmEdge>(37, height, Checks::STRICT);
    }
}

#[test]
fn pushed_rows_are_the_pulled_rows_at_every_width() {
    for width in (1..=20).chain([31, 32, 33, 95, 96]) {
        compare::<Fast>(width, 15, Checks::DEFAULT);
        compare::<Block>(width, 15, Checks::DENSE);
        compare::<SgmLean>(width, 15, Checks::DENSE);
    }
}

#[test]
fn the_row_that_came_out_last_can_be_looked_at_again() {
    let pair = pair(40, 20);
    let mut pipeline = started::<Fast>(&Config::for_method::<Block>(40, 20, 16));
    assert!(pipeline.row().is_none(), "no frame was begun");
    pipeline.begin().expect("it is started");
    for (left, right) in lines(&pair) {
        let row = pipeline.push(left, right).expect("a line of the frame").map(Kept::from);
        assert_eq!(pipeline.row().map(Kept::from), row);
    }
    assert_eq!(pipeline.config(), &Config::for_method::<Block>(40, 20, 16));
}

#[test]
fn every_misuse_has_its_error() {
    let (left, right) = (&[0; 40], &[0; 40]);
    let mut pipeline = Box::new(Any::<Block>::new());
    let not_started = MatchError::NotStarted;
    assert_eq!(pipeline.begin(), Err(not_started));
    assert_eq!(pipeline.push(left, right).err(), Some(PushError::Matcher(not_started)));
    assert_eq!(pipeline.flush().err(), Some(PushError::Matcher(not_started)));

    pipeline.start(&Config::for_method::<Block>(40, 4, 16)).expect("the configuration is valid");
    assert_eq!(pipeline.push(left, right).err(), Some(PushError::NotBegun));
    assert_eq!(pipeline.flush().err(), Some(PushError::NotBegun));

    pipeline.begin().expect("it is started");
    for wrong in [&[][..], &[0; 39], &[0; 41]] {
        assert_eq!(pipeline.push(wrong, right).err(), Some(PushError::LineLength { needed: 40 }));
        assert_eq!(pipeline.push(left, wrong).err(), Some(PushError::LineLength { needed: 40 }));
    }
    for missing in (1..=4).rev() {
        assert_eq!(pipeline.flush().err(), Some(PushError::LinesMissing { missing }));
        pipeline.push(left, right).expect("the line follows all the same");
    }
    assert_eq!(pipeline.push(left, right).err(), Some(PushError::NoLineLeft));
    assert_eq!(pipeline.flush().expect("all lines are in").map(|row| row.index()), Some(0));
    assert_eq!(pipeline.push(left, right).err(), Some(PushError::NoLineLeft));

    // A start forgets the frame.
    pipeline.start(&Config::for_method::<Block>(40, 4, 16)).expect("the configuration is valid");
    assert_eq!(pipeline.flush().err(), Some(PushError::NotBegun));
}

#[test]
fn a_wrong_line_changes_nothing() {
    let pair = pair(50, 18);
    let mut pipeline = started::<Block>(&Config::for_method::<Block>(50, 18, 16));
    let expected = pulled(&mut pipeline, &pair);
    pipeline.begin().expect("it is started");
    let mut rows = Vec::<Kept>::new();
    for (left, right) in lines(&pair) {
        assert_eq!(pipeline.push(&left[1..], right).err(), Some(PushError::LineLength { needed: 50 }));
        assert!(pipeline.flush().is_err(), "this line is missing");
        rows.extend(pipeline.push(left, right).expect("a line of the frame").map(Kept::from));
    }
    while let Some(row) = pipeline.flush().expect("all lines are in") {
        rows.push(row.into());
    }
    assert!(rows == expected);
}

type Guard = Guarded<Fast, W, D>;

/// The rows of a guarded pipeline whose caller reports line `lost` as lost, and the pipeline.
fn guarded(pair: &(GrayImage, GrayImage), lost: Option<(usize, LineFault)>) -> (Vec<Kept>, Box<Guard>) {
    let (width, height) = (pair.0.width() as u16, pair.0.height() as u16);
    let mut pipeline = Box::new(Guard::new());
    pipeline.start(&Config::for_method::<Fast>(width, height, 16)).expect("the configuration is valid");
    pipeline.begin().expect("it is started");
    let mut rows = Vec::new();
    for (y, (left, right)) in lines(pair).enumerate() {
        let row = match lost {
            Some((line, fault)) if line == y => pipeline.push_lost(fault),
            _ => pipeline.push(left, right),
        };
        let row = row.expect("a line of the frame").map(Kept::from);
        assert_eq!(row.is_some(), y >= Any::<Fast>::LATENCY, "line {y}");
        assert_eq!(pipeline.row().map(Kept::from), row);
        rows.extend(row);
    }
    while let Some(row) = pipeline.flush().expect("all lines are in") {
        rows.push(row.into());
    }
    assert!(pipeline.flush().is_ok_and(|row| row.is_none()), "the frame stays over");
    (rows, pipeline)
}

#[test]
fn lines_pushed_into_a_guarded_pipeline_give_the_same_rows() {
    let pair = pair(40, 50);
    let expected = pushed(&mut started::<Fast>(&Config::for_method::<Fast>(40, 50, 16)), &pair);
    let (rows, pipeline) = guarded(&pair, None);
    assert!(rows == expected);
    let counters = pipeline.counters();
    assert_eq!((counters.frames, counters.frames_whole, counters.rows, counters.lines), (1, 1, 50, 50));
}

#[test]
fn a_line_that_the_caller_lost_is_counted_and_flagged() {
    let pair = pair(40, 80);
    for (line, fault) in
        [(0, LineFault::Dropped), (5, LineFault::Torn), (30, LineFault::Late), (79, LineFault::Stale)]
    {
        // The line above, or a black one above which there is none.
        let mut above = pair.clone();
        for picture in [&mut above.0, &mut above.1] {
            for x in 0..40 {
                let grey = if line == 0 { 0 } else { picture.get_pixel(x, line as u32 - 1).0[0] };
                picture.put_pixel(x, line as u32, image::Luma([grey]));
            }
        }
        let expected = pushed(&mut started::<Fast>(&Config::for_method::<Fast>(40, 80, 16)), &above);
        let (rows, pipeline) = guarded(&pair, Some((line, fault)));
        let flagged =
            line.saturating_sub(Any::<Fast>::LATENCY)..=(line + pipeline.reach_down()).min(rows.len() - 1);
        for (y, (row, expected)) in rows.iter().zip(&expected).enumerate() {
            let is_flagged = row.flags.iter().all(|flags| flags.contains(PixelFlags::DAMAGED));
            assert_eq!(is_flagged, flagged.contains(&y), "line {line}, row {y}");
            let is_away = y.abs_diff(line) > 2 + Any::<Fast>::LATENCY;
            assert!(!is_away || row.disparities == expected.disparities, "line {line}, row {y}");
            assert!(is_flagged || row == expected, "line {line}, row {y}");
        }
        let counters = pipeline.counters();
        let of_faults =
            [counters.lines_dropped, counters.lines_torn, counters.lines_late, counters.lines_stale];
        let is_it = |other| u32::from(fault == other);
        let faults = [LineFault::Dropped, LineFault::Torn, LineFault::Late, LineFault::Stale];
        assert_eq!(of_faults, faults.map(is_it));
        assert_eq!((counters.lines, counters.frames_damaged, pipeline.lost_lines()), (79, 1, 1));
        assert_eq!(counters.rows_damaged as usize, flagged.count());
    }
}

#[test]
fn pixels_that_a_camera_did_not_see_lose_their_answers() {
    let pair = pair(60, 30);
    let config = Config::for_method::<Fast>(60, 30, 16);
    let (mut plain, mut masked) = (started::<Fast>(&config), started::<Fast>(&config));
    let mut guard = Box::new(Guard::new());
    guard.start(&config).expect("the configuration is valid");
    plain.begin().and(masked.begin()).and(guard.begin()).expect("they are started");
    let mut lost = 0;
    for (left, right) in lines(&pair) {
        let Some(expected) = plain.push(left, right).expect("a line of the frame").map(Kept::from) else {
            assert!(masked.push(left, right).is_ok() && guard.push(left, right).is_ok());
            continue;
        };
        assert!(masked.push(left, right).is_ok() && guard.push(left, right).is_ok());
        // Nothing is known of the masks.
        masked.mask(|_, _| false);
        assert_eq!(masked.row().map(|row| row.disparities().to_vec()).as_ref(), Some(&expected.disparities));
        // The left camera saw nothing of the columns 20 to 39.
        let valid = |row: u16, [left, right]: [&mut [u8]; 2]| {
            assert_eq!(row, expected.index);
            left.fill(1);
            right.fill(1);
            left[20..40].fill(0);
            true
        };
        masked.mask(valid);
        guard.mask(valid);
        let row = Kept::from(masked.row().expect("a row"));
        assert_eq!(guard.row().map(Kept::from).as_ref(), Some(&row));
        for (x, (found, own)) in row.disparities.iter().zip(&expected.disparities).enumerate() {
            let is_seen = !(20..40).contains(&x);
            assert_eq!(*found, if is_seen { *own } else { Disparity::NONE }, "column {x}");
            lost += usize::from(!is_seen && own.is_some());
        }
    }
    assert!(lost > 50, "{lost}");
}

#[test]
fn a_kernel_that_the_machine_lacks_is_refused() {
    let (mut pipeline, mut guarded) = (Box::new(Any::<Fast>::new()), Box::new(Guard::new()));
    let choose = |kernel| (pipeline.set_kernel(kernel), guarded.set_kernel(kernel));
    let chosen = Kernel::ALL.map(choose);
    assert!(chosen.iter().all(|(one, other)| one == other));
    assert!(chosen.iter().any(|(one, _)| one.is_ok()) && chosen.iter().any(|(one, _)| one.is_err()));
}
