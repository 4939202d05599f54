//! Files of poses, and how far trajectories are off.

use crate::support::pose;
use nalgebra::Vector3;
use stereopsis::geometry::camera::Pose;
use stereopsis_host::odometry::error::{Alignment, align, ate, drift, rpe};
use stereopsis_host::odometry::poses::{self, Poses};
use stereopsis_host::odometry::truth::FrameTruth;

/// A way round a corner.
fn way() -> Vec<Pose<f64>> {
    (0..12).map(f64::from).map(|s| pose([0.0, 0.1 * s, 0.02 * s], [0.05 * s * s, 0.1 * s, s])).collect()
}

#[test]
fn files_come_back_as_they_were() {
    let mut bytes = Vec::new();
    poses::write(&mut bytes, &way()).expect("room");
    let text = String::from_utf8(bytes.clone()).expect("text");
    assert_eq!(text.lines().count(), 12);
    assert!(text.lines().all(|line| line.split(' ').count() == 12));
    let first: Vec<f64> =
        text.lines().next().expect("a line").split(' ').map(|w| w.parse().expect("a number")).collect();
    assert_eq!(first, [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    let file = tempfile::NamedTempFile::new().expect("a file");
    std::fs::write(file.path(), &bytes).expect("room");
    let read = poses::read(file.path()).expect("poses");
    assert!(read.times_s.is_none());
    for (a, b) in read.poses.iter().zip(way()) {
        assert!(
            (a.translation() - b.translation()).norm() < 1e-8 && (a.rotation() - b.rotation()).amax() < 1e-8
        );
    }
    std::fs::write(file.path(), "1 0 0 0 0 1 0 0 0 0 1 0\n1 2 3\n").expect("room");
    let error = poses::read(file.path()).expect_err("no pose").to_string();
    let expected = "line 2 is no pose; 12 numbers are needed, the rows of [R | t] with a rotation R, or 8, \
                    t x y z qx qy qz qw";
    assert!(error.ends_with(expected), "{error}");
}

#[test]
fn times_places_and_quaternions_come_back_as_they_were() {
    let times: Vec<f64> = (0..12).map(|i| 1.5e9 + 0.1 * f64::from(i)).collect();
    let mut bytes = b"# timestamp tx ty tz qx qy qz qw\n".to_vec();
    poses::write_tum(&mut bytes, &way(), &times).expect("room");
    // A turn by 0.1 about Y and 0.02 about Z has the quaternion 0, 0.05, 0.01, 1, nearly.
    let text = String::from_utf8(bytes.clone()).expect("text");
    let second: Vec<f64> =
        text.lines().nth(2).expect("a line").split(' ').map(|w| w.parse().expect("a number")).collect();
    let expected = [1.5e9 + 0.1, 0.05, 0.1, 1.0, 0.0, 0.04998, 0.009996, 0.9987];
    assert!(second.len() == 8 && second.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-5), "{text}");
    let file = tempfile::NamedTempFile::new().expect("a file");
    std::fs::write(file.path(), &bytes).expect("room");
    let read = poses::read(file.path()).expect("poses");
    assert_eq!(read.poses.len(), 12);
    assert_eq!(read.times_s.as_deref(), Some(times.as_slice()));
    for (a, b) in read.poses.iter().zip(way()) {
        assert!(
            (a.translation() - b.translation()).norm() < 1e-8 && (a.rotation() - b.rotation()).amax() < 1e-8
        );
    }
    std::fs::write(file.path(), "0 1 2 3 0 0 0 0.5\n").expect("room");
    assert!(poses::read(file.path()).is_err(), "a quaternion has the length 1");
    std::fs::write(file.path(), "0 1 2 3 0 0 0 1\n1 0 0 0 0 1 0 0 0 0 1 0\n").expect("room");
    let error = poses::read(file.path()).expect_err("one form").to_string();
    assert!(error.contains("line 2 is no pose"), "{error}");
    for (text, expected) in [
        ("0\n0.1\n0.3\n", None),
        ("0\n0.1\n", Some("has 2 times; 3 are needed, one a frame")),
        ("0\n0.1\n0.1\n", Some("line 3 is no time after the one before; a number of seconds is needed")),
        ("0\nx\n", Some("line 2 is no time after the one before; a number of seconds is needed")),
    ] {
        std::fs::write(file.path(), text).expect("room");
        match (poses::read_times(file.path(), 3), expected) {
            (Ok(times), None) => assert_eq!(times, [0.0, 0.1, 0.3]),
            (Err(error), Some(expected)) => assert!(error.to_string().ends_with(expected), "{error}"),
            (found, _) => panic!("{text}: {found:?}"),
        }
    }
}

#[test]
fn true_poses_are_those_of_the_frames_times() {
    // Straight ahead by 1 and about Y by 0.1 each second, four poses a second, of which one second is
    // missing; the order of the lines does not matter.
    let at = |s: f64| pose([0.0, 0.1 * s, 0.0], [0.0, 0.0, s]);
    let mut times: Vec<f64> = (0..40).map(|i| 100.0 + 0.25 * f64::from(i)).collect();
    times.retain(|t| *t <= 104.0 || *t >= 105.0);
    times.reverse();
    let truth = Poses { poses: times.iter().map(|t| at(t - 100.0)).collect(), times_s: Some(times) };
    // The first frame is before the truth, the second one at its beginning but for a rounded digit.
    let frames = [99.9, 99.999, 100.1, 100.3, 100.5, 103.9, 104.1, 104.4, 104.9, 105.1, 105.3, 120.0];
    let known = FrameTruth::at(&truth, &frames);
    assert_eq!(known.frames, [1, 2, 3, 4, 5, 9, 10]);
    for (frame, found) in known.frames.iter().zip(&known.poses) {
        let expected = at((frames[*frame] - 100.0).max(0.0));
        assert!((found.translation() - expected.translation()).norm() < 1e-9, "{frame}: {found:?}");
        assert!((found.rotation() - expected.rotation()).amax() < 1e-9, "{frame}: {found:?}");
    }
    assert_eq!(known.steps().collect::<Vec<_>>(), [[0, 1], [1, 2], [2, 3], [3, 4], [5, 6]]);
    let numbered: Vec<_> = (0..12).map(|i| at(f64::from(i))).collect();
    let beside = known.beside(&numbered);
    assert!(beside.iter().zip(&known.frames).all(|(pose, &frame)| *pose == numbered[frame]));
    // A truth without times has a line for each frame.
    let untimed = FrameTruth::at(&Poses { times_s: None, ..truth }, &frames[..3]);
    assert_eq!((untimed.frames, untimed.poses.len()), (vec![0, 1, 2], 3));
}

#[test]
fn alignment_undoes_a_similarity() {
    let truth = way();
    let by = pose([0.3, -0.5, 0.2], [4.0, -1.0, 2.0]);
    let moved: Vec<_> = truth
        .iter()
        .map(|p| {
            let p = by.then(p);
            Pose::new(*p.rotation(), p.translation() * 0.25).expect("a pose")
        })
        .collect();
    let found = align(&moved, &truth, Alignment::Similar).expect("an alignment");
    assert!((found.scale - 4.0).abs() < 1e-9, "{}", found.scale);
    assert!(ate(&moved, &truth, Alignment::Similar).expect("places") < 1e-9);
    // With the scale held, the places of a way a quarter as long are off by three quarters of its spread.
    assert!(ate(&moved, &truth, Alignment::Rigid).expect("places") > 1.0);
    let relative = rpe(&moved, &truth, 1, found.scale).expect("steps");
    assert!(
        relative.translation < 1e-9 && relative.rotation_rad < 1e-7 && relative.worst_direction_rad < 1e-6
    );
    assert!(align(&moved[..1], &truth, Alignment::Similar).is_none());
    assert!(rpe(&moved[..1], &truth, 1, 1.0).is_none());
}

#[test]
fn worked_by_hand() {
    // Straight ahead in steps of 1; the estimate's are 1.02 and it turns by 0.001 rad with each.
    let truth: Vec<_> = (0..11).map(|i| pose([0.0; 3], [0.0, 0.0, f64::from(i)])).collect();
    let mut estimate = vec![Pose::identity()];
    for _ in 0..10 {
        let last = estimate[estimate.len() - 1];
        estimate.push(last.then(&pose([0.0, 0.001, 0.0], [0.0, 0.0, 1.02])));
    }
    let one = rpe(&estimate, &truth, 1, 1.0).expect("steps");
    assert!((one.translation - 0.02).abs() < 1e-9 && (one.rotation_rad - 0.001).abs() < 1e-9, "{one:?}");
    assert!(one.worst_direction_rad < 1e-7);
    let five = drift(&estimate, &truth, 5.0, 1.0).expect("ways");
    assert_eq!(five.ways, 6);
    // 0.1 of 5 ahead, and sideways 1.02 (1 + 2 + 3 + 4) / 1000 of 5: the root of their squares.
    assert!((five.translation - 0.1_f64.hypot(0.0102) / 5.0).abs() < 1e-5, "{five:?}");
    assert!((five.rotation_rad - 0.001).abs() < 1e-9);
    assert!(drift(&estimate, &truth, 11.0, 1.0).is_none());
    assert_eq!(Vector3::new(0.0, 0.0, 10.0), *truth[10].translation());
}
