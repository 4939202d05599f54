//! Accuracy on the real rectified pairs of the folder in `STEREO_DATA`: both methods, default filter, every scene.
//!
//! Built by the feature `real-data`, which `cargo xtask test` sets when `STEREO_DATA` is.

use std::fmt::Write;
use std::path::Path;
use std::sync::LazyLock;
use stereopsis::matching::{Config, Filter};
use stereopsis_host::map::DisparityMap;
use stereopsis_host::real::{RealScene, Score};
use stereopsis_host::run::{MemoryPair, Method, run};

/// The scenes, read once.
static SCENES: LazyLock<Vec<RealScene>> = LazyLock::new(|| {
    let data = std::env::var_os("STEREO_DATA").expect("set STEREO_DATA to the folder that holds stereo/");
    RealScene::all(&Path::new(&data).join("stereo")).unwrap_or_else(|e| panic!("STEREO_DATA: {e}"))
});

fn match_with(scene: &RealScene, method: Method, filter: Filter) -> DisparityMap {
    let (width, height) = (scene.left.width() as u16, scene.left.height() as u16);
    let camera = MemoryPair::new(width, scene.left.to_vec(), scene.right.to_vec());
    let config = method.with_filter(filter, Config::new(width, height, scene.disparities));
    run(method, &config, &mut camera.expect("two images of one size"), |_| ()).expect("a frame").map
}

/// The mean over all scenes, printed under a table of them.
fn mean_over_scenes(method: Method) -> Score {
    mean_with(method, Filter::Default)
}

fn mean_with(method: Method, filter: Filter) -> Score {
    let mut table =
        format!("{:24}{:>9}{:>9}{:>9}\n", format!("{method}, {}", filter.name()), "density", "bad2 %", "missed %");
    let mut row = |name: &str, s: Score| {
        writeln!(table, "{name:24}{:9.3}{:9.2}{:9.2}", s.density, 100.0 * s.bad2, 100.0 * s.missed)
            .expect("to a string");
    };
    let mut scores = Vec::new();
    for scene in SCENES.iter() {
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
fn block_on_real_pairs() {
    let mean = mean_over_scenes(Method::Block);
    assert!(mean.missed <= 0.129 && mean.bad2 <= 0.043, "missed {}, bad2 {}", mean.missed, mean.bad2);
}

#[test]
fn fast_on_real_pairs() {
    let mean = mean_over_scenes(Method::Fast);
    assert!(mean.missed <= 0.138, "missed {}", mean.missed);
}

#[test]
fn sgm_lean_on_real_pairs() {
    let mean = mean_over_scenes(Method::SgmLean);
    assert!(mean.missed <= 0.038 && mean.bad2 <= 0.025, "missed {}, bad2 {}", mean.missed, mean.bad2);
}

#[test]
fn sgm_on_real_pairs() {
    let mean = mean_over_scenes(Method::Sgm);
    assert!(mean.missed <= 0.036 && mean.bad2 <= 0.025, "missed {}, bad2 {}", mean.missed, mean.bad2);
}

#[test]
fn sgm_edge_on_real_pairs() {
    let mean = mean_over_scenes(Method::SgmEdge);
    assert!(mean.missed <= 0.033 && mean.bad2 <= 0.022, "missed {}, bad2 {}", mean.missed, mean.bad2);
}

#[test]
fn strict_answers_of_sgm_are_sure() {
    let mean = mean_with(Method::Sgm, Filter::Strict);
    assert!(mean.density >= 0.95 && mean.bad2 <= 0.014, "density {}, bad2 {}", mean.density, mean.bad2);
    let mean = mean_with(Method::SgmEdge, Filter::Strict);
    assert!(mean.density >= 0.955 && mean.bad2 <= 0.012, "density {}, bad2 {}", mean.density, mean.bad2);
}
