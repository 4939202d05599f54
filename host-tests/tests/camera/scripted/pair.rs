//! Two cameras as one source.

use super::{Camera, LineFault, SMALL, camera, numbered, pair, small};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use stereopsis::camera::{
    CameraError, CameraPair, FrameStart, LineFormat, LineStart, PairError, Pairing, PixelFormat, RowSkew,
    StereoSource,
};

type Failure = CameraError<PairError<LineFault, LineFault>>;

/// All lines of the next frame, left and right.
fn frame(
    source: &mut impl StereoSource<Error = PairError<LineFault, LineFault>>,
) -> Result<[Vec<u8>; 2], Failure> {
    let format = source.format();
    source.start_frame()?;
    let mut frame = [Vec::new(), Vec::new()];
    for row in 0..format.height {
        let (mut left, mut right) = (vec![0; format.line_bytes()], vec![0; format.line_bytes()]);
        assert_eq!(source.next_lines(&mut left, &mut right)?.row, row);
        frame[0].extend(left);
        frame[1].extend(right);
    }
    Ok(frame)
}

#[test]
fn a_pair_gives_the_lines_of_both_cameras_each_in_its_buffer() {
    let mut both = pair(small(0), Camera { late_us: 3, ..small(100) });
    assert_eq!(both.format(), SMALL);
    assert_eq!(both.max_row_skew_us(), 5);
    for sequence in 0..3 {
        let start = both.start_frame().expect("the cameras work");
        let timestamp_us = u64::from(sequence) * 1000;
        assert_eq!(start, FrameStart { sequence, timestamp_us, exposure_us: 7 }, "the left camera's");
        let (mut left, mut right) = ([0; 6], [0; 6]);
        for row in 0..3 {
            let line = both.next_lines(&mut left, &mut right).expect("the cameras work");
            assert_eq!(line, LineStart { row, timestamp_us: timestamp_us + u64::from(row) });
            let first = 4 * row as u8;
            assert_eq!(left, [first, first + 1, first + 2, first + 3, 0, 0]);
            assert_eq!(right, [100 + first, 101 + first, 102 + first, 103 + first, 0, 0]);
        }
        assert_eq!(both.next_lines(&mut left, &mut right), Err(CameraError::NoLineLeft));
    }
    let (left, right) = both.release();
    assert_eq!((left.starts, right.starts), (3, 3));
    // A borrowed pair is a source as well.
    let mut both = pair(left, right);
    assert_eq!(frame(&mut &mut both).expect("the cameras work")[1], (100..112).collect::<Vec<u8>>());
}

#[test]
fn cameras_of_different_formats_are_no_pair() {
    let others = [
        LineFormat { width: 5, ..SMALL },
        LineFormat { height: 4, ..SMALL },
        LineFormat { pixel: PixelFormat::Rgb8, ..SMALL },
    ];
    for right in others {
        let bytes = vec![0; right.line_bytes() * usize::from(right.height)];
        let refused = CameraPair::new(small(0), camera(right, bytes), 5).expect_err("the formats differ");
        assert_eq!(refused, CameraError::Hardware(PairError::Formats { left: SMALL, right }));
    }
}

#[test]
fn the_camera_that_lost_frames_catches_up() {
    for lost in 0..=4_u32 {
        let gap: Vec<u32> = (10..=10 + lost).collect();
        for (left, right) in [(gap.clone(), vec![10 + lost]), (vec![10 + lost], gap.clone())] {
            let starts = (left.len(), right.len());
            let mut both = pair(numbered(&left), numbered(&right));
            assert_eq!(both.start_frame().expect("at most four frames are lost").sequence, 10 + lost);
            let (left, right) = both.release();
            assert_eq!((left.starts, right.starts), starts);
        }
    }
}

#[test]
fn five_lost_frames_are_too_many_and_the_next_try_goes_on() {
    let mut both = pair(numbered(&[10]), numbered(&[15]));
    let error = both.start_frame().expect_err("the left camera is five behind");
    assert_eq!(error, CameraError::Hardware(PairError::Sequence { left: 14, right: 15 }));
    assert_eq!(error.to_string(), "frame 14 of the left camera meets frame 15 of the right");
    // 15 on the left, 16 on the right: one start more on the left.
    assert_eq!(both.start_frame().expect("the cameras are near enough").sequence, 16);
    let mut both = pair(numbered(&[15]), numbered(&[10]));
    let error = both.start_frame().expect_err("the right camera is five behind");
    assert_eq!(error, CameraError::Hardware(PairError::Sequence { left: 15, right: 14 }));
}

#[test]
fn sequence_numbers_wrap() {
    let mut both = pair(numbered(&[u32::MAX - 1]), numbered(&[1]));
    assert_eq!(both.start_frame().expect("three steps over the wrap").sequence, 1);
    let (left, right) = both.release();
    assert_eq!((left.starts, right.starts), (4, 1), "the left camera was behind");
    let mut both = pair(numbered(&[0]), numbered(&[u32::MAX]));
    assert_eq!(both.start_frame().expect("one step over the wrap").sequence, 0);
}

#[test]
fn rows_that_were_read_too_far_apart_are_refused() {
    for (left_late, right_late, skew) in [(0, 5, None), (5, 0, None), (0, 6, Some(6)), (900, 0, Some(900))] {
        let mut both =
            pair(Camera { late_us: left_late, ..small(0) }, Camera { late_us: right_late, ..small(0) });
        let expected = skew.map(|skew_us| CameraError::Hardware(PairError::RowSkew { skew_us }));
        assert_eq!(frame(&mut both).err(), expected, "{left_late} {right_late}");
    }
    let late = PairError::<LineFault, LineFault>::RowSkew { skew_us: 6 };
    assert_eq!(late.to_string(), "the cameras' rows are 6 us apart");
}

#[test]
fn rows_that_differ_are_refused() {
    let mut both = pair(Camera { wrong_row: Some(1), ..small(0) }, small(0));
    assert_eq!(frame(&mut both), Err(CameraError::Hardware(PairError::Rows { left: 2, right: 1 })));
    let mut both = pair(small(0), Camera { wrong_row: Some(2), ..small(0) });
    let error = frame(&mut both).expect_err("the right camera tells a wrong row");
    assert_eq!(error, CameraError::Hardware(PairError::Rows { left: 2, right: 3 }));
    assert_eq!(error.to_string(), "row 2 of the left camera meets row 3 of the right");
}

#[test]
fn what_the_hardware_says_is_kept_and_the_next_frame_works() {
    let mut both = pair(Camera { fault: Some(1), ..small(0) }, small(50));
    let error = frame(&mut both).expect_err("line 1 of the left camera fails");
    assert_eq!(error, CameraError::Hardware(PairError::Left(LineFault(1))));
    assert_eq!(error.to_string(), "left camera: line 1 is lost");
    let (left, right) = both.release();
    let mut both = pair(Camera { fault: None, ..left }, Camera { fault: Some(0), ..right });
    let error = frame(&mut both).expect_err("line 0 of the right camera fails");
    assert_eq!(error, CameraError::Hardware(PairError::Right(LineFault(0))));
    let (left, right) = both.release();
    let mut both = pair(left, Camera { fault: None, ..right });
    let [left, right] = frame(&mut both).expect("both cameras work again");
    assert_eq!((left[0], right[0], left.len(), right.len()), (0, 50, 12, 12));
}

#[test]
fn a_buffer_that_is_too_short_says_what_is_needed() {
    let mut both = pair(small(0), small(50));
    both.start_frame().expect("the cameras work");
    assert_eq!(both.next_lines(&mut [0; 3], &mut [0; 4]), Err(CameraError::BufferTooShort { needed: 4 }));
    both.start_frame().expect("the cameras work");
    assert_eq!(both.next_lines(&mut [0; 4], &mut [0; 3]), Err(CameraError::BufferTooShort { needed: 4 }));
}

#[test]
fn cameras_that_run_freely_are_paired_by_their_time_stamps() {
    // The right camera's counter is seven behind, and its clock stamps the same moments two microseconds
    // later.
    let free = |first: u32| Camera { late_us: 7002, ..numbered(&[first]) };
    for (left, right, starts) in [(10, 3, (1, 1)), (9, 3, (2, 1)), (10, 1, (1, 3))] {
        let mut both = pair(numbered(&[left]), free(right)).paired_by(Pairing::TimeStamp);
        assert_eq!(both.row_skew(), RowSkew::default());
        assert_eq!(frame(&mut both).expect("they are near enough")[0].len(), 12);
        assert_eq!(both.row_skew(), RowSkew { rows: 3, least_us: 2, most_us: 2 });
        let (left, right) = both.release();
        assert_eq!((left.starts, right.starts), starts);
        assert_eq!(left.sequence, right.sequence + 7);
    }
    let apart = Camera { late_us: 7500, ..numbered(&[3]) };
    let mut both = pair(numbered(&[10]), apart).paired_by(Pairing::TimeStamp);
    let error = both.start_frame().expect_err("they are half a frame apart");
    assert_eq!(error, CameraError::Hardware(PairError::FrameSkew { skew_us: 500 }));
    assert_eq!(error.to_string(), "the cameras' frames stay 500 us apart");
}

#[test]
fn the_row_skew_is_measured_on_refused_rows_too() {
    let mut both = pair(Camera { late_us: 6, ..small(0) }, small(0));
    both.start_frame().expect("the sequence numbers agree");
    assert!(both.next_lines(&mut [0; 4], &mut [0; 4]).is_err());
    assert_eq!(both.row_skew(), RowSkew { rows: 1, least_us: -6, most_us: -6 });
}

#[test]
fn an_old_line_or_frame_of_one_camera_is_refused() {
    // The frame of before once more: the camera is started again.
    let mut both = pair(numbered(&[10, 11, 12]), numbered(&[10, 10, 11, 12]));
    assert_eq!([0; 3].map(|_| both.start_frame().map(|start| start.sequence)), [Ok(10), Ok(11), Ok(12)]);
    let (left, right) = both.release();
    assert_eq!((left.starts, right.starts), (3, 4));
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 500,
        rng_seed: RngSeed::Fixed(6),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Whatever frames get lost: a pair is of one exposure or refused, after a bounded number of starts.
    #[test]
    fn a_pair_is_never_of_two_exposures(
        first: u32,
        left_gaps in proptest::collection::vec(0u32..4, 8),
        right_gaps in proptest::collection::vec(0u32..4, 8),
    ) {
        let count_on = |gaps: &[u32]| -> Vec<u32> {
            gaps.iter().scan(first, |n, gap| { *n = n.wrapping_add(1 + gap); Some(*n) }).collect()
        };
        let mut both = pair(numbered(&count_on(&left_gaps)), numbered(&count_on(&right_gaps)));
        let started = both.start_frame();
        let (left, right) = both.release();
        prop_assert!(left.starts + right.starts <= 2 + CameraPair::<Camera, Camera>::MAX_CATCH_UP as usize);
        match started {
            Ok(start) => prop_assert!(start.sequence == left.sequence && start.sequence == right.sequence),
            Err(e) => {
                prop_assert_ne!(left.sequence, right.sequence);
                let apart = PairError::Sequence { left: left.sequence, right: right.sequence };
                prop_assert_eq!(e, CameraError::Hardware(apart));
            }
        }
    }
}
