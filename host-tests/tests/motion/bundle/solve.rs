//! Whole adjustments, held to the truth.

use super::scene::{Scene, calibrated, filled, radial, rig, scene};
use nalgebra::Vector3;
use stereopsis::geometry::Real;
use stereopsis::motion::bundle::{BundleConfig, BundleReport, CameraView, Gauge, Loss, StopReason, View};

fn centres_off<V: View<T, N>, T: Real, const N: usize>(found: &[V], truth: &[V]) -> f64 {
    let off = |(a, b): (&V, &V)| (a.pose().translation() - b.pose().translation()).norm().to_f64();
    found.iter().zip(truth).map(off).fold(0.0, f64::max)
}

/// Without noise, from beside the truth back to it.
fn comes_back<V: View<T, N>, T: Real, const N: usize>(
    truth: &Scene<V, T>,
    held: u16,
    within: f64,
) -> BundleReport<T> {
    let mut window = filled(&truth.disturbed(held.into(), 0.01, 0.03));
    let report = window.adjust(BundleConfig::new(Gauge::Views(0..held))).expect("a problem");
    let off = centres_off(window.views(), &truth.views);
    assert!(off <= within, "{off} {report:?}");
    for (view, truth) in window.views().iter().zip(&truth.views).take(held.into()) {
        assert_eq!(view.pose(), truth.pose());
    }
    report
}

#[test]
fn from_beside_the_truth() {
    for views in [2, 3, 8] {
        let report = comes_back::<_, f64, 6>(
            &scene((0..views).map(calibrated).collect(), 128, 1, 0.0, |_, _| true),
            2,
            1e-9,
        );
        assert_eq!(report.stop, StopReason::Exact, "{report:?}");
    }
    let report = comes_back::<_, f64, 6>(&scene((0..3).map(rig).collect(), 60, 2, 0.0, |_, _| true), 1, 1e-9);
    assert_eq!(report.stop, StopReason::Exact, "{report:?}");
    let report =
        comes_back::<_, f64, 9>(&scene((0..6).map(radial).collect(), 128, 1, 0.0, |_, _| true), 2, 1e-6);
    assert_eq!(report.stop, StopReason::Exact, "{report:?}");
    // In f32, pixels are rounded to 3e-5 px: a hundred thousandth of the depth at these baselines.
    comes_back::<_, f32, 6>(&scene((0..3).map(calibrated).collect(), 128, 1, 0.0, |_, _| true), 2, 2e-4);
    comes_back::<_, f32, 6>(&scene((0..3).map(rig).collect(), 60, 2, 0.0, |_, _| true), 1, 2e-4);
}

#[test]
fn noise_leaves_its_own_cost() {
    let truth: Scene<CameraView<f64>, f64> =
        scene((0..6).map(calibrated).collect(), 128, 1, 0.7, |_, _| true);
    let mut window = filled(&truth.disturbed(2, 0.01, 0.03));
    let report = window.adjust(BundleConfig::new(Gauge::Views(0..2))).expect("a problem");
    // chi^2 / 2 of 2 x 768 numbers less 24 + 384 unknowns, times the variance: 564 x 0.49, with a deviation
    // of 11.6.
    assert!((report.cost - 276.0).abs() < 4.0 * 11.6, "{report:?}");
    assert_eq!(report.stop, StopReason::Cost);
    let single: Scene<CameraView<f32>, f32> =
        scene((0..6).map(calibrated).collect(), 128, 1, 0.7, |_, _| true);
    let mut small = filled(&single.disturbed(2, 0.01, 0.03));
    let other = small.adjust(BundleConfig::new(Gauge::Views(0..2))).expect("a problem");
    // Both begin with the same random numbers.
    assert!((f64::from(other.cost) / report.cost - 1.0).abs() < 1e-4, "{other:?} {report:?}");
    assert!(
        (centres_off(small.views(), &single.views) - centres_off(window.views(), &truth.views)).abs() < 1e-3
    );
}

#[test]
fn a_baseline_keeps_its_length() {
    let truth = scene((0..4).map(calibrated::<f64>).collect(), 60, 1, 0.3, |_, _| true);
    let mut window = filled(&truth.disturbed(1, 0.01, 0.03));
    let length =
        |views: &[CameraView<f64>]| (views[3].pose.translation() - views[0].pose.translation()).norm();
    let before = length(window.views());
    let report = window.adjust(BundleConfig::new(Gauge::Baseline { held: 0, other: 3 })).expect("a problem");
    assert_eq!(window.views()[0], truth.views[0]);
    assert!((length(window.views()) - before).abs() < 1e-12 * before, "{report:?}");
    let direction =
        |views: &[CameraView<f64>]| (views[3].pose.translation() - views[0].pose.translation()).normalize();
    assert!((direction(window.views()) - direction(&truth.views)).norm() < 0.01);
    // The same cost as without a gauge: seven numbers are free.
    let mut free = filled(&truth.disturbed(1, 0.01, 0.03));
    let other = free.adjust(BundleConfig::new(Gauge::Free)).expect("a problem");
    assert!((report.cost / other.cost - 1.0).abs() < 1e-4, "{report:?} {other:?}");
}

#[test]
fn what_is_far_off_pulls_little() {
    let mut truth = scene((0..5).map(calibrated::<f64>).collect(), 100, 1, 0.3, |_, _| true);
    for observation in truth.observations.iter_mut().step_by(17) {
        observation.pixel += Vector3::new(40.0, -25.0, 0.0).xy();
    }
    let found = |loss| {
        let mut window = filled(&truth.disturbed(2, 0.01, 0.03));
        let config = BundleConfig { loss, ..BundleConfig::new(Gauge::Views(0..2)) };
        let report = window.adjust(config).expect("a problem");
        assert!(report.cost < report.initial_cost, "{report:?}");
        centres_off(window.views(), &truth.views)
    };
    let (robust, plain) = (found(Loss::Huber(1.0)), found(Loss::Squares));
    assert!(robust < 0.01 && plain > 4.0 * robust, "{robust} {plain}");
}

#[test]
fn a_step_at_a_time_is_the_same() {
    let truth = scene((0..3).map(calibrated::<f64>).collect(), 40, 1, 0.5, |_, _| true);
    let start = truth.disturbed(2, 0.01, 0.03);
    let config =
        BundleConfig { most_iterations: 3, cost_tolerance: 1e-15, ..BundleConfig::new(Gauge::Views(0..2)) };
    let (mut whole, mut stepped) = (filled(&start), filled(&start));
    let report = whole.adjust(config.clone()).expect("a problem");
    assert_eq!((report.stop, report.iterations), (StopReason::Iterations, 3));
    let mut adjustment = stepped.start(config).expect("a problem");
    let mut last = f64::INFINITY;
    while stepped.iterate(&mut adjustment).is_continue() {
        assert!(adjustment.report(StopReason::Iterations).cost <= last);
        last = adjustment.report(StopReason::Iterations).cost;
    }
    assert_eq!(stepped.views(), whole.views());
    assert_eq!(stepped.points(), whole.points());
}

#[test]
fn a_far_point_and_an_exact_problem_stop() {
    // Parallel observations: the point goes away, the cost does not.
    let mut truth = scene((0..3).map(calibrated::<f64>).collect(), 20, 1, 0.0, |_, _| true);
    truth.points.push(nalgebra::Point3::new(0.0, 0.0, 1e4));
    for (n, view) in truth.views.iter().enumerate() {
        let pixel = view.project(0, &nalgebra::Point3::new(0.0, 0.0, 1e9)).expect("seen");
        truth.observations.push(stereopsis::motion::bundle::Observation {
            point: 20,
            view: n as u16,
            eye: 0,
            pixel,
        });
    }
    let mut window = filled(&truth);
    let report = window.adjust(BundleConfig::new(Gauge::Views(0..2))).expect("a problem");
    assert!(
        report.cost < 1e-3 && window.points().iter().all(|p| p.coords.iter().all(|x| x.is_finite())),
        "{report:?}"
    );
    let exact = scene((0..2).map(calibrated::<f64>).collect(), 20, 1, 0.0, |_, _| true);
    let report = filled(&exact).adjust(BundleConfig::new(Gauge::Views(0..1))).expect("a problem");
    assert_eq!((report.stop, report.iterations), (StopReason::Exact, 0));
    // One observation of one point: any depth will do.
    let mut one = scene(vec![calibrated::<f64>(0)], 1, 1, 0.0, |_, _| true);
    one.observations[0].pixel += Vector3::new(3.0, 4.0, 0.0).xy();
    let report = filled(&one).adjust(BundleConfig::new(Gauge::Free)).expect("a problem");
    assert!(report.cost < 1e-20 && (report.initial_cost - 12.5).abs() < 1e-9, "{report:?}");
}
