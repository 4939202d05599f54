//! What cannot be told is named, and never a wrong pose.

use crate::support::{frames, mono, pose, rig, room, stereo, turned_deg, wall};
use image::GrayImage;
use nalgebra::{Point2, Point3};
use stereopsis::features::Feature;
use stereopsis::geometry::absolute::Landmark;
use stereopsis::geometry::camera::{Camera, Pose};
use stereopsis::geometry::two_view::Correspondence;
use stereopsis::imaging::Picture;
use stereopsis::motion::odometry::{
    Frame, OdometryConfig, OdometryError, OdometryRig, OdometryRigError, OdometryState, OdometryView,
    PointMatch, State, StereoOdometry, Track,
};

#[test]
fn a_camera_that_stands_still_stands_still() {
    let frames = frames(room(), vec![Pose::identity(); 4]);
    for trajectory in [stereo(rig(), &frames), mono(rig(), &frames)] {
        let states: Vec<_> = trajectory.steps.iter().map(|step| step.state).collect();
        assert_eq!(states, [State::First, State::Stationary, State::Stationary, State::Stationary]);
        assert!(trajectory.poses.iter().all(|pose| *pose == Pose::identity()), "{:?}", trajectory.poses);
    }
}

#[test]
fn one_camera_that_only_turns_has_no_step() {
    let path: Vec<_> =
        (0..5).map(|i| pose([0.004 * f64::from(i), 0.02 * f64::from(i), 0.0], [0.0; 3])).collect();
    let trajectory = mono(rig(), &frames(room(), path.clone()));
    for ((found, truth), step) in trajectory.poses.iter().zip(&path).zip(&trajectory.steps).skip(1) {
        assert_eq!(step.state, State::RotationOnly);
        assert_eq!(found.translation().norm(), 0.0);
        assert!(turned_deg(found, truth) < 0.05, "{}", turned_deg(found, truth));
        // What is not known of the step says so.
        assert!(step.covariance[(3, 3)] > 1e6 && step.covariance[(0, 0)] < 1e-6, "{}", step.covariance);
    }
}

/// Poses after steps to the side, m, each with a turn about Y, radians.
fn way(steps: &[(f64, f64)]) -> Vec<Pose<f64>> {
    let (mut place, mut turn) = (0.0, 0.0);
    let moved = steps.iter().map(|&(step, by)| {
        (place, turn) = (place + step, turn + by);
        pose([0.0, turn, 0.0], [place, 0.0, 0.0])
    });
    [Pose::identity()].into_iter().chain(moved).collect()
}

#[test]
fn one_camera_that_stops_measures_its_steps_again() {
    const STEP: (f64, f64) = (0.054, 0.0);
    const STEPS: [(f64, f64); 14] = [STEP; 14];
    // It turns in place for two frames, or stands.
    for (stop, stopped) in [((0.0, 0.01), State::RotationOnly), ((0.0, 0.0), State::Stationary)] {
        let path = way(&[&STEPS[..], &[stop; 2], &STEPS[..8]].concat());
        let trajectory = mono(rig(), &frames(room(), path));
        let told: Vec<_> =
            trajectory.steps.iter().map(|s| (s.state, s.motion.translation().norm())).collect();
        let (before, after) = told.split_at(15);
        assert_eq!(before[14].0, State::Tracked);
        let states: Vec<_> = after.iter().map(|step| step.0).collect();
        assert_eq!(states[..2], [stopped; 2]);
        assert_eq!(states[2..], [State::Tracked; 8]);
        // A step is as long as before.
        let length = |steps: &[(State, f64)]| steps.iter().map(|step| step.1).sum::<f64>() / 8.0;
        let ratio = length(&after[2..]) / length(&before[7..]);
        assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
    }
}

#[test]
fn a_pair_that_only_turns_measures_that_there_is_no_step() {
    let path: Vec<_> = (0..4).map(|i| pose([0.0, 0.02 * f64::from(i), 0.0], [0.0; 3])).collect();
    let trajectory = stereo(rig(), &frames(room(), path.clone()));
    for ((found, truth), step) in trajectory.poses.iter().zip(&path).zip(&trajectory.steps).skip(1) {
        assert_eq!(step.state, State::Tracked);
        assert!(turned_deg(found, truth) < 0.1, "{}", turned_deg(found, truth));
        assert!(found.translation().norm() < 0.01, "{}", found.translation());
    }
}

#[test]
fn points_at_infinity_tell_the_turn_alone() {
    // A wall in 3 km: a step of 30 cm moves it by 0.02 px.
    let path: Vec<_> =
        (0..4).map(|i| pose([0.0, 0.015 * f64::from(i), 0.0], [0.3 * f64::from(i), 0.0, 0.0])).collect();
    let frames = frames(wall(3000.0, 0.0), path.clone());
    let trajectory = stereo(rig(), &frames);
    for ((found, truth), step) in trajectory.poses.iter().zip(&path).zip(&trajectory.steps).skip(1) {
        assert_eq!(step.state, State::TranslationUnknown);
        assert_eq!(found.translation().norm(), 0.0);
        assert!(turned_deg(found, truth) < 0.1, "{}", turned_deg(found, truth));
    }
    // To one camera it is as if it only turned.
    let trajectory = mono(rig(), &frames);
    assert!(trajectory.steps.iter().skip(1).all(|step| step.state == State::RotationOnly));
}

#[test]
fn what_is_far_tells_no_pair_that_it_stands() {
    // A wall so far away that no point's depth is more than noise. A drive towards it moves its points
    // outwards by up to a pixel a frame, which no turn explains, and neither does a step.
    for (step_m, distance_m) in [(0.15, 40.0), (0.5, 60.0), (0.0, 40.0)] {
        let path: Vec<_> = (0..16).map(|i| pose([0.0; 3], [0.0, 0.0, step_m * f64::from(i)])).collect();
        let trajectory = stereo(rig(), &frames(wall(distance_m, 0.0), path));
        for (i, (found, step)) in trajectory.poses.iter().zip(&trajectory.steps).enumerate().skip(1) {
            assert_eq!(step.state, State::TranslationUnknown, "{step_m} m of {distance_m}: {i}");
            assert!(!step.state.is_known() && found.translation().norm() == 0.0);
            // What moves outwards pulls at the turn by half a pixel a frame.
            let turned = turned_deg(found, &Pose::identity());
            assert!(turned < 0.15 * i as f64, "{step_m} m of {distance_m}: {i}: {turned}");
        }
    }
}

#[test]
fn a_plane_is_enough_for_a_pair_and_no_wrong_pose_of_one_camera() {
    let path: Vec<_> = (0..4)
        .map(|i| pose([0.0, 0.005 * f64::from(i), 0.0], [0.12 * f64::from(i), 0.0, 0.05 * f64::from(i)]))
        .collect();
    let frames = frames(wall(2.5, 0.3), path.clone());
    let trajectory = stereo(rig(), &frames);
    for (found, truth) in trajectory.poses.iter().zip(&path) {
        let off = (found.translation() - truth.translation()).norm();
        assert!(off < 0.01 && turned_deg(found, truth) < 0.3, "{off} {}", turned_deg(found, truth));
    }
    // Of one camera a plane has two motions: either it waits, or it is the right one, of which so
    // small a picture says the direction to some degrees: the wrong one is 20 off.
    let trajectory = mono(rig(), &frames);
    for (i, step) in trajectory.steps.iter().enumerate().skip(1) {
        if step.state == State::Tracked {
            let found = trajectory.poses[i].translation().angle(path[i].translation());
            assert!(found.to_degrees() < 10.0, "{i}: {} deg", found.to_degrees());
        } else {
            assert!(!step.state.is_known(), "{:?}", step.state);
        }
    }
}

#[test]
fn lost_in_the_dark_and_found_again() {
    let path: Vec<_> =
        (0..7).map(|i| pose([0.0, 0.01 * f64::from(i), 0.0], [0.0, 0.0, 0.06 * f64::from(i)])).collect();
    let mut frames = frames(room(), path.clone());
    let dark = GrayImage::new(frames[0].0.width(), frames[0].0.height());
    for frame in &mut frames[3..5] {
        *frame = (dark.clone(), dark.clone());
    }
    let trajectory = stereo(rig(), &frames);
    let states: Vec<_> = trajectory.steps.iter().map(|step| step.state).collect();
    let (tracked, lost) = (State::Tracked, State::Lost);
    assert_eq!(states, [State::First, tracked, tracked, lost, lost, State::Found, tracked]);
    // Those in between lie on the way.
    for (found, truth) in trajectory.poses.iter().zip(&path) {
        let off = (found.translation() - truth.translation()).norm();
        assert!(off < 0.02 && turned_deg(found, truth) < 0.2, "{off} {}", turned_deg(found, truth));
    }
}

#[test]
fn what_does_not_come_back_is_begun_anew() {
    let mut frames = frames(room(), vec![Pose::identity(); 1]);
    let dark = GrayImage::new(frames[0].0.width(), frames[0].0.height());
    frames.extend((0..7).map(|_| (dark.clone(), dark.clone())));
    let trajectory = stereo(rig(), &frames);
    let states: Vec<_> = trajectory.steps.iter().map(|step| step.state).collect();
    let lost = State::Lost;
    assert_eq!(states, [State::First, lost, lost, lost, lost, lost, State::Restarted, lost]);
}

#[test]
fn frames_that_do_not_fit_are_refused_by_name() {
    let mut odometry = StereoOdometry::<f32, 16>::new();
    let pixels = [0; 64 * 48];
    let picture = Picture::new(&pixels, 64, 48).expect("a picture");
    let features: [Feature; 0] = [];
    let frame = Frame { left: picture, right: Some(picture), features: &features };
    assert_eq!(odometry.step(&frame).err(), Some(OdometryError::NotStarted));
    odometry.start(&rig(), OdometryConfig::new(64)).expect("a rig");
    assert_eq!(odometry.step(&Frame { right: None, ..frame }).err(), Some(OdometryError::NoRight));
    let other = Picture::new(&pixels, 48, 64).expect("a picture");
    assert_eq!(odometry.step(&Frame { right: Some(other), ..frame }).err(), Some(OdometryError::Size));
    assert_eq!(odometry.step(&frame).map(|step| step.state), Ok(State::First));
    assert_eq!(
        odometry.step(&Frame { left: other, right: Some(other), ..frame }).err(),
        Some(OdometryError::Size)
    );
    assert_eq!(odometry.step(&frame).map(|step| step.state), Ok(State::Lost));
}

#[test]
fn configurations_that_can_never_work_are_refused() {
    let refused = |change: fn(&mut OdometryConfig)| {
        let mut config = OdometryConfig::new(64);
        change(&mut config);
        let mut odometry = StereoOdometry::<f32, 16>::new();
        let whole = odometry.start(&rig(), config).err();
        let stereo = OdometryRig::stereo(&rig()).expect("a rig");
        let view = odometry.as_mut_view().start(stereo, config).err();
        assert_eq!(whole, view.map(|_| OdometryRigError::Config));
        assert!(view.is_none_or(|error| error == OdometryError::Config), "{view:?}");
        view.is_some()
    };
    let wrong: [fn(&mut OdometryConfig); 15] = [
        |c| c.sigma_px = 0.0,
        |c| c.sigma_px = 1e-20,
        |c| c.sigma_px = f32::INFINITY,
        |c| c.sigma_px = f32::NAN,
        |c| c.sigma_px = -0.3,
        |c| (c.far_px, c.near_px) = (0.0, 0.0),
        |c| c.far_px = 0.0,
        |c| c.near_px = 0.0,
        |c| c.near_px = -1.0,
        |c| c.far_px = f32::NAN,
        |c| c.most_disparity_px = 0,
        |c| c.spacing_px = f32::INFINITY,
        |c| c.spacing_px = f32::NAN,
        |c| c.spacing_px = -7.0,
        |c| c.most_samples = 0,
    ];
    for (i, change) in wrong.into_iter().enumerate() {
        assert!(refused(change), "change {i}");
    }
    let usable: [fn(&mut OdometryConfig); 3] = [|_| (), |c| c.spacing_px = 0.0, |c| c.far_px = f32::INFINITY];
    for change in usable {
        assert!(!refused(change));
    }
}

#[test]
fn memory_of_other_lengths_is_refused_by_name() {
    let pinhole = Camera::new(60.0, 60.0, 32.0, 24.0).expect("a camera");
    // How many tracks, matches, landmarks, inliers, partners and correspondences, and what is said of a pair
    // and of one camera.
    let (ok, refused) = (None, |needed| Some(OdometryError::Memory { needed }));
    for (lengths, pair, one) in [
        ([16, 16, 16, 16, 16, 32], ok, ok),
        ([16, 16, 16, 16, 16, 0], ok, refused(32)),
        ([15, 15, 15, 15, 15, 30], refused(16), refused(16)),
        ([20, 19, 20, 20, 20, 40], refused(20), refused(20)),
        ([20, 20, 19, 20, 20, 40], refused(20), refused(20)),
        ([20, 20, 20, 19, 20, 40], refused(20), refused(20)),
        ([20, 20, 20, 20, 19, 40], refused(20), refused(20)),
        ([70_000; 6], refused(65_534), refused(65_534)),
    ] {
        let mut tracks = vec![Track::EMPTY; lengths[0]];
        let mut matches = vec![PointMatch::EMPTY; lengths[1]];
        let landmark = Landmark { world: Point3::origin(), pixel: Point2::origin() };
        let mut landmarks = vec![landmark; lengths[2]];
        let (mut inliers, mut partners) = (vec![false; lengths[3]], vec![(0, 0); lengths[4]]);
        let mut correspondences = vec![Correspondence::new(0.0, 0.0, 0.0, 0.0); lengths[5]];
        for (rig, expected) in
            [(OdometryRig::stereo(&rig()).expect("a rig"), pair), (OdometryRig::one(pinhole), one)]
        {
            let mut state = OdometryState::<f64>::new();
            // What begins is refused at the start, what is under way at once.
            for _ in 0..2 {
                let view = OdometryView::new(
                    &mut state,
                    &mut tracks,
                    &mut matches,
                    &mut landmarks,
                    &mut inliers,
                    &mut partners,
                    &mut correspondences,
                );
                let started = view.and_then(|mut view| view.start(rig, OdometryConfig::new(64)));
                assert_eq!(started.err(), expected);
            }
        }
    }
}
