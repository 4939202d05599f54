//! Lines that the caller pushes give the rows that lines pulled from a camera give, and every misuse has its
//! error.

use image::GrayImage;
use stereopsis::matching::{Block, Checks, Config, Fast, MatchError, Method, Row, Sgm, SgmEdge, SgmLean};
use stereopsis::pipeline::{Pipeline, PushError};
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
