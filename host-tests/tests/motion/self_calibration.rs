//! Pairs whose calibration is off along the rows, found while they move.

use crate::support::{camera, stereo};
use image::GrayImage;
use std::convert::Infallible;
use std::sync::LazyLock;
use stereopsis::geometry::camera::RectifiedRig;
use stereopsis::motion::odometry::RigEstimate;
use stereopsis_host::odometry::error::drift;
use stereopsis_host::odometry::run::{Rig, RunConfig, run};
use stereopsis_host::scene::MovingScene;

const FRAMES: usize = 20;

/// A drive and what its cameras see, which takes longer to draw than to follow.
static DRIVE: LazyLock<(MovingScene, Vec<(GrayImage, GrayImage)>)> = LazyLock::new(|| {
    let street = MovingScene::street(320, 160, FRAMES, 0.5, 7).with_noise(3.0);
    let frames = (0..FRAMES).map(|i| street.frame(i)).collect();
    (street, frames)
});

/// The rig as it would be with the right camera's principal point so many columns further right.
fn off_by(rig: &RectifiedRig, columns: f32) -> RectifiedRig {
    let ((cx, cy), offset) = (rig.principal_point(), rig.disparity_offset_px());
    RectifiedRig::with_offset(rig.focal_px(), rig.baseline_m(), cx, cy, cx + offset + columns).expect("a rig")
}

#[test]
fn a_principal_point_that_is_off_is_found_and_corrected() {
    let (street, frames) = &*DRIVE;
    let truth = street.truth();
    let run_of = |columns: f32| {
        let trajectory = stereo(off_by(&street.rig(), columns), frames);
        let last = *trajectory.rigs.last().expect("an estimate");
        (drift(&trajectory.poses, &truth, 5.0, 1.0).expect("ways").translation, last)
    };
    let (unmoved, rig) = run_of(0.0);
    assert!(rig.is_sure && !rig.is_off() && rig.disparity_px.abs() < 4.0 * rig.sigma_px, "{rig:?}");
    for columns in [-0.7, 0.35, 1.0] {
        let (share, rig) = run_of(columns);
        let lack = rig.disparity_px + f64::from(columns);
        assert!(rig.is_sure && rig.is_applied && rig.is_off(), "{columns}: {rig:?}");
        assert!(lack.abs() < 4.0 * rig.sigma_px && rig.sigma_px < 0.06, "{columns}: {rig:?}");
        // 1 px uncorrected is 5 % and more; frames that are counted twice make it 2 times as much.
        assert!(share < 1.4 * unmoved.max(2e-3), "{columns}: {share} beside {unmoved}");
    }
}

#[test]
fn what_is_not_asked_for_is_reported_and_not_corrected() {
    let (street, frames) = &*DRIVE;
    let frames = frames.iter().cloned().map(|(left, right)| Ok::<_, Infallible>((left, Some(right))));
    let config = RunConfig { corrects_rig: false, ..RunConfig::default() };
    let trajectory =
        run(&Rig::Stereo(off_by(&street.rig(), 1.0)), frames, config, |_| ()).expect("a trajectory");
    assert_eq!(trajectory.rigs.len(), FRAMES);
    let rig = trajectory.rigs.last().expect("an estimate");
    assert!(
        rig.is_off() && !rig.is_applied && (rig.disparity_px + 1.0).abs() < 4.0 * rig.sigma_px,
        "{rig:?}"
    );
}

#[test]
fn a_camera_that_is_turned() {
    // Columns of the right camera as one that is turned by 3 mrad to the right sees them.
    let (street, mut frames) = DRIVE.clone();
    let (camera, yaw) = (camera(&street.rig()), 0.003_f64);
    let (focal, (cx, _)) = (camera.focal_px().0, camera.principal_point());
    for (_, right) in &mut frames {
        let level = right.clone();
        for (x, y, pixel) in right.enumerate_pixels_mut() {
            let straight = (((f64::from(x) - cx) / focal).atan() + yaw).tan() * focal + cx;
            let (whole, part) = (straight.floor(), straight.fract());
            let at = |x: f64| f64::from(level.get_pixel(x.clamp(0.0, 319.0) as u32, y).0[0]);
            pixel.0[0] = (at(whole) * (1.0 - part) + at(whole + 1.0) * part).round() as u8;
        }
    }
    let trajectory = stereo(street.rig(), &frames);
    let rig: &RigEstimate<f64> = trajectory.rigs.last().expect("an estimate");
    // 0.576 px in the middle: parts of it may be taken for the principal point's.
    assert!(rig.is_applied && (rig.disparity_px + yaw * focal).abs() < 0.1, "{rig:?}");
    let deviation = rig.covariance[1][1].sqrt();
    assert!((rig.yaw_rad - yaw).abs() < 4.0 * deviation + 0.2 * yaw, "{rig:?}");
    let share = drift(&trajectory.poses, &street.truth(), 5.0, 1.0).expect("ways").translation;
    assert!(share < 0.012, "{share}");
}
