//! `cargo xtask altered`: how right the methods are on real pairs that worse cameras took, beside OpenCV.
//!
//! * `opencv`: the other columns. `table`: what is printed and written.
//!
//! The alterations and the score are the host's: [`stereopsis_host::real`]. OpenCV gets the very same altered
//! images.

mod opencv;
mod table;

use crate::firmware::tables::{Part, Readme, into_readme};
use crate::steps::{Failure, Outcome};
use clap::Args;
use image::GrayImage;
use std::io::Write;
use std::path::{Path, PathBuf};
use stereopsis::matching::{Config, Filter};
use stereopsis_host::eval::{EvalError, OpenCv, OpenCvScene};
use stereopsis_host::real::{Alteration, RealScene, Score};
use stereopsis_host::run::{MemoryPair, MethodName, measure_balance, measure_noise, run as match_pair};
use table::Column;
use tempfile::NamedTempFile;

/// The options of `altered`.
#[derive(Args)]
pub struct Arguments {
    /// Folder of scenes: folders with left.png, right.png, gt.png, nonocc.png and meta.json
    #[arg(long, value_name = "DIR")]
    data: PathBuf,
    /// File for the tables, in Markdown
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// A Python that has numpy and OpenCV; else one is set up in the folder of build products
    #[arg(long, value_name = "PATH")]
    python: Option<PathBuf>,
    /// The methods of this library alone
    #[arg(long, conflicts_with = "python")]
    without_opencv: bool,
    /// Writes the first table into docs/performance.md
    #[arg(long, conflicts_with = "without_opencv")]
    readme: bool,
    /// Fails when the table of docs/performance.md is another, and writes nothing there
    #[arg(long, conflicts_with_all = ["readme", "without_opencv"])]
    check: bool,
}

/// The part of docs/performance.md.
const PART: Part = Part { name: "altered", command: "cargo xtask altered --data DIR --readme" };

/// Measures, prints and writes.
pub fn run(arguments: &Arguments) -> Outcome {
    // What cannot be done shows before the long work.
    let out = arguments.out.as_deref().map(prepared).transpose()?;
    let scenes = RealScene::all(&arguments.data).map_err(|e| Failure::new(format!("--data: {e}")))?;
    let opencv =
        if arguments.without_opencv { None } else { Some(opencv::find(arguments.python.as_deref())?) };
    let columns = columns(&scenes, opencv.as_ref())?;
    let version = opencv.as_ref().map(|opencv| opencv.version.as_str());
    let page = table::page(&columns, scenes.len(), version, OpenCv::PARAMETERS);
    println!("{page}");
    if let Some((file, path)) = out {
        keep(file, path, &page).map_err(|e| Failure::new(format!("--out: {}: {e}", path.display())))?;
    }
    if arguments.readme || arguments.check {
        let note = format!("OpenCV {}: {}.", version.unwrap_or_default(), OpenCv::PARAMETERS);
        let text = format!("{}\n{note}\n", table::of(&columns, |score| score.missed));
        into_readme(&PART, &text, Readme::of_check(arguments.check))?;
    }
    Ok(())
}

/// A file beside the one that is asked for, whose place it takes when it is complete.
fn prepared(path: &Path) -> Outcome<(NamedTempFile, &Path)> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let failed = |e: &dyn std::fmt::Display| {
        Failure::new(format!("--out: {}: {e}; name a file in a folder", path.display()))
    };
    if path.is_dir() {
        return Err(failed(&"is a folder"));
    }
    NamedTempFile::new_in(folder).map(|file| (file, path)).map_err(|e| failed(&e))
}

fn keep(mut file: NamedTempFile, path: &Path, text: &str) -> std::io::Result<()> {
    file.write_all(text.as_bytes())?;
    file.persist(path).map(drop).map_err(|e| e.error)
}

/// The scores of OpenCV's matchers, if it is there, and of all methods.
fn columns(scenes: &[RealScene], opencv: Option<&OpenCv>) -> Outcome<Vec<Column>> {
    let theirs = if opencv.is_some() { OpenCv::MATCHERS.as_slice() } else { &[] };
    let names = theirs.iter().map(|name| format!("OpenCV {name}"));
    let names = names.chain(MethodName::ALL.map(|method| format!("`{method}`")));
    let mut columns: Vec<_> = names.map(|name| Column { name, scores: Vec::new() }).collect();
    for alteration in Alteration::ALL {
        let folder = tempfile::tempdir().map_err(|e| Failure::new(e.to_string()))?;
        let mut scores = vec![Vec::new(); columns.len()];
        let (of_opencv, of_methods) = scores.split_at_mut(theirs.len());
        // The seed tells the scenes apart: the same noise in all of them would count but once.
        for (scene, seed) in scenes.iter().zip(1..) {
            let pair = alteration.apply([&scene.left, &scene.right], seed);
            for (scores, method) in of_methods.iter_mut().zip(MethodName::ALL) {
                scores.push(scored(scene, answers(method, scene, &pair)?)?);
            }
            for (image, side) in pair.iter().zip(["left", "right"]).filter(|_| opencv.is_some()) {
                let path = folder.path().join(format!("{}-{side}.pgm", scene.name));
                image.save(&path).map_err(|e| Failure::new(format!("{}: {e}", path.display())))?;
            }
        }
        if let Some(opencv) = opencv {
            let searched =
                scenes.iter().map(|scene| OpenCvScene { name: &scene.name, search: [scene.disparities, 0] });
            let failed = |e: EvalError| Failure::new(e.to_string());
            opencv.run(folder.path(), &searched.collect::<Vec<_>>()).map_err(failed)?;
            for (scores, matcher) in of_opencv.iter_mut().zip(theirs) {
                for scene in scenes {
                    let found = OpenCv::answers(folder.path(), &scene.name, matcher).map_err(failed)?;
                    scores.push(scored(scene, found.values)?);
                }
            }
        }
        for (column, scores) in columns.iter_mut().zip(&scores) {
            column.scores.push(Score::mean(scores));
        }
        println!("{}: {} scenes are matched", alteration.name(), scenes.len());
    }
    println!();
    Ok(columns)
}

/// What a method finds, px; infinite where there is no answer.
fn answers(method: MethodName, scene: &RealScene, [left, right]: &[GrayImage; 2]) -> Outcome<Vec<f32>> {
    let failed = |e: &dyn std::fmt::Display| Failure::new(format!("{}, {method}: {e}", scene.name));
    let (width, height) = (left.width() as u16, left.height() as u16);
    let pair = |right: Vec<u8>| {
        MemoryPair::new(width, left.to_vec(), right).ok_or_else(|| failed(&"the pictures are empty"))
    };
    let mut right = right.to_vec();
    if method.compares_brightness() {
        // As `stereo match` does it.
        measure_balance(&mut pair(right.clone())?).map_err(|e| failed(&e))?.line(&mut right);
    }
    let mut camera = pair(right)?;
    let noise = measure_noise(&mut camera).map_err(|e| failed(&e))?.level();
    let search = Config { noise, ..method.config(width, height, scene.disparities) };
    let config = method.with_filter(Filter::Default, search);
    let outcome = match_pair(method, &config, &mut camera, |_| ());
    outcome.map(|outcome| outcome.map.pixels()).map_err(|e| failed(&e))
}

fn scored(scene: &RealScene, answers: Vec<f32>) -> Outcome<Score> {
    let failed = |what: &str| Failure::new(format!("{}: {what}", scene.name));
    if answers.len() != scene.truth.len() {
        return Err(failed("the answers are not as many as the pixels"));
    }
    Score::of(answers.into_iter().map(Some), &scene.truth).ok_or_else(|| failed("no pixel is scored"))
}
