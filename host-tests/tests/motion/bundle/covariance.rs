//! Covariances beside the inverse of the twin's whole matrix.

use super::scene::{Scene, calibrated, filled, rig, scene};
use super::twin::Room;
use nalgebra::{DMatrix, Matrix3, Point3, Vector3};
use stereopsis::geometry::Real;
use stereopsis::motion::bundle::{CovarianceError, Covariances, Gauge, Loss, Problem, View};
use stereopsis_host::twin::bundle::Dense;

fn near(a: f64, b: f64, size: f64, what: &str) {
    assert!((a - b).abs() <= 1e-3 * size, "{what}: {a} {b}, of {size}");
}

/// The core's blocks beside the twin's, whose step lies in the columns of `free`.
fn same<V: View<f64, 6>>(truth: &Scene<V, f64>, gauge: &Gauge, free: Vec<DMatrix<f64>>) {
    let dense = Dense {
        views: &truth.views,
        points: &truth.points,
        observations: &truth.observations,
        loss: Loss::Squares,
        free,
    };
    let whole = dense.covariance();
    let (mut views, mut points) = (truth.views.clone(), truth.points.clone());
    let mut room = Room::new(views.len(), points.len());
    let problem = Problem { views: &mut views, points: &mut points, observations: &truth.observations };
    let mut found =
        Covariances::new(problem, room.workspace(), gauge.clone(), Loss::Squares, 0.5).expect("determined");
    let mut at = 0;
    for (n, free) in dense.free.iter().enumerate() {
        let own = whole.view((at, at), (free.ncols(), free.ncols()));
        let expected = free * own * free.transpose() * 0.25;
        at += free.ncols();
        let block = found.view(n as u16);
        for (a, row) in block.iter().enumerate() {
            for (b, &x) in row.iter().enumerate() {
                let size = (expected[(a, a)] * expected[(b, b)]).sqrt() + 1e-3 * expected.amax();
                near(x, expected[(a, b)], size, &format!("view {n}: {a} {b}"));
            }
        }
    }
    for n in 0..truth.points.len() {
        let expected: Matrix3<f64> = whole.fixed_view::<3, 3>(at + 3 * n, at + 3 * n) * 0.25;
        let block = found.point(n).expect("seen");
        assert!((block - expected).amax() <= 1e-3 * expected.amax(), "point {n}: {block} {expected}");
    }
    assert_eq!(found.point(truth.points.len()), Err(CovarianceError::Point(truth.points.len())));
}

#[test]
fn with_views_held() {
    let truth =
        scene((0..4).map(calibrated).collect(), 12, 1, 0.0, |view, point| point % 3 == 0 || view != 1);
    let columns = |n: usize| DMatrix::identity(6, if n < 2 { 0 } else { 6 });
    same(&truth, &Gauge::Views(0..2), (0..4).map(columns).collect());
    let truth = scene((0..3).map(rig).collect(), 12, 2, 0.0, |_, _| true);
    let columns = |n: usize| DMatrix::identity(6, if n < 1 { 0 } else { 6 });
    same(&truth, &Gauge::Views(0..1), (0..3).map(columns).collect());
}

#[test]
fn with_a_baseline_held() {
    let truth = scene((0..3).map(calibrated).collect(), 12, 1, 0.0, |_, _| true);
    // Three turns, and two directions across the baseline of view 0 and view 2.
    let along = (truth.views[2].pose.translation() - truth.views[0].pose.translation()).normalize();
    let first = along.cross(&Vector3::y()).normalize();
    let mut across = DMatrix::zeros(6, 5);
    across.view_mut((0, 0), (3, 3)).copy_from(&Matrix3::identity());
    across.view_mut((3, 3), (3, 1)).copy_from(&first);
    across.view_mut((3, 4), (3, 1)).copy_from(&along.cross(&first));
    let free = vec![DMatrix::zeros(6, 0), DMatrix::identity(6, 6), across];
    same(&truth, &Gauge::Baseline { held: 0, other: 2 }, free);
}

#[test]
fn in_f32_to_some_percent() {
    fn deviations<T: Real>() -> [f64; 6] {
        let truth = scene((0..2).map(calibrated::<T>).collect(), 64, 1, 0.0, |_, _| true);
        let mut window = filled(&truth);
        let gauge = Gauge::Baseline { held: 0, other: 1 };
        let block = window.covariances(gauge, Loss::Squares, T::of(0.5)).expect("determined").view(1);
        std::array::from_fn(|k| block[k][k].to_f64().max(0.0).sqrt())
    }
    let (single, double) = (deviations::<f32>(), deviations::<f64>());
    let largest = double.iter().copied().fold(0.0, f64::max);
    for (a, b) in single.iter().zip(double) {
        assert!((a - b).abs() <= 0.03 * b + 1e-4 * largest, "{single:?} {double:?}");
    }
}

#[test]
fn what_is_not_determined_is_refused() {
    let truth = scene((0..2).map(calibrated).collect(), 12, 1, 0.0, |_, _| true);
    let mut window = filled(&truth);
    for gauge in [Gauge::Free, Gauge::Views(0..1)] {
        let refused = window.covariances(gauge, Loss::Squares, 1.0).err();
        assert_eq!(refused, Some(CovarianceError::Undetermined));
    }
    let baseline = Gauge::Baseline { held: 0, other: 1 };
    assert!(window.covariances(baseline.clone(), Loss::Squares, 1.0).is_ok());
    let ahead = Point3::new(0.0, 0.0, 5.0);
    window.add_point(ahead).expect("room");
    window.add_observation(0, 0, truth.views[0].project(0, &ahead).expect("seen")).expect("room");
    assert_eq!(window.covariances(baseline, Loss::Squares, 1.0).err(), Some(CovarianceError::Point(12)));
}
