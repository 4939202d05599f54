//! `stereo pose`: correspondences of known cameras into where the second one stands, and points.

use crate::failure::Failure;
use crate::fundamental::{by_chance, off_a_line, warn_of_chance, why};
use crate::place::json_file;
use crate::shared::{RobustArgs, TwoViewMethod, print, remark, rows};
use clap::Args;
use serde::Serialize;
use std::path::PathBuf;
use stereopsis::geometry::{
    camera::Camera,
    robust::{RobustConfig, RobustError, robust_essential, robust_fundamental},
    two_view::{
        Correspondence, EightPointError, Essential, Fundamental, Homography, PlaneMotionError, RelativePose,
        TwoViewModel, TwoViews, choose, eight_point,
    },
};
use stereopsis_host::calibration::Cameras;
use stereopsis_host::matches::read_matches;
use stereopsis_host::turned::only_turned;

/// What follows the options in the command's help.
pub const EXAMPLE: &str = "Example:
  stereo pose --matches matches.csv --calib calib.txt --out pose.json

Written is one JSON object: essential (3x3 in rows), rotation and translation (a point P' of the second \
                           camera is R P' + t in the first; t has length one, for the scale is not in the \
                           matches), points (in the first camera, the baseline is one; null where a match \
                           is wrong or its sights are parallel), inliers, model: essential (samples of \
                           five), fundamental, or homography when what was seen is on a plane, and \
                           log10_false_alarms (the logarithm of how many such matrices unrelated matches \
                           would have).";

#[derive(Debug, Args)]
pub struct PoseArgs {
    /// The matches: lines of x1,y1,x2,y2 in px under that header
    #[arg(long, value_name = "FILE")]
    pub matches: PathBuf,
    /// Calibration of the two cameras, which need not be rectified, or of the one that took both images:
    /// OpenCV's YAML, XML or JSON, ROS's camera_info (twice for two cameras), Kalibr's camchain, a
    /// Middlebury or KITTI calib.txt
    #[arg(long, value_name = "FILE", required = true)]
    pub calib: Vec<PathBuf>,
    #[command(flatten)]
    pub robust: RobustArgs,
    /// File for the result; its folder is made when it is missing
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
}

/// What is written. Names are a contract with programs that read them.
#[derive(Serialize)]
struct Answer {
    essential: [[f64; 3]; 3],
    rotation: [[f64; 3]; 3],
    translation: [f64; 3],
    points: Vec<Option<[f64; 3]>>,
    inliers: Vec<bool>,
    model: &'static str,
    log10_false_alarms: f64,
}

impl Answer {
    /// The answer for all matches, of one for those that are in sight: the others are no inliers.
    fn among<T>(self, in_sight: &[Option<T>]) -> Self {
        let (mut points, mut inliers) = (self.points.into_iter(), self.inliers.into_iter());
        Self {
            points: in_sight.iter().map(|s| s.as_ref().and_then(|_| points.next()?)).collect(),
            inliers: in_sight.iter().map(|s| s.is_some() && inliers.next() == Some(true)).collect(),
            ..self
        }
    }
}

/// A threshold that no match of two images is beyond, px.
const ANY_DISTANCE: f64 = 1e6;

/// A start for the refinement, and which model it comes from.
type Start = (Essential<f64>, &'static str);

pub fn run(args: &PoseArgs) -> Result<(), Failure> {
    let seen = read_matches(&args.matches)?;
    let cameras = Cameras::open(&args.calib)?;
    let in_sight: Vec<_> = seen.iter().map(|s| undistorted(s, &cameras)).collect();
    let sighted: Vec<_> = in_sight.iter().flatten().copied().collect();
    let blind = seen.len() - sighted.len();
    let named = |why| Failure::new(format!("{}: {why}", args.matches.display()));
    if sighted.is_empty() && blind > 0 {
        return Err(named(format!("the lenses' coefficients describe no sight for any of {blind} matches")));
    }
    // What fails on a line fails for that.
    let solved = solve(&sighted, &cameras, &args.robust);
    let (answer, rms) = solved.or_else(|why| off_a_line(&sighted).and(Err(why))).map_err(named)?;
    let mut answer = answer.among(&in_sight);
    // A zero's sign says nothing.
    answer.translation.iter_mut().for_each(|x| *x += 0.0);
    json_file(&args.out, &answer)?;
    let (kept, points) =
        (answer.inliers.iter().filter(|&&i| i).count(), answer.points.iter().flatten().count());
    let n = seen.len();
    if blind > 0 {
        let file = args.matches.display();
        remark(&format!(
            "note: {file}: the lenses' coefficients describe no sight for {blind} of {n} matches: no inliers"
        ));
    }
    warn_of_chance(answer.log10_false_alarms, kept, n, &args.robust);
    print(&format!(
        "{kept} of {n} matches within {} px ({rms:.3} px RMS), {points} points, by the {} matrix\n",
        args.robust.threshold, answer.model
    ))
}

/// A pose with what it leaves.
struct Found {
    /// The gain of a soft loss, how much agrees how well, times the share of it that is before both cameras.
    gain: f64,
    in_front: usize,
    rms: f64,
    essential: Essential<f64>,
    pose: RelativePose<f64>,
    inliers: Vec<bool>,
    model: &'static str,
}

impl Found {
    /// Whether clearly more agrees than with another, or as much and more of it before both cameras: what is
    /// before the cameras tells apart the two motions that a plane leaves, not estimates of one motion.
    fn is_better(&self, other: &Self) -> bool {
        self.gain > 1.02 * other.gain || self.gain >= 0.98 * other.gain && self.in_front > other.in_front
    }
}

fn solve(
    seen: &[Correspondence<f64>],
    cameras: &Cameras,
    args: &RobustArgs,
) -> Result<(Answer, f64), String> {
    let (first, second) = (pinhole(&cameras.first)?, pinhole(&cameras.second)?);
    let mut starts = start(seen, &first, &second, args)?;
    if args.method == TwoViewMethod::Ransac {
        let config = RobustConfig { seed: args.seed, ..RobustConfig::new(args.threshold) };
        let found = robust_essential(seen, &first, &second, &config, &mut vec![false; seen.len()]);
        starts.extend(found.map(|found| (found.essential, "essential")));
    }
    let mut best: Option<Found> = None;
    let mut why = "no pose".to_owned();
    for (essential, model) in starts {
        let refined = match args.method {
            // Every match counts alike, however far off it is.
            TwoViewMethod::EightPoint => essential.refined(seen, &first, &second, ANY_DISTANCE),
            TwoViewMethod::Ransac => essential.refined(seen, &first, &second, args.threshold),
        };
        let refined = refined.map_err(|e| e.to_string())?;
        let f = Fundamental::from_essential(&refined, &first, &second);
        let inliers: Vec<bool> = seen.iter().map(|s| f.sampson_px(s).abs() <= args.threshold).collect();
        let kept = || seen.iter().zip(&inliers).filter(|&(_, &inlier)| inlier).map(|(s, _)| *s);
        let squares: f64 = kept().map(|s| f.sampson_squared_px2(&s)).sum();
        // As the estimates have it: one and a half thresholds wide.
        let share = |s: &Correspondence<f64>| f.sampson_squared_px2(s) / (1.5 * args.threshold).powi(2);
        let gain: f64 = seen.iter().map(|s| (1.0 - share(s)).max(0.0).powi(3)).sum();
        let rms = (squares / kept().count().max(1) as f64).sqrt();
        // Every match counts alike, here too.
        let counted = |inlier| inlier || args.method == TwoViewMethod::EightPoint;
        let voters = || seen.iter().zip(&inliers).filter(|&(_, &inlier)| counted(inlier)).map(|(s, _)| *s);
        match refined.recover_pose(voters(), &first, &second) {
            Ok(found) => {
                let (in_front, pose) = (found.in_front, found.pose);
                let gain = gain * in_front as f64 / voters().count() as f64;
                let found = Found { gain, in_front, rms, essential: refined, pose, inliers, model };
                if best.as_ref().is_none_or(|best| found.is_better(best)) {
                    best = Some(found);
                }
            }
            Err(e) => why = e.to_string(),
        }
    }
    let Found { rms, essential, pose, inliers, model, .. } = best.ok_or(why)?;
    let kept: Vec<_> = seen.iter().zip(&inliers).filter(|&(_, &inlier)| inlier).map(|(s, _)| *s).collect();
    let log10_false_alarms = by_chance(seen, kept.len(), args)?;
    off_a_line(&kept)?;
    // Exact matches have the noise of their digits.
    if let Some(degrees) = only_turned(&kept, &essential, [&first, &second], rms.max(0.01)) {
        return Err(format!("the camera has only turned, by {degrees:.2} degrees: there is no translation"));
    }
    let in_baselines = pose.in_baselines();
    let views = TwoViews::new(first, second, in_baselines).map_err(|e| e.to_string())?;
    let point = |(s, &inlier): (&Correspondence<f64>, &bool)| {
        let point = inlier.then(|| views.optimal(s).ok()).flatten()?.point;
        Some([point.x, point.y, point.z])
    };
    let answer = Answer {
        essential: rows(essential.matrix()),
        rotation: rows(pose.rotation()),
        translation: (*in_baselines.translation()).into(),
        points: seen.iter().zip(&inliers).map(point).collect(),
        inliers,
        model,
        log10_false_alarms,
    };
    Ok((answer, rms))
}

/// Essential matrices to begin with: one of a scene with depth, two of a plane.
fn start(
    seen: &[Correspondence<f64>],
    first: &Camera<f64>,
    second: &Camera<f64>,
    args: &RobustArgs,
) -> Result<Vec<Start>, String> {
    let mut inliers = vec![true; seen.len()];
    let found = match args.method {
        TwoViewMethod::EightPoint => match eight_point(seen) {
            Err(EightPointError::Plane) => None,
            found => Some(found.map_err(|e| e.to_string())?),
        },
        TwoViewMethod::Ransac => {
            let config = RobustConfig { seed: args.seed, ..RobustConfig::new(args.threshold) };
            match robust_fundamental(seen, &config, &mut inliers) {
                Err(RobustError::Plane) => None,
                found => Some(found.map_err(|e| why(seen, &e))?.fundamental),
            }
        }
    };
    let kept: Vec<_> = seen.iter().zip(&inliers).filter(|&(_, &inlier)| inlier).map(|(s, _)| *s).collect();
    if let Some(f) = found {
        let within = seen.iter().filter(|s| f.sampson_px(s).abs() <= args.threshold).count();
        by_chance(seen, within, args)?;
    }
    let homography = match found {
        None => Some(Homography::from_correspondences(&kept).map_err(|e| e.to_string())?),
        Some(f) => {
            let squares: f64 = kept.iter().map(|s| f.sampson_squared_px2(s)).sum();
            // Exact matches have the noise of their digits.
            let sigma = (squares / kept.len() as f64).sqrt().max(0.01);
            match choose(&kept, sigma).map(|choice| choice.model) {
                Ok(TwoViewModel::Planar(h)) => Some(h),
                _ => None,
            }
        }
    };
    match (homography, found) {
        (None, Some(f)) => {
            let essential = Essential::from_fundamental(&f, first, second).map_err(|e| e.to_string())?;
            Ok(vec![(essential, "fundamental")])
        }
        (None, None) => Err("no model fits".to_owned()),
        (Some(h), _) => {
            let motions = h.recover_motions(kept, first, second).map_err(|e| match e {
                PlaneMotionError::NoBaseline => {
                    "the camera has only turned: there is no translation".to_owned()
                }
                e => e.to_string(),
            })?;
            let poses = motions.iter().filter_map(|(motion, _)| motion.relative_pose());
            let essential = poses.filter_map(|pose| Essential::from_pose(&pose.in_baselines()).ok());
            Ok(essential.map(|essential| (essential, "homography")).collect())
        }
    }
}

/// The camera without its lens.
fn pinhole(camera: &Camera<f64>) -> Result<Camera<f64>, String> {
    Camera::from_matrix(&camera.matrix()).map_err(|e| e.to_string())
}

/// The match as cameras without lenses would show it; `None` where a lens's coefficients describe no sight.
fn undistorted(seen: &Correspondence<f64>, cameras: &Cameras) -> Option<Correspondence<f64>> {
    let first = cameras.first.undistort(&seen.first).ok()?;
    let second = cameras.second.undistort(&seen.second).ok()?;
    Some(Correspondence { first, second })
}
