//! The ray-traced scenes against themselves and against analytic geometry.
//!
//! The figures are printed: `cargo test --test harness scene -- --nocapture`.

use image::GrayImage;
use nalgebra::{Matrix3, Point3, Rotation3, Vector3};
use stereopsis::geometry::camera::{Pose, RectifiedRig};
use stereopsis_host::scene::{Object, Scene, Shape, Texture, Truth};

type Pair = (GrayImage, GrayImage);

/// Left minus right at these disparities, grey levels, for every point that both see.
fn differences((left, right): &Pair, truth: &Truth) -> Vec<f64> {
    let pixels =
        truth.disparity.iter().zip(&truth.occluded).enumerate().filter(|(_, (_, occluded))| !**occluded);
    pixels
        .filter_map(|(i, (&disparity, _))| {
            let (x, y) = ((i % truth.width) as u32, (i / truth.width) as u32);
            let column = f64::from(x) - f64::from(disparity);
            if column < 0.0 || column + 1.0 > f64::from(right.width() - 1) {
                return None;
            }
            let at = |x: u32| f64::from(right.get_pixel(x, y).0[0]);
            let t = column.fract();
            let seen = at(column as u32) * (1.0 - t) + at(column as u32 + 1) * t;
            Some(f64::from(left.get_pixel(x, y).0[0]) - seen)
        })
        .collect()
}

fn rms(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let count = values.clone().count() as f64;
    (values.map(|v| v * v).sum::<f64>() / count).sqrt()
}

/// A share in percent.
fn percent(part: usize, whole: usize) -> f64 {
    100.0 * part as f64 / whole as f64
}

#[test]
fn a_camera_elsewhere_sees_what_the_right_one_sees() {
    let scene = Scene::small(160, 120).with_noise(0.0, 1);
    let beside = Vector3::new(f64::from(scene.rig().baseline_m()), 0.0, 0.0);
    let pose = Pose::new(Matrix3::identity(), beside).expect("a rotation");
    let (seen, right) = (scene.seen_from(&pose).render().0, scene.render().1);
    // Rounding turns a grey level here and there.
    let most = seen.pixels().zip(right.pixels()).map(|(a, b)| a.0[0].abs_diff(b.0[0])).max();
    let other = seen.pixels().zip(right.pixels()).filter(|(a, b)| a != b).count();
    assert!(most <= Some(1) && other < 200, "{other} pixels differ, by up to {most:?}");
    // A camera turned by half a turn about its axis sees the scene upside down.
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), core::f64::consts::PI);
    let turned =
        scene.seen_from(&Pose::new(*turn.matrix(), Vector3::zeros()).expect("a rotation")).render().0;
    let (back, left) = (image::imageops::rotate180(&turned), scene.render().0);
    let differing = back.pixels().zip(left.pixels()).filter(|(a, b)| a.0[0].abs_diff(b.0[0]) > 1);
    assert!(differing.count() < 200);
}

#[test]
fn both_pictures_show_the_same_points_at_their_true_places() {
    for (name, scene) in [("demo", Scene::small(320, 240)), ("slanted plane", Scene::slanted_plane())] {
        let (truth, clean) = (scene.truth(), scene.clone().with_noise(0.0, 1).render());
        let quiet = differences(&clean, &truth);
        let near = quiet.iter().filter(|d| d.abs() <= 12.0).count();
        let (quiet_rms, noisy_rms) =
            (rms(quiet.iter().copied()), rms(differences(&scene.render(), &truth).into_iter()));
        // The same comparison one pixel off is far worse: the truth is where the pictures agree.
        let mut shifted = truth.clone();
        shifted.disparity.iter_mut().for_each(|d| *d += 1.0);
        let shifted_rms = rms(differences(&clean, &shifted).into_iter());
        println!(
            "{name}: left - right(x - d): RMS {quiet_rms:.2} without noise, {noisy_rms:.2} with; one px off \
             {shifted_rms:.2}; within 12: {:.2} %",
            percent(near, quiet.len())
        );
        // What remains is interpolation between pixels and the outlines of the bodies.
        assert!(percent(near, quiet.len()) > 97.0, "{name}");
        assert!(shifted_rms > 2.5 * quiet_rms, "{name}");
        assert!(noisy_rms < (quiet_rms * quiet_rms + 2.2).sqrt(), "{name}: the noise is of 1 grey level");
    }
}

#[test]
fn noise_has_the_deviation_asked_for_and_differs_between_the_cameras() {
    let scene = Scene::small(160, 120);
    let (clean_left, clean_right) = scene.clone().with_noise(0.0, 5).render();
    let (left, right) = scene.clone().with_noise(3.0, 5).render();
    let noise = |noisy: &image::GrayImage, clean: &image::GrayImage| -> Vec<f64> {
        // Pixels that noise cannot push out of range.
        let inside = |c: &u8| (20..=235).contains(c);
        let pairs = noisy.as_raw().iter().zip(clean.as_raw());
        pairs.map(|(&n, c)| if inside(c) { f64::from(n) - f64::from(*c) } else { 0.0 }).collect()
    };
    let (in_left, in_right) = (noise(&left, &clean_left), noise(&right, &clean_right));
    for samples in [&in_left, &in_right] {
        let some = samples.iter().copied().filter(|&v| v != 0.0);
        assert!((2.7..3.5).contains(&rms(some.clone())), "{}", rms(some));
    }
    let product: f64 = in_left.iter().zip(&in_right).map(|(a, b)| a * b).sum::<f64>() / in_left.len() as f64;
    assert!(product.abs() < 0.3, "the two cameras' noise is independent: {product}");
    assert_eq!(scene.clone().with_noise(3.0, 5).render(), (left.clone(), right), "a seed gives one picture");
    assert_ne!(scene.with_noise(3.0, 6).render().0, left);
}

fn rig() -> RectifiedRig {
    RectifiedRig::with_offset(300.0, 0.1, 80.0, 60.0, 84.0).expect("the numbers are in range")
}

#[test]
fn the_depth_of_a_plane_is_the_analytic_one() {
    let (normal, distance) = (Vector3::new(0.3, -0.2, 1.0), 2.0);
    let point = Point3::from(normal * (distance / normal.norm_squared()));
    let truth =
        Scene::new(rig(), 161, 121, 64).with(Object::plane(point, normal, Texture::flat(0.5))).truth();
    for (i, (&z, &d)) in truth.depth_m.iter().zip(&truth.disparity).enumerate() {
        let (u, v) = ((i % 161) as f64, (i / 161) as f64);
        // n P = distance on the plane, with P = Z ((u - cx) / f, (v - cy) / f, 1).
        let expected = distance / (0.3 * (u - 80.0) / 300.0 - 0.2 * (v - 60.0) / 300.0 + 1.0);
        assert!((f64::from(z) - expected).abs() < 1e-6 * expected, "({u}, {v}): {z}, {expected}");
        assert!((f64::from(d) - (30.0 / expected - 4.0)).abs() < 1e-4, "({u}, {v}): {d}");
        // Nothing hides a point of a single plane: the right camera misses what falls off its picture.
        let column = u - f64::from(d);
        if column.abs() > 1e-4 {
            assert_eq!(truth.occluded[i], !(0.0..=160.0).contains(&column), "({u}, {v})");
        }
    }
}

#[test]
fn the_slanted_plane_has_the_disparity_that_it_says() {
    let truth = Scene::slanted_plane().truth();
    for (i, &d) in truth.disparity.iter().enumerate() {
        let (u, v) = ((i % truth.width) as f64, (i / truth.width) as f64);
        let expected = 26.0 + 0.06 * (u - 159.5) + 0.02 * (v - 119.5);
        assert!((f64::from(d) - expected).abs() < 1e-4, "({u}, {v}): {d}, {expected}");
    }
}

/// Depths of one body in front of nothing.
fn depths(shape: Shape, position: Point3<f64>, rotation: Rotation3<f64>) -> Vec<(Vector3<f64>, f64)> {
    let body = Object::new(shape, Texture::flat(0.5), position).turned(rotation);
    let truth = Scene::new(rig(), 161, 121, 64).with(body).truth();
    let ray =
        |i: usize| Vector3::new(((i % 161) as f64 - 80.0) / 300.0, ((i / 161) as f64 - 60.0) / 300.0, 1.0);
    truth.depth_m.iter().enumerate().map(|(i, &z)| (ray(i), f64::from(z))).collect()
}

#[test]
fn the_depth_of_a_sphere_is_the_analytic_one() {
    let (centre, radius) = (Point3::new(0.1, -0.05, 2.0), 0.3);
    let mut hits = 0;
    for (ray, z) in depths(Shape::Sphere { radius }, centre, Rotation3::identity()) {
        // The ray passes the centre at this distance; half a chord before that point lies the surface.
        let along = ray.normalize();
        let foot = along.dot(&centre.coords);
        let off = (centre.coords - along * foot).norm();
        if off > radius {
            assert_eq!(z, f64::INFINITY);
            continue;
        }
        hits += 1;
        let expected = (along * (foot - (radius * radius - off * off).sqrt())).z;
        assert!((z - expected).abs() < 1e-6, "{z}, {expected}");
    }
    // About pi (r f / Z)^2 pixels.
    assert!((6200..6800).contains(&hits), "{hits}");
}

#[test]
fn boxes_and_bars_are_as_large_as_they_say() {
    let centre = Point3::new(0.0, 0.0, 2.0);
    let turn = Rotation3::from_euler_angles(0.4, 0.6, 0.2);
    let half = Vector3::new(0.2, 0.1, 0.15);
    let bar = Shape::Cylinder { radius: 0.1, half_height: 0.25 };
    for (shape, rotation) in [
        (Shape::Cuboid { half }, Rotation3::identity()),
        (Shape::Cuboid { half }, turn),
        (bar.clone(), turn),
        (bar, Rotation3::identity()),
        (Shape::Rectangle { half_width: 0.2, half_height: 0.15 }, turn),
    ] {
        let mut hits = 0;
        for (ray, z) in depths(shape.clone(), centre, rotation).into_iter().filter(|(_, z)| z.is_finite()) {
            hits += 1;
            let p = rotation.inverse() * (ray * z - centre.coords);
            // On the surface: one of the coordinates is at its limit, and none is beyond.
            let off = match shape {
                Shape::Cuboid { half } => p.abs().component_div(&half).max() - 1.0,
                Shape::Cylinder { radius, half_height } => {
                    (p.xz().norm() / radius).max(p.y.abs() / half_height) - 1.0
                }
                _ => p.z + ((p.x.abs() / 0.2).max(p.y.abs() / 0.15) - 1.0).max(0.0),
            };
            assert!(off.abs() < 1e-5, "{shape:?}: {p}");
            // The near side: a step towards the camera leaves the body.
            let nearer = rotation.inverse() * (ray * (z - 0.001) - centre.coords);
            let inside = match shape {
                Shape::Cuboid { half } => nearer.abs().component_div(&half).max() < 1.0,
                Shape::Cylinder { radius, half_height } => {
                    nearer.xz().norm() < radius && nearer.y.abs() < half_height
                }
                _ => false,
            };
            assert!(!inside, "{shape:?}");
        }
        assert!(hits > 500, "{shape:?}: {hits}");
    }
}

#[test]
fn a_body_hides_a_strip_as_wide_as_the_step_in_disparity() {
    let wall = Object::plane(Point3::new(0.0, 0.0, 2.0), Vector3::z(), Texture::flat(0.5));
    let card = Object::new(
        Shape::Rectangle { half_width: 0.0501, half_height: 0.05 },
        Texture::flat(0.5),
        Point3::new(0.0, 0.0, 1.0),
    );
    let rig = RectifiedRig::new(300.0, 0.1, 80.0, 60.0).expect("the numbers are in range");
    let truth = Scene::new(rig, 161, 121, 64).with(wall).with(card).truth();
    let row = 60 * 161..61 * 161;
    // The card covers columns 65 to 95 with 30 px of disparity, the wall has 15: 15 px left of the card are
    // hidden, and the first 15 columns fall off the right picture.
    for (x, (&d, &occluded)) in truth.disparity[row.clone()].iter().zip(&truth.occluded[row]).enumerate() {
        let expected = if (65..=95).contains(&x) { 30.0 } else { 15.0 };
        assert!((d - expected).abs() < 1e-5, "column {x}: {d}");
        assert_eq!(occluded, x < 15 || (50..65).contains(&x), "column {x}");
    }
}
