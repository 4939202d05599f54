//! A camera among known points: all poses of three, the one of many of which some are wrong.

use crate::views::{any_pose, seeded};
use nalgebra::{Matrix6, Point2, Point3, Rotation3, Vector3, Vector6};
use proptest::prelude::*;
use stereopsis::geometry::{
    Real,
    absolute::{Landmark, P3pError, p3p},
    camera::{Camera, Pose},
    robust::{RobustConfig, RobustResectionError, robust_resection},
};
use stereopsis_host::scene::Random;

fn camera() -> Camera<f64> {
    Camera::new(500.0, 510.0, 320.0, 240.0).expect("a camera")
}

/// Points of the world that a camera at `pose` sees within its picture, at 1 to 20.
fn seen(pose: &Pose<f64>, random: &mut Random, count: usize, noise_px: f64) -> Vec<Landmark<f64>> {
    let mut point = || {
        let pixel = Point2::new(640.0 * random.unit(), 480.0 * random.unit());
        let sight = camera().unproject(&pixel).expect("a sight");
        let world = pose.transform(&Point3::from(sight * (1.0 + 19.0 * random.unit())));
        Landmark { world, pixel: pixel + Vector3::new(random.gauss(), random.gauss(), 0.0).xy() * noise_px }
    };
    (0..count).map(|_| point()).collect()
}

/// A small turn and a step along the camera's axes, from `of` to `to`; of a large turn its sine.
fn difference(of: &Pose<f64>, to: &Pose<f64>) -> Vector6<f64> {
    let between = of.inverse().then(to);
    let (r, step) = (between.rotation(), between.translation());
    let turn = Vector3::new(r.m32 - r.m23, r.m13 - r.m31, r.m21 - r.m12) / 2.0;
    Vector6::new(turn.x, turn.y, turn.z, step.x, step.y, step.z)
}

fn solves<T: Real>(pose: &Pose<T>, sights: &[Vector3<T>; 3], points: &[Point3<T>; 3]) -> T {
    let off = sights.iter().zip(points).map(|(sight, point)| {
        let p = pose.inverse_transform(point).coords;
        // Before the camera, and along the sight.
        if p.dot(sight) > T::ZERO { p.cross(sight).norm() / (p.norm() * sight.norm()) } else { T::ONE }
    });
    off.fold(T::ZERO, |most, off| most.max(off))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..seeded() })]

    #[test]
    fn three_points_have_the_pose_among_their_poses(pose in any_pose(), seed in 0..u64::MAX) {
        let landmarks = seen(&pose, &mut Random::new(seed), 3, 0.0);
        let points = [0, 1, 2].map(|i: usize| landmarks[i].world);
        let sights = points.map(|p| pose.inverse_transform(&p).coords);
        let poses = p3p(&sights, &points).expect("poses");
        let nearest = poses.as_slice().iter().map(|p| difference(p, &pose).norm())
            .fold(f64::INFINITY, f64::min);
        // A sight or an edge of a hundredth of the others costs two digits, the square root at a double
        // solution half.
        prop_assert!(nearest < 1e-5, "{nearest}");
        for p in poses.as_slice() {
            prop_assert!(solves(p, &sights, &points) < 1e-8, "{}", solves(p, &sights, &points));
        }
    }

    #[test]
    fn single_precision_solves_too(pose in any_pose(), seed in 0..u64::MAX) {
        let landmarks = seen(&pose, &mut Random::new(seed), 3, 0.0);
        let points = [0, 1, 2].map(|i: usize| landmarks[i].world);
        let sights = points.map(|p| pose.inverse_transform(&p).coords.cast::<f32>());
        let points = points.map(|p| p.cast::<f32>());
        if let Ok(poses) = p3p(&sights, &points) {
            for p in poses.as_slice() {
                prop_assert!(solves(p, &sights, &points) < 2e-3, "{}", solves(p, &sights, &points));
            }
        }
    }
}

#[test]
fn single_precision_finds_nearly_all() {
    let mut random = Random::new(3);
    let found = (0..1000).filter(|_| {
        let landmarks = seen(&Pose::identity(), &mut random, 3, 0.0);
        let points = [0, 1, 2].map(|i: usize| landmarks[i].world.cast::<f32>());
        let poses = p3p(&points.map(|p| p.coords), &points);
        poses.is_ok_and(|poses| poses.as_slice().iter().any(|p| p.translation().norm() < 0.05))
    });
    let found = found.count();
    assert!(found >= 970, "{found} of 1000");
}

/// Edges a thirtieth to a three-hundredth of the others, along any direction: what is told sees the points.
#[test]
fn a_short_edge_turns_no_pose_away_from_the_points() {
    let (mut random, mut told) = (Random::new(5), 0);
    for ratio in [1.0, 10.0, 30.0, 100.0, 200.0, 300.0] {
        for _ in 0..500 {
            let mut cube = || [(); 3].map(|()| 2.0 * random.unit() - 1.0);
            let ahead = Vector3::new(0.0, 0.0, 3.0);
            let [first, third, along] = [(); 3].map(|()| Vector3::from(cube()));
            let points = [first + ahead, first + ahead + along.normalize() / ratio, third + ahead];
            let points = points.map(|p| Point3::from(p.cast::<f32>()));
            let sights = points.map(|p| p.coords);
            for pose in p3p(&sights, &points).iter().flat_map(|poses| poses.as_slice()) {
                told += 1;
                assert!(solves(pose, &sights, &points) < 2e-3, "{ratio}: {pose:?}");
            }
        }
    }
    assert!(told > 4000, "{told} poses");
}

#[test]
fn wrong_points_do_no_harm() {
    for (seed, share) in [(1, 0.0), (2, 0.3), (3, 0.6)] {
        let mut random = Random::new(seed);
        let turn = Rotation3::new(Vector3::new(0.2, -0.4, 0.1));
        let pose = Pose::new(*turn.matrix(), Vector3::new(1.0, -0.5, 2.0)).expect("a pose");
        let mut landmarks = seen(&pose, &mut random, 200, 0.5);
        let wrong = (200.0 * share) as usize;
        for landmark in landmarks.iter_mut().take(wrong) {
            landmark.pixel = Point2::new(640.0 * random.unit(), 480.0 * random.unit());
        }
        let mut inliers = [false; 200];
        let config = RobustConfig { seed, ..RobustConfig::new(2.0) };
        let found = robust_resection(&landmarks, &camera(), &config, &mut inliers).expect("a pose");
        let off = difference(&found.pose, &pose);
        assert!(
            off.fixed_rows::<3>(0).norm() < 1e-3 && off.fixed_rows::<3>(3).norm() < 5e-3,
            "{share}: {off}"
        );
        let kept = inliers[wrong..].iter().filter(|&&i| i).count();
        assert!(kept >= 99 * (200 - wrong) / 100, "{kept} of {}", 200 - wrong);
        assert!(inliers[..wrong].iter().filter(|&&i| i).count() <= wrong / 20);
        assert!((found.rms_px - 0.5).abs() < 0.1, "{}", found.rms_px);
        let distance = |l: &Landmark<f64>| {
            let there = camera().project(&found.pose.inverse_transform(&l.world)).expect("in front");
            (there - l.pixel).norm()
        };
        assert!(landmarks.iter().zip(&inliers).all(|(l, &inlier)| inlier == (distance(l) <= 2.0)));
        let squares = landmarks.iter().map(distance).filter(|&d| d <= 2.0).map(|d| d * d).sum::<f64>();
        // Two coordinates of each, less the six numbers of the pose.
        let free = 2.0 * found.inliers as f64 - 6.0;
        assert!((found.rms_px - (squares / free).sqrt()).abs() < 1e-9, "{}", found.rms_px);
        // The same seed, the same estimate.
        assert_eq!(robust_resection(&landmarks, &camera(), &config, &mut inliers), Ok(found));
    }
}

/// The squared error in units of the covariance is on average the number of the pose's numbers.
#[test]
fn the_covariance_is_that_of_the_errors() {
    let (mut random, mut sum) = (Random::new(7), 0.0);
    const RUNS: usize = 100;
    for seed in 0..RUNS as u64 {
        let landmarks = seen(&Pose::identity(), &mut random, 60, 0.4);
        let config = RobustConfig { seed, ..RobustConfig::new(3.0) };
        let found = robust_resection(&landmarks, &camera(), &config, &mut [false; 60]).expect("a pose");
        let off = difference(&found.pose, &Pose::identity());
        let inverse: Matrix6<f64> = found.covariance.try_inverse().expect("definite");
        sum += off.dot(&(inverse * off));
    }
    let mean = sum / RUNS as f64;
    // The weights throw a little of the information away; the mean's own deviation is 0.35.
    assert!((5.0..8.0).contains(&mean), "{mean}");
}

#[test]
fn what_has_no_pose_is_refused_by_name() {
    let mut random = Random::new(9);
    let landmarks = seen(&Pose::identity(), &mut random, 20, 0.0);
    let run = |landmarks: &[Landmark<f64>], config: &RobustConfig<f64>, room: usize| {
        robust_resection(landmarks, &camera(), config, &mut vec![false; room]).map(|found| found.inliers)
    };
    let config = RobustConfig::new(1.0);
    assert_eq!(run(&landmarks, &config, 20), Ok(20));
    assert_eq!(run(&landmarks[..3], &config, 20), Err(RobustResectionError::TooFew));
    assert_eq!(run(&landmarks, &config, 19), Err(RobustResectionError::Inliers(20)));
    assert_eq!(run(&landmarks, &RobustConfig::new(0.0), 20), Err(RobustResectionError::Threshold));
    assert_eq!(
        run(&landmarks, &RobustConfig { miss_probability: 1.0, ..config }, 20),
        Err(RobustResectionError::MissProbability)
    );
    assert_eq!(
        run(&landmarks, &RobustConfig { most_samples: 0, ..config }, 20),
        Err(RobustResectionError::NoSamples)
    );
    let mut broken = landmarks.clone();
    broken[3].world.x = f64::NAN;
    assert_eq!(run(&broken, &config, 20), Err(RobustResectionError::NotFinite));
    // On a line there is no triangle.
    let line: Vec<_> = (0..20)
        .map(|i| {
            let world = Point3::new(f64::from(i), 0.5, 8.0);
            Landmark { world, pixel: camera().project(&world).expect("in front") }
        })
        .collect();
    assert_eq!(run(&line, &config, 20), Err(RobustResectionError::NoAgreement));
    assert_eq!(
        p3p(&[0, 1, 2].map(|i: usize| line[i].world.coords), &[0, 1, 2].map(|i: usize| line[i].world)),
        Err(P3pError::Line)
    );
}
