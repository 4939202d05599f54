//! Structure from observations alone, some of them wrong, held to the truth; what gives none is named.

use super::scene::{Scene, calibrated, pose, scene};
use super::twin::Room;
use nalgebra::{Point2, Point3};
use stereopsis::geometry::{
    absolute::Landmark,
    camera::Pose,
    two_view::{Correspondence, ScaleError},
};
use stereopsis::motion::bundle::{BundleError, CameraView, Observation, View};
use stereopsis::motion::structure::{
    InitialPairError, MetricStructure, PointState, Structure, StructureConfig, StructureError,
    StructureReport, StructureWorkspace, StructureWorkspaceView, ViewState, structure,
};
use stereopsis_host::scene::Random;

type Seen = Scene<CameraView<f64>, f64>;

/// Runs on memory of the right size; the baseline of the pair it began with is known, and what `judge` makes
/// of it in metres.
fn found<R>(
    seen: &Seen,
    judge: impl FnOnce(&MetricStructure<'_, f64>, &StructureReport<f64>) -> R,
) -> Result<R, StructureError> {
    let (m, n) = (seen.views.len(), seen.points.len());
    let mut views: Vec<_> = seen.views.iter().map(|view| view.with_pose(Pose::identity())).collect();
    let (mut placements, mut states) = (vec![ViewState::Unknown; m], vec![PointState::Unknown; n]);
    let (mut points, mut kept) =
        (vec![Point3::origin(); n], vec![Observation::EMPTY; seen.observations.len()]);
    let mut matches = vec![Correspondence::new(0.0, 0.0, 0.0, 0.0); n];
    let mut landmarks = vec![Landmark { world: Point3::origin(), pixel: Point2::origin() }; n];
    let (mut inliers, mut room) = (vec![false; n], Room::new(m, n));
    let memory = StructureWorkspaceView {
        views: &mut views,
        view_states: &mut placements,
        points: &mut points,
        states: &mut states,
        kept: &mut kept,
        matches: &mut matches,
        landmarks: &mut landmarks,
        inliers: &mut inliers,
        bundle: room.workspace(),
    };
    let (found, report) = structure(memory, &seen.observations, &StructureConfig::new(1.5))?;
    let (a, b) = (usize::from(report.pair.0), usize::from(report.pair.1));
    let metres = (seen.views[a].pose.translation() - seen.views[b].pose.translation()).norm();
    let metric = found.with_baseline((a, b), metres).expect("both stand somewhere");
    Ok(judge(&metric, &report))
}

/// The largest error of a view's centre and of a known point, metres; how many points are known.
fn errors(
    seen: &Seen,
    metric: &MetricStructure<'_, f64>,
    report: &StructureReport<f64>,
) -> (f64, f64, usize) {
    let frame = &seen.views[usize::from(report.pair.0)].pose;
    let (mut centres, mut points, mut known) = (0.0_f64, 0.0_f64, 0);
    for (n, view) in seen.views.iter().enumerate() {
        let found = frame.then(metric.pose(n).expect("placed"));
        centres = centres.max((found.translation() - view.pose.translation()).norm());
    }
    for (n, point) in seen.points.iter().enumerate() {
        if let Ok(found) = metric.point(n) {
            points = points.max((frame.transform(found) - point).norm() / point.coords.norm());
            known += 1;
        }
    }
    (centres, points, known)
}

/// Some of the observations put anywhere.
fn with_wrong(mut seen: Seen, share: f64) -> Seen {
    let mut random = Random::new(3);
    for observation in &mut seen.observations {
        if random.unit() < share {
            observation.pixel = Point2::new(640.0 * random.unit(), 480.0 * random.unit());
        }
    }
    seen
}

fn views(count: usize) -> Vec<CameraView<f64>> {
    (0..count).map(calibrated).collect()
}

#[test]
fn without_noise_it_is_the_truth() {
    let seen = scene(views(5), 60, 1, 0.0, |view, point| point % 3 == 0 || view + 1 != point % 5);
    let (centres, points, known) =
        found(&seen, |metric, report| errors(&seen, metric, report)).expect("a structure");
    assert!(centres < 1e-8 && points < 1e-8 && known == 60, "{centres} {points} {known}");
}

#[test]
fn noise_and_wrong_observations_are_borne() {
    for share in [0.0, 0.2] {
        let seen = with_wrong(scene(views(6), 80, 1, 0.3, |_, _| true), share);
        let (centres, points, known) =
            found(&seen, |metric, report| errors(&seen, metric, report)).expect("a structure");
        assert!(centres < 0.08 && points < 0.08 && known >= 74, "{share}: {centres} {points} {known}");
    }
}

#[test]
fn a_plane_is_named_and_solved() {
    let mut seen = scene(views(4), 60, 1, 0.0, |_, _| true);
    for point in &mut seen.points {
        point.z = 5.0 + 0.3 * point.x - 0.2 * point.y;
    }
    for observation in &mut seen.observations {
        let (view, point) =
            (&seen.views[usize::from(observation.view)], &seen.points[observation.point as usize]);
        observation.pixel = view.project(0, point).expect("before the camera");
    }
    let (plane, off) =
        found(&seen, |metric, report| (report.plane, errors(&seen, metric, report))).expect("a structure");
    assert!(plane && off.0 < 1e-6 && off.1 < 1e-6, "{plane} {off:?}");
    let general = scene(views(4), 60, 1, 0.0, |_, _| true);
    assert_eq!(found(&general, |_, report| report.plane), Ok(false));
}

#[test]
fn what_gives_no_pose_is_named() {
    let at = |turn: f64, shift: f64| {
        let place = |n: usize| {
            pose([0.01 * turn, -0.05 * turn * n as f64, 0.02 * turn], [shift * n as f64, 0.0, 0.0])
        };
        (0..3).map(|n| calibrated(n).with_pose(place(n))).collect::<Vec<_>>()
    };
    for share in [0.0, 0.2] {
        let of = |views| found(&with_wrong(scene(views, 60, 1, 0.2, |_, _| true), share), |_, _| ()).err();
        assert_eq!(of(at(0.0, 0.0)), Some(StructureError::NoPair(InitialPairError::NoMotion)), "{share}");
        assert_eq!(of(at(1.0, 0.0)), Some(StructureError::NoPair(InitialPairError::PureRotation)), "{share}");
        // A millimetre beside metres.
        assert_eq!(
            of(at(1.0, 0.001)),
            Some(StructureError::NoPair(InitialPairError::PureRotation)),
            "{share}"
        );
    }
    let few = scene(views(3), 11, 1, 0.0, |_, _| true);
    assert_eq!(found(&few, |_, _| ()).err(), Some(StructureError::NoPair(InitialPairError::TooFew)));
    let mut random = scene(views(2), 60, 1, 0.0, |_, _| true);
    random = with_wrong(random, 1.1);
    let fault = found(&random, |_, _| ()).err();
    assert!(
        matches!(
            fault,
            Some(StructureError::NoPair(InitialPairError::NoAgreement | InitialPairError::SmallAngle))
        ),
        "{fault:?}"
    );
}

#[test]
fn points_at_infinity_are_far() {
    let mut seen = scene(views(4), 60, 1, 0.0, |_, _| true);
    for point in seen.points.iter_mut().step_by(4) {
        point.coords *= 1e4;
    }
    for observation in &mut seen.observations {
        let (view, point) =
            (&seen.views[usize::from(observation.view)], &seen.points[observation.point as usize]);
        observation.pixel = view.project(0, point).expect("before the camera");
    }
    let states =
        |metric: &MetricStructure<'_, f64>| (0..60).map(|n| metric.point(n).err()).collect::<Vec<_>>();
    for (n, state) in found(&seen, |metric, _| states(metric)).expect("a structure").into_iter().enumerate() {
        assert_eq!(state, (n % 4 == 0).then_some(PointState::Far), "{n}");
    }
}

#[test]
fn a_view_that_sees_nothing_known_is_named() {
    let seen = scene(views(4), 40, 1, 0.0, |view, point| view < 3 || point < 5);
    let missing = found(&seen, |metric, report| (metric.pose(3).err(), report.views)).expect("a structure");
    assert_eq!(missing, (Some(ViewState::TooFew), 3));
    // One whose observations are all wrong.
    let mut seen = scene(views(4), 40, 1, 0.0, |_, _| true);
    let mut random = Random::new(8);
    for observation in seen.observations.iter_mut().filter(|observation| observation.view == 2) {
        observation.pixel = Point2::new(640.0 * random.unit(), 480.0 * random.unit());
    }
    let missing = found(&seen, |metric, _| metric.pose(2).err()).expect("a structure");
    assert_eq!(missing, Some(ViewState::NoAgreement));
}

#[test]
fn no_views_or_observations_are_refused() {
    let one = scene(views(1), 20, 1, 0.0, |_, _| true);
    assert_eq!(found(&one, |_, _| ()).err(), Some(StructureError::Views));
    let mut none = scene(views(2), 20, 1, 0.0, |_, _| true);
    none.observations.clear();
    let error = found(&none, |_, _| ()).err();
    assert_eq!(error, Some(StructureError::Bundle(BundleError::Empty)));
}

/// An index or a number that cannot be is named by its place among the caller's observations.
#[test]
fn observations_that_cannot_be_are_refused() {
    let with = |change: &dyn Fn(&mut [Observation<f64>])| {
        let mut seen = scene(views(3), 20, 1, 0.0, |_, _| true);
        change(&mut seen.observations);
        found(&seen, |_, _| ()).err()
    };
    let refused = |error| Some(StructureError::Bundle(error));
    assert_eq!(with(&|_| ()), None);
    assert_eq!(with(&|s| s[4].view = 3), refused(BundleError::View(4)));
    assert_eq!(with(&|s| s[59].point = 20), refused(BundleError::Point(59)));
    assert_eq!(with(&|s| s.swap(29, 30)), refused(BundleError::Unsorted(30)));
    assert_eq!(with(&|s| s[7].pixel.x = f64::NAN), refused(BundleError::NotFinite(7)));
}

#[test]
fn a_length_between_unknown_ends_is_no_scale() {
    let seen = scene(views(4), 40, 1, 0.0, |view, point| view < 3 || point < 5);
    let cameras: Vec<_> = seen.views.iter().map(|view| view.camera).collect();
    let mut room = Box::new(StructureWorkspace::<f64, 4, 40, 160>::new());
    let mut scaled = |by: &dyn Fn(Structure<'_, f64>) -> Option<ScaleError>| {
        let memory = room.as_mut_view(&cameras, seen.points.len()).expect("room");
        let (found, _) =
            structure(memory, &seen.observations, &StructureConfig::new(1.5)).expect("a structure");
        by(found)
    };
    assert_eq!(scaled(&|found| found.with_baseline((0, 3), 1.0).err()), Some(ScaleError::Unknown));
    assert_eq!(scaled(&|found| found.with_baseline((9, 0), 1.0).err()), Some(ScaleError::Unknown));
    assert_eq!(scaled(&|found| found.with_baseline((1, 1), 1.0).err()), Some(ScaleError::SamePoint));
    assert_eq!(scaled(&|found| found.with_length((0, 40), 1.0).err()), Some(ScaleError::Unknown));
    assert_eq!(scaled(&|found| found.with_length((2, 2), 1.0).err()), Some(ScaleError::SamePoint));
    assert_eq!(scaled(&|found| found.with_length((0, 1), -1.0).err()), Some(ScaleError::Length));
    assert_eq!(scaled(&|found| found.with_length((0, 1), 1.0).err()), None);
}

#[test]
fn a_room_gives_what_slices_give() {
    let seen = with_wrong(scene(views(4), 50, 1, 0.3, |_, _| true), 0.1);
    let cameras: Vec<_> = seen.views.iter().map(|view| view.camera).collect();
    let config = StructureConfig::new(1.5);
    let mut room = Box::new(StructureWorkspace::<f64, 5, 60, 250>::new());
    let (of_room, report) = room
        .as_mut_view(&cameras, seen.points.len())
        .and_then(|view| structure(view, &seen.observations, &config))
        .expect("a structure");
    let pose = |n| *of_room.pose(n).expect("placed");
    let poses: Vec<_> = (0..4).map(pose).collect();
    let (a, b) = (usize::from(report.pair.0), usize::from(report.pair.1));
    let metres = (seen.views[a].pose.translation() - seen.views[b].pose.translation()).norm();
    let unit = (poses[a].translation() - poses[b].translation()).norm();
    let of_slices =
        found(&seen, |metric, _| (0..4).map(|n| *metric.pose(n).expect("placed")).collect::<Vec<_>>());
    for (one, other) in poses.iter().zip(of_slices.expect("a structure")) {
        assert!((one.translation() * (metres / unit) - other.translation()).amax() < 1e-12);
        assert_eq!(one.rotation(), other.rotation());
    }
    // What has no room says how much would do.
    let mut small = StructureWorkspace::<f64, 3, 60, 250>::new();
    assert_eq!(
        small.as_mut_view(&cameras, 50).and_then(|view| structure(view, &seen.observations, &config)).err(),
        Some(StructureError::Memory(4))
    );
    let mut small = StructureWorkspace::<f64, 5, 49, 250>::new();
    assert_eq!(
        small.as_mut_view(&cameras, 50).and_then(|view| structure(view, &seen.observations, &config)).err(),
        Some(StructureError::Memory(50))
    );
    let mut small = StructureWorkspace::<f64, 5, 60, 199>::new();
    assert_eq!(
        small.as_mut_view(&cameras, 50).and_then(|view| structure(view, &seen.observations, &config)).err(),
        Some(StructureError::Memory(200))
    );
}
