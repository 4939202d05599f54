//! The eight-point algorithm: exact, noisy, degenerate, and beside its twin.

use crate::twin;
use crate::views::{Views, anywhere, narrow, nearby, noisy, rms_sampson, wide};
use nalgebra::{Point3, Rotation3, Vector3};
use stereopsis::geometry::{
    Real,
    camera::Pose,
    two_view::{Correspondence, EightPointError, Fundamental, eight_point, eight_point_weighted},
};
use stereopsis_host::scene::Random;

fn worst(f: &Fundamental<f64>, seen: &[Correspondence<f64>]) -> f64 {
    seen.iter().map(|s| f.sampson_px(s).abs()).fold(0.0, f64::max)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// What both precisions refuse.
fn refused(seen: &[Correspondence<f64>]) -> (Option<EightPointError>, Option<EightPointError>) {
    (eight_point(seen).err(), eight_point(&narrow(seen)).err())
}

#[test]
fn exact_points_give_f() {
    for seed in 0..60 {
        for n in [8, 9, 12, 20, 50, 200] {
            let views = Views::scene(seed, n);
            let f = eight_point(&views.seen).expect("a scene with depth");
            let off = worst(&f, &views.seen);
            assert!(off < 1e-9, "seed {seed}, {n} points: {off:e} px");
            assert!(f.matrix().determinant().abs() < 1e-15);
        }
    }
}

#[test]
fn single_precision_reaches_its_bound() {
    // Twenty and more: a thousandth of a pixel, the median under a fifth of that. Eight are not squared.
    for (n, most) in [(8, 1e-3), (20, 2e-3), (50, 2e-3), (200, 2e-3)] {
        let estimates = (0..60).map(|seed| {
            let views = Views::scene(seed, n);
            let f = eight_point(&narrow(&views.seen)).expect("a scene with depth");
            rms_sampson(&wide(&f), &views.seen)
        });
        let errors: Vec<f64> = estimates.collect();
        let largest = errors.iter().copied().fold(0.0, f64::max);
        assert!(largest < most, "{n} points: {largest} px");
        let median = median(errors);
        assert!(median < 2e-4, "{n} points: {median} px");
    }
}

#[test]
fn noise_costs_both_precisions_the_same() {
    for n in [20, 50, 200] {
        let (mut double, mut single) = (Vec::new(), Vec::new());
        for seed in 0..60 {
            let views = Views::scene(seed, n);
            let seen = noisy(&views.seen, 0.5, seed);
            double.push(rms_sampson(&eight_point(&seen).expect("a scene"), &views.seen));
            single.push(rms_sampson(&wide(&eight_point(&narrow(&seen)).expect("a scene")), &views.seen));
        }
        let (double, single) = (median(double), median(single));
        assert!((double - single).abs() < 0.01 * double, "{n} points: {double} and {single} px");
        // About sigma times the root of 7 / n: each of seven parameters takes up noise.
        let expected = 0.5 * (7.0 / n as f64).sqrt();
        assert!((0.7..1.3).contains(&(double / expected)), "{n} points: {double} px");
    }
}

/// What OpenCV 5.0.0 reaches on the same correspondences, `findFundamentalMat(first, second, FM_8POINT)` in
/// `f64`: how many correspondences, and the mean over sixty scenes of the root mean square Sampson distance,
/// px, of the exact points. `opencv.py` beside this file makes the scenes and prints the figures.
const OPENCV: [(usize, f64); 4] = [(8, 1.947494), (20, 0.329060), (50, 0.200196), (200, 0.098837)];

#[test]
fn noise_costs_no_more_than_it_costs_opencv() {
    for (n, theirs) in OPENCV {
        let (mut double, mut single) = (0.0, 0.0);
        for seed in 0..60 {
            let views = Views::scene(seed, n);
            let seen = noisy(&views.seen, 0.5, seed);
            double += rms_sampson(&eight_point(&seen).expect("a scene"), &views.seen) / 60.0;
            single += rms_sampson(&wide(&eight_point(&narrow(&seen)).expect("a scene")), &views.seen) / 60.0;
        }
        for ours in [double, single] {
            assert!(ours < 1.02 * theirs, "{n} points: {ours} px, OpenCV {theirs} px");
        }
    }
}

#[test]
fn agrees_with_the_twin() {
    for seed in 0..40 {
        for (n, sigma) in [(8, 0.0), (8, 0.5), (9, 0.5), (20, 0.0), (20, 0.5), (100, 2.0)] {
            let views = Views::scene(seed, n);
            let seen = noisy(&views.seen, sigma, seed);
            let (ours, theirs) = (eight_point(&seen).expect("a scene"), twin::eight_point(&seen));
            let off = (rms_sampson(&ours, &seen) - rms_sampson(&theirs, &seen)).abs();
            assert!(off < 1e-7, "seed {seed}, {n} points, {sigma} px: {off:e} px");
            // Each to the other's epipolar lines, at the corners of the image.
            for (u, v) in [(0.0, 0.0), (640.0, 0.0), (0.0, 480.0), (640.0, 480.0)] {
                let line =
                    |f: &Fundamental<f64>| *f.line_in_first(&[u, v].into()).expect("a line").coefficients();
                let (a, b) = (line(&ours), line(&theirs));
                let off = (a - b).amax().min((a + b).amax());
                assert!(off < 1e-4, "seed {seed}, {n} points, {sigma} px: {off:e}");
            }
        }
    }
}

#[test]
fn a_world_that_moves_changes_nothing() {
    // Both cameras and all points carried elsewhere together, and the unit of length changed: the same
    // pixels.
    for seed in 0..20 {
        let mut random = Random::new(seed);
        let views = Views::of(&mut random, 30, nearby(&mut Random::new(seed)), anywhere);
        let larger = Pose::new(*views.pose.rotation(), views.pose.translation() * 7.0).expect("a pose");
        let f = Fundamental::from_cameras(&larger, &views.camera, &views.camera).expect("a baseline");
        assert!((f.matrix() - views.fundamental().matrix()).amax() < 1e-12);
        // The order of the correspondences does not matter either, nor which image is first.
        let seen = noisy(&views.seen, 0.5, seed);
        let f = eight_point(&seen).expect("a scene");
        let reversed: Vec<_> = seen.iter().rev().copied().collect();
        assert!((worst(&eight_point(&reversed).expect("a scene"), &seen) - worst(&f, &seen)).abs() < 1e-7);
        let swapped: Vec<_> = seen.iter().map(Correspondence::swapped).collect();
        let f2 = eight_point(&swapped).expect("a scene").swapped();
        assert!((worst(&f2, &seen) - worst(&f, &seen)).abs() < 1e-7);
    }
}

#[test]
fn weights_leave_out_and_repeat() {
    let views = Views::scene(3, 30);
    let mut seen = noisy(&views.seen, 0.5, 3);
    let plain = eight_point(&seen).expect("a scene");
    seen.push(Correspondence::new(0.0, 0.0, 600.0, 400.0));
    let mut weights = vec![2.0; 31];
    weights[30] = 0.0;
    let weighted = eight_point_weighted(&seen, &weights).expect("a scene");
    assert!((plain.matrix() - weighted.matrix()).amax() < 1e-9, "a common weight changes nothing");
    assert_eq!(eight_point_weighted(&seen, &weights[..7]), Err(EightPointError::TooFew));
    weights[0] = f64::NAN;
    assert_eq!(eight_point_weighted(&seen, &weights), Err(EightPointError::NotFinite));
}

#[test]
fn planes_are_refused() {
    for seed in 0..30 {
        for n in [8, 9, 20, 100] {
            // A tilted wall.
            let pose = nearby(&mut Random::new(seed));
            let views = Views::of(&mut Random::new(seed), n, pose, |random| {
                let p = anywhere(random);
                Point3::new(p.x, p.y, 7.0 + 0.5 * p.x - 0.25 * p.y)
            });
            let plane = Some(EightPointError::Plane);
            assert_eq!(refused(&views.seen), (plane, plane), "seed {seed}, {n} points");
            // A camera that only turns.
            let turned = Pose::new(*Rotation3::new(Vector3::new(0.02, 0.1, 0.01)).matrix(), Vector3::zeros());
            let views = Views::of(&mut Random::new(seed), n, turned.expect("a pose"), anywhere);
            assert_eq!(refused(&views.seen), (plane, plane), "seed {seed}, {n} points, turned");
        }
    }
}

#[test]
fn lines_are_refused() {
    for seed in 0..30 {
        for n in [8, 9, 50] {
            let pose = nearby(&mut Random::new(seed));
            let views = Views::of(&mut Random::new(seed), n, pose, |random| {
                let along = 4.0 * random.unit() - 2.0;
                Point3::new(along, 0.3 * along - 0.2, 7.0 + along)
            });
            let line = Some(EightPointError::Line);
            assert_eq!(refused(&views.seen), (line, line), "seed {seed}, {n} points");
        }
    }
}

#[test]
fn what_is_too_little_is_refused() {
    let seen = Views::scene(1, 20).seen;
    let same = |error| (Some(error), Some(error));
    for n in 0..8 {
        assert_eq!(refused(&seen[..n]), same(EightPointError::TooFew));
    }
    let repeated: Vec<_> = seen[..7].iter().cycle().take(40).copied().collect();
    assert_eq!(refused(&repeated), same(EightPointError::Repeated));
    assert_eq!(refused(&[seen[0]; 8]), same(EightPointError::Repeated));
    for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut seen = seen.clone();
        seen[11].second.y = wrong;
        assert_eq!(refused(&seen), same(EightPointError::NotFinite));
    }
    // One pixel of the first image, anywhere in the second.
    let one: Vec<_> = seen.iter().map(|s| Correspondence { first: seen[0].first, ..*s }).collect();
    assert_eq!(refused(&one), same(EightPointError::Line));
}

#[test]
fn a_quadric_through_both_centres_is_refused() {
    // A cylinder about a vertical axis through (0, 0, 5), radius 5, on which camera 1 is at the origin and
    // camera 2 at an angle of 0.2 rad about the axis.
    for n in [8, 9, 40] {
        let pose = Pose::new(
            *Rotation3::new(Vector3::new(0.0, -0.1, 0.0)).matrix(),
            Vector3::new(5.0 * 0.2_f64.sin(), 0.3, 5.0 - 5.0 * 0.2_f64.cos()),
        );
        let views = Views::of(&mut Random::new(5), n, pose.expect("a pose"), |random| {
            let angle = 2.0 * random.unit() - 1.0;
            Point3::new(5.0 * angle.sin(), 4.0 * random.unit() - 2.0, 5.0 + 5.0 * angle.cos())
        });
        assert_eq!(eight_point(&views.seen), Err(EightPointError::Undetermined), "{n} points");
    }
}

#[test]
fn epsilons_are_those_of_the_language() {
    assert_eq!((<f32 as Real>::EPSILON, <f64 as Real>::EPSILON), (f32::EPSILON, f64::EPSILON));
}
