//! The essential and the fundamental matrix of known cameras.

use crate::views::{Views, any_pose, seeded};
use nalgebra::Vector3;
use proptest::prelude::*;
use stereopsis::geometry::{
    camera::Camera,
    two_view::{Correspondence, Essential, Fundamental},
};

proptest! {
    #![proptest_config(seeded())]

    #[test]
    fn singular_values_of_e_are_s_s_0(pose in any_pose()) {
        let e = Essential::from_pose(&pose).expect("a baseline");
        let mut values = e.matrix().singular_values();
        values.as_mut_slice().sort_by(f64::total_cmp);
        prop_assert!((values - Vector3::new(0.0, 1.0, 1.0)).amax() < 1e-12, "{values}");
        // [t]x R, but for its scale.
        let plain = pose.translation().cross_matrix() * pose.rotation() / pose.translation().norm();
        prop_assert!((e.matrix() - plain).amax() < 1e-14);
    }

    #[test]
    fn the_epipoles_are_null_vectors(pose in any_pose(), f in 100.0..2000.0_f64) {
        let camera = Camera::new(f, f * 1.1, 320.0, 240.0).expect("a camera");
        let f = Fundamental::from_cameras(&pose, &camera, &camera).expect("a baseline");
        prop_assert!((f.matrix() * f.epipole_in_second().homogeneous()).amax() < 1e-12);
        prop_assert!((f.matrix().tr_mul(f.epipole_in_first().homogeneous())).amax() < 1e-12);
        // e is where camera 1 sees the centre of camera 2, in front of it or behind.
        let seen = camera.matrix() * pose.translation();
        prop_assert!(seen.normalize().cross(f.epipole_in_first().homogeneous()).norm() < 1e-9);
        // E comes back from F.
        let back = Essential::from_fundamental(&f, &camera, &camera).expect("rank 2");
        let e = Essential::from_pose(&pose).expect("a baseline");
        let off = (back.matrix() - e.matrix()).amax().min((back.matrix() + e.matrix()).amax());
        prop_assert!(off < 1e-9, "{off}");
    }

    #[test]
    fn lines_meet_the_points_they_belong_to(seed in any::<u64>()) {
        let views = Views::scene(seed, 20);
        let f = views.fundamental();
        for (seen, point) in views.seen.iter().zip(&views.points) {
            let (l, l2) = (f.line_in_first(&seen.second), f.line_in_second(&seen.first));
            prop_assert!(l.expect("no epipole").distance_px(&seen.first).abs() < 1e-9);
            prop_assert!(l2.expect("no epipole").distance_px(&seen.second).abs() < 1e-9);
            // What is elsewhere on the sight is on the same line.
            let farther = views.pose.inverse_transform(&(point * 3.0));
            let there = views.camera.project(&farther).expect("it is in front");
            prop_assert!(l2.expect("no epipole").distance_px(&there).abs() < 1e-9);
        }
    }

    #[test]
    fn opencv_writes_the_transpose(pose in any_pose()) {
        let camera = Camera::new(500.0, 500.0, 320.0, 240.0).expect("a camera");
        let f = Fundamental::from_cameras(&pose, &camera, &camera).expect("a baseline");
        let again = Fundamental::from_opencv(&f.to_opencv()).expect("rank 2");
        prop_assert!((again.matrix() - f.matrix()).amax() < 1e-12);
        // OpenCV: E = [T]x R with P' = R P + T.
        let (r, t) = pose.to_opencv();
        let theirs = t.cross_matrix() * r / t.norm();
        let ours = Essential::from_pose(&pose).expect("a baseline").to_opencv();
        prop_assert!((theirs - ours).amax().min((theirs + ours).amax()) < 1e-12);
    }

    #[test]
    fn distances_do_not_depend_on_which_image_is_first(seed in any::<u64>(), u in 0.0..640.0,
        v in 0.0..480.0) {
        let f = Views::scene(seed, 1).fundamental();
        let seen = Correspondence::new(u, v, 640.0 - u, v + 3.0);
        let (a, b) = (f.sampson_px(&seen), f.swapped().sampson_px(&seen.swapped()));
        prop_assert!((a - b).abs() < 1e-9);
        prop_assert!((f.sampson_squared_px2(&seen) - a * a).abs() < 1e-9 * (1.0 + a * a));
        let (d, d2) = f.line_distances_px(&seen);
        prop_assert!(a.abs() <= d.min(d2) + 1e-12, "the nearest pair is no farther than a line");
        prop_assert!((f.symmetric_squared_px2(&seen) - d * d - d2 * d2)
            .abs() < 1e-9 * (1.0 + d * d + d2 * d2));
    }
}

#[test]
fn single_precision_keeps_a_matrix_to_thousandths_of_a_pixel() {
    let (mut squared, mut largest, mut count) = (0.0, 0.0_f32, 0.0);
    for seed in 0..100 {
        let views = Views::scene(seed, 50);
        let single =
            Fundamental::from_matrix(&views.fundamental().matrix().map(|x| x as f32)).expect("rank 2");
        for seen in crate::views::narrow(&views.seen) {
            let off = single.sampson_px(&seen).abs();
            (squared, largest, count) = (squared + off * off, largest.max(off), count + 1.0);
        }
    }
    let rms = (squared / count).sqrt();
    assert!(rms < 5e-4 && largest < 5e-3, "{rms} px, at most {largest} px");
}
