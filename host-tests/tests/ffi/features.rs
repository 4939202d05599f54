//! Features, matches and the motion of a pair: the functions for C give what the types in Rust give.

use super::*;
use firmware_scenes::walk::{FRAMES, HEIGHT, WIDTH as COLUMNS, Walk};
use stereopsis::features::{Epipolar, Feature, FeatureMatcher, MatchConfig};
use stereopsis::ffi::{
    CDetection, CDetectionCounts, CFeature, CMatch, COdometryConfig, CPicture, CSearch, CStep,
    DetectorHandle, detector_bytes, odometry_bytes,
};
use stereopsis::geometry::two_view::Fundamental;
use stereopsis::motion::odometry::Step;

const POINTS: usize = 40;
const SLOTS: u16 = 12;
const NOTHING: CFeature = CFeature { x_px: 0.0, y_px: 0.0, score: 0, level: 0, descriptor: [0; 8] };

fn words(bytes: usize) -> Vec<u64> {
    vec![0xA5A5_A5A5_A5A5_A5A5; bytes.div_ceil(8)]
}

/// A detector in memory that outlives it.
fn detector(memory: &mut [u64]) -> *mut DetectorHandle {
    let mut handle = null_mut();
    // SAFETY: as many bytes are there.
    let status = unsafe {
        let (memory, length) = (memory.as_mut_ptr().cast(), size_of_val(memory));
        stereopsis_detector_init(memory, length, COLUMNS as u16, SLOTS, &raw mut handle)
    };
    assert_eq!(status, Status::Ok);
    handle
}

/// The features of a picture.
fn detect(handle: *mut DetectorHandle, picture: &[u8], room: usize) -> (Vec<CFeature>, CDetectionCounts) {
    let mut config = CDetection { width: 0, height: 0, cell_px: 0, per_cell: 0, threshold: 0, turned: 9 };
    let mut counts = CDetectionCounts { corners: 0, crowded_out: 0, dropped: 0 };
    let (mut found, mut count) = (vec![NOTHING; room], 0);
    // SAFETY: the detector is there, and arrays have the lengths that are said.
    unsafe {
        let (width, height) = (COLUMNS as u16, HEIGHT as u16);
        assert_eq!(stereopsis_detection_default(width, height, &raw mut config), Status::Ok);
        (config.cell_px, config.per_cell) = (24, 2);
        assert_eq!(stereopsis_detector_start(handle, &raw const config), Status::Ok);
        for line in picture.chunks(COLUMNS) {
            let (line, features) = (line.as_ptr(), found.as_mut_ptr());
            let status = stereopsis_detector_push(handle, line, COLUMNS, features, room, &raw mut count);
            assert_eq!(status, Status::Ok);
        }
        assert_eq!(stereopsis_detector_counts(handle, &raw mut counts), Status::Ok);
    }
    found.truncate(count);
    (found, counts)
}

fn in_rust(features: &[CFeature]) -> Vec<Feature> {
    // SAFETY: the types have the same layout, as the library asserts.
    unsafe { slice::from_raw_parts(features.as_ptr().cast::<Feature>(), features.len()) }.to_vec()
}

#[test]
fn features_are_those_of_rust() {
    let mut memory = words(detector_bytes(COLUMNS, SLOTS.into()));
    let handle = detector(&mut memory);
    let mut walk = Box::new(Walk::new());
    for frame in 0..FRAMES {
        walk.take(frame).expect("a frame");
        let (found, counts) = detect(handle, walk.pictures()[0], POINTS);
        assert_eq!(in_rust(&found), walk.features(), "frame {frame}");
        assert!(found.len() > 20 && counts.dropped == 0);
        assert_eq!(counts.corners, found.len() as u32 + counts.crowded_out);
        let (few, counts) = detect(handle, walk.pictures()[0], 5);
        assert_eq!((&few[..], counts.dropped), (&found[..5], found.len() as u32 - 5));
    }
}

#[test]
fn matches_are_those_of_rust() {
    let mut memory = words(detector_bytes(COLUMNS, SLOTS.into()));
    let handle = detector(&mut memory);
    let mut walk = Box::new(Walk::new());
    walk.take(0).expect("a frame");
    let [left, right] = walk.pictures().map(|picture| detect(handle, picture, POINTS).0);
    // Rows are aligned: l' = F^T p is the row of p.
    let level = [0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0_f32];
    let fundamental =
        Fundamental::from_matrix(&nalgebra::Matrix3::from_row_slice(&level)).expect("of rank 2");
    for (along_px, epipolar) in [(f32::INFINITY, false), (24.0, false), (40.0, true)] {
        let mut search = CSearch {
            along_px: 0.0,
            across_px: 0.0,
            apart_px: 0.0,
            epipolar_px: 0.0,
            most_different: 0,
            ratio_percent: 0,
            levels_apart: 0,
        };
        let (mut slots, mut count) = (vec![7_u16; 5 * POINTS], 0);
        let mut found = vec![CMatch { u: 0.0, v: 0.0, u2: 0.0, v2: 0.0 }; POINTS];
        // SAFETY: arrays have the lengths that are said.
        let status = unsafe {
            assert_eq!(stereopsis_search_default(&raw mut search), Status::Ok);
            search.along_px = along_px;
            stereopsis_match_features(
                &raw const search,
                if epipolar { level.as_ptr() } else { null() },
                left.as_ptr(),
                left.len(),
                right.as_ptr(),
                right.len(),
                slots.as_mut_ptr(),
                found.as_mut_ptr(),
                POINTS,
                &raw mut count,
            )
        };
        assert_eq!(status, Status::Ok);
        let epipolar = epipolar.then_some(Epipolar { fundamental, tolerance_px: 1.0 });
        let config = MatchConfig { along_px, epipolar, ..MatchConfig::new() };
        let mut expected = heapless::Vec::<_, POINTS>::new();
        let (left, right) = (in_rust(&left), in_rust(&right));
        let dropped = FeatureMatcher::<POINTS>::new().run(&left, &right, &config, expected.as_mut_view());
        assert_eq!(dropped, Ok(0));
        let expected: Vec<_> = expected
            .iter()
            .map(|m| (&left[usize::from(m.left)], &right[usize::from(m.right)]))
            .map(|(left, right)| CMatch { u: left.x_px, v: left.y_px, u2: right.x_px, v2: right.y_px })
            .collect();
        assert_eq!(found[..count], expected);
        assert!(count > 5, "{count} matches");
    }
}

/// The numbers of a step, as the functions for C give them.
fn numbers(step: &Step<f32>) -> Vec<f32> {
    let (rotation, covariance) = (step.motion.rotation().transpose(), step.covariance.transpose());
    let numbers = rotation.iter().chain(step.motion.translation().iter()).chain(covariance.iter());
    numbers.copied().chain([step.residual]).collect()
}

#[test]
fn motions_are_those_of_rust() {
    let mut memory = [words(detector_bytes(COLUMNS, SLOTS.into())), words(odometry_bytes(POINTS))];
    let [of_detector, of_odometry] = &mut memory;
    let detector = detector(of_detector);
    let mut walk = Box::new(Walk::new());
    walk.start().expect("a rig");
    let mut handle = null_mut();
    let rig = CRig { focal_px: 120.0, baseline_m: 0.1, cx: 63.5, cy: 47.5, cx_right: 63.5 };
    let mut config = MaybeUninit::<COdometryConfig>::uninit();
    // SAFETY: as many bytes are there, and the configuration is filled before it is read.
    unsafe {
        let (memory, length) = (of_odometry.as_mut_ptr().cast(), size_of_val(&of_odometry[..]));
        assert_eq!(stereopsis_odometry_init(memory, length, POINTS as u16, &raw mut handle), Status::Ok);
        assert_eq!(stereopsis_odometry_default(COLUMNS as u16, config.as_mut_ptr()), Status::Ok);
        assert_eq!(stereopsis_odometry_start(handle, &raw const rig, config.as_ptr()), Status::Ok);
    }
    let mut known = 0;
    for frame in 0..FRAMES {
        walk.take(frame).expect("a frame");
        let (features, _) = detect(detector, walk.pictures()[0], POINTS);
        let [left, right] = walk.pictures().map(|pixels| CPicture {
            pixels: pixels.as_ptr(),
            width: COLUMNS as u16,
            height: HEIGHT as u16,
        });
        let mut step = MaybeUninit::<CStep>::uninit();
        // SAFETY: pictures and features are there; the step is filled before it is read.
        let step = unsafe {
            let status = stereopsis_odometry_step(
                handle,
                &raw const left,
                &raw const right,
                features.as_ptr(),
                features.len(),
                step.as_mut_ptr(),
            );
            assert_eq!(status, Status::Ok, "frame {frame}");
            step.assume_init()
        };
        let expected = walk.step().expect("a step");
        let CStep { motion, covariance, residual, .. } = step;
        let found = [&motion.rotation[..], &motion.translation, &covariance, &[residual]].concat();
        assert_eq!(found, numbers(&expected), "frame {frame}");
        let counts = [step.points, step.found, step.inliers].map(|count| count as usize);
        assert_eq!(counts, [expected.points, expected.found, expected.inliers]);
        known += usize::from(step.state == stereopsis::ffi::STEREOPSIS_MOTION_TRACKED);
    }
    assert_eq!(known, FRAMES - 1);
}
