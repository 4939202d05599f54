//! `stereo fundamental`: correspondences into a fundamental matrix.

use crate::failure::Failure;
use crate::place::{Place, json};
use crate::shared::{RobustArgs, TwoViewMethod, print, remark, rows};
use clap::Args;
use image::RgbImage;
use nalgebra::Point2;
use serde::Serialize;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::time::Instant;
use stereopsis::geometry::{
    robust::{RobustConfig, RobustError, robust_fundamental},
    two_view::{Correspondence, Fundamental, eight_point},
};
use stereopsis_host::chance::log10_false_alarms;
use stereopsis_host::degenerate::{Degenerate, degenerate};
use stereopsis_host::epipolar_picture::epipolar_picture;
use stereopsis_host::matches::read_matches;
use stereopsis_host::mock::MockCamera;

/// What follows the options in the command's help.
pub const EXAMPLE: &str = "Example:
  stereo fundamental --matches matches.csv --out fundamental.json --left first.png --right second.png \
                           --picture lines.png

Written is one JSON object: fundamental (3x3 in rows, p1^T F p2 = 0 for a point p1 of the first image and p2 \
                           of the second), inliers (whether each match is within the threshold), time_us \
                           (the estimate alone, the best of five), log10_false_alarms (the logarithm of how \
                           many such matrices unrelated matches would have); with ransac also samples and \
                           miss_probability, the probability that a better estimate was missed. The picture \
                           has both images with the points of all matches, red where one does not agree, \
                           and for some of the others the lines on which they must lie.";

#[derive(Debug, Args)]
pub struct FundamentalArgs {
    /// The matches: lines of x1,y1,x2,y2 in px under that header
    #[arg(long, value_name = "FILE")]
    pub matches: PathBuf,
    #[command(flatten)]
    pub robust: RobustArgs,
    /// File for the result; its folder is made when it is missing
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    /// File for a picture of the epipolar lines over both images
    #[arg(long, value_name = "FILE.png", requires_all = ["left", "right"])]
    pub picture: Option<PathBuf>,
    /// The image of x1,y1, for the picture
    #[arg(long, value_name = "FILE", requires_all = ["right", "picture"])]
    pub left: Option<PathBuf>,
    /// The image of x2,y2, for the picture
    #[arg(long, value_name = "FILE", requires_all = ["left", "picture"])]
    pub right: Option<PathBuf>,
}

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
    log10_false_alarms: f64,
}

/// A fundamental matrix, and what agrees with it.
pub struct Estimate {
    pub fundamental: Fundamental<f64>,
    pub inliers: Vec<bool>,
    samples: Option<(u32, f64)>,
}

pub fn run(args: &FundamentalArgs) -> Result<(), Failure> {
    let seen = read_matches(&args.matches)?;
    let (out, picture) = Place::with_picture(&args.out, args.picture.as_deref())?;
    let images = args.left.as_deref().zip(args.right.as_deref());
    let images = images.map(|(left, right)| images_of(&seen, left, right)).transpose()?;
    let failed = |why: String| Failure::new(format!("{}: {why}", args.matches.display()));
    let estimate = estimate(&seen, &args.robust).map_err(failed)?;
    let mut best = f64::INFINITY;
    let all = Instant::now();
    for _ in 0..TIMED {
        // What takes long is timed once.
        if best.is_finite() && all.elapsed().as_secs_f64() > 0.5 {
            break;
        }
        let start = Instant::now();
        let again = self::estimate(black_box(&seen), &args.robust).map_err(failed)?;
        best = best.min(start.elapsed().as_secs_f64() * 1e6);
        black_box(again);
    }
    let kept = estimate.inliers.iter().filter(|&&inlier| inlier).count();
    let log10_false_alarms = by_chance(&seen, kept, &args.robust).map_err(failed)?;
    let drawn = |(place, (left, right)): (_, &(RgbImage, RgbImage))| {
        let matches: Vec<_> = seen.iter().copied().zip(estimate.inliers.iter().copied()).collect();
        (place, epipolar_picture(left, right, &estimate.fundamental, &matches))
    };
    let drawn = picture.as_ref().zip(images.as_ref()).map(drawn);
    let answer = Answer {
        fundamental: rows(estimate.fundamental.matrix()),
        inliers: estimate.inliers,
        time_us: best,
        samples: estimate.samples.map(|(samples, _)| samples),
        miss_probability: estimate.samples.map(|(_, missed)| missed),
        log10_false_alarms,
    };
    out.write(|out| json(out, &answer), drawn)?;
    let n = seen.len();
    warn_of_chance(log10_false_alarms, kept, n, &args.robust);
    print(&format!("{kept} of {n} matches within {} px, {best:.0} us\n", args.robust.threshold))
}

/// The logarithm of how often so many matches agree by chance, or that these do. Those that the user says are
/// right may be few, where all of them agree.
pub fn by_chance(seen: &[Correspondence<f64>], kept: usize, args: &RobustArgs) -> Result<f64, String> {
    let log10 = log10_false_alarms(seen, kept, args.threshold);
    let all_are_right = args.method == TwoViewMethod::EightPoint && kept == seen.len();
    if log10 >= 0.0 && !all_are_right {
        let cure = match args.method {
            TwoViewMethod::EightPoint => "where some are wrong, use --method ransac",
            TwoViewMethod::Ransac => "are these images of one scene?",
        };
        return Err(format!(
            "{kept} of {} matches agree within {} px, as many as of unrelated ones by chance (1e{log10:.0} \
             such matrices are expected); {cure}",
            seen.len(),
            args.threshold
        ));
    }
    Ok(log10)
}

/// The logarithm from which on matches may well agree by chance: once in a hundred.
const DOUBTFUL: f64 = -2.0;

/// Says so where unrelated matches may well agree as much, and the user does not say that these are right.
pub fn warn_of_chance(log10: f64, kept: usize, matches: usize, args: &RobustArgs) {
    if log10 > DOUBTFUL && args.method == TwoViewMethod::Ransac {
        remark(&format!(
            "warning: {kept} of {matches} matches agree, which up to {:.0} in 100 sets of unrelated ones do \
             by chance; see whether these images are of one scene",
            100.0 * 10f64.powf(log10)
        ));
    }
}

/// The images of the matches, for display; refused when a match is outside of its image.
fn images_of(
    seen: &[Correspondence<f64>],
    left: &Path,
    right: &Path,
) -> Result<(RgbImage, RgbImage), Failure> {
    let images = (MockCamera::open(left)?.picture(), MockCamera::open(right)?.picture());
    let inside = |p: &Point2<f64>, image: &RgbImage| {
        let within = |x: f64, side: u32| (-0.5..=f64::from(side) - 0.5).contains(&x);
        within(p.x, image.width()) && within(p.y, image.height())
    };
    for (s, number) in seen.iter().zip(1..) {
        for (option, path, p, image) in
            [("--left", left, s.first, &images.0), ("--right", right, s.second, &images.1)]
        {
            if !inside(&p, image) {
                let (name, (width, height)) = (path.display(), image.dimensions());
                let why = format!(
                    "{option} {name}: match {number} is outside of its {width} x {height} px; name its image"
                );
                return Err(Failure::new(why));
            }
        }
    }
    Ok(images)
}

/// Refuses matches that agree, but lie on a line in an image: many matrices fit those.
pub fn off_a_line(kept: &[Correspondence<f64>]) -> Result<(), String> {
    match degenerate(kept) {
        Some(line @ Degenerate::Line) => Err(line.to_string()),
        _ => Ok(()),
    }
}

/// Why matches have no fundamental matrix: what is special about them says more than that there is none.
pub fn why(seen: &[Correspondence<f64>], error: &RobustError) -> String {
    let special = degenerate(seen).filter(|_| *error == RobustError::NoAgreement);
    special.map_or_else(|| error.to_string(), |special| special.to_string())
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
            let found = robust_fundamental(seen, &config, &mut inliers).map_err(|e| why(seen, &e))?;
            let kept: Vec<_> =
                seen.iter().zip(&inliers).filter(|&(_, &is_in)| is_in).map(|(s, _)| *s).collect();
            off_a_line(&kept)?;
            let samples = Some((found.samples, found.miss_probability));
            Ok(Estimate { fundamental: found.fundamental, inliers, samples })
        }
    }
}
