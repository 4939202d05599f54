//! Rows aligned by matches alone.

use crate::views::rotation;
use nalgebra::{Point2, Vector3};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use stereopsis::geometry::{
    camera::{Camera, ImageSize, Pose},
    rectify::{UncalibratedError, UncalibratedRectification},
    two_view::{Correspondence, Fundamental},
};
use stereopsis_host::scene::Random;

const SIZE: ImageSize = ImageSize { width: 320, height: 240 };

fn camera() -> Camera<f64> {
    Camera::new(280.0, 285.0, 165.0, 112.0).expect("a camera")
}

/// Matches in both images, as far as they are in them.
fn seen(pose: &Pose<f64>, random: &mut Random) -> Vec<Correspondence<f64>> {
    let is_inside = |p: &Point2<f64>| p.x >= 0.0 && p.y >= 0.0 && p.x <= 319.0 && p.y <= 239.0;
    let one = |_| {
        let first = Point2::new(319.0 * random.unit(), 239.0 * random.unit());
        let there = camera().unproject(&first).ok()? * (0.6 + 3.0 * random.unit());
        let second = camera().project(&pose.inverse_transform(&there.into())).ok().filter(is_inside)?;
        Some(Correspondence { first, second })
    };
    (0..60).filter_map(one).collect()
}

fn rectified(
    pose: &Pose<f64>,
    seen: &[Correspondence<f64>],
) -> Result<UncalibratedRectification<f64>, UncalibratedError> {
    let f = Fundamental::from_cameras(pose, &camera(), &camera()).expect("apart");
    UncalibratedRectification::new(&f, seen, SIZE)
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 64,
        rng_seed: RngSeed::Fixed(5),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Cameras beside each other, turned by up to 15 degrees: rows agree, every match has a disparity, images
    /// are not mirrored and stay where they were, about.
    #[test]
    fn rows_agree(
        turned in [-0.15..0.15_f64, -0.15..0.15, -0.25..0.25],
            t in [0.05..0.1_f64, -0.03..0.03, -0.015..0.015], seed in any::<u64>(),
    ) {
        let pose = Pose::new(rotation(turned), Vector3::from(t)).expect("a pose");
        let seen = seen(&pose, &mut Random::new(seed));
        prop_assume!(seen.len() >= 12);
        let both = match rectified(&pose, &seen) {
            Ok(both) => both,
            // A camera that looks along the other's way.
            Err(UncalibratedError::EpipoleInside) => return Ok(()),
            Err(error) => panic!("{error}"),
        };
        for s in &seen {
            let (first, second) =
                (both.first(&s.first).expect("finite"), both.second(&s.second).expect("finite"));
            prop_assert!((first.y - second.y).abs() < 1e-6, "{first} {second}");
            prop_assert!(first.x - second.x > 1.0 - 1e-6, "{first} {second}");
            let back = both.to_raw()[0].to_first(&first).expect("finite");
            prop_assert!((back - s.first).norm() < 1e-6);
        }
        let middle = Point2::new(159.5, 119.5);
        prop_assert!((both.second(&middle).expect("finite") - middle).norm() < 1e-6);
        for map in [UncalibratedRectification::first, UncalibratedRectification::second] {
            let [a, b, c] = [(0.0, 0.0), (8.0, 0.0), (0.0, 8.0)]
                .map(|(x, y)| map(&both, &(middle + Vector3::new(x, y, 0.0).xy())));
            let (a, b, c) = (a.expect("finite"), b.expect("finite"), c.expect("finite"));
            prop_assert!((b - a).perp(&(c - a)) > 0.0, "mirrored");
        }
    }
}

#[test]
fn what_cannot_be_rectified_is_named() {
    let mut random = Random::new(1);
    let ahead = Pose::new(rotation([0.0; 3]), Vector3::new(0.02, 0.0, 0.2)).expect("a pose");
    let matches = seen(&ahead, &mut random);
    assert_eq!(rectified(&ahead, &matches), Err(UncalibratedError::EpipoleInside));
    let beside = Pose::new(rotation([0.01, 0.02, 0.0]), Vector3::new(0.1, 0.0, 0.0)).expect("a pose");
    let mut matches = seen(&beside, &mut random);
    assert_eq!(rectified(&beside, &matches[..2]), Err(UncalibratedError::TooFew));
    let same = vec![matches[0]; 20];
    assert_eq!(rectified(&beside, &same), Err(UncalibratedError::Line));
    matches[4].first.x = f64::INFINITY;
    assert_eq!(rectified(&beside, &matches), Err(UncalibratedError::NotFinite));
}
