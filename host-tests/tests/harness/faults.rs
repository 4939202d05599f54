//! The injector of faults itself.

use image::{DynamicImage, GrayImage};
use stereopsis::camera::{CameraError, LineSource};
use stereopsis_host::fault::{Fault, Faulty};
use stereopsis_host::mock::MockCamera;

/// A line that stayed behind a bus fault comes with the next call, and no other line is spared by that.
#[test]
fn a_bus_fault_spares_the_next_call_alone() {
    let camera = MockCamera::from_image(DynamicImage::ImageLuma8(GrayImage::new(16, 500))).expect("a camera");
    let mut faulty = Faulty::new(camera, &[Fault::BusBefore], 0.2, 1);
    let (mut line, mut calls, mut failed, mut has_failed) = ([0; 16], 0, 0, false);
    for _ in 0..10 {
        faulty.start_frame().expect("no fault is of frames");
        has_failed = false;
        loop {
            let next = faulty.next_line(&mut line);
            match (next, has_failed) {
                (Err(CameraError::NoLineLeft), _) => break,
                (next, true) => assert!(next.is_ok(), "the line that stayed comes"),
                (next, false) => {
                    calls += 1;
                    failed += u32::from(next.is_err());
                    has_failed = next.is_err();
                    continue;
                }
            }
            has_failed = false;
        }
    }
    assert!(!has_failed);
    let share = f64::from(failed) / f64::from(calls);
    // The deviation of 5000 draws is .006.
    assert!((share - 0.2).abs() < 0.02, "{failed} of {calls}");
}
