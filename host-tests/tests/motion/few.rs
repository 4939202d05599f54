//! Poses that too few points agree with.

use stereopsis::features::{Feature, FeatureConfig, FeatureDetector};
use stereopsis::geometry::camera::RectifiedRig;
use stereopsis::imaging::Picture;
use stereopsis::motion::odometry::{Frame, OdometryConfig, State, StereoOdometry};
use stereopsis_host::scene::Random;

/// A wall that slides past a pair whose right camera slips by some px now and then: the loss of a pose that
/// no point agrees with is bounded, and must not pass for that of a camera that stands.
#[test]
fn poses_that_few_points_agree_with_are_not_told() {
    const SIZE: [u16; 2] = [120, 90];
    let rig = RectifiedRig::new(110.0, 0.1, 59.5, 44.5).expect("a rig");
    let mut told = 0;
    for seed in 0..20 {
        let mut random = Random::new(seed);
        let knots: Vec<_> = (0..60 * 20).map(|_| 255.0 * random.unit()).collect();
        let picture = |at: f64| {
            let grey = |u: u16, v: u16| {
                let (x, y) = ((f64::from(u) + at) / 5.0, f64::from(v) / 5.0);
                let knot = |i: f64, j: f64| knots[j as usize * 60 + i as usize];
                let row =
                    |j: f64| knot(x.floor(), j) * (1.0 - x.fract()) + knot(x.floor() + 1.0, j) * x.fract();
                (row(y.floor()) * (1.0 - y.fract()) + row(y.floor() + 1.0) * y.fract()) as u8
            };
            (0..SIZE[1]).flat_map(|v| (0..SIZE[0]).map(move |u| (u, v))).map(|(u, v)| grey(u, v)).collect()
        };
        let mut odometry = Box::new(StereoOdometry::<f32, 64>::new());
        odometry.start(&rig, OdometryConfig::new(SIZE[0])).expect("a start");
        let mut detector = Box::new(FeatureDetector::<120, 64>::new());
        let (disparity, mut at) = (*random.pick(&[3.0, 4.0, 6.0, 9.0]), 0.0);
        for _ in 0..6 {
            at += random.pick(&[0.0, 0.7, 2.0, 5.0, 8.0, 12.0, 20.0]);
            let slip = random.pick(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -2.0, 2.0, 3.0]);
            let [left, right]: [Vec<u8>; 2] = [at, at + disparity + slip].map(picture);
            let mut features = stereopsis::heapless::Vec::<Feature, 256>::new();
            detector.start(&FeatureConfig::new(SIZE[0], SIZE[1])).expect("a start");
            for line in left.chunks_exact(SIZE[0].into()) {
                detector.push(line, features.as_mut_view()).expect("a line");
            }
            let [left, right] =
                [&left, &right].map(|grey| Picture::new(grey, SIZE[0], SIZE[1]).expect("a picture"));
            let step =
                odometry.step(&Frame { left, right: Some(right), features: &features }).expect("a step");
            if matches!(step.state, State::Stationary | State::TranslationUnknown) {
                told += 1;
                assert!(step.inliers >= 8, "{seed}: {step:?}");
                assert!(step.covariance.iter().all(|x| x.is_finite()), "{seed}: {step:?}");
            }
        }
    }
    assert!(told > 3, "{told} frames");
}
