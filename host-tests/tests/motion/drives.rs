//! A street that is driven through: how far the end of the way is off.

use crate::support::{mono, stereo};
use image::GrayImage;
use nalgebra::Matrix3;
use stereopsis::motion::odometry::State;
use stereopsis_host::odometry::error::{Alignment, align, ate, drift, rpe};
use stereopsis_host::odometry::trajectory::Trajectory;
use stereopsis_host::scene::MovingScene;

fn drive(frames: usize, size: (u16, u16), shutter: f64) -> (MovingScene, Vec<(GrayImage, GrayImage)>) {
    let street = MovingScene::street(size.0, size.1, frames, 0.5, 7).with_noise(2.0).with_shutter(shutter);
    let pictures = (0..frames).map(|i| street.frame(i)).collect();
    (street, pictures)
}

/// The distance of the last place from the true one, as a share of the way.
fn off(trajectory: &Trajectory, street: &MovingScene, scale: f64) -> f64 {
    let truth = street.truth();
    let (found, last) = (trajectory.poses[truth.len() - 1], truth[truth.len() - 1]);
    let way: f64 = truth.windows(2).map(|p| (p[1].translation() - p[0].translation()).norm()).sum();
    (found.translation() * scale - last.translation()).norm() / way
}

#[test]
fn a_short_drive() {
    let (street, frames) = drive(12, (320, 160), 0.0);
    let truth = street.truth();
    let trajectory = stereo(street.rig(), &frames);
    assert!(trajectory.steps.iter().skip(1).all(|step| step.state == State::Tracked));
    let share = off(&trajectory, &street, 1.0);
    assert!(share < 0.01, "{:.3} % of the way", 100.0 * share);
    let rpe_stereo = rpe(&trajectory.poses, &truth, 1, 1.0).expect("steps");
    assert!(rpe_stereo.translation < 0.01 && rpe_stereo.rotation_rad.to_degrees() < 0.05, "{rpe_stereo:?}");

    // One camera may wait for a baseline first.
    let trajectory = mono(street.rig(), &frames);
    let waited = trajectory.count(State::Waiting);
    assert!(waited < 4 && trajectory.count(State::Tracked) + waited + 1 == frames.len(), "{waited}");
    let scale = align(&trajectory.poses, &truth, Alignment::Similar).expect("an alignment").scale;
    let share = off(&trajectory, &street, scale);
    assert!(share < 0.02, "{:.3} % of the way", 100.0 * share);
    // Frames that waited are laid between others.
    let rpe_mono = rpe(&trajectory.poses[waited + 1..], &truth[waited + 1..], 1, scale).expect("steps");
    // The first steps are as sure as two views of so small a picture make them.
    let [mean, worst] = [rpe_mono.direction_rad, rpe_mono.worst_direction_rad].map(f64::to_degrees);
    assert!(mean < 0.6 && worst < 1.5, "{rpe_mono:?}");
}

#[test]
fn a_drive_with_an_open_shutter() {
    let (street, frames) = drive(6, (240, 120), 0.4);
    let trajectory = stereo(street.rig(), &frames);
    let share = off(&trajectory, &street, 1.0);
    assert!(share < 0.02, "{:.3} % of the way", 100.0 * share);
}

/// What rounding leaves of a rotation would grow by more than three times with every frame that is predicted
/// from the one before.
#[test]
fn motions_are_rotations_after_many_frames() {
    let (street, frames) = drive(24, (240, 120), 0.0);
    for (i, step) in stereo(street.rig(), &frames).steps.iter().enumerate() {
        let rotation = step.motion.rotation();
        let off = (rotation.transpose() * rotation - Matrix3::identity()).amax();
        assert!(off < 1e-13, "{i}: {off}");
    }
}

/// `cargo test --release -p stereopsis-host --test motion -- --ignored --nocapture` prints the figures.
#[test]
#[ignore = "renders for minutes"]
fn two_hundred_frames() {
    let (street, frames) = drive(200, (320, 160), 0.25);
    let truth = street.truth();
    let trajectory = stereo(street.rig(), &frames);
    let share = off(&trajectory, &street, 1.0);
    let ate = ate(&trajectory.poses, &truth, Alignment::Rigid).expect("places");
    println!("stereo: {:.3} % of the way off at its end, ATE {ate:.4} m", 100.0 * share);
    for length in [10.0, 50.0] {
        let drift = drift(&trajectory.poses, &truth, length, 1.0).expect("ways");
        println!(
            "drift over {length} m: {:.3} %, {:.4} deg/m",
            100.0 * drift.translation,
            drift.rotation_rad.to_degrees()
        );
    }
    assert!(share < 0.01, "{:.3} % of the way", 100.0 * share);
    let trajectory = mono(street.rig(), &frames);
    let scale = align(&trajectory.poses, &truth, Alignment::Similar).expect("an alignment").scale;
    println!("mono: {:.3} % of the way off at its end", 100.0 * off(&trajectory, &street, scale));
}
