//! One step beside that of the naive twin.

use super::scene::{Scene, calibrated, radial, rig, scene};
use nalgebra::{DMatrix, Point3};
use stereopsis::motion::bundle::{
    BundleConfig, BundleWorkspaceView, CrossBlock, Gauge, Loss, Problem, View, ViewSlot, adjust,
};
use stereopsis_host::twin::bundle::Dense;

/// Memory enough for anything here.
pub struct Room<V, const N: usize> {
    slots: Vec<ViewSlot<V, f64, N>>,
    terms: Vec<CrossBlock<f64, N>>,
    points: Vec<Point3<f64>>,
    blocks: Vec<[[f64; N]; N]>,
}

impl<V: View<f64, N>, const N: usize> Room<V, N> {
    pub fn new(views: usize, points: usize) -> Self {
        Self {
            slots: vec![ViewSlot::EMPTY; views],
            terms: vec![CrossBlock::EMPTY; views],
            points: vec![Point3::origin(); points],
            blocks: vec![[[0.0; N]; N]; views * (views + 1) / 2],
        }
    }

    pub fn workspace(&mut self) -> BundleWorkspaceView<'_, V, f64, N> {
        let Self { slots, terms, points, blocks } = self;
        BundleWorkspaceView { slots, terms, trial_points: points, blocks }
    }
}

/// One step of the core from `start`, against the twin's.
fn same_step<V: View<f64, N>, const N: usize>(start: &Scene<V, f64>, held: u16, loss: Loss<f64>) {
    let (mut views, mut points) = (start.views.clone(), start.points.clone());
    let mut room = Room::new(views.len(), points.len());
    let mut problem = Problem { views: &mut views, points: &mut points, observations: &start.observations };
    let gauge = if held > 0 { Gauge::Views(0..held) } else { Gauge::Free };
    let config = BundleConfig { loss, most_iterations: 1, damping: 0.01, ..BundleConfig::new(gauge) };
    let report = adjust(&mut problem, &mut room.workspace(), config).expect("a problem");
    assert_eq!((report.iterations, report.steps), (1, 1), "{report:?}");
    let free = (0..start.views.len()).map(|n| {
        let columns = if n < usize::from(held) { 0 } else { N };
        DMatrix::identity(N, columns)
    });
    let (observations, free) = (&start.observations, free.collect());
    let step = Dense { views: &start.views, points: &start.points, observations, loss, free }.step(0.01);
    // Differences err by a ten-thousandth of a step at most: it is their error by the condition of the
    // equations.
    let size = step.amax();
    for (n, (after, before)) in views.iter().zip(&start.views).enumerate().skip(held.into()) {
        let own = step.fixed_rows::<N>((n - usize::from(held)) * N);
        let expected = before.moved(&std::array::from_fn(|k| own[k]));
        let off = (after.pose().translation() - expected.pose().translation()).amax();
        let turned = (after.pose().rotation() - expected.pose().rotation()).amax();
        assert!(off.max(turned) <= 1e-4 * size.min(1.0), "view {n}: {off} {turned}");
    }
    let first = step.len() - 3 * points.len();
    for (n, (after, before)) in points.iter().zip(&start.points).enumerate() {
        let expected = before + step.fixed_rows::<3>(first + 3 * n);
        assert!((after - expected).amax() <= 1e-4 * size.min(1.0), "point {n}: {after} {expected}");
    }
}

#[test]
fn cameras_that_are_held_or_not() {
    let truth = scene((0..4).map(calibrated).collect(), 20, 1, 0.5, |_, _| true);
    same_step(&truth.disturbed(0, 0.01, 0.02), 0, Loss::Squares);
    same_step(&truth.disturbed(2, 0.01, 0.02), 2, Loss::Squares);
    same_step(&truth.disturbed(1, 0.01, 0.02), 1, Loss::Huber(2.0));
}

#[test]
fn points_that_few_see() {
    // A band: each point is seen by three views in a row, so that the matrix has an envelope.
    let views = (0..9).map(calibrated).collect();
    let truth = scene(views, 40, 1, 0.5, |view, point| (point % 7..point % 7 + 3).contains(&view));
    same_step(&truth.disturbed(2, 0.01, 0.02), 2, Loss::Squares);
    // Rows of different reach: some points join the first view and the last.
    let views = (0..6).map(calibrated).collect();
    let truth = scene(views, 40, 1, 0.5, |view, point| match point % 3 {
        0 => view == 0 || view == 5,
        1 => (2..5).contains(&view),
        _ => view < 3,
    });
    same_step(&truth.disturbed(1, 0.01, 0.02), 1, Loss::Squares);
}

#[test]
fn rigs_and_lenses() {
    let truth = scene((0..3).map(rig).collect(), 15, 2, 0.5, |_, _| true);
    same_step(&truth.disturbed(1, 0.01, 0.02), 1, Loss::Squares);
    let truth = scene((0..4).map(radial).collect(), 30, 1, 0.5, |_, _| true);
    same_step(&truth.disturbed(2, 0.01, 0.02), 2, Loss::Squares);
}
