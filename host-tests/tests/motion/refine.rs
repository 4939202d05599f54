//! The last views adjusted together, beside a problem that is put together anew for every frame.

use crate::support::pose;
use nalgebra::{Point2, Point3, Vector3};
use stereopsis::geometry::camera::{Camera, Pose, RectifiedRig};
use stereopsis::motion::bundle::{
    BundleConfig, BundleReport, BundleWorkspaceView, CrossBlock, Gauge, Loss, Observation, Problem,
    RectifiedView, View, ViewSlot, adjust,
};
use stereopsis::motion::odometry::{ObservedPoint, OdometryRig, Refinement, RefinementConfig};
use stereopsis_host::scene::Random;

const VIEWS: usize = 4;
type Refined = Refinement<f64, 5, 200, 2000>;

fn path(n: usize) -> Pose<f64> {
    let n = n as f64;
    pose([0.01 * n.sin(), 0.02 * n, 0.005 * n], [0.1 * n.sin(), 0.02 * n, 0.4 * n])
}

/// Where the motions that are told are off.
fn told(n: usize) -> Pose<f64> {
    let s = n as f64;
    let off = pose(
        [0.002 * (3.0 * s).sin(), 0.002 * (2.0 * s).cos(), 0.001],
        [0.01 * s.cos(), 0.01 * s.sin(), 0.02],
    );
    path(n - 1).inverse().then(&path(n)).then(&off)
}

fn rig() -> OdometryRig<f64> {
    OdometryRig::stereo(&RectifiedRig::new(400.0, 0.3, 320.0, 240.0).expect("a rig")).expect("cameras")
}

fn view() -> RectifiedView<f64> {
    RectifiedView {
        camera: Camera::new(400.0, 400.0, 320.0, 240.0).expect("a camera"),
        baseline: f64::from(0.3_f32),
        pose: Pose::identity(),
    }
}

fn points() -> Vec<Point3<f64>> {
    let mut random = Random::new(5);
    let mut at =
        || Point3::new(8.0 * random.unit() - 4.0, 5.0 * random.unit() - 2.5, 4.0 + 14.0 * random.unit());
    (0..90).map(|_| at()).collect()
}

/// What a view sees: each point for five views of seven, every fourth observation without its disparity.
fn seen(n: usize, noise_px: f64, in_right: bool) -> Vec<ObservedPoint<f64>> {
    let mut random = Random::new(100 + n as u64);
    let view = view().with_pose(path(n));
    let mut noise = || noise_px * random.gauss();
    let mut seen = Vec::new();
    for (i, point) in points().iter().enumerate() {
        let own = view.pose.inverse_transform(point);
        if (i + n) % 7 >= 5 || own.z < 1.0 {
            continue;
        }
        let pixel = view.project(0, point).expect("before it") + Vector3::new(noise(), noise(), 0.0).xy();
        let disparity = view.project(1, point).expect("before it").x + noise();
        let guess = own * 1.02;
        seen.push(ObservedPoint {
            name: (i as u16, 3),
            pixel,
            disparity_px: (in_right && !(i + n).is_multiple_of(4)).then_some(disparity),
            inverse: Vector3::new(guess.x / guess.z, guess.y / guess.z, 1.0 / guess.z),
        });
    }
    seen
}

fn config() -> RefinementConfig<f64> {
    RefinementConfig { most_iterations: 50, ..RefinementConfig::new(VIEWS) }
}

fn off(a: &Pose<f64>, b: &Pose<f64>) -> f64 {
    let off = a.inverse().then(b);
    off.translation().norm().max(off.angle_rad())
}

/// The views from `from` on, from the truth: what the least cost is, whatever came before.
fn anew(from: usize, noise_px: f64) -> (Vec<Pose<f64>>, BundleReport<f64>) {
    let base = path(from).inverse();
    let mut views: Vec<_> = (0..VIEWS).map(|n| view().with_pose(base.then(&path(from + n)))).collect();
    let mut places: Vec<_> = points().iter().map(|point| path(from).inverse_transform(point)).collect();
    let all: Vec<_> = (0..VIEWS).map(|n| seen(from + n, noise_px, true)).collect();
    let mut observations = Vec::new();
    for i in 0..places.len() {
        let of = |n: usize| all[n].iter().find(|seen| usize::from(seen.name.0) == i);
        if (0..VIEWS).filter(|&n| of(n).is_some()).count() < 2 {
            continue;
        }
        for n in 0..VIEWS {
            let Some(seen) = of(n) else { continue };
            let observation = |eye, pixel| Observation { point: i as u32, view: n as u16, eye, pixel };
            observations.push(observation(0, seen.pixel));
            observations.extend(seen.disparity_px.map(|d| observation(1, Point2::new(d, 0.0))));
        }
    }
    let count = places.len();
    let mut problem = Problem { views: &mut views, points: &mut places, observations: &observations };
    let mut workspace = BundleWorkspaceView {
        slots: &mut [ViewSlot::EMPTY; VIEWS],
        terms: &mut [CrossBlock::EMPTY; 2 * VIEWS],
        trial_points: &mut vec![Point3::origin(); count],
        blocks: &mut [[[0.0; 6]; 6]; VIEWS * VIEWS],
    };
    let config = BundleConfig { loss: Loss::Huber(0.1), ..BundleConfig::new(Gauge::Views(0..1)) };
    let report = adjust(&mut problem, &mut workspace, config).expect("a problem");
    (views.iter().map(|view| view.pose).collect(), report)
}

#[test]
fn as_a_problem_put_together_anew() {
    let noise = 0.2;
    let mut refined = Box::new(Refined::new());
    refined.start(&rig(), config());
    for n in 0..9 {
        let motion = if n == 0 { Pose::identity() } else { told(n) };
        let report = refined.push(&motion, seen(n, noise, true).into_iter()).expect("a problem");
        assert_eq!(report.is_some(), n > 0);
        assert_eq!(refined.poses().len(), (n + 1).min(VIEWS));
        if n + 1 < VIEWS {
            continue;
        }
        let (poses, twin) = anew(n + 1 - VIEWS, noise);
        let report = report.expect("an adjustment");
        // It stops where a step gains a ten-thousandth of the cost, of what gains by steps that shrink
        // slowly: some dozens of those.
        assert!((report.cost - twin.cost).abs() < 5e-3 * twin.cost, "{report:?} {twin:?}");
        for (own, other) in refined.poses().iter().zip(&poses) {
            assert!(off(own, other) < 2e-3, "{n}: {}", off(own, other));
        }
    }
}

#[test]
fn without_noise_it_is_the_truth() {
    for in_right in [true, false] {
        let mut refined = Box::new(Refined::new());
        refined.start(&rig(), config());
        for n in 0..7 {
            let motion = if n == 0 { Pose::identity() } else { told(n) };
            refined.push(&motion, seen(n, 0.0, in_right).into_iter()).expect("a problem");
        }
        let poses = refined.poses();
        let truth = |n: usize| path(3).inverse().then(&path(3 + n));
        // Of one camera a distance is held that was off by some percent.
        let scale = poses[1].translation().norm() / truth(1).translation().norm();
        assert!((scale - 1.0).abs() < if in_right { 1e-4 } else { 0.1 }, "{scale}");
        for (n, pose) in poses.iter().enumerate() {
            let scaled = Pose::new(*pose.rotation(), pose.translation() / scale).expect("a pose");
            assert!(off(&scaled, &truth(n)) < 1e-4, "{in_right} {n}: {}", off(&scaled, &truth(n)));
        }
    }
}

/// One camera that stands still, then goes, and comes back to where it was: there is a distance to hold where
/// one view has moved, and the last view is found in each case.
#[test]
fn one_camera_that_stands_still_is_refined() {
    let wrong = pose([0.002, -0.001, 0.001], [0.02, 0.01, -0.02]);
    for stops in [[0, 0, 0, 0, 0], [0, 0, 0, 0, 1], [0, 0, 1, 1, 0], [0, 2, 0, 0, 1], [0, 1, 0, 0, 0]] {
        let mut refined = Box::new(Refined::new());
        refined.start(&rig(), RefinementConfig { views: 5, ..config() });
        let mut report = None;
        for (n, &stop) in stops.iter().enumerate() {
            let motion = path(stops[n.saturating_sub(1)]).inverse().then(&path(stop));
            let seen = seen(stop, 0.0, false).into_iter().map(|s| {
                let own = path(stop).inverse_transform(&points()[usize::from(s.name.0)]);
                ObservedPoint { inverse: Vector3::new(own.x / own.z, own.y / own.z, 1.0 / own.z), ..s }
            });
            // The last motion is told wrong.
            let told = if n == 4 { motion.then(&wrong) } else { motion };
            report = refined.push(&told, seen).expect("a problem");
        }
        let report = report.expect("an adjustment");
        assert!(report.steps > 0 && report.cost < 1e-3 * report.initial_cost, "{stops:?}: {report:?}");
        let truth = path(stops[0]).inverse().then(&path(stops[4]));
        assert!(off(&refined.poses()[4], &truth) < 1e-3, "{stops:?}: {}", off(&refined.poses()[4], &truth));
    }
}

#[test]
fn what_has_nothing_in_common_begins_anew() {
    let mut refined = Box::new(Refined::new());
    refined.start(&rig(), config());
    for n in 0..3 {
        let motion = if n == 0 { Pose::identity() } else { told(n) };
        refined.push(&motion, seen(n, 0.1, true).into_iter()).expect("a problem");
    }
    // The same places in memory, given to other points.
    let others = || {
        (3..5).map(|n| {
            seen(n, 0.0, true).into_iter().map(|seen| ObservedPoint { name: (seen.name.0, 4), ..seen })
        })
    };
    let mut others = others();
    let found = refined.push(&told(3), others.next().expect("two"));
    assert!(matches!(found, Ok(None)), "{found:?}");
    assert_eq!(refined.poses(), [Pose::identity()]);
    let found = refined.push(&told(4), others.next().expect("two"));
    assert!(matches!(found, Ok(Some(_))), "{found:?}");
    assert_eq!(refined.poses().len(), 2);
    assert!(off(&refined.poses()[1], &path(3).inverse().then(&path(4))) < 1e-4);
    refined.clear();
    assert!(refined.poses().is_empty());
}

#[test]
fn its_memory_is_stated() {
    // Four views and 64 points on a microcontroller.
    let bytes = size_of::<Refinement<f32, 4, 64, 512>>();
    assert!(bytes < 32 * 1024, "{bytes}");
}
