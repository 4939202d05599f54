//! Robust two-view estimates on the real pairs of the folder in `STEREO_DATA`, whose geometry is known.
//!
//! `cargo xtask test` runs them when `STEREO_DATA` is set.

use nalgebra::{Matrix3, Point2, Vector3};
use std::path::{Path, PathBuf};
use stereopsis::geometry::{
    camera::Camera,
    robust::{RobustConfig, robust_fundamental},
    two_view::{Correspondence, Essential, Fundamental, eight_point},
};
use stereopsis_host::matches::read_matches;
use stereopsis_host::scene::Random;

/// A pair of pictures: its matches, which of them the true geometry explains to a pixel, and that geometry.
struct Pair {
    name: String,
    seen: Vec<Correspondence<f64>>,
    right: Vec<bool>,
    camera: Camera<f64>,
    /// R and T as OpenCV writes them.
    rotation: Matrix3<f64>,
    translation: Vector3<f64>,
}

fn matrix(value: &serde_json::Value) -> Matrix3<f64> {
    let element = |i: usize, j: usize| value[i][j].as_f64().expect("a number");
    Matrix3::from_fn(element)
}

fn pairs() -> Vec<Pair> {
    let data = std::env::var_os("STEREO_DATA").expect("set STEREO_DATA to the folder that holds two_view/");
    let folder = Path::new(&data).join("two_view/fountain-P11");
    let entries =
        std::fs::read_dir(&folder).unwrap_or_else(|e| panic!("STEREO_DATA: {}: {e}", folder.display()));
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "csv"));
    files.sort();
    assert!(files.len() >= 10, "{} pairs in {}", files.len(), folder.display());
    files.iter().map(|file| pair(file)).collect()
}

fn pair(file: &Path) -> Pair {
    let seen = read_matches(file).expect("matches");
    let text = std::fs::read_to_string(file).expect("a file");
    let right = text.lines().skip(1).map(|line| line.ends_with(",1")).collect();
    let json = std::fs::read_to_string(file.with_extension("json")).expect("a file");
    let json: serde_json::Value = serde_json::from_str(&json).expect("an object");
    let t = &json["t"];
    let component = |i: usize| t[i].as_f64().expect("a number");
    Pair {
        name: file.file_stem().expect("a name").to_string_lossy().into_owned(),
        seen,
        right,
        camera: Camera::from_matrix(&matrix(&json["K1"])).expect("a camera"),
        rotation: matrix(&json["R"]),
        translation: Vector3::new(component(0), component(1), component(2)),
    }
}

impl Pair {
    fn right(&self) -> Vec<Correspondence<f64>> {
        self.seen.iter().zip(&self.right).filter(|&(_, &right)| right).map(|(s, _)| *s).collect()
    }

    /// All matches, and wrong ones added at random places until they are `share` of all.
    fn with_wrong(&self, share: f64, seed: u64) -> Vec<Correspondence<f64>> {
        let right = self.right().len() as f64;
        let wanted = (share / (1.0 - share) * right) as usize;
        let have = self.right.iter().filter(|&&right| !right).count();
        let mut random = Random::new(seed);
        let mut place = || Point2::new(768.0 * random.unit(), 512.0 * random.unit());
        let mut seen = self.seen.clone();
        seen.extend((have..wanted).map(|_| Correspondence { first: place(), second: place() }));
        seen
    }

    /// The mean distance of the right matches to their lines, px, and the share of them that is within a
    /// pixel.
    fn score(&self, f: &Fundamental<f64>) -> (f64, f64) {
        let distances: Vec<f64> = self.right().iter().map(|s| f.symmetric_px(s)).collect();
        let n = distances.len() as f64;
        (distances.iter().sum::<f64>() / n, distances.iter().filter(|&&d| d < 1.0).count() as f64 / n)
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn wrong_matches_do_no_harm() {
    for share in [0.3, 0.5] {
        for seed in 0..3 {
            let (mut errors, mut recalls) = (Vec::new(), Vec::new());
            for pair in pairs() {
                let seen = pair.with_wrong(share, seed);
                let mut inliers = vec![false; seen.len()];
                let config = RobustConfig { seed, ..RobustConfig::new(1.0) };
                let found = robust_fundamental(&seen, &config, &mut inliers).expect("an estimate");
                let (error, recall) = pair.score(&found.fundamental);
                assert!(error < 0.3, "{}, {share} wrong, seed {seed}: {error} px", pair.name);
                errors.push(error);
                recalls.push(recall);
            }
            let recall = recalls.iter().sum::<f64>() / recalls.len() as f64;
            let error = median(errors);
            assert!(
                error < 0.175 && recall > 0.983,
                "{share} wrong, seed {seed}: {error} px, recall {recall}"
            );
        }
    }
}

#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn right_matches_alone() {
    let scores: Vec<_> =
        pairs().iter().map(|pair| pair.score(&eight_point(&pair.right()).expect("an estimate"))).collect();
    assert!(median(scores.iter().map(|score| score.0).collect()) < 0.156);
    assert!(scores.iter().all(|score| score.0 < 0.22));
}

#[test]
#[ignore = "reads the folder in STEREO_DATA"]
fn the_pose_is_the_true_one() {
    for pair in pairs() {
        let seen = pair.with_wrong(0.3, 1);
        let mut inliers = vec![false; seen.len()];
        let found = robust_fundamental(&seen, &RobustConfig::new(1.0), &mut inliers).expect("an estimate");
        let start =
            Essential::from_fundamental(&found.fundamental, &pair.camera, &pair.camera).expect("rank 2");
        let essential = start.refined(&seen, &pair.camera, &pair.camera, 1.0).expect("rank 2");
        let kept = seen.iter().zip(&inliers).filter(|&(_, &inlier)| inlier).map(|(s, _)| *s);
        let pose =
            essential.recover_pose(kept, &pair.camera, &pair.camera).expect("a pose").pose.in_baselines();
        let (rotation, translation) = pose.to_opencv();
        let turned = rotation.tr_mul(&pair.rotation).trace();
        let off_rotation = ((turned - 1.0) / 2.0).clamp(-1.0, 1.0).acos().to_degrees();
        let along = translation.dot(&pair.translation) / pair.translation.norm();
        let off_direction = along.clamp(-1.0, 1.0).acos().to_degrees();
        assert!(
            off_rotation < 0.3 && off_direction < 1.5,
            "{}: {off_rotation} {off_direction} degrees",
            pair.name
        );
    }
}
