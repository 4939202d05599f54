//! The firmware example's camera and report, compiled for the host: its text is the one that the board prints.
//!
//! `cargo xtask test` holds the run in QEMU to the same file, so board and host agree bit for bit.

#[path = "../../examples/firmware/src/camera.rs"]
mod camera;
#[path = "../../examples/firmware/src/report.rs"]
mod report;

use camera::BoardCamera;
use report::{BoardPipeline, Report};

#[test]
fn the_host_prints_what_the_board_prints() {
    let mut pipeline = Box::new(BoardPipeline::new());
    let report = Report::take_frame(&mut pipeline, &mut BoardCamera::new()).expect("a frame");
    let expected = include_str!("../../examples/firmware/expected.txt");
    assert_eq!(report.to_string(), expected, "examples/firmware/expected.txt should read:\n{report}");
}

#[test]
fn a_second_frame_is_the_same() {
    let mut pipeline = Box::new(BoardPipeline::new());
    let mut camera = BoardCamera::new();
    let first = Report::take_frame(&mut pipeline, &mut camera).expect("a frame").to_string();
    let second = Report::take_frame(&mut pipeline, &mut camera).expect("another").to_string();
    assert_eq!(first, second);
}

#[test]
fn most_answers_are_right() {
    let mut pipeline = Box::new(BoardPipeline::new());
    let text = Report::take_frame(&mut pipeline, &mut BoardCamera::new()).expect("a frame").to_string();
    let number = |name: &str| -> u32 {
        let line = text.lines().find_map(|line| line.strip_prefix(name)).expect("a line of that name");
        line.split_whitespace().next().and_then(|word| word.parse().ok()).expect("a number")
    };
    let pixels = u32::from(camera::WIDTH) * u32::from(camera::HEIGHT);
    let (answers, right) = (number("answers "), number("within 1 px of the truth "));
    assert!(answers * 10 >= pixels * 8, "{answers} answers for {pixels} pixels");
    assert!(right * 100 >= answers * 95, "{right} of {answers} answers are right");
}
