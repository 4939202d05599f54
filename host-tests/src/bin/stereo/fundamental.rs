//! `stereo fundamental`: correspondences into a fundamental matrix.

use crate::cli::{FundamentalArgs, RobustArgs, TwoViewMethod};
use crate::failure::Failure;
use crate::files::json_file;
use crate::print;
use nalgebra::Matrix3;
use serde::Serialize;
use std::hint::black_box;
use std::time::Instant;
use stereopsis::geometry::{Correspondence, Fundamental, RobustConfig, eight_point, robust_fundamental};
use stereopsis_host::matches::read_matches;

/// How often the solver is timed.
const TIMED: usize = 5;

/// What is written. Names are a contract with programs that read them.
#[derive(Serialize)]
struct Answer {
    fundamental: [[f64; 3]; 3],
    inliers: Vec<bool>,
    time_us: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    samples: Option<u32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    miss_probability: Option<f64>,
}

/// A fundamental matrix, and what agrees with it.
pub struct Estimate {
    pub fundamental: Fundamental<f64>,
    pub inliers: Vec<bool>,
    samples: Option<(u32, f64)>,
}

pub fn run(args: &FundamentalArgs) -> Result<(), Failure> {
    let seen = read_matches(&args.matches)?;
    let failed = |why: String| Failure::new(format!("{}: {why}", args.matches.display()));
    let estimate = estimate(&seen, &args.robust).map_err(failed)?;
    let mut best = f64::INFINITY;
    for _ in 0..TIMED {
        let start = Instant::now();
        let again = self::estimate(black_box(&seen), &args.robust).map_err(failed)?;
        best = best.min(start.elapsed().as_secs_f64() * 1e6);
        black_box(again);
    }
    let kept = estimate.inliers.iter().filter(|&&inlier| inlier).count();
    let answer = Answer {
        fundamental: rows(estimate.fundamental.matrix()),
        inliers: estimate.inliers,
        time_us: best,
        samples: estimate.samples.map(|(samples, _)| samples),
        miss_probability: estimate.samples.map(|(_, missed)| missed),
    };
    json_file(&args.out, &answer)?;
    let n = seen.len();
    print(&format!("{kept} of {n} matches within {} px, {best:.0} us\n", args.robust.threshold))
}

/// By the method that the options name, or why not.
pub fn estimate(seen: &[Correspondence<f64>], args: &RobustArgs) -> Result<Estimate, String> {
    match args.method {
        TwoViewMethod::EightPoint => {
            let fundamental = eight_point(seen).map_err(|e| e.to_string())?;
            let inliers = seen.iter().map(|s| fundamental.sampson_px(s).abs() <= args.threshold).collect();
            Ok(Estimate { fundamental, inliers, samples: None })
        }
        TwoViewMethod::Ransac => {
            let mut inliers = vec![false; seen.len()];
            let config = RobustConfig { seed: args.seed, ..RobustConfig::new(args.threshold) };
            let found = robust_fundamental(seen, &config, &mut inliers).map_err(|e| e.to_string())?;
            let samples = Some((found.samples, found.miss_probability));
            Ok(Estimate { fundamental: found.fundamental, inliers, samples })
        }
    }
}

/// A matrix by its rows.
pub fn rows(matrix: &Matrix3<f64>) -> [[f64; 3]; 3] {
    matrix.transpose().into()
}
