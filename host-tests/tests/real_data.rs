//! Accuracy on the real rectified pairs of the folder in `STEREO_DATA`: both methods, default filter, every scene.
//!
//! A scene is a folder below `stereo/` with `left.png`, `right.png`, `gt.png` (16 bit, disparity x 256, 0 = unknown),
//! `nonocc.png` (255 = both cameras see it) and `meta.json` (`disparities`, the search range). Scored are pixels with a
//! known truth that both cameras see, from column `disparities` on: left of it the range does not fit the right image.
//!
//! Built by the feature `real-data`, which `cargo xtask test` sets when `STEREO_DATA` is.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use stereopsis::camera::CameraPair;
use stereopsis::imaging::GreyLines;
use stereopsis::matching::{Config, Filter};
use stereopsis_host::map::DisparityMap;
use stereopsis_host::mock::MockCamera;
use stereopsis_host::run::{MOST_WIDTH, Method, run};
use stereopsis_host::sparsification::Sparsification;

/// An answer that is off by more is bad, px.
const BAD_PX: f32 = 2.0;
/// Bytes of a line in the widest format of a file.
const RAW_BYTES: usize = MOST_WIDTH * 6;

/// Shares of one map, 0 to 1.
#[derive(Clone, Copy, Default)]
struct Score {
    /// Answers among the scored pixels.
    density: f64,
    /// Bad ones among these answers.
    bad2: f64,
    /// Scored pixels with a bad answer or none.
    missed: f64,
}

/// What a scene's files say.
struct Scene {
    folder: PathBuf,
    disparities: u16,
    /// Disparity in px for each pixel, 0 where it is not scored.
    truth: Vec<f32>,
}

/// The folders with a scene, in order of their names.
fn scenes() -> Vec<PathBuf> {
    let data = std::env::var_os("STEREO_DATA").expect("set STEREO_DATA to the folder that holds stereo/");
    let stereo = Path::new(&data).join("stereo");
    let entries = fs::read_dir(&stereo).unwrap_or_else(|e| panic!("STEREO_DATA: {}: {e}", stereo.display()));
    let folders = entries.map(|entry| entry.expect("a folder's entry").path());
    let mut scenes: Vec<_> = folders.filter(|folder| folder.join("meta.json").is_file()).collect();
    scenes.sort();
    assert!(!scenes.is_empty(), "{} holds no scene", stereo.display());
    scenes
}

impl Scene {
    fn read(folder: PathBuf) -> Self {
        let at = |name: &str| folder.join(name);
        let image = |name: &str| image::open(at(name)).unwrap_or_else(|e| panic!("{}: {e}", at(name).display()));
        let meta = fs::read_to_string(at("meta.json")).expect("meta.json");
        let meta: serde_json::Value = serde_json::from_str(&meta).expect("meta.json holds JSON");
        let disparities =
            meta["disparities"].as_u64().and_then(|n| u16::try_from(n).ok()).expect("meta.json: disparities");
        let (gt, seen) = (image("gt.png").into_luma16(), image("nonocc.png").into_luma8());
        assert_eq!(gt.dimensions(), seen.dimensions(), "{}: gt.png and nonocc.png", folder.display());
        let scored = |x: u32, y: u32| seen.get_pixel(x, y).0[0] > 0 && x >= u32::from(disparities);
        let truth = |(x, y, pixel): (u32, u32, &image::Luma<u16>)| {
            if scored(x, y) { f32::from(pixel.0[0]) / 256.0 } else { 0.0 }
        };
        Self { disparities, truth: gt.enumerate_pixels().map(truth).collect(), folder }
    }

    /// The scene's two files through the same chain as in the program `stereo`.
    fn match_with(&self, method: Method, filter: Filter) -> DisparityMap {
        let (left, right) =
            MockCamera::open_pair(self.folder.join("left.png"), self.folder.join("right.png")).expect("two images");
        let left = GreyLines::<_, RAW_BYTES>::new(left).expect("a format with a brightness");
        let right = GreyLines::<_, RAW_BYTES>::new(right).expect("a format with a brightness");
        let mut camera = CameraPair::new(left, right, 0).expect("one size");
        let format = stereopsis::camera::StereoSource::format(&camera);
        let checks = method.checks(filter);
        let config = Config { checks, confidence: true, ..Config::new(format.width, format.height, self.disparities) };
        run(method, &config, &mut camera, |_| ()).expect("a frame").map
    }

    fn score(&self, map: &DisparityMap) -> Score {
        assert_eq!(map.disparity.len(), self.truth.len(), "{}: left.png and gt.png", self.folder.display());
        let (mut scored, mut answers, mut good) = (0u32, 0u32, 0u32);
        for (disparity, &truth) in map.disparity.iter().zip(&self.truth).filter(|(_, truth)| **truth > 0.0) {
            scored += 1;
            if let Some(px) = disparity.to_f32() {
                answers += 1;
                good += u32::from((px - truth).abs() <= BAD_PX);
            }
        }
        assert!(scored > 0, "{}: no pixel is scored", self.folder.display());
        let share = |part: u32, whole: u32| f64::from(part) / f64::from(whole.max(1));
        let (density, bad2) = (share(answers, scored), 1.0 - share(good, answers.max(1)));
        Score { density, bad2, missed: 1.0 - share(good, scored) }
    }
}

impl Scene {
    /// What confidences are worth, for three losses: over 2 px off, over 1 px off, the error.
    fn worth(&self, map: &DisparityMap) -> [Sparsification; 3] {
        let losses: [fn(f32) -> f32; 3] =
            [|error| f32::from(u8::from(error > 2.0)), |error| f32::from(u8::from(error > 1.0)), |error| error];
        losses.map(|loss| {
            let of_known = |i: usize, px: f32| (self.truth[i] > 0.0).then(|| loss((px - self.truth[i]).abs()));
            Sparsification::of(&map.judged(of_known)).expect("answers that are scored")
        })
    }
}

/// The area under the sparsification curve of every scene, from the oracle's (0) to that of a random order (1): printed as
/// such, and over the oracle's; for answers over 2 px off at most `bound`.
fn confidence_on_real_pairs(method: Method, filter: Filter, bound: f64) {
    let mut table =
        format!("{:24}{:>24}{:>24}{:>24}\n", format!("{method}, {}", filter.name()), "bad2", "bad1", "error");
    let mut worst = (0.0, String::new());
    let (mut mean, scenes) = ([[0.0; 2]; 3], scenes());
    for folder in &scenes {
        let scene = Scene::read(folder.clone());
        let worth = scene.worth(&scene.match_with(method, filter)).map(|s| [s.from_oracle(), s.area / s.oracle]);
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        writeln!(table, "{name:24}{}", worth.map(|[from, over]| format!("{from:12.3}{over:12.2}")).concat())
            .expect("to a string");
        if worth[0][0] > worst.0 {
            worst = (worth[0][0], name);
        }
        for (mean, worth) in mean.iter_mut().flatten().zip(worth.iter().flatten()) {
            *mean += worth / scenes.len() as f64;
        }
    }
    let mean = mean.map(|[from, over]| format!("{from:12.3}{over:12.2}")).concat();
    println!("{table}{:24}{mean}\n", "mean");
    assert!(worst.0 <= bound, "{method}, {}: {worst:?}", filter.name());
}

/// The mean over all scenes, printed under a table of them.
fn mean_over_scenes(method: Method) -> Score {
    mean_with(method, Filter::Default)
}

fn mean_with(method: Method, filter: Filter) -> Score {
    let scenes: Vec<_> = scenes().into_iter().map(Scene::read).collect();
    let mut table =
        format!("{:24}{:>9}{:>9}{:>9}\n", format!("{method}, {}", filter.name()), "density", "bad2 %", "missed %");
    let mut row = |name: &str, s: Score| {
        writeln!(table, "{name:24}{:9.3}{:9.2}{:9.2}", s.density, 100.0 * s.bad2, 100.0 * s.missed)
            .expect("to a string");
    };
    let mut mean = Score::default();
    for scene in &scenes {
        let score = scene.score(&scene.match_with(method, filter));
        row(&scene.folder.file_name().unwrap_or_default().to_string_lossy(), score);
        mean.density += score.density / scenes.len() as f64;
        mean.bad2 += score.bad2 / scenes.len() as f64;
        mean.missed += score.missed / scenes.len() as f64;
    }
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
fn strict_answers_of_sgm_are_sure() {
    let mean = mean_with(Method::Sgm, Filter::Strict);
    assert!(mean.density >= 0.95 && mean.bad2 <= 0.014, "density {}, bad2 {}", mean.density, mean.bad2);
}

#[test]
fn confidence_tells_wrong_answers_on_every_real_pair() {
    for method in Method::ALL {
        for filter in [Filter::Dense, Filter::Default] {
            confidence_on_real_pairs(method, filter, 0.15);
        }
    }
}
