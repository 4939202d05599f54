//! Cameras before something of known shape: found again, no worse than the noise allows, refused where
//! nothing is said.

use crate::views::seeded;
use nalgebra::{Matrix3, Point2, Point3, Rotation3, Vector3};
use proptest::prelude::*;
use stereopsis::geometry::{
    camera::{Camera, Distortion, Pose},
    known_shape::{
        LineSegment, ManhattanFrame, ManhattanFrameError, Sighting, SquareMark, SquareMarkError,
        VanishingPoint,
    },
};
use stereopsis_host::scene::Random;

fn camera() -> Camera<f64> {
    Camera::new(600.0, 620.0, 320.0, 240.0).expect("a camera")
}

fn with_lens() -> Camera<f64> {
    camera().with_distortion(Distortion::from_opencv([-0.2, 0.05, 0.001, -0.0005, 0.0])).expect("a camera")
}

fn project(camera: &Camera<f64>, point: Point3<f64>) -> Point2<f64> {
    camera.project(&point).expect("in front")
}

fn moved(pixel: Point2<f64>, sigma: f64, random: &mut Random) -> Point2<f64> {
    Point2::new(pixel.x + sigma * random.gauss(), pixel.y + sigma * random.gauss())
}

fn rotation(axis: Vector3<f64>) -> Matrix3<f64> {
    *Rotation3::new(axis).matrix()
}

/// The angle between two rotations, radians, to second order: an arc cosine would lose half of the digits.
fn apart(a: &Matrix3<f64>, b: &Matrix3<f64>) -> f64 {
    (a - b).norm() / 2.0_f64.sqrt()
}

fn axis(most: f64) -> impl Strategy<Value = Vector3<f64>> {
    let number = move || -most..most;
    (number(), number(), number()).prop_map(|(x, y, z)| Vector3::new(x, y, z))
}

proptest! {
    #![proptest_config(seeded())]

    #[test]
    fn a_pole_across_the_sight_is_where_it_is(
        (x, y, z) in (-1.5..1.5_f64, -1.0..1.0_f64, 2.0..8.0_f64), angle in 0.0..6.3_f64,
            length in 0.2..1.5_f64,
    ) {
        let middle = Vector3::new(x, y, z);
        let right = middle.cross(&Vector3::y()).normalize();
        let along = right * angle.cos() + middle.normalize().cross(&right) * angle.sin();
        let ends = [-0.5, 0.5].map(|by| project(&with_lens(), Point3::from(middle + along * (by * length))));
        let seen = Sighting::of_length(&with_lens(), &ends, length, 0.1).expect("a distance");
        prop_assert!((seen.distance_m / middle.norm() - 1.0).abs() < 1e-5);
        prop_assert!((seen.point().coords - middle).norm() < 1e-4);
        let again = Vector3::new(
            seen.azimuth_rad().sin() * seen.elevation_rad().cos(),
            -seen.elevation_rad().sin(),
            seen.azimuth_rad().cos() * seen.elevation_rad().cos(),
        );
        prop_assert!((again - seen.bearing.into_inner()).norm() < 1e-12);
    }

    #[test]
    fn a_square_is_where_it_is(turn in axis(0.6), (x, y, z) in (-0.5..0.5_f64, -0.4..0.4_f64, 0.8..3.0_f64)) {
        let mark = SquareMark::new(0.3).expect("a mark");
        let pose = Pose::new(rotation(turn), Vector3::new(x, y, z)).expect("a pose");
        let corners = mark.corners().map(|corner| project(&with_lens(), pose.transform(&corner)));
        let poses = mark.locate(&with_lens(), &corners).expect("a pose");
        prop_assert!(poses.best.rms_px < 0.01, "{:?}", poses);
        prop_assert!(apart(poses.best.pose.rotation(), pose.rotation()) < 0.005, "{:?}", poses);
        prop_assert!((poses.best.pose.translation() - pose.translation()).norm() < 1e-3);
        if let Some(other) = poses.other {
            prop_assert!(other.rms_px >= poses.best.rms_px && (0.0..=1.0).contains(&poses.ambiguity()));
        }
        // Without a lens, to rounding.
        let corners = mark.corners().map(|corner| project(&camera(), pose.transform(&corner)));
        let exact = mark.locate(&camera(), &corners).expect("a pose").best;
        prop_assert!(exact.rms_px < 1e-9, "{:e}", exact.rms_px);
        prop_assert!((exact.pose.translation() - pose.translation()).norm() < 1e-8);
    }

    #[test]
    fn walls_give_the_orientation_and_the_focal_length(turn in axis(0.35), seed in any::<u64>()) {
        // A corner of a room, seen from afar: all three directions are askew.
        let truth = rotation(turn) * rotation(Vector3::new(0.6, 0.0, 0.0))
            * rotation(Vector3::new(0.0, 0.7, 0.0));
        let bundles = room(&square(), &truth, 0.0, seed);
        let of = [&bundles[0][..], &bundles[1], &bundles[2]];
        let walls = ManhattanFrame::orientation(&square(), of, &truth).expect("an orientation");
        prop_assert!(apart(&walls.rotation, &truth) < 1e-8, "{:?}", walls);
        prop_assert!(walls.rms_px < 1e-8 && walls.focal_sigma_per_px == 0.0);
        let walls = ManhattanFrame::orientation_and_focal(&Point2::new(320.0, 240.0), of, &truth)
            .expect("an orientation");
        prop_assert!(apart(&walls.rotation, &truth) < 1e-7, "{:?}", walls);
        prop_assert!((walls.focal_px - 600.0).abs() < 1e-4, "{}", walls.focal_px);
        // Lines have no sense: expected the other way round, it is turned by half a turn.
        let half = Matrix3::from_diagonal(&Vector3::new(-1.0, 1.0, -1.0));
        let other = ManhattanFrame::orientation(&square(), of, &(truth * half)).expect("an orientation");
        prop_assert!(apart(&other.rotation, &(truth * half)) < 1e-8);
        let point = VanishingPoint::of(of[1]).expect("a point");
        let direction = point.direction(&square()).into_inner();
        prop_assert!(direction.cross(&truth.column(1)).norm() < 1e-8);
    }
}

fn square() -> Camera<f64> {
    Camera::new(600.0, 600.0, 320.0, 240.0).expect("a camera")
}

/// Ten segments in each of three directions, as far as the image of 640 x 480 shows them.
fn room(camera: &Camera<f64>, truth: &Matrix3<f64>, sigma: f64, seed: u64) -> [Vec<LineSegment<f64>>; 3] {
    let mut random = Random::new(seed);
    core::array::from_fn(|k| {
        let direction: Vector3<f64> = truth.column(k).into();
        let mut bundle = Vec::new();
        while bundle.len() < 10 {
            let start =
                Vector3::new(4.0 * random.unit() - 2.0, 3.0 * random.unit() - 1.5, 4.0 + 3.0 * random.unit());
            let ends = [start, start + direction * (0.5 + random.unit())];
            let [Ok(a), Ok(b)] = ends.map(|end| camera.project(&Point3::from(end))) else { continue };
            let inside = |p: &Point2<f64>| (0.0..640.0).contains(&p.x) && (0.0..480.0).contains(&p.y);
            if inside(&a) && inside(&b) && (a - b).norm() > 20.0 {
                bundle.push(LineSegment {
                    from: moved(a, sigma, &mut random),
                    to: moved(b, sigma, &mut random),
                });
            }
        }
        bundle
    })
}

/// Root mean square.
fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let values: Vec<_> = values.collect();
    (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt()
}

/// What a thousand noisy sights scatter is what the deviation says.
#[test]
fn a_sighting_knows_its_deviation() {
    let mut random = Random::new(7);
    let ends = [Point2::new(100.0, 200.0), Point2::new(130.0, 260.0)];
    let truth = Sighting::of_length(&with_lens(), &ends, 0.5, 0.3).expect("a distance");
    let scatter = rms((0..1000).map(|_| {
        let seen = ends.map(|end| moved(end, 0.3, &mut random));
        Sighting::of_length(&with_lens(), &seen, 0.5, 0.3).expect("a distance").distance_m - truth.distance_m
    }));
    assert!((0.93..1.07).contains(&(scatter / truth.sigma_m)), "{scatter} beside {}", truth.sigma_m);
    let truth = Sighting::of_ball(&with_lens(), &ends, 0.5, 0.3).expect("a distance");
    let scatter = rms((0..1000).map(|_| {
        let seen = ends.map(|end| moved(end, 0.3, &mut random));
        Sighting::of_ball(&with_lens(), &seen, 0.5, 0.3).expect("a distance").distance_m - truth.distance_m
    }));
    assert!((0.93..1.07).contains(&(scatter / truth.sigma_m)), "{scatter} beside {}", truth.sigma_m);
}

/// A tilted mark with noise: the true pose is among the two, and is the better one where the picture tells.
#[test]
fn two_poses_of_a_noisy_mark() {
    let mark = SquareMark::new(0.2).expect("a mark");
    let (mut found, mut sure, mut right) = (0, 0, 0);
    for seed in 0..400 {
        let mut random = Random::new(seed);
        let tilt = Vector3::new(random.unit() - 0.5, random.unit() - 0.5, random.unit() - 0.5).normalize();
        let (x, z) = (0.4 * random.unit() - 0.2, 0.6 + 1.4 * random.unit());
        let pose = Pose::new(rotation(tilt * 0.6), Vector3::new(x, -0.1, z)).expect("a pose");
        let corners =
            mark.corners().map(|corner| moved(project(&camera(), pose.transform(&corner)), 0.3, &mut random));
        let poses = mark.locate(&camera(), &corners).expect("a pose");
        let near = |found: &Pose<f64>| apart(found.rotation(), pose.rotation()) < 0.12;
        found += usize::from(near(&poses.best.pose) || poses.other.is_some_and(|other| near(&other.pose)));
        if poses.ambiguity() < 0.2 {
            sure += 1;
            right += usize::from(near(&poses.best.pose));
        }
        assert!((poses.best.pose.translation().z / z - 1.0).abs() < 0.05);
    }
    assert!(found >= 380, "{found} of 400");
    assert!(sure >= 100 && right * 100 >= sure * 98, "{right} of {sure}");
}

/// What 200 noisy rooms scatter is what the deviations say.
#[test]
fn walls_know_their_deviation() {
    let truth = rotation(Vector3::new(0.1, 0.2, 0.05))
        * rotation(Vector3::new(0.6, 0.0, 0.0))
        * rotation(Vector3::y() * 0.7);
    let sigma = 0.5;
    let (mut turns, mut focals) = (Vec::new(), Vec::new());
    for seed in 0..200 {
        let bundles = room(&square(), &truth, sigma, seed);
        let of = [&bundles[0][..], &bundles[1], &bundles[2]];
        let walls = ManhattanFrame::orientation(&square(), of, &truth).expect("an orientation");
        let turn = Rotation3::from_matrix_unchecked(walls.rotation * truth.transpose()).scaled_axis();
        turns.extend(
            turn.iter().zip(&walls.sigma_rad_per_px).map(|(turn, deviation)| turn / (deviation * sigma)),
        );
        let walls = ManhattanFrame::orientation_and_focal(&Point2::new(320.0, 240.0), of, &truth)
            .expect("an orientation");
        focals.push((walls.focal_px - 600.0) / (walls.focal_sigma_per_px * sigma));
    }
    let (turns, focals) = (rms(turns.into_iter()), rms(focals.into_iter()));
    assert!((0.85..1.15).contains(&turns), "{turns}");
    assert!((0.85..1.15).contains(&focals), "{focals}");
}

#[test]
fn walls_that_say_nothing_are_refused() {
    let truth = rotation(Vector3::new(0.3, 0.4, 0.0));
    let bundles = room(&square(), &truth, 0.0, 1);
    let (a, b) = (&bundles[0][..], &bundles[1][..]);
    let of = |bundles| ManhattanFrame::orientation(&square(), bundles, &truth);
    assert_eq!(of([a, &[], &[]]), Err(ManhattanFrameError::TooFew));
    assert_eq!(of([a, a, &[]]), Err(ManhattanFrameError::NotOrthogonal));
    assert!(of([a, b, &[]]).is_ok());
    let line = [a[0], LineSegment { from: a[0].to, to: a[0].to + (a[0].to - a[0].from) }];
    assert_eq!(of([&line, b, &[]]), Err(ManhattanFrameError::Line));
    let nan = [LineSegment::new((f64::NAN, 0.0), (1.0, 1.0)), a[0]];
    assert_eq!(of([&nan, b, &[]]), Err(ManhattanFrameError::NotFinite));
    // Right before a wall: two directions are parallel to the image, and the third is with each of them.
    let bundles = room(&square(), &Matrix3::identity(), 0.0, 1);
    let of = [&bundles[0][..], &bundles[1], &bundles[2]];
    let focal = ManhattanFrame::orientation_and_focal(&Point2::new(320.0, 240.0), of, &Matrix3::identity());
    assert_eq!(focal, Err(ManhattanFrameError::Focal));
    let known = ManhattanFrame::orientation(&square(), of, &Matrix3::identity()).expect("an orientation");
    assert!(apart(&known.rotation, &Matrix3::identity()) < 1e-8);
}

/// The same in the numbers that cores have hardware for.
#[test]
fn single_precision() {
    let camera = Camera::new(600.0_f32, 600.0, 320.0, 240.0).expect("a camera");
    let turn = Rotation3::new(Vector3::new(0.5_f32, 0.3, 0.1));
    let pose = Pose::new(*turn.matrix(), Vector3::new(0.2, -0.1, 1.5)).expect("a pose");
    let mark = SquareMark::new(0.3_f32).expect("a mark");
    let corners = mark.corners().map(|corner| camera.project(&pose.transform(&corner)).expect("in front"));
    let best = mark.locate(&camera, &corners).expect("a pose").best;
    assert!(best.rms_px < 1e-3, "{best:?}");
    assert!((best.pose.rotation() - pose.rotation()).amax() < 2e-4, "{best:?}");
    assert!((best.pose.translation() - pose.translation()).amax() < 2e-4, "{best:?}");

    let truth = rotation(Vector3::new(0.6, 0.0, 0.0)) * rotation(Vector3::new(0.0, 0.7, 0.0));
    let bundles = room(&square(), &truth, 0.0, 3);
    let narrow = |p: Point2<f64>| (p.x as f32, p.y as f32);
    let bundles =
        bundles.map(|b| b.iter().map(|s| LineSegment::new(narrow(s.from), narrow(s.to))).collect::<Vec<_>>());
    let expected = truth.map(|x| x as f32);
    let of = [&bundles[0][..], &bundles[1], &bundles[2]];
    let walls = ManhattanFrame::orientation_and_focal(&Point2::new(320.0, 240.0), of, &expected)
        .expect("an orientation");
    assert!((walls.rotation - expected).amax() < 1e-4 && (walls.focal_px - 600.0).abs() < 0.1, "{walls:?}");
}

#[test]
fn a_mark_seen_from_behind_is_refused() {
    let mark = SquareMark::new(0.2).expect("a mark");
    let pose = Pose::new(rotation(Vector3::new(0.0, 2.6, 0.0)), Vector3::new(0.0, 0.0, 1.0)).expect("a pose");
    let corners = mark.corners().map(|corner| project(&camera(), pose.transform(&corner)));
    assert_eq!(mark.locate(&camera(), &corners), Err(SquareMarkError::Mirrored));
}
