//! Raw lines through the functions for C: the lines and masks of the remaps in Rust.

use super::*;
use nalgebra::{Matrix3, Vector3};
use std::ptr::{null, null_mut};
use stereopsis::camera::StereoSource;
use stereopsis::ffi::{CCameras, STEREOPSIS_ALPHA_NATURAL};
use stereopsis::geometry::camera::{Camera, Distortion, ImageSize, Pose, StereoRig};
use stereopsis::geometry::rectify::{Crop, Rectification};
use stereopsis::imaging::{RectifiedPair, RemapPair};
use stereopsis_host::run::MemoryPair;

const SIZE: ImageSize = ImageSize { width: 96, height: 60 };

/// Two cameras with a lens, the right one lower and farther.
fn rig() -> StereoRig<f64> {
    let camera = |cy| {
        let camera = Camera::new(80.0, 81.0, 47.5, cy).expect("a camera");
        camera.with_distortion(Distortion::from_opencv([-0.1, 0.02, 0.0, 0.0, 0.0])).expect("a lens")
    };
    let pose = Pose::new(Matrix3::identity(), Vector3::new(0.06, 0.002, 0.001)).expect("a pose");
    StereoRig::new([camera(29.5), camera(31.0)], pose, [SIZE; 2]).expect("a rig")
}

/// A line of the left camera, one of the right one, and both masks.
type Row = [Vec<u8>; 4];

/// What Rust finds.
fn rectified(record: &[u8], crop: Crop<f32>, [left, right]: &Lines) -> (Vec<Row>, Rectification<f32>) {
    let rig = StereoRig::<f32>::from_record(record).expect("a record");
    let rectified = Rectification::new(&rig, crop, SIZE).expect("a rectification");
    let mut remaps = Box::new(RemapPair::<96, 33, 500>::empty());
    remaps.set(&rectified).expect("room");
    let raw = MemoryPair::new(SIZE.width, left.concat(), right.concat()).expect("a pair");
    let mut pair = RectifiedPair::new(raw, &mut remaps).expect("enough lines");
    pair.start_frame().expect("a frame");
    let row = |_| {
        let (mut left, mut right) = (vec![0; SIZE.width.into()], vec![0; SIZE.width.into()]);
        pair.next_lines(&mut left, &mut right).expect("lines");
        let [valid_left, valid_right] = pair.valid();
        [left, right, valid_left.to_vec(), valid_right.to_vec()]
    };
    ((0..SIZE.height).map(row).collect(), rectified)
}

#[test]
fn lines_and_masks_are_those_of_the_remaps() {
    let (record, raw) = (rig().to_record(), lines(SIZE.width, SIZE.height));
    for (alpha, crop) in [(STEREOPSIS_ALPHA_NATURAL, Crop::Natural), (1.0, Crop::Alpha(1.0))] {
        let (expected, rectification) = rectified(&record, crop, &raw);
        let mut memory = vec![0xA5A5_A5A5_A5A5_A5A5_u64; stereopsis_rectifier_size().div_ceil(8)];
        let (mut handle, mut found) = (null_mut(), Vec::new());
        let mut rig = CRig { focal_px: 0.0, baseline_m: 0.0, cx: 0.0, cy: 0.0, cx_right: 0.0 };
        let (width, height) = (SIZE.width, SIZE.height);
        // SAFETY: the memory outlives the handle, and all arrays have the lengths that are said.
        unsafe {
            let length = size_of_val(&memory[..]);
            let status = stereopsis_rectifier_init(memory.as_mut_ptr().cast(), length, &raw mut handle);
            assert_eq!(status, Status::Ok);
            let (bytes, length) = (record.as_ptr(), record.len());
            let status = stereopsis_rectifier_start(
                handle,
                bytes,
                length,
                width,
                height,
                alpha,
                &raw mut rig,
                null_mut(),
            );
            assert_eq!(status, Status::Ok);
            assert_eq!(stereopsis_rectifier_begin_frame(handle), Status::Ok);
            for (left, right) in raw[0].iter().zip(&raw[1]) {
                let status = stereopsis_rectifier_push(handle, left.as_ptr(), right.as_ptr(), left.len());
                assert!(status as i32 >= 0, "{status:?}");
                loop {
                    let mut row: Row = std::array::from_fn(|_| vec![9; width.into()]);
                    let [left, right, valid_left, valid_right] = row.each_mut().map(|line| line.as_mut_ptr());
                    if stereopsis_rectifier_line(handle, left, right, width.into()) != Status::Ok {
                        break;
                    }
                    let y = found.len() as u16;
                    let status = stereopsis_rectifier_mask(handle, y, valid_left, valid_right, width.into());
                    assert_eq!(status, Status::Ok);
                    found.push(row);
                }
            }
            assert_eq!(stereopsis_rectifier_deinit(handle), Status::Ok);
        }
        assert!(found == expected, "alpha {alpha}");
        assert!(expected.iter().any(|[_, _, valid, _]| valid.contains(&0)), "some pixels are not seen");
        assert_eq!(rig.focal_px, rectification.camera().focal_px().0);
        assert_eq!(rig.baseline_m, rectification.baseline_m());
    }
}

#[test]
fn a_record_says_what_the_cameras_are() {
    let record = rig().to_record();
    let mut cameras = CCameras { width: [0; 2], height: [0; 2], baseline_m: 0.0 };
    // SAFETY: the record has its length.
    unsafe {
        let status = stereopsis_record_read(record.as_ptr(), record.len(), &raw mut cameras);
        assert_eq!(status, Status::Ok);
        assert_eq!(stereopsis_record_read(null(), record.len(), &raw mut cameras), Status::Null);
    }
    assert_eq!((cameras.width, cameras.height), ([96; 2], [60; 2]));
    assert!((f64::from(cameras.baseline_m) - rig().baseline_m()).abs() < 1e-6);
}
