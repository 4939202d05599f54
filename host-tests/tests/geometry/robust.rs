//! The robust estimate: what it keeps, what it is worth, what it does not depend on, what it refuses.

use crate::views::{Views, anywhere, mixed, narrow, nearby, noisy, seeded};
use nalgebra::{Matrix3, Point2, Point3, Vector3};
use proptest::prelude::*;
use stereopsis::geometry::{
    camera::Pose,
    robust::{RobustConfig, RobustError, RobustFundamental, Sampling, robust_fundamental},
    two_view::{Correspondence, Essential, Fundamental},
};
use stereopsis_host::scene::Random;

const THRESHOLD: f64 = 1.5;

/// A scene with 0.3 px of noise and wrong correspondences among its right ones, `share` of all.
struct Mixed {
    views: Views,
    seen: Vec<Correspondence<f64>>,
    right: Vec<bool>,
    truth: Fundamental<f64>,
}

impl Mixed {
    fn new(seed: u64, count: usize, share: f64) -> Self {
        Self::of(Views::scene(seed, count), seed, share)
    }

    fn of(views: Views, seed: u64, share: f64) -> Self {
        let truth = views.fundamental();
        let (seen, right) = mixed(&views.seen, 0.3, share, seed).into_iter().unzip();
        Self { views, seen, right, truth }
    }

    /// The mean distance of the exact points to the estimate's lines, px.
    fn error(&self, f: &Fundamental<f64>) -> f64 {
        self.views.seen.iter().map(|s| f.symmetric_px(s)).sum::<f64>() / self.views.seen.len() as f64
    }
}

fn config(seed: u64) -> RobustConfig<f64> {
    RobustConfig { seed, ..RobustConfig::new(THRESHOLD) }
}

fn solve(
    seen: &[Correspondence<f64>],
    config: &RobustConfig<f64>,
) -> Result<(RobustFundamental<f64>, Vec<bool>), RobustError> {
    let mut inliers = vec![false; seen.len()];
    robust_fundamental(seen, config, &mut inliers).map(|found| (found, inliers))
}

proptest! {
    #![proptest_config(seeded())]

    #[test]
    fn right_ones_are_kept_and_wrong_ones_are_not(seed in any::<u64>(), share in 0.1..0.6_f64) {
        let mixed = Mixed::new(seed, 120, share);
        let (found, inliers) = solve(&mixed.seen, &config(seed)).expect("an estimate");
        prop_assert!(mixed.error(&found.fundamental) < 1.0, "{} px off", mixed.error(&found.fundamental));
        prop_assert_eq!(found.inliers, inliers.iter().filter(|&&inlier| inlier).count());
        // The mask is what the threshold says of the matrix.
        for (s, &inlier) in mixed.seen.iter().zip(&inliers) {
            prop_assert_eq!(inlier, found.fundamental.sampson_px(s).abs() <= THRESHOLD);
        }
        let squares = mixed.seen.iter().zip(&inliers).filter(|&(_, &inlier)| inlier)
            .map(|(s, _)| found.fundamental.sampson_squared_px2(s)).sum::<f64>();
        prop_assert!((found.rms_px - (squares / found.inliers as f64).sqrt()).abs() < 1e-9);
        let kept = mixed.right.iter().zip(&inliers).filter(|&(&right, &inlier)| right && inlier).count();
        // Nearly all: the threshold is five deviations of the noise.
        prop_assert!(kept >= 114, "{kept} of 120");
        // A wrong one is on its line by chance: a band of three px in 480.
        let wrong = found.inliers - kept;
        let all = mixed.seen.len() - 120;
        prop_assert!(wrong as f64 <= 6.0 + 0.05 * all as f64, "{wrong} of {all} wrong ones");
        // Of the true matrix the inliers are as many and the gain is no more: this one was fitted.
        prop_assert!(found.rms_px < 0.55 && found.miss_probability <= 1e-3, "{found:?}");
    }

    #[test]
    fn a_seed_gives_the_same_to_the_bit(seed in any::<u64>()) {
        let mixed = Mixed::new(seed, 80, 0.4);
        let first = solve(&mixed.seen, &config(seed)).expect("an estimate");
        prop_assert_eq!(&first, &solve(&mixed.seen, &config(seed)).expect("an estimate"));
        // Another seed goes another way to a minimum that is as good.
        let (other, _) = solve(&mixed.seen, &config(seed.wrapping_add(1))).expect("an estimate");
        prop_assert!(first.0.inliers.abs_diff(other.inliers) <= 4, "{} {}", first.0.inliers, other.inliers);
    }

    #[test]
    fn where_the_images_lie_and_which_is_first_does_not_matter(seed in any::<u64>()) {
        let mixed = Mixed::new(seed, 80, 0.3);
        let (found, _) = solve(&mixed.seen, &config(1)).expect("an estimate");
        let swapped: Vec<_> = mixed.seen.iter().map(Correspondence::swapped).collect();
        let (back, _) = solve(&swapped, &config(1)).expect("an estimate");
        prop_assert!(mixed.error(&back.fundamental.swapped()) < 1.0);
        prop_assert!(back.inliers.abs_diff(found.inliers) <= 4, "{} {}", back.inliers, found.inliers);
        // Twice the px, and somewhere else: the same distances, doubled.
        let moved = |p: Point2<f64>| Point2::new(2.0 * p.x + 1000.0, 2.0 * p.y - 300.0);
        let larger: Vec<_> = mixed.seen.iter()
            .map(|s| Correspondence { first: moved(s.first), second: moved(s.second) }).collect();
        let config = RobustConfig { threshold_px: 2.0 * THRESHOLD, ..config(1) };
        let (double, _) = solve(&larger, &config).expect("an estimate");
        prop_assert!(double.inliers.abs_diff(found.inliers) <= 4, "{} {}", double.inliers, found.inliers);
        prop_assert!((double.rms_px - 2.0 * found.rms_px).abs() < 0.3 * double.rms_px);
    }

    #[test]
    fn no_step_from_it_is_better(seed in any::<u64>()) {
        // The twin of the refinement: singular matrices all around, and the loss as its doc has it.
        let mixed = Mixed::new(seed, 100, 0.3);
        let (found, _) = solve(&mixed.seen, &config(seed)).expect("an estimate");
        let width = 1.5 * THRESHOLD;
        let gain = |f: &Fundamental<f64>| -> f64 {
            mixed.seen.iter().map(|s| (1.0 - f.sampson_squared_px2(s) / (width * width)).max(0.0).powi(3))
                .sum()
        };
        let best = gain(&found.fundamental);
        // A minimum, not always the least of all: the true matrix is hardly better.
        prop_assert!(best >= 0.96 * gain(&mixed.truth), "{best} {}", gain(&mixed.truth));
        let mut random = Random::new(seed);
        for size in [1e-2, 1e-3, 1e-4] {
            for _ in 0..20 {
                let f = found.fundamental.matrix();
                let other = Matrix3::from_fn(|i, j| f[(i, j)] * (1.0 + size * random.gauss()));
                let other = Fundamental::from_matrix(&other).expect("rank 2");
                prop_assert!(gain(&other) <= best * (1.0 + 1e-3), "{} {best}", gain(&other));
            }
        }
    }

    #[test]
    fn single_precision_is_as_good(seed in any::<u64>()) {
        let mixed = Mixed::new(seed, 100, 0.4);
        let (found, _) = solve(&mixed.seen, &config(seed)).expect("an estimate");
        let mut inliers = vec![false; mixed.seen.len()];
        let config = RobustConfig { seed, ..RobustConfig::new(THRESHOLD as f32) };
        let narrow = robust_fundamental(&narrow(&mixed.seen), &config, &mut inliers).expect("an estimate");
        let wide = crate::views::wide(&narrow.fundamental);
        prop_assert!(mixed.error(&wide) < 1.2 * mixed.error(&found.fundamental) + 0.1);
    }

    #[test]
    fn a_wall_does_not_hide_the_scene(seed in any::<u64>()) {
        // Eight of ten points on a wall, and a third of the matches wrong.
        let pose = nearby(&mut Random::new(seed));
        let mut random = Random::new(seed);
        let wall = Views::of(&mut random, 160, pose, |random| {
            let p = anywhere(random);
            Point3::new(p.x, p.y, 7.0 + 0.5 * p.x - 0.25 * p.y)
        });
        let mut views = Views::of(&mut random, 40, pose, anywhere);
        views.seen.extend(&wall.seen);
        let mixed = Mixed::of(views, seed, 0.33);
        let (found, _) = solve(&mixed.seen, &config(seed)).expect("an estimate");
        prop_assert!(mixed.error(&found.fundamental) < 1.0, "{} px off", mixed.error(&found.fundamental));
    }

    #[test]
    fn a_wall_alone_is_reported(seed in any::<u64>(), share in prop_oneof![Just(0.0), 0.1..0.4_f64]) {
        let pose = nearby(&mut Random::new(seed));
        let wall = Views::of(&mut Random::new(seed), 100, pose, |random| {
            let p = anywhere(random);
            Point3::new(p.x, p.y, 7.0 + 0.5 * p.x - 0.25 * p.y)
        });
        let mixed = Mixed::of(wall, seed, share);
        let mut inliers = vec![false; mixed.seen.len()];
        prop_assert_eq!(robust_fundamental(&mixed.seen, &config(seed), &mut inliers),
            Err(RobustError::Plane));
        let kept = mixed.right.iter().zip(&inliers).filter(|&(&right, &inlier)| right && inlier).count();
        prop_assert!(kept >= 98, "{kept}");
    }
}

#[test]
fn known_cameras_make_it_better() {
    // The refined essential matrix beside F, and beside the essential matrix nearest to F, from which it
    // starts.
    let (mut refined, mut start, mut plain) = (0.0, 0.0, 0.0);
    let (mut than_start, mut than_plain) = (0, 0);
    for seed in 0..100 {
        let mixed = Mixed::new(seed, 60, 0.3);
        let camera = mixed.views.camera;
        let error = |e: &Essential<f64>| mixed.error(&Fundamental::from_essential(e, &camera, &camera));
        let (found, _) = solve(&mixed.seen, &config(seed)).expect("an estimate");
        let nearest = Essential::from_fundamental(&found.fundamental, &camera, &camera).expect("rank 2");
        let e = nearest.refined(&mixed.seen, &camera, &camera, THRESHOLD).expect("rank 2");
        assert!(error(&e) < 1.5, "seed {seed}: {} px off", error(&e));
        let truth = Essential::from_pose(&mixed.views.pose).expect("a baseline");
        let off = (e.matrix() - truth.matrix()).amax().min((e.matrix() + truth.matrix()).amax());
        assert!(off < 0.6, "seed {seed}: {off}");
        let f = mixed.error(&found.fundamental);
        than_start += usize::from(error(&e) < error(&nearest));
        than_plain += usize::from(error(&e) < f);
        (refined, start, plain) = (refined + error(&e), start + error(&nearest), plain + f);
    }
    assert!(refined < 0.2 * start && than_start >= 95, "{refined} {start}, {than_start} of 100 better");
    // F bends to what the cameras cannot do, where few points say otherwise: to the points it is as near.
    assert!(refined < 1.1 * plain && than_plain > 50, "{refined} {plain}, {than_plain} of 100 better");
}

#[test]
fn an_order_saves_samples() {
    let (mut ordered, mut uniform) = (0, 0);
    for seed in 0..10 {
        // The right ones first, but for every tenth.
        let mixed = Mixed::new(seed, 100, 0.6);
        let (mut front, mut back): (Vec<_>, Vec<_>) = (Vec::new(), Vec::new());
        for (i, (s, &right)) in mixed.seen.iter().zip(&mixed.right).enumerate() {
            if right != (i % 10 == 0) { front.push(*s) } else { back.push(*s) }
        }
        front.extend(back);
        let first = RobustConfig { sampling: Sampling::Ordered, most_samples: 200, ..config(seed) };
        let (found, _) = solve(&front, &first).expect("an estimate");
        ordered += usize::from(mixed.error(&found.fundamental) < 0.5);
        let alike = RobustConfig { most_samples: 200, ..config(seed) };
        uniform +=
            usize::from(solve(&front, &alike).is_ok_and(|(found, _)| mixed.error(&found.fundamental) < 0.5));
    }
    assert!(ordered >= 9 && uniform <= 7, "{ordered} {uniform}");
}

#[test]
fn what_cannot_be_is_refused_by_name() {
    let mixed = Mixed::new(3, 40, 0.3);
    let of = |seen: &[Correspondence<f64>]| solve(seen, &config(0)).map(|_| ()).expect_err("no estimate");
    assert_eq!(of(&mixed.seen[..7]), RobustError::TooFew);
    assert_eq!(of(&[]), RobustError::TooFew);
    let mut broken = mixed.seen.clone();
    broken[5].second.y = f64::NAN;
    assert_eq!(of(&broken), RobustError::NotFinite);
    assert_eq!(of(&[mixed.seen[0]; 20]), RobustError::NoAgreement);
    let line: Vec<_> = (0..30)
        .map(|i| Correspondence::new(f64::from(i), 2.0 * f64::from(i), f64::from(i * i), 3.0))
        .collect();
    assert!(matches!(of(&line), RobustError::NoAgreement | RobustError::Plane));
    let mut random = Random::new(4);
    let mut place = || Point2::new(640.0 * random.unit(), 480.0 * random.unit());
    let noise: Vec<_> = (0..12).map(|_| Correspondence { first: place(), second: place() }).collect();
    let tight = RobustConfig::new(1e-3);
    assert_eq!(solve(&noise, &tight).map(|_| ()), Err(RobustError::NoAgreement));

    let with = |config: RobustConfig<f64>| solve(&mixed.seen, &config).map(|_| ()).expect_err("no estimate");
    for threshold_px in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(with(RobustConfig::new(threshold_px)), RobustError::Threshold);
    }
    for miss_probability in [0.0, 1.0, f64::NAN] {
        assert_eq!(with(RobustConfig { miss_probability, ..config(0) }), RobustError::MissProbability);
    }
    assert_eq!(with(RobustConfig { most_samples: 0, ..config(0) }), RobustError::NoSamples);
    let needed = mixed.seen.len();
    let mut short = vec![false; needed - 1];
    assert_eq!(robust_fundamental(&mixed.seen, &config(0), &mut short), Err(RobustError::Inliers(needed)));
}

#[test]
fn a_camera_that_only_turned_is_reported() {
    let pose = nearby(&mut Random::new(8));
    let turned = Pose::new(*pose.rotation(), Vector3::zeros()).expect("a rotation");
    let views = Views::of(&mut Random::new(8), 80, turned, anywhere);
    assert_eq!(solve(&noisy(&views.seen, 0.2, 1), &config(0)).map(|_| ()), Err(RobustError::Plane));
}

#[test]
fn samples_are_bounded() {
    let mixed = Mixed::new(5, 40, 0.6);
    // Whatever three samples find, they are no more, and it is said how unsure that is.
    let few = (0..20).map(|seed| solve(&mixed.seen, &RobustConfig { most_samples: 3, ..config(seed) }));
    let found: Vec<_> = few.filter_map(Result::ok).map(|(found, _)| found).collect();
    assert!(found.len() >= 5, "three samples find something {} times", found.len());
    for found in found {
        assert!(found.samples == 3 && found.miss_probability > 0.5, "{found:?}");
    }
    let (found, _) = solve(&mixed.seen, &config(0)).expect("an estimate");
    assert!(found.samples > 16 && found.miss_probability <= 1e-3);
}
