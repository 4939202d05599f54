//! `stereo eval`: results of any program, or of this one, beside a known truth.

mod altered;
mod rival;
mod table;

use crate::failure::Failure;
use crate::frame::{Matched, matched};
use crate::look::{Disparities, Look, Looked, SearchArgs, disparities, look};
use crate::place::Place;
use crate::results::depth_unit;
use crate::shared::{BalanceArgs, MethodArgs, min_disparity, print, remark};
use clap::Args;
use rival::Rival;
use std::path::{Path, PathBuf};
use stereopsis_host::calibration::Calibration;
use stereopsis_host::eval::{DisparityFile, Measures, Results, Scene, Truth, confidence};
use stereopsis_host::real::Alteration;
use table::{Evaluated, Evaluation, Scenes};

/// What follows the options in the command's help.
pub const EXAMPLE: &str = "Examples:
  stereo eval --found out/disparity.pfm --truth disp0.pfm --mask mask0nocc.png
  stereo eval --found results --truth MiddEval3/trainingQ
  stereo eval --scenes kitti/training --method sgm --disparities auto --csv kitti.csv
  stereo eval --scenes MiddEval3/trainingQ --opencv --altered noise:5

Disparities are PFM (px) or PNG (px x 256, 0 where there is none). Folders are those of Middlebury 2014 \
                           (SCENE/disp0.pfm), ETH3D (SCENE/disp0GT.pfm), KITTI (disp_occ_0/000000_10.png) \
                           and this program's (SCENE/gt.png and meta.json, or what demo writes); results in \
                           them are SCENE/disparity.pfm, SCENE/disp0.pfm, SCENE.pfm or SCENE.png.";

#[derive(Debug, Args)]
pub struct EvalArgs {
    /// Results: a file, or a folder with one for each scene
    #[arg(long, value_name = "PATH", requires = "truth", required_unless_present = "scenes",
        conflicts_with_all = ["method", "filter", "noise", "min_confidence", "threads", "balance"])]
    found: Option<PathBuf>,
    /// The truth: a file, or a folder of scenes
    #[arg(long, value_name = "PATH", requires = "found")]
    truth: Option<PathBuf>,
    /// A folder of scenes that are matched here
    #[arg(long, value_name = "DIR", conflicts_with_all = ["found", "truth"])]
    scenes: Option<PathBuf>,
    /// What is scored of a truth that is a file: where this picture is 255
    #[arg(long, value_name = "FILE", requires = "found", conflicts_with = "scenes")]
    mask: Option<PathBuf>,
    /// How sure the results of a file are: a byte a pixel, more is surer
    #[arg(long, value_name = "FILE", requires = "found", conflicts_with = "scenes")]
    confidence: Option<PathBuf>,
    /// Steps of a PNG of results in a pixel
    #[arg(long, value_name = "N", default_value = "256", conflicts_with = "scenes", value_parser = scale,
        allow_negative_numbers = true)]
    found_scale: f64,
    /// Steps of a PNG of a truth that is a file in a pixel
    #[arg(long, value_name = "N", default_value = "256", conflicts_with = "scenes", value_parser = scale,
        allow_negative_numbers = true)]
    truth_scale: f64,
    /// Results are depths, m, which this calibration makes disparities of
    #[arg(long, value_name = "FILE", requires = "found", conflicts_with = "scenes")]
    depths_by: Option<PathBuf>,
    /// The truth holds depths, too
    #[arg(long, requires = "depths_by")]
    truth_depths: bool,
    /// Length of a step of a PNG of depths, m: 0.001 where none is given
    #[arg(long, value_name = "M", requires = "depths_by", value_parser = depth_unit,
        allow_negative_numbers = true)]
    depth_unit: Option<f64>,
    /// How many whole disparities are searched in scenes that are matched here, or auto; what the scene says
    /// where none is given, and auto where it says nothing
    #[arg(long, value_name = "N|auto", conflicts_with = "found", value_parser = disparities,
        allow_negative_numbers = true)]
    disparities: Option<Disparities>,
    /// The smallest disparity searched, px
    #[arg(long, value_name = "M", conflicts_with = "found", value_parser = min_disparity,
        allow_negative_numbers = true)]
    min_disparity: Option<u16>,
    /// Runs OpenCV's StereoBM and StereoSGBM on the same scenes, by a Python that has it: python3 where none
    /// is named
    #[arg(long, value_name = "PYTHON", num_args = 0..=1, default_missing_value = "python3",
        conflicts_with = "found")]
    opencv: Option<PathBuf>,
    /// Matches the scenes as worse cameras would have taken them: noise:SIGMA (Gaussian noise of both images,
    /// grey levels), exposure:GAIN:OFFSET or gamma:GAMMA (of the right image), or half-row (the right image
    /// half a row low)
    #[arg(long, value_name = "HOW", conflicts_with = "found", value_parser = altered::alteration)]
    altered: Option<Alteration>,
    #[command(flatten)]
    method: MethodArgs,
    #[command(flatten)]
    balance: BalanceArgs,
    /// Print one JSON object in place of the table
    #[arg(long)]
    json: bool,
    /// Write the table into a file, too
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
}

/// The share of wrong answers above which two files do not seem to be in one unit.
const MOST_WRONG: f64 = 0.9;

fn scale(text: &str) -> Result<f64, &'static str> {
    let value = text.parse().ok().filter(|value| (0.001..=65536.0).contains(value));
    value.ok_or("a number from 0.001 to 65536 is needed")
}

pub fn run(args: &EvalArgs) -> Result<(), Failure> {
    let csv = args.csv.as_deref().map(|path| Place::of("--csv", path)).transpose()?;
    let mut beside = Vec::new();
    let scenes = match (&args.scenes, args.found.as_deref().zip(args.truth.as_deref())) {
        (Some(folder), _) => {
            let all = Scene::all(folder)?;
            let mut rival = args.opencv.as_deref().map(Rival::new).transpose()?;
            // The seed tells the scenes apart: the same noise in all of them would count but once.
            let matched = |(scene, seed)| by_matching(args, scene, seed, rival.as_mut());
            let scenes = all.iter().zip(1..).map(matched).collect::<Result<Vec<_>, _>>()?;
            if let Some(rival) = rival {
                beside = rival.evaluated(&all)?;
            }
            scenes
        }
        (None, Some((found, truth))) if truth.is_dir() => of_folders(args, found, truth)?,
        (None, Some((found, truth))) => vec![of_files(args, found, truth)?],
        (None, None) => return Err(Failure::usage("--found: is missing; give it and --truth, or --scenes")),
    };
    let altered = args.altered.map(Alteration::name);
    let evaluation = Evaluation { own: Scenes::new(scenes), altered, beside };
    if let Some(place) = csv {
        let bytes = evaluation.csv()?;
        place.write(|out| out.write_all(&bytes), None)?;
    }
    if args.json {
        return print(&(serde_json::to_string_pretty(&evaluation)? + "\n"));
    }
    print(&evaluation.table())
}

/// How results are read.
fn found_file(args: &EvalArgs) -> Result<DisparityFile, Failure> {
    let Some(path) = &args.depths_by else {
        return Ok(DisparityFile { scale: args.found_scale, depths_of: None });
    };
    let rig = Calibration::open(path, Path::new(""))?.rig;
    Ok(DisparityFile { scale: 1.0 / args.depth_unit.unwrap_or(0.001), depths_of: Some(rig) })
}

/// A file beside a file.
fn of_files(args: &EvalArgs, found: &Path, truth_path: &Path) -> Result<Evaluated, Failure> {
    let file = found_file(args)?;
    let of_disparities = DisparityFile { scale: args.truth_scale, depths_of: None };
    let of_truth = if args.truth_depths { file } else { of_disparities };
    let truth = Truth::read(truth_path, &of_truth, args.mask.as_deref(), 0)?;
    let name = found.file_name().unwrap_or_default().to_string_lossy().into_owned();
    compared(&file, name, found, args.confidence.as_deref(), &truth)
}

/// Every scene of a folder beside its result in another one.
fn of_folders(args: &EvalArgs, found: &Path, truth: &Path) -> Result<Vec<Evaluated>, Failure> {
    if let Some((option, path)) = [("--mask", &args.mask), ("--confidence", &args.confidence)]
        .iter()
        .find_map(|(o, p)| Some((o, (*p).as_ref()?)))
    {
        let path = path.display();
        return Err(Failure::new(format!(
            "{option} {path}: is for a truth that is a file; folders have their own"
        )));
    }
    if args.truth_depths {
        return Err(Failure::new(format!(
            "--truth-depths: is for a truth that is a file, and {} is a folder; those of folders are \
             disparities",
            truth.display()
        )));
    }
    let (file, scenes) = (found_file(args)?, Scene::all(truth)?);
    let results = Results::open(found)?;
    let evaluated = |scene: &Scene| {
        let (result, sure) = results.of(scene)?;
        compared(&file, scene.name.clone(), &result, sure.as_deref(), &scene.read_truth()?)
    };
    scenes.iter().map(evaluated).collect()
}

fn compared(
    file: &DisparityFile,
    scene: String,
    found: &Path,
    sure: Option<&Path>,
    truth: &Truth,
) -> Result<Evaluated, Failure> {
    let answers = file.read_beside(found, &truth.scored)?;
    let sure = sure.map(|path| confidence(path, &truth.scored)).transpose()?;
    // A truth has scored pixels, else it is refused.
    let measures = Measures::of(&answers.values, truth, sure.as_deref()).unwrap_or_default();
    if !measures.score.has_answers() {
        remark(&format!(
            "warning: {}: no scored pixel has an answer; the means of errors leave the scene out",
            found.display()
        ));
    } else if measures.score.bad2 > MOST_WRONG {
        remark(&format!(
            "warning: {}: {:.0} % of the answers are over 2 px off: are both files in px? --depths-by is for \
             results in metres, --truth-depths for a truth in metres, --found-scale and --truth-scale for \
             other steps of a PNG",
            found.display(),
            100.0 * measures.score.bad2
        ));
    }
    Ok(Evaluated { scene, disparities: None, time_ms: None, measures })
}

/// A scene that is matched here, as `match` does it.
fn by_matching(
    args: &EvalArgs,
    scene: &Scene,
    seed: u64,
    rival: Option<&mut Rival>,
) -> Result<Evaluated, Failure> {
    let truth = scene.read_truth()?;
    let (mut pair, [left, right]) = altered::pair(scene, args.altered, seed)?;
    let (width, height) = (pair.width, pair.height);
    let size = (truth.scored.width, truth.scored.height);
    if size != (usize::from(width), usize::from(height)) {
        return Err(Failure::new(format!(
            "{}: is {} x {} px, and the images {width} x {height} px; give the truth of these images",
            scene.truth.display(),
            size.0,
            size.1
        )));
    }
    let stated = scene.disparities.map(|n| Disparities::Count(n.min(width)));
    let search = SearchArgs {
        disparities: args.disparities.or(stated).unwrap_or(Disparities::Auto),
        min_disparity: args.min_disparity,
        force: false,
    };
    let named = |e: Failure| Failure::new(format!("{}: {e}", scene.name));
    search.check(&args.method, width, height).map_err(named)?;
    let Look { config, .. } =
        look(&search, &args.method, &Looked::of([&left, &right]), || None).map_err(named)?;
    if let Some(rival) = rival {
        rival.take([&left, &right], [config.disparities, config.min_disparity])?;
    }
    let Matched { config, outcome, .. } = matched(&args.method, &args.balance, config, &mut pair.camera)?;
    let map = &outcome.map;
    let measures = Measures::of(&map.pixels(), &truth, Some(&map.confidence)).unwrap_or_default();
    Ok(Evaluated {
        scene: scene.name.clone(),
        disparities: Some(config.disparities),
        time_ms: Some(outcome.time_ms),
        measures,
    })
}
