//! The thin lens: each way and back, in floats and whole micrometres, and what it refuses.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use stereopsis::focus::{FarLimit, FocusPeak, FocusScale, FocusScaleError, LensError, MicroLens, ThinLens};

const BAD: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

#[test]
fn what_no_lens_does_is_refused_by_name() {
    for bad in BAD {
        assert_eq!(ThinLens::new(bad).err(), Some(LensError::NotFinite));
    }
    for bad in [0.0, -0.05] {
        assert_eq!(ThinLens::new(bad).err(), Some(LensError::FocalLength));
    }
    let lens = ThinLens::new(0.05).expect("a lens");
    for bad in BAD {
        let all = [
            lens.image_distance(bad),
            lens.object_distance(bad),
            lens.magnification(bad),
            lens.hyperfocal(bad, 1e-5),
        ];
        assert_eq!(all, [Err(LensError::NotFinite); 4]);
        assert_eq!(lens.object_sigma(0.06, bad), Err(LensError::NotFinite));
        assert_eq!(lens.circle_of_confusion(0.02, bad, 1.0), Err(LensError::NotFinite));
        assert_eq!(ThinLens::from_distances(bad, 1.0).err(), Some(LensError::NotFinite));
    }
    for within in [0.05, 0.01, 0.0, -1.0] {
        assert_eq!(lens.image_distance(within), Err(LensError::ObjectWithinFocus));
        assert_eq!(lens.magnification(within), Err(LensError::ObjectWithinFocus));
        assert_eq!(lens.object_distance(within), Err(LensError::ImageWithinFocus));
        assert_eq!(lens.object_sigma(within, 1e-6), Err(LensError::ImageWithinFocus));
        assert_eq!(lens.circle_of_confusion(0.02, 1.0, within), Err(LensError::ObjectWithinFocus));
        assert_eq!(lens.circle_of_confusion(0.02, within, 1.0), Err(LensError::ObjectWithinFocus));
        assert_eq!(lens.depth_of_field(2.0, within, 1e-5).err(), Some(LensError::ObjectWithinFocus));
    }
    assert_eq!(lens.breathing(0.04, 0.06), Err(LensError::ImageWithinFocus));
    assert_eq!(lens.object_sigma(0.06, -1e-6), Err(LensError::Sigma));
    assert_eq!(lens.circle_of_confusion(0.0, 1.0, 2.0), Err(LensError::Aperture));
    assert_eq!(lens.hyperfocal(0.0, 1e-5), Err(LensError::Aperture));
    assert_eq!(lens.hyperfocal(2.0, 0.0), Err(LensError::Blur));
    assert_eq!(ThinLens::from_distances(0.0, 1.0).err(), Some(LensError::ObjectWithinFocus));
    assert_eq!(ThinLens::from_distances(1.0, -1.0).err(), Some(LensError::ImageWithinFocus));

    assert_eq!(MicroLens::new(0), Err(LensError::FocalLength));
    let lens = MicroLens::new(4000).expect("a lens");
    assert_eq!(lens.image_distance_um(4000), Err(LensError::ObjectWithinFocus));
    assert_eq!(lens.object_distance_um(4000), Err(LensError::ImageWithinFocus));
    assert_eq!(lens.object_distance_from_extension_um(0), Err(LensError::ImageWithinFocus));
    assert_eq!(lens.object_sigma_um(0, 5), Err(LensError::ImageWithinFocus));
    assert_eq!(lens.object_distance_from_extension_um(1), Err(LensError::TooLarge));
    assert_eq!(
        MicroLens::new(u32::MAX - 1).expect("a lens").image_distance_um(u32::MAX),
        Err(LensError::TooLarge)
    );
}

#[test]
fn a_scale_is_positions_that_go_one_way() {
    let lens = ThinLens::new(0.004_f32).expect("a lens");
    assert_eq!(FocusScale::new(lens, &[0.0041]).err(), Some(FocusScaleError::TooFew));
    assert_eq!(
        FocusScale::new(lens, &[0.0041, 0.0042, 0.0042]).err(),
        Some(FocusScaleError::Order { index: 2 })
    );
    assert_eq!(
        FocusScale::new(lens, &[0.0043, 0.0042, 0.0044]).err(),
        Some(FocusScaleError::Order { index: 2 })
    );
    let reason = LensError::ImageWithinFocus;
    assert_eq!(
        FocusScale::new(lens, &[0.0041, 0.004]).err(),
        Some(FocusScaleError::Position { index: 1, reason })
    );
    for positions in [[0.0041, 0.0042, 0.0043], [0.0043, 0.0042, 0.0041]] {
        let scale = FocusScale::new(lens, &positions).expect("a scale");
        let peak = FocusPeak { position_q8: 256, sigma_q8: 64, noise_q8: 0, confidence: 9 };
        let depth = scale.depth(&peak).expect("a depth");
        let exact = 0.004 * 0.0042 / 0.0002;
        assert!((depth.depth_m - exact).abs() < 1e-4 * exact, "{depth:?}");
        // A quarter of 0.1 mm, 400 times as much of depth.
        assert!((depth.sigma_m - 0.01).abs() < 1e-4, "{depth:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        rng_seed: RngSeed::Fixed(5),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn distances_come_back(focal in 1e-3..0.2_f64, ratio in 1.1..500.0_f64) {
        let lens = ThinLens::new(focal).expect("a lens");
        let object = focal * ratio;
        let image = lens.image_distance(object).expect("an image");
        prop_assert!((1.0 / image + 1.0 / object - 1.0 / focal).abs() < 1e-9 / focal);
        prop_assert!((lens.object_distance(image).expect("an object") / object - 1.0).abs() < 1e-10);
        prop_assert!((ThinLens::from_distances(object, image).expect("a lens").focal() / focal - 1.0)
            .abs() < 1e-12);
        prop_assert!((lens.magnification(object).expect("a ratio") * object / image - 1.0).abs() < 1e-12);
        // f32: what is lost of z - f comes back (Z - f) / f times, 2^-23 of z each in z, f and their
        // difference.
        let single = ThinLens::new(focal as f32).expect("a lens");
        let image = single.image_distance(object as f32).expect("an image");
        let back = f64::from(single.object_distance(image).expect("an object"));
        prop_assert!((back / object - 1.0).abs() < 4.0 * ratio * f64::from(f32::EPSILON), "{back} {object}");
    }

    #[test]
    fn sigma_is_the_slope(focal in 1e-3..0.2_f64, ratio in 1.1..100.0_f64) {
        let lens = ThinLens::new(focal).expect("a lens");
        let image = lens.image_distance(focal * ratio).expect("an image");
        let step = (image - focal) * 1e-5;
        let moved = lens.object_distance(image + step)
            .expect("an object") - lens.object_distance(image - step).expect("one");
        let sigma = lens.object_sigma(image, 2.0 * step).expect("a deviation");
        prop_assert!((sigma / moved.abs() - 1.0).abs() < 1e-5);
    }

    #[test]
    fn the_field_ends_where_the_blur_is_too_large(
        focal in 1e-3..0.2_f64, number in 1.0..20.0_f64, ratio in 2.0..2000.0_f64, blur in 1e-6..5e-5_f64,
    ) {
        let lens = ThinLens::new(focal).expect("a lens");
        let focused = focal * ratio;
        let field = lens.depth_of_field(number, focused, blur).expect("a field");
        let at = |object| lens.circle_of_confusion(focal / number, focused, object).expect("a blur");
        prop_assert!(field.near <= focused);
        if field.near > focal {
            prop_assert!((at(field.near) / blur - 1.0).abs() < 1e-6);
        }
        match field.far {
            FarLimit::At(far) => prop_assert!(far >= focused && (at(far) / blur - 1.0).abs() < 1e-6),
            FarLimit::Infinity => prop_assert!(at(1e12) <= blur * (1.0 + 1e-6)),
        }
    }

    #[test]
    fn micrometres_are_the_nearest(focal in 500..100_000_u32, beyond in 1..200_000_000_u32,
        extension in 1..u32::MAX) {
        let lens = MicroLens::new(focal).expect("a lens");
        let object = focal + beyond;
        let exact = f64::from(focal) * f64::from(object) / f64::from(beyond);
        match lens.image_distance_um(object) {
            Ok(image) => prop_assert!((f64::from(image) - exact).abs() <= 0.5 + 1e-6),
            Err(error) => prop_assert!(error == LensError::TooLarge && exact > f64::from(u32::MAX)),
        }
        let exact = f64::from(focal) + f64::from(focal).powi(2) * 1000.0 / f64::from(extension);
        match lens.object_distance_from_extension_um(extension) {
            Ok(object) => prop_assert!((f64::from(object) - exact).abs() <= 0.5 + 1e-3),
            Err(error) => prop_assert!(error == LensError::TooLarge && exact > f64::from(u32::MAX) - 1.0),
        }
        let exact = (f64::from(focal) * 1000.0 / f64::from(extension)).powi(2) * 50.0 / 1000.0;
        match lens.object_sigma_um(extension, 50) {
            Ok(sigma) => prop_assert!((f64::from(sigma) - exact).abs() <= 1.0),
            Err(error) => prop_assert!(error == LensError::TooLarge && exact > f64::from(u32::MAX) - 1.0),
        }
    }
}
