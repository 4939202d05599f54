//! Accuracy on rectified pairs of the folder in `STEREO_DATA`: every method, default filter, every scene.
//!
//! On all pairs of `stereo/` the recipes, penalties and checks were chosen ([`TUNED_ON`]): the bounds of
//! these tests say that nothing gets worse, not how good the answers are on other pairs. Pairs that nothing
//! was chosen on may stand in `stereo_held_back/`, in the same form; a test of their own, which is ignored as
//! long as nobody has any, holds them to what such pairs gave once.

use image::GrayImage;
use std::fmt::Write;
use std::path::Path;
use std::sync::LazyLock;
use stereopsis::imaging::{Balance, Noise};
use stereopsis::matching::{Config, Filter};
use stereopsis_host::map::DisparityMap;
use stereopsis_host::real::{Alteration, RealScene, Score};
use stereopsis_host::run::{MemoryPair, MethodName, measure_balance, measure_noise, run};
use stereopsis_host::sparsification::Sparsification;

/// The pairs that something was chosen on: all there are.
const TUNED_ON: [&str; 15] = [
    "cones",
    "mb2006_Aloe",
    "mb2006_Baby1",
    "mb2006_Bowling1",
    "mb2006_Cloth1",
    "mb2006_Cloth3",
    "mb2006_Lampshade1",
    "mb2006_Midd1",
    "mb2006_Monopoly",
    "mb2006_Rocks1",
    "mb2006_Wood2",
    "mb2014q_Motorcycle",
    "sceneflow_dmb_0",
    "tsukuba",
    "venus",
];

/// The scenes, read once.
static SCENES: LazyLock<Vec<RealScene>> = LazyLock::new(|| scenes("stereo"));

fn scenes(folder: &str) -> Vec<RealScene> {
    let data = std::env::var_os("STEREO_DATA").expect("set STEREO_DATA to the folder that holds stereo/");
    RealScene::all(&Path::new(&data).join(folder)).unwrap_or_else(|e| panic!("STEREO_DATA: {e}"))
}

fn camera([left, right]: [&GrayImage; 2]) -> MemoryPair {
    MemoryPair::new(left.width() as u16, left.to_vec(), right.to_vec()).expect("two images of one size")
}

/// A scene as `stereo match` does it: noise is measured.
fn match_with(scene: &RealScene, method: MethodName, filter: Filter) -> DisparityMap {
    match_images(scene, [&scene.left, &scene.right], method, filter)
}

fn match_images(
    scene: &RealScene,
    images: [&GrayImage; 2],
    method: MethodName,
    filter: Filter,
) -> DisparityMap {
    let (width, height) = (scene.left.width() as u16, scene.left.height() as u16);
    let mut camera = camera(images);
    let noise = measure_noise(&mut camera).expect("a frame").level();
    let search = Config { confidence: true, noise, ..method.config(width, height, scene.disparities) };
    let config = method.with_filter(filter, search);
    run(method, &config, &mut camera, |_| ()).expect("a frame").map
}

/// What confidences are worth, for three losses: over 2 px off, over 1 px off, the error.
fn worth(scene: &RealScene, map: &DisparityMap) -> [Sparsification; 3] {
    let losses: [fn(f32) -> f32; 3] =
        [|error| f32::from(u8::from(error > 2.0)), |error| f32::from(u8::from(error > 1.0)), |error| error];
    losses.map(|loss| {
        let of_known = |i: usize, px: f32| (scene.truth[i] > 0.0).then(|| loss((px - scene.truth[i]).abs()));
        Sparsification::of(&map.judged(of_known)).expect("answers that are scored")
    })
}

/// The area under the sparsification curve of every scene, from the oracle's (0) to that of a random order
/// (1): printed as such, and over the oracle's; for answers over 2 px off at most `bound`.
fn confidence_on_real_pairs(method: MethodName, filter: Filter, bound: f64) {
    let mut table =
        format!("{:24}{:>24}{:>24}{:>24}\n", format!("{method}, {}", filter.name()), "bad2", "bad1", "error");
    let mut worst = (0.0, String::new());
    let mut mean = [[0.0; 2]; 3];
    for scene in SCENES.iter() {
        let worth =
            worth(scene, &match_with(scene, method, filter)).map(|s| [s.from_oracle(), s.area / s.oracle]);
        let name = scene.name.clone();
        writeln!(table, "{name:24}{}", worth.map(|[from, over]| format!("{from:12.3}{over:12.2}")).concat())
            .expect("to a string");
        if worth[0][0] > worst.0 {
            worst = (worth[0][0], name);
        }
        for (mean, worth) in mean.iter_mut().flatten().zip(worth.iter().flatten()) {
            *mean += worth / SCENES.len() as f64;
        }
    }
    let mean = mean.map(|[from, over]| format!("{from:12.3}{over:12.2}")).concat();
    println!("{table}{:24}{mean}\n", "mean");
    assert!(worst.0 <= bound, "{method}, {}: {worst:?}", filter.name());
}

/// The mean over all scenes, printed under a table of them.
fn mean_over_scenes(method: MethodName) -> Score {
    mean_with(method, Filter::Default)
}

fn mean_with(method: MethodName, filter: Filter) -> Score {
    mean_of(&SCENES, method, filter)
}

fn mean_of(scenes: &[RealScene], method: MethodName, filter: Filter) -> Score {
    let mut table = format!(
        "{:24}{:>9}{:>9}{:>9}\n",
        format!("{method}, {}", filter.name()),
        "density",
        "bad2 %",
        "missed %"
    );
    let mut row = |name: &str, s: Score| {
        writeln!(table, "{name:24}{:9.3}{:9.2}{:9.2}", s.density, 100.0 * s.bad2, 100.0 * s.missed)
            .expect("to a string");
    };
    let mut scores = Vec::new();
    for scene in scenes {
        let answers = match_with(scene, method, filter).disparity;
        assert_eq!(answers.len(), scene.truth.len(), "{}", scene.name);
        let score = Score::of(answers.iter().map(|d| d.to_f32()), &scene.truth).expect("scored pixels");
        row(&scene.name, score);
        scores.push(score);
    }
    let mean = Score::mean(&scores);
    row("mean", mean);
    println!("{table}");
    mean
}

#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn the_pairs_are_those_that_were_tuned_on() {
    let names: Vec<_> = SCENES.iter().map(|scene| scene.name.as_str()).collect();
    assert_eq!(names, TUNED_ON, "a pair that nothing was chosen on belongs to stereo_held_back/");
}

/// 18 pairs that none of it was chosen on once gave the recipe of [`MethodName::Sgm`] 8.3 % missed and 6.2 %
/// of the answers over 2 px off, of [`MethodName::SgmLean`] 8.6 and 6.5, of [`MethodName::SgmEdge`] 7.7 and
/// 5.9, and OpenCV's StereoSGBM 13.6 and 7.2.
#[test]
#[ignore = "needs pairs that nothing was chosen on, in the folder stereo_held_back/ of STEREO_DATA"]
fn held_back_pairs() {
    let scenes = scenes("stereo_held_back");
    assert!(scenes.iter().all(|scene| !TUNED_ON.contains(&scene.name.as_str())), "a pair was tuned on");
    for method in [MethodName::Sgm, MethodName::SgmLean, MethodName::SgmEdge] {
        let mean = mean_of(&scenes, method, Filter::Default);
        assert!(
            mean.missed <= 0.136 && mean.bad2 <= 0.072,
            "{method}: missed {}, bad2 {}",
            mean.missed,
            mean.bad2
        );
    }
}

#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn block_on_real_pairs() {
    let mean = mean_over_scenes(MethodName::Block);
    assert!(mean.missed <= 0.129 && mean.bad2 <= 0.043, "missed {}, bad2 {}", mean.missed, mean.bad2);
}

#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn fast_on_real_pairs() {
    let mean = mean_over_scenes(MethodName::Fast);
    assert!(mean.missed <= 0.138, "missed {}", mean.missed);
}

#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn sgm_lean_on_real_pairs() {
    let mean = mean_over_scenes(MethodName::SgmLean);
    assert!(mean.missed <= 0.037 && mean.bad2 <= 0.018, "missed {}, bad2 {}", mean.missed, mean.bad2);
}

#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn sgm_on_real_pairs() {
    let mean = mean_over_scenes(MethodName::Sgm);
    assert!(mean.missed <= 0.034 && mean.bad2 <= 0.018, "missed {}, bad2 {}", mean.missed, mean.bad2);
}

#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn sgm_edge_on_real_pairs() {
    let mean = mean_over_scenes(MethodName::SgmEdge);
    assert!(mean.missed <= 0.033 && mean.bad2 <= 0.017, "missed {}, bad2 {}", mean.missed, mean.bad2);
}

#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn strict_answers_of_sgm_are_sure() {
    let mean = mean_with(MethodName::Sgm, Filter::Strict);
    assert!(mean.density >= 0.95 && mean.bad2 <= 0.01, "density {}, bad2 {}", mean.density, mean.bad2);
    let mean = mean_with(MethodName::SgmEdge, Filter::Strict);
    assert!(mean.density >= 0.95 && mean.bad2 <= 0.01, "density {}, bad2 {}", mean.density, mean.bad2);
}

#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn confidence_orders_answers_on_every_real_pair() {
    for method in MethodName::ALL {
        for filter in [Filter::Dense, Filter::Default] {
            confidence_on_real_pairs(method, filter, 0.155);
        }
    }
}

/// What the meter's description says of these scenes.
#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn noise_is_measured_on_every_real_pair() {
    let (mut measured, mut textured) = (Vec::new(), 0);
    for (scene, seed) in SCENES.iter().zip(1..) {
        let meters = [0.0, 2.0, 5.0].map(|sigma| {
            let [left, right] = Alteration::Noise(sigma).apply([&scene.left, &scene.right], seed);
            measure_noise(&mut camera([&left, &right])).expect("a frame")
        });
        let sigmas = meters.each_ref().map(|meter| f64::from(meter.sigma_16ths().expect("a run")) / 16.0);
        println!("{:24}{:?}", scene.name, sigmas);
        textured += usize::from(meters[0].level() != Noise::None);
        assert!(
            meters[1].level() >= Noise::Low && meters[2].level() == Noise::High,
            "{}: {sigmas:?}",
            scene.name
        );
        measured.push(sigmas);
    }
    assert!(textured <= 1 && measured.iter().all(|[clean, ..]| *clean < 2.9), "{measured:?}");
}

#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn sgm_on_noisy_real_pairs() {
    // OpenCV's StereoSGBM misses 0.13 and 0.25, and of its answers 0.06 and 0.088 are wrong.
    for (sigma, most_missed, most_wrong) in [(2.0, 0.083, 0.052), (5.0, 0.157, 0.088)] {
        let scores: Vec<_> = SCENES
            .iter()
            .zip(1..)
            .map(|(scene, seed)| {
                let [left, right] = Alteration::Noise(sigma).apply([&scene.left, &scene.right], seed);
                let answers =
                    match_images(scene, [&left, &right], MethodName::Sgm, Filter::Default).disparity;
                Score::of(answers.iter().map(|d| d.to_f32()), &scene.truth).expect("scored pixels")
            })
            .collect();
        let mean = Score::mean(&scores);
        println!("sgm, noise of {sigma}: {mean:?}");
        assert!(mean.missed <= most_missed && mean.bad2 <= most_wrong, "noise of {sigma}: {mean:?}");
    }
}

#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn sgm_on_real_pairs_of_other_exposures() {
    let mut scores = Vec::new();
    for scene in SCENES.iter() {
        let balance =
            |right: &GrayImage| measure_balance(&mut camera([&scene.left, right])).expect("a frame");
        assert_eq!(balance(&scene.right), Balance::NONE, "{}: as taken", scene.name);
        let exposure = Alteration::Exposure { gain: 1.2, offset: 15.0 };
        let [_, mut right] = exposure.apply([&scene.left, &scene.right], 1);
        let balance = balance(&right);
        println!("{:24}{balance:?}", scene.name);
        balance.line(&mut right);
        let answers = match_images(scene, [&scene.left, &right], MethodName::Sgm, Filter::Default).disparity;
        scores.push(Score::of(answers.iter().map(|d| d.to_f32()), &scene.truth).expect("scored pixels"));
    }
    let mean = Score::mean(&scores);
    println!("sgm, right x 1.2 + 15: {mean:?}");
    // On three scenes too much is saturated.
    assert!(mean.missed <= 0.101 && mean.bad2 <= 0.068, "missed {}, bad2 {}", mean.missed, mean.bad2);
}
