//! What is no problem is refused by name, and nothing is moved.

use super::scene::{Scene, calibrated, scene};
use super::twin::Room;
use nalgebra::{Point2, Point3};
use stereopsis::geometry::camera::Pose;
use stereopsis::motion::bundle::{
    BundleConfig, BundleError, BundleWorkspaceView, CameraView, Gauge, Loss, Problem, Window, WindowError,
    WorkspaceSize, adjust,
};

fn good() -> Scene<CameraView<f64>, f64> {
    scene((0..3).map(calibrated).collect(), 5, 1, 0.5, |_, _| true)
}

fn refusal(scene: &Scene<CameraView<f64>, f64>, config: BundleConfig<f64>) -> Option<BundleError> {
    let (mut views, mut points) = (scene.views.clone(), scene.points.clone());
    let mut room = Room::new(3, 5);
    let mut problem = Problem { views: &mut views, points: &mut points, observations: &scene.observations };
    let error = adjust(&mut problem, &mut room.workspace(), config).err();
    assert!(error.is_none() || (views == scene.views && points == scene.points), "{error:?}");
    error
}

fn with(change: impl FnOnce(&mut Scene<CameraView<f64>, f64>)) -> Option<BundleError> {
    let mut scene = good();
    change(&mut scene);
    refusal(&scene, BundleConfig::new(Gauge::Free))
}

#[test]
fn indices_and_numbers() {
    assert_eq!(with(|_| ()), None);
    assert_eq!(with(|s| s.observations.clear()), Some(BundleError::Empty));
    assert_eq!(with(|s| s.observations[4].view = 3), Some(BundleError::View(4)));
    assert_eq!(with(|s| s.observations[14].point = 5), Some(BundleError::Point(14)));
    assert_eq!(with(|s| s.observations.swap(2, 3)), Some(BundleError::Unsorted(3)));
    assert_eq!(with(|s| s.observations[7].pixel.y = f64::NAN), Some(BundleError::NotFinite(7)));
    assert_eq!(with(|s| s.points[1].z = -5.0), Some(BundleError::NotSeen(3)));
    assert_eq!(with(|s| s.points[2].x = f64::INFINITY), Some(BundleError::NotSeen(6)));
}

#[test]
fn configurations() {
    let of = |change: &dyn Fn(&mut BundleConfig<f64>)| {
        let mut config = BundleConfig::new(Gauge::Free);
        change(&mut config);
        refusal(&good(), config)
    };
    for gauge in [Gauge::Views(0..0), Gauge::Views(0..4), Gauge::Baseline { held: 1, other: 1 }] {
        assert_eq!(of(&|c| c.gauge = gauge.clone()), Some(BundleError::Gauge));
    }
    assert_eq!(of(&|c| c.gauge = Gauge::Baseline { held: 0, other: 3 }), Some(BundleError::Gauge));
    let baseline = BundleConfig::new(Gauge::Baseline { held: 2, other: 0 });
    let mut scene = good();
    assert_eq!(refusal(&scene, baseline.clone()), None);
    let place = *scene.views[2].pose.translation();
    scene.views[0].pose = Pose::new(*scene.views[0].pose.rotation(), place).expect("a pose");
    assert_eq!(refusal(&scene, baseline), Some(BundleError::Gauge));
    assert_eq!(of(&|c| c.loss = Loss::Huber(0.0)), Some(BundleError::Config));
    assert_eq!(of(&|c| c.cost_tolerance = f64::NAN), Some(BundleError::Config));
    assert_eq!(of(&|c| c.step_tolerance = -1.0), Some(BundleError::Config));
    assert_eq!(of(&|c| c.damping = 0.0), Some(BundleError::Config));
    assert_eq!(of(&|c| c.most_iterations = 0), None);
}

#[test]
fn memory_that_is_too_small_says_how_much() {
    let scene = good();
    let (mut views, mut points) = (scene.views.clone(), scene.points.clone());
    let mut problem = Problem { views: &mut views, points: &mut points, observations: &scene.observations };
    let mut room = Room::<CameraView<f64>, 6>::new(3, 5);
    let config = BundleConfig::new(Gauge::Free);
    let BundleWorkspaceView { slots, terms, trial_points, blocks } = room.workspace();
    let mut small = BundleWorkspaceView { slots: &mut slots[..2], terms, trial_points, blocks };
    let need = WorkspaceSize { slots: 3, terms: 3, points: 5, blocks: 0 };
    let refused = adjust(&mut problem, &mut small, config.clone());
    assert_eq!(refused, Err(BundleError::Workspace(need)));
    let BundleWorkspaceView { slots, terms, trial_points, blocks } = room.workspace();
    let mut small = BundleWorkspaceView { slots, terms, trial_points, blocks: &mut blocks[..5] };
    let refused = adjust(&mut problem, &mut small, config);
    assert_eq!(refused, Err(BundleError::Workspace(WorkspaceSize { blocks: 6, ..need })));
}

#[test]
fn windows_that_are_full() {
    let mut window = Window::<CameraView<f32>, f32, 6, 1, 1, 1>::new();
    let pixel = Point2::new(0.0, 0.0);
    assert_eq!(window.add_observation(0, 0, pixel), Err(WindowError::NoPoint));
    assert_eq!(window.add_point(Point3::origin()), Ok(0));
    assert_eq!(window.add_observation(0, 0, pixel), Err(WindowError::NoView));
    assert_eq!(window.add_view(calibrated(0)), Ok(0));
    assert_eq!(window.add_observation(0, 0, pixel), Ok(()));
    assert_eq!(window.add_observation(0, 0, pixel), Err(WindowError::Observations(2)));
    assert_eq!(window.add_view(calibrated(1)), Err(WindowError::Views(2)));
    assert_eq!(window.add_point(Point3::origin()), Err(WindowError::Points(2)));
    window.clear();
    assert_eq!(window.adjust(BundleConfig::new(Gauge::Free)), Err(BundleError::Empty));
}

#[test]
fn a_window_for_two_views_is_small() {
    assert!(size_of::<Window<CameraView<f32>, f32, 6, 2, 128, 256>>() <= 12 * 1024);
    assert!(size_of::<Window<CameraView<f32>, f32, 6, 8, 128, 1024>>() <= 40 * 1024);
}
