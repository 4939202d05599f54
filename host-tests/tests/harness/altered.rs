//! Altered pairs and their scores, on rendered scenes.

use image::GrayImage;
use std::sync::LazyLock;
use stereopsis::imaging::Noise;
use stereopsis::matching::{Config, Filter};
use stereopsis_host::real::{Alteration, RealError, RealScene, Score};
use stereopsis_host::run::{MemoryPair, MethodName, NoiseChoice, run};
use stereopsis_host::scene::Scene;

/// A rendered scene as a folder's files would give it.
static SCENE: LazyLock<RealScene> = LazyLock::new(|| {
    let scene = Scene::small(320, 240);
    let ((left, right), truth) = (scene.render(), scene.truth());
    let scored = |i: usize| !truth.occluded[i] && i % truth.width >= usize::from(scene.disparities());
    let truth =
        (0..truth.disparity.len()).map(|i| if scored(i) { truth.disparity[i] } else { 0.0 }).collect();
    RealScene { name: "room".into(), disparities: scene.disparities(), left, right, truth }
});

fn altered(alteration: Alteration, seed: u64) -> [GrayImage; 2] {
    alteration.apply([&SCENE.left, &SCENE.right], seed)
}

fn missed(method: MethodName, alteration: Alteration) -> f64 {
    missed_with(method, alteration, NoiseChoice::Given(Noise::None))
}

fn missed_with(method: MethodName, alteration: Alteration, noise: NoiseChoice) -> f64 {
    score(method, Filter::Default, alteration, noise).missed
}

fn score(method: MethodName, filter: Filter, alteration: Alteration, noise: NoiseChoice) -> Score {
    let [left, right] = altered(alteration, 1);
    let (width, height) = (left.width() as u16, left.height() as u16);
    let mut camera =
        MemoryPair::new(width, left.into_raw(), right.into_raw()).expect("two pictures of one size");
    let (noise, _) = noise.level(&mut camera).expect("a frame");
    let search = Config { noise, ..method.config(width, height, SCENE.disparities) };
    let config = method.with_filter(filter, search);
    let map = run(method, &config, &mut camera, |_| ()).expect("a frame").map;
    Score::of(map.disparity.iter().map(|d| d.to_f32()), &SCENE.truth).expect("scored pixels")
}

/// Mean and deviation of what an alteration changes where it cannot be clipped.
fn change(before: &GrayImage, after: &GrayImage) -> (f64, f64) {
    let inside = before.iter().zip(after.iter()).filter(|(before, _)| (40..=215).contains(*before));
    let changes: Vec<f64> = inside.map(|(before, after)| f64::from(*after) - f64::from(*before)).collect();
    assert!(changes.len() > 10_000, "{} pixels are neither dark nor bright", changes.len());
    let mean = changes.iter().sum::<f64>() / changes.len() as f64;
    let variance = changes.iter().map(|change| (change - mean).powi(2)).sum::<f64>() / changes.len() as f64;
    (mean, variance.sqrt())
}

#[test]
fn noise_has_its_deviation_in_both_images() {
    for sigma in [2.0, 5.0] {
        let [left, right] = altered(Alteration::Noise(sigma), 7);
        for (before, after) in [(&SCENE.left, &left), (&SCENE.right, &right)] {
            let (mean, deviation) = change(before, after);
            // Rounding adds a twelfth to the variance.
            let expected = (sigma * sigma + 1.0 / 12.0).sqrt();
            assert!(mean.abs() < 0.05 * sigma, "mean {mean}");
            assert!((deviation / expected - 1.0).abs() < 0.02, "deviation {deviation}, {expected} expected");
        }
    }
}

#[test]
fn noise_is_the_same_for_the_same_seed_and_another_on_the_other_side() {
    let noise = Alteration::Noise(5.0);
    assert_eq!(altered(noise, 3), altered(noise, 3));
    assert_ne!(altered(noise, 3), altered(noise, 4));
    let grey = GrayImage::from_pixel(64, 64, image::Luma([128]));
    let [left, right] = noise.apply([&grey, &grey], 3);
    let product: f64 =
        left.iter().zip(right.iter()).map(|(l, r)| (f64::from(*l) - 128.0) * (f64::from(*r) - 128.0)).sum();
    let correlation = product / (64.0 * 64.0 * 25.0);
    assert!(correlation.abs() < 0.06, "the sides' noise has a correlation of {correlation}");
}

#[test]
fn the_truth_misses_nothing_and_what_is_off_misses_all() {
    let off = |px: f32| SCENE.truth.iter().map(move |truth| Some(truth + px));
    let score = |px| Score::of(off(px), &SCENE.truth).expect("scored pixels");
    assert_eq!(score(0.0), Score { density: 1.0, bad2: 0.0, missed: 0.0 });
    assert_eq!(score(2.5), Score { density: 1.0, bad2: 1.0, missed: 1.0 });
}

#[test]
fn altered_pairs_are_harder_and_paths_bear_another_exposure() {
    for method in MethodName::ALL {
        let (clean, noisy) = (missed(method, Alteration::Unaltered), missed(method, Alteration::Noise(5.0)));
        assert!(clean < 0.1, "{method} misses {clean} as taken");
        assert!(clean < noisy, "{method} misses {clean} as taken, {noisy} with noise");
    }
    for method in [MethodName::SgmLean, MethodName::Sgm] {
        let missed = missed(method, Alteration::Exposure { gain: 1.2, offset: 15.0 });
        assert!(missed < 0.1, "{method} misses {missed} with another exposure");
    }
}

#[test]
fn measured_noise_is_smoothed_and_what_has_little_is_left() {
    for method in MethodName::ALL {
        let noisy = |filter| {
            [NoiseChoice::Given(Noise::None), NoiseChoice::Auto]
                .map(|noise| score(method, filter, Alteration::Noise(5.0), noise))
        };
        let [as_given, measured] = noisy(Filter::Dense).map(|score| score.missed);
        assert!(
            measured < 0.9 * as_given,
            "{method} misses {measured} of noisy pixels, {as_given} without smoothing"
        );
        if [MethodName::SgmLean, MethodName::Sgm, MethodName::SgmEdge].contains(&method) {
            let [as_given, measured] = noisy(Filter::Default).map(|score| score.bad2);
            assert!(
                measured < 0.8 * as_given,
                "of its answers {method} has {measured} wrong, {as_given} as told"
            );
        }
        let [as_given, measured] = [NoiseChoice::Given(Noise::None), NoiseChoice::Auto]
            .map(|noise| missed_with(method, Alteration::Unaltered, noise));
        assert_eq!(measured, as_given, "{method}: as taken");
    }
}

#[test]
fn folders_that_hold_no_scene_are_named() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let told = || RealScene::all(folder.path()).expect_err("no scene").to_string();
    assert!(matches!(RealScene::all(folder.path()), Err(RealError::NoScene { .. })));
    assert!(told().starts_with(&format!("{}: holds no scene", folder.path().display())));
    let scene = folder.path().join("a");
    std::fs::create_dir(&scene).expect("a folder");
    for (meta, expected) in [
        ("{}", "meta.json: states no disparities from 16 to 256"),
        ("{\"disparities\": 8}", "meta.json: states no disparities from 16 to 256"),
        ("{\"disparities\": 16}", "left.png: cannot be read"),
    ] {
        std::fs::write(scene.join("meta.json"), meta).expect("meta.json");
        assert!(told().contains(expected), "{}", told());
    }
    let save = |name: &str, width| GrayImage::new(width, 4).save(scene.join(name)).expect("a picture");
    for name in ["left.png", "right.png", "gt.png", "nonocc.png"] {
        save(name, 20);
    }
    let read = RealScene::all(folder.path()).expect("a scene");
    assert_eq!((read.len(), read[0].name.as_str(), read[0].truth.len()), (1, "a", 80));
    save("gt.png", 21);
    assert!(told().contains("gt.png: is (21, 4) pixels large, left.png (20, 4)"), "{}", told());
    std::fs::write(scene.join("gt.png"), "P5").expect("no picture");
    assert!(told().contains("gt.png: is no image"), "{}", told());
}
