//! Pairs whose calibration is off along the rows, found while they move.

use crate::support::{camera, stereo};
use image::{GrayImage, Luma, imageops};
use std::convert::Infallible;
use std::sync::LazyLock;
use stereopsis::geometry::{camera::RectifiedRig, rectify::RowAlignment};
use stereopsis::motion::odometry::{RigEstimate, State};
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

/// The frames with right pictures that show at each place what those of the drive show there.
fn moved(place: impl Fn(f64, f64) -> [f64; 2]) -> Vec<(GrayImage, GrayImage)> {
    let mut frames = DRIVE.1.clone();
    for (_, right) in &mut frames {
        let level = right.clone();
        for (x, y, pixel) in right.enumerate_pixels_mut() {
            let [x, y] = place(x.into(), y.into()).map(|x| x as f32);
            *pixel = imageops::interpolate_bilinear(&level, x, y).unwrap_or(Luma([0]));
        }
    }
    frames
}

#[test]
fn a_camera_that_is_turned() {
    // Columns of the right camera as one that is turned by 3 mrad to the right sees them.
    let street = &DRIVE.0;
    let (camera, yaw) = (camera(&street.rig()), 0.003_f64);
    let (focal, (cx, _)) = (camera.focal_px().0, camera.principal_point());
    let frames = moved(|x, y| [(((x - cx) / focal).atan() + yaw).tan() * focal + cx, y]);
    let trajectory = stereo(street.rig(), &frames);
    let rig: &RigEstimate<f64> = trajectory.rigs.last().expect("an estimate");
    // 0.576 px in the middle: parts of it may be taken for the principal point's.
    assert!(rig.is_applied && (rig.disparity_px + yaw * focal).abs() < 0.1, "{rig:?}");
    let deviation = rig.covariance[1][1].sqrt();
    assert!((rig.yaw_rad - yaw).abs() < 4.0 * deviation + 0.2 * yaw, "{rig:?}");
    let share = drift(&trajectory.poses, &street.truth(), 5.0, 1.0).expect("ways").translation;
    assert!(share < 0.012, "{share}");
}

#[test]
fn a_roll_and_a_longer_lens_are_told_by_rows() {
    let street = &DRIVE.0;
    let (cx, cy) = camera(&street.rig()).principal_point();
    let truth = street.truth();
    for (roll, scale) in [(0.006_f64, 1.0), (0.0, 1.008), (-0.01, 0.994)] {
        // The right picture shows at `p` what it should show at `p` turned back and shrunk.
        let (sin, cos) = roll.sin_cos();
        let frames = moved(|x, y| {
            let [x, y] = [(x - cx) / scale, (y - cy) / scale];
            [cx + cos * x + sin * y, cy + cos * y - sin * x]
        });
        let trajectory = stereo(street.rig(), &frames);
        let rig = trajectory.rigs.last().expect("an estimate");
        assert!(rig.is_sure && rig.is_applied && !rig.is_off(), "{rig:?}");
        assert!((rig.roll_rad - roll).abs() < 3e-4 && (rig.scale - scale).abs() < 3e-4, "{rig:?}");
        assert!(rig.disparity_px.abs() < 4.0 * rig.sigma_px, "{rig:?}");
        // By a principal point and a yaw alone it is 4 % and more.
        let share = drift(&trajectory.poses, &truth, 5.0, 1.0).expect("ways").translation;
        assert!(share < 0.005, "{roll} {scale}: {share}");
    }
}

#[test]
fn rows_that_are_known_to_be_off_are_found_again() {
    let street = &DRIVE.0;
    let frames = moved(|x, y| [x, y - 3.0]);
    let focal = camera(&street.rig()).focal_px().0;
    let run_of = |rows: Option<RowAlignment<f64>>| {
        let frames = frames.iter().cloned().map(|(left, right)| Ok::<_, Infallible>((left, Some(right))));
        let config = RunConfig { rows, ..RunConfig::default() };
        run(&Rig::Stereo(street.rig()), frames, config, |_| ()).expect("a trajectory")
    };
    assert!(run_of(None).count(State::Tracked) < FRAMES / 2);
    // Three pixels lower is a turn up.
    let rows = RowAlignment { rotation_rad: [-3.0 / focal, 0.0, 0.0], sigma_rad: [1e-3; 3] };
    let trajectory = run_of(Some(rows));
    let rig = trajectory.rigs.last().expect("an estimate");
    assert_eq!(trajectory.count(State::Tracked), FRAMES - 1);
    assert!(rig.is_applied && (rig.lower_px - 3.0).abs() < 0.05, "{rig:?}");
    assert!(drift(&trajectory.poses, &street.truth(), 5.0, 1.0).expect("ways").translation < 0.005);
}
