//! Two views, and shapes that are known.

use super::{CASES, Numbers, finite, is_pose, is_rotation, is_unit};
use nalgebra::{Matrix3, Point2, Vector3};
use stereopsis::geometry::Real;
use stereopsis::geometry::camera::Pose;
use stereopsis::geometry::known_shape::{LineSegment, ManhattanFrame, Sighting, SquareMark, VanishingPoint};
use stereopsis::geometry::two_view::{
    Correspondence, Essential, Fundamental, Homography, Line, TwoViews, eight_point,
};

fn triangulation_is_sound<T: Real>(n: &mut Numbers, seed: u64) -> bool {
    let (first, second) = (n.camera::<T>(), n.camera::<T>());
    let pose = if seed.is_multiple_of(3) {
        Pose::new(Matrix3::identity(), Vector3::new(T::of(0.2), T::ZERO, T::ZERO)).expect("a pose")
    } else {
        n.pose()
    };
    let Ok(views) = TwoViews::new(first, second, pose) else { return false };
    assert!((views.fundamental().matrix().norm() - T::ONE).abs() < T::of(1e-3), "{seed}");
    let mut seen = Correspondence { first: n.pixel(), second: n.pixel() };
    let point = n.point();
    if let (0, Ok(p), Ok(q)) =
        (seed % 4, first.project(&point), second.project(&pose.inverse_transform(&point)))
    {
        seen = Correspondence { first: p, second: q };
    }
    let all = [views.midpoint(&seen), views.linear(&seen), views.optimal(&seen)];
    for found in all.iter().flatten() {
        assert!(finite(found.point.coords.as_slice()), "{seed}: {found:?}");
        assert!(found.residual_px.is_finite() && found.angle_rad.is_finite(), "{seed}: {found:?}");
        assert!(found.point.z > T::ZERO && found.angle_rad > T::ZERO, "{seed}: {found:?}");
    }
    all.iter().any(Result::is_ok)
}
check!(triangulated_points_are_in_front, triangulation_is_sound);

fn two_view_is_sound<T: Real>(n: &mut Numbers, seed: u64) -> bool {
    let seen: Vec<_> = (0..9).map(|_| Correspondence { first: n.pixel::<T>(), second: n.pixel() }).collect();
    let matrix = n.matrix::<T>();
    let place = n.pixel();
    let fundamental = Fundamental::from_matrix(&matrix);
    for found in [fundamental.ok(), eight_point(&seen).ok()].into_iter().flatten() {
        assert!((found.matrix().norm() - T::ONE).abs() < T::of(1e-3), "{seed}: {found:?}");
        let lines = [found.line_in_first(&place), found.line_in_second(&place), Line::new(&n.vector())];
        for line in lines.into_iter().flatten() {
            assert!(finite(line.coefficients().as_slice()), "{seed}: {line:?}");
        }
        for epipole in [found.epipole_in_first(), found.epipole_in_second()] {
            assert!(finite(epipole.homogeneous().as_slice()), "{seed}");
            assert!(epipole.pixel().is_none_or(|p| finite(p.coords.as_slice())), "{seed}");
        }
    }
    if let Ok(found) = Essential::nearest(&matrix) {
        let poses = found.poses();
        let are_sound =
            poses.iter().all(|p| is_rotation(p.rotation()) && is_unit(&p.direction().into_inner()));
        assert!(are_sound, "{seed}: {found:?} {poses:?}");
    }
    fundamental.is_ok()
}
check!(matrices_of_two_views_are_of_size_one, two_view_is_sound);

fn homography_is_sound<T: Real>(n: &mut Numbers, seed: u64) -> bool {
    let seen: Vec<_> = (0..5).map(|_| Correspondence { first: n.pixel::<T>(), second: n.pixel() }).collect();
    let homographies = [
        Homography::from_matrix(&n.matrix()),
        Homography::from_correspondences(&seen),
        Homography::from_correspondences(&seen[..4]),
        Homography::from_plane(&n.pose(), &n.camera(), &n.camera(), &n.vector(), n.next()),
    ];
    for found in homographies.iter().flatten() {
        assert!((found.matrix().norm() - T::ONE).abs() < T::of(1e-3), "{seed}: {found:?}");
        assert!((found.inverse().matrix().norm() - T::ONE).abs() < T::of(1e-3), "{seed}: {found:?}");
        for place in [found.to_first(&n.pixel()), found.to_second(&n.pixel())].into_iter().flatten() {
            assert!(finite(place.coords.as_slice()), "{seed}: {found:?}");
        }
        for motion in found.motions(&n.camera(), &n.camera()).iter().flatten() {
            assert!(is_rotation(motion.rotation()) && is_unit(motion.normal()), "{seed}: {motion:?}");
            assert!(finite(motion.translation_per_distance().as_slice()), "{seed}: {motion:?}");
        }
    }
    homographies[0].is_ok()
}
check!(homographies_are_of_size_one, homography_is_sound);

fn known_shape_is_sound<T: Real>(n: &mut Numbers, seed: u64) -> bool {
    let camera = n.camera::<T>();
    let ends = [n.pixel(), n.pixel()];
    let (size, sigma) = (n.half_sane::<T>(1.0, 0.5), n.half_sane(0.5, 0.5));
    let sightings =
        [Sighting::of_length(&camera, &ends, size, sigma), Sighting::of_ball(&camera, &ends, size, sigma)];
    for seen in sightings.iter().flatten() {
        assert!(
            seen.distance_m > T::ZERO && finite(&[seen.distance_m, seen.sigma_m, seen.angle_rad]),
            "{seed}"
        );
        assert!(
            is_unit(&seen.bearing.into_inner()) && finite(seen.point().coords.as_slice()),
            "{seed}: {seen:?}"
        );
    }
    let corners = if seed.is_multiple_of(2) {
        core::array::from_fn(|_| n.pixel())
    } else {
        // A square, of any size at any place.
        let (u, v, side) =
            (n.half_sane::<T>(300.0, 90.0), n.half_sane::<T>(200.0, 90.0), n.half_sane(40.0, 30.0));
        [(u, v), (u + side, v), (u + side, v + side), (u, v + side)].map(|(u, v)| Point2::new(u, v))
    };
    let found = SquareMark::new(size).and_then(|mark| mark.locate(&camera, &corners));
    if let Ok(found) = &found {
        for one in [Some(&found.best), found.other.as_ref()].into_iter().flatten() {
            assert!(is_pose(&one.pose) && one.rms_px.is_finite(), "{seed}: {one:?}");
        }
        assert!(found.ambiguity().is_finite(), "{seed}: {found:?}");
    }
    sightings[0].is_ok() && found.is_ok()
}
check!(known_shapes_have_places_that_are_numbers, known_shape_is_sound);

fn vanishing_is_sound<T: Real>(n: &mut Numbers, seed: u64) -> bool {
    let mut segments = || -> Vec<LineSegment<T>> {
        (0..3).map(|_| LineSegment { from: n.pixel(), to: n.pixel() }).collect()
    };
    let [a, b, c] = [segments(), segments(), segments()];
    let point = VanishingPoint::of(&a);
    if let Ok(point) = &point {
        assert!(is_unit(point.homogeneous()) && point.rms_px().is_finite(), "{seed}: {a:?} {point:?}");
        assert!(point.pixel().is_none_or(|p| finite(p.coords.as_slice())), "{seed}: {point:?}");
    }
    let (camera, bundles) = (n.camera::<T>(), [&a[..], &b[..], &c[..]]);
    let frames = [
        ManhattanFrame::orientation(&camera, bundles, &Matrix3::identity()),
        ManhattanFrame::orientation_and_focal(&n.pixel(), bundles, &Matrix3::identity()),
    ];
    for frame in frames.iter().flatten() {
        let numbers = [frame.focal_px, frame.rms_px, frame.focal_sigma_per_px];
        assert!(is_rotation(&frame.rotation) && finite(&numbers), "{seed}: {frame:?}");
        assert!(finite(frame.sigma_rad_per_px.as_slice()), "{seed}: {frame:?}");
    }
    point.is_ok()
}
check!(vanishing_points_are_of_length_one, vanishing_is_sound);
