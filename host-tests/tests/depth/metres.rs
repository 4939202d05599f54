//! Disparity to depth against the same equations in f64, over all disparities and many rigs.

use nalgebra::Vector4;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use stereopsis::depth::{DepthError, DepthScale, DepthTable, TableError};
use stereopsis::geometry::camera::{RectifiedRig, RigError};
use stereopsis::matching::{Block, Config};
use stereopsis::units::{Disparity, Metres, Millimetres};

fn rig(focal_px: f32, baseline_m: f32, doffs_px: f32) -> RectifiedRig {
    RectifiedRig::with_offset(focal_px, baseline_m, 320.0, 240.0, 320.0 + doffs_px)
        .expect("the numbers are in range")
}

/// The rig's numbers as f64: f b (px m) and doffs (px), exactly as the rig holds them.
fn numbers(rig: &RectifiedRig) -> (f64, f64) {
    (f64::from(rig.focal_px()) * f64::from(rig.baseline_m()), f64::from(rig.disparity_offset_px()))
}

fn every_answer() -> impl Iterator<Item = Disparity> {
    (0..u16::MAX).map(Disparity::from_raw)
}

fn close(value: f32, expected: f64, relative: f64) -> bool {
    (f64::from(value) - expected).abs() <= relative * expected.abs()
}

#[test]
fn millimetres_are_rounded_to_the_nearest_for_every_disparity() {
    // f b is a whole number of millimetres times steps, so the quotient is exact: 64 px m = 2 048 000 mm
    // steps.
    for (focal, baseline, doffs, product) in [
        (512.0, 0.125, 0, 2_048_000_u64),
        (512.0, 0.125, 3, 2_048_000),
        (1024.0, 0.5, -40, 16_384_000),
        (8.0, 0.25, 0, 64_000),
    ] {
        let scale = DepthScale::new(&rig(focal, baseline, doffs as f32)).expect("the rig has depths");
        for d in every_answer() {
            let shift = i64::from(d.raw()) + 32 * doffs;
            let expected = match u64::try_from(shift) {
                Ok(shift @ 1..) => u16::try_from((2 * product + shift) / (2 * shift)).unwrap_or(0),
                _ => 0,
            };
            assert_eq!(scale.millimetres(d), Millimetres(expected), "{} steps, doffs {doffs}", d.raw());
        }
        assert_eq!(scale.millimetres(Disparity::NONE), Millimetres::NONE);
    }
}

#[test]
fn the_ends_of_the_range_are_no_depth() {
    let scale = DepthScale::new(&rig(512.0, 0.125, 0.0)).expect("the rig has depths");
    // 2 048 000 / 31 is 66 065 mm, beyond; / 32 is 64 m.
    assert_eq!(scale.millimetres(Disparity::from_raw(0)), Millimetres::NONE);
    assert_eq!(scale.millimetres(Disparity::from_raw(31)), Millimetres::NONE);
    assert_eq!(scale.millimetres(Disparity::from_raw(32)), Millimetres(64_000));
    assert_eq!(scale.metres(Disparity::from_raw(0)), None, "at infinity");
    assert_eq!(scale.metres(Disparity::from_raw(16)), Some(Metres(128.0)), "metres reach farther");
    // A rig of 1 mm steps: half a millimetre rounds up to one, less to nothing.
    let tiny = DepthScale::new(&rig(8.0, 0.00390625, 0.0)).expect("the rig has depths");
    assert_eq!(tiny.millimetres(Disparity::from_raw(2000)), Millimetres(1));
    assert_eq!(tiny.millimetres(Disparity::from_raw(2001)), Millimetres::NONE);
    // Behind infinity, and the first step before it.
    let offset = DepthScale::new(&rig(512.0, 0.125, -10.0)).expect("the rig has depths");
    for steps in [0, 100, 319, 320] {
        let d = Disparity::from_raw(steps);
        assert_eq!(offset.millimetres(d), Millimetres::NONE, "{steps}");
        assert_eq!(offset.metres(d), None);
        assert_eq!(offset.sigma(d, 0.1), None);
        assert_eq!(offset.point(0, 0, d), None);
    }
    assert_eq!(offset.metres(Disparity::from_raw(321)), Some(Metres(2048.0)));
    assert_eq!(offset.millimetres(Disparity::from_raw(352)), Millimetres(64_000));
    assert_eq!(offset.metres(Disparity::NONE), None);
    assert_eq!(offset.sigma(Disparity::NONE, 0.1), None);
    assert_eq!(offset.point(1, 2, Disparity::NONE), None);
}

#[test]
fn rigs_without_depths_are_refused() {
    let refused =
        |focal, baseline, doffs| DepthScale::new(&rig(focal, baseline, doffs)).expect_err("out of range");
    assert_eq!(refused(1e6, 1.0, 0.0), DepthError::TooLarge);
    assert_eq!(refused(1e-3, 1e-3, 0.0), DepthError::TooSmall);
    assert_eq!(refused(500.0, 0.1, 31_000.0), DepthError::Offset);
    assert_eq!(refused(500.0, 0.1, -31_000.0), DepthError::Offset);
    // Just inside the documented limits.
    for (focal, baseline, doffs) in [(134_000.0, 1.0, 0.0), (0.0157, 0.001, 0.0), (500.0, 0.1, -30_000.0)] {
        assert!(DepthScale::new(&rig(focal, baseline, doffs)).is_ok(), "{focal} {baseline} {doffs}");
    }
    assert_eq!(RectifiedRig::new(0.0, 0.1, 0.0, 0.0), Err(RigError::FocalLength));
    assert_eq!(RectifiedRig::new(-5.0, 0.1, 0.0, 0.0), Err(RigError::FocalLength));
    assert_eq!(RectifiedRig::new(500.0, 0.0, 0.0, 0.0), Err(RigError::Baseline));
    for bad in [f32::NAN, f32::INFINITY] {
        assert_eq!(RectifiedRig::new(bad, 0.1, 0.0, 0.0), Err(RigError::NotFinite));
        assert_eq!(RectifiedRig::new(500.0, bad, 0.0, 0.0), Err(RigError::NotFinite));
        assert_eq!(RectifiedRig::new(500.0, 0.1, bad, 0.0), Err(RigError::NotFinite));
        assert_eq!(RectifiedRig::with_offset(500.0, 0.1, 0.0, 0.0, bad), Err(RigError::NotFinite));
    }
}

#[test]
fn the_range_is_the_depth_at_its_ends() {
    let rig = rig(500.0, 0.08, 0.0);
    let scale = DepthScale::new(&rig).expect("the rig has depths");
    let range = scale
        .range(&Config::for_method::<Block>(640, 480, 64), 0.15)
        .expect("the range is before the camera");
    // Disparity 63 is the ceiling, so 62 is the largest that is believed; the search begins at infinity.
    assert!(close(range.nearest.0, 40.0 / 62.0, 1e-6));
    assert!(close(range.farthest.0, 40.0, 1e-6), "one pixel of parallax");
    assert!(close(range.sigma_nearest.0, (40.0 / 62.0_f64).powi(2) / 40.0 * 0.15, 1e-6));
    assert!(close(range.sigma_farthest.0, 40.0 * 0.15, 1e-6));
    // From disparity 20 on, the far end is at 20.
    let config = Config { min_disparity: 20, ..Config::for_method::<Block>(640, 480, 32) };
    let range = scale.range(&config, 0.15).expect("the range is before the camera");
    assert!(close(range.nearest.0, 40.0 / 50.0, 1e-6) && close(range.farthest.0, 2.0, 1e-6));
    assert!(range.nearest.0 < range.farthest.0 && range.sigma_nearest.0 < range.sigma_farthest.0);
    // The whole search at or behind infinity.
    let behind = DepthScale::new(&self::rig(500.0, 0.08, -62.0)).expect("the rig has depths");
    assert!(behind.range(&Config::for_method::<Block>(640, 480, 64), 0.15).is_none());
}

#[test]
fn q_is_opencvs() {
    // stereoRectify: Q = [1 0 0 -cx; 0 1 0 -cy; 0 0 0 f; 0 0 -1/Tx (cx - cx')/Tx] with Tx = -b.
    let (f, b, cx, cy, cx_right) = (700.0, 0.25, 310.5, 255.0, 322.5);
    let rig = RectifiedRig::with_offset(f, b, cx, cy, cx_right).expect("the numbers are in range");
    let tx = -b;
    let expected = [
        [1.0, 0.0, 0.0, -cx],
        [0.0, 1.0, 0.0, -cy],
        [0.0, 0.0, 0.0, f],
        [0.0, 0.0, -1.0 / tx, (cx - cx_right) / tx],
    ];
    let q = rig.q();
    for (row, expected) in expected.iter().enumerate() {
        for (column, expected) in expected.iter().enumerate() {
            assert_eq!(q[(row, column)], *expected, "Q[{row}][{column}]");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 300,
        rng_seed: RngSeed::Fixed(5),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn depths_and_deviations_are_those_of_f64(
        focal in 20.0f32..8000.0, baseline in 0.005f32..3.0, doffs in -100.0f32..100.0,
            sigma_px in 0.01f32..4.0,
    ) {
        let rig = rig(focal, baseline, doffs);
        let scale = DepthScale::new(&rig).expect("the rig has depths");
        let (fb, doffs) = numbers(&rig);
        let mut last = Millimetres::MAX;
        for d in every_answer().step_by(7) {
            let shift = f64::from(d.raw()) / 32.0 + doffs;
            if shift < 0.1 {
                // Near infinity f32 cannot place the answer; behind it there is none.
                prop_assert!(shift > -1e-4 || scale.metres(d).is_none());
                continue;
            }
            let z = fb / shift;
            let depth = scale.metres(d).expect("before infinity").0;
            // The sum d + doffs, the product f b and the quotient are each rounded to 2^-24; the sum's error
            // counts more where the two terms cancel.
            let cancel = (shift + 2.0 * doffs.abs()) / shift;
            let relative = 2f64.powi(-24) * (3.0 + cancel);
            prop_assert!(close(depth, z, relative), "{depth} {z}");
            let sigma = scale.sigma(d, sigma_px).expect("before infinity").0;
            prop_assert!(close(sigma, z * z / fb * f64::from(sigma_px), 2.0 * relative + 3e-7), "{sigma}");

            // Half a millimetre, and what doffs loses in being rounded to 1/32 px.
            let offset_error = z * z / fb / 64.0 * 1.2 * 1000.0;
            let mm = scale.millimetres(d);
            if mm.is_some() {
                let error = (f64::from(mm.0) - z * 1000.0).abs();
                prop_assert!(error <= 0.5 + offset_error + z * 1e-3, "{mm:?} {z}");
                prop_assert!(mm <= last, "a larger disparity is not farther");
                last = mm;
                let metres = mm.to_metres().expect("there is a depth").0;
                prop_assert!(close(metres, f64::from(mm.0) / 1000.0, 1e-6));
            } else {
                let outside = z * 1000.0 > 65_535.0 - offset_error - 66.0 || z * 1000.0 < 0.6;
                prop_assert!(outside, "{z} m has a depth in millimetres");
            }
        }
    }

    /// sigma_Z is the slope of Z over the disparity.
    #[test]
    fn the_deviation_is_the_slope(focal in 100.0f64..2000.0, baseline in 0.02f64..0.5, d in 4u16..200) {
        let rig = rig(focal as f32, baseline as f32, 0.0);
        let scale = DepthScale::new(&rig).expect("the rig has depths");
        let (fb, _) = numbers(&rig);
        let (d0, h) = (f64::from(d), 1e-4);
        let slope = (fb / (d0 - h) - fb / (d0 + h)) / (2.0 * h);
        let sigma = scale.sigma(Disparity::from_pixels(d), 1.0).expect("before infinity").0;
        prop_assert!(close(sigma, slope, 1e-5), "{sigma} {slope}");
    }

    /// A point projects back onto its pixels in both images, and lies where Q puts it.
    #[test]
    fn points_project_back(
        focal in 100.0f32..2000.0, baseline in 0.02f32..0.5, doffs in -8.0f32..50.0, u in 0u16..4096,
            v in 0u16..4096,
        steps in (10u16 * 32)..(500 * 32),
    ) {
        let rig = rig(focal, baseline, doffs);
        let scale = DepthScale::new(&rig).expect("the rig has depths");
        let d = Disparity::from_raw(steps);
        let p = scale.point(u, v, d).expect("before infinity").cast::<f64>();
        let (f, b) = (f64::from(focal), f64::from(rig.baseline_m()));
        let (cx, cy) = rig.principal_point();
        let (cx, cy) = (f64::from(cx), f64::from(cy));
        let pixels = f64::from(steps) / 32.0;
        prop_assert!((f * p.x / p.z + cx - f64::from(u)).abs() < 2e-3);
        prop_assert!((f * p.y / p.z + cy - f64::from(v)).abs() < 2e-3);
        let u_right = f * (p.x - b) / p.z + cx + f64::from(rig.disparity_offset_px());
        prop_assert!((f64::from(u) - u_right - pixels).abs() < 4e-3);
        let z = f64::from(scale.metres(d).expect("before infinity").0);
        prop_assert!((p.z - z).abs() < 1e-6 * z * 10.0);

        let h = rig.q() * Vector4::new(f32::from(u), f32::from(v), pixels as f32, 1.0);
        prop_assert!(close(h.z / h.w, p.z, 1e-6));
        // And the rig's own two directions invert each other.
        let back = rig.disparity_px(rig.depth_m(pixels as f32).expect("before infinity"));
        prop_assert!((f64::from(back) - pixels).abs() < 1e-4 * (1.0 + pixels + doffs.abs() as f64));
    }

    /// A table says what the scale says, for every disparity of the search and none outside of it.
    #[test]
    fn a_table_is_the_scale(focal in 50.0f32..2000.0, doffs in -20.0f32..20.0, first in 0u16..1900,
        count in 16u16..=64) {
        let scale = DepthScale::new(&rig(focal, 0.1, doffs)).expect("the rig has depths");
        let config = Config { min_disparity: first, ..Config::for_method::<Block>(640, 480, count) };
        let table = DepthTable::<{ 64 * 32 + 1 }>::new(&scale, &config).expect("64 disparities fit");
        let last = first + count;
        for raw in 0..=u16::MAX {
            let d = Disparity::from_raw(raw);
            let inside = (first * 32..=last * 32).contains(&raw) && d.is_some();
            let expected = if inside { scale.millimetres(d) } else { Millimetres::NONE };
            prop_assert_eq!(table.millimetres(d), expected, "{} steps", raw);
        }
    }

    #[test]
    fn disparities_keep_what_they_are_given(raw in 0..u16::MAX, other in 0..u16::MAX, pixels: u16) {
        let (d, e) = (Disparity::from_raw(raw), Disparity::from_raw(other));
        prop_assert!(d.is_some() && d.raw() == raw);
        prop_assert_eq!(d.to_f32(), Some(f32::from(raw) / 32.0));
        prop_assert_eq!(d.distance(e), Some(raw.abs_diff(other)));
        prop_assert_eq!(d.distance(Disparity::NONE), None);
        let whole = Disparity::from_pixels(pixels);
        let expected = if pixels <= Disparity::MAX_PIXELS { u32::from(pixels)
            * 32 } else { u32::from(Disparity::MAX.raw()) };
        prop_assert_eq!(u32::from(whole.raw()), expected);
        prop_assert!(whole.is_some());
    }
}

#[test]
fn a_table_that_is_too_small_says_its_size() {
    let scale = DepthScale::new(&rig(500.0, 0.1, 0.0)).expect("the rig has depths");
    let refused =
        DepthTable::<512>::new(&scale, &Config::for_method::<Block>(640, 480, 16)).expect_err("one too few");
    assert_eq!(refused, TableError { needed: 513 });
    assert!(DepthTable::<513>::new(&scale, &Config::for_method::<Block>(640, 480, 16)).is_ok());
    // The search that ends at the largest disparity of all.
    let config = Config { min_disparity: 2032, ..Config::for_method::<Block>(640, 480, 16) };
    let table = DepthTable::<513>::new(&scale, &config).expect("513 are enough");
    assert_eq!(table.millimetres(Disparity::MAX), scale.millimetres(Disparity::MAX));
    assert_eq!(table.millimetres(Disparity::NONE), Millimetres::NONE);
}

#[test]
fn the_field_of_view_is_twice_the_arc_tangent() {
    let rig = RectifiedRig::new(320.0, 0.1, 319.5, 239.5).expect("the numbers are in range");
    assert!((rig.field_of_view_rad(640) - core::f32::consts::FRAC_PI_2).abs() < 1e-6);
}
