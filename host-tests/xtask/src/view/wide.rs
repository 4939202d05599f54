//! The report of images that are larger than its pictures.

use super::page::{failed, hold, url_of};
use super::report::{opened, pixels_are_those_of_the_files};
use crate::steps::{Outcome, output_of};
use image::imageops::{FilterType, resize};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Columns and rows: those of the page's pictures are fewer by shares that differ.
const SIZE: (u32, u32) = (1344, 391);

/// Matches a scene's pair, made wider, and holds the report to the files beside it.
pub fn it_answers_as_the_files_do(stereo: &Path, scene: &Path) -> Outcome {
    let folder = scene.join("wide");
    fs::create_dir(&folder).map_err(|e| failed(&folder, &e))?;
    let mut run = Command::new(stereo);
    run.args(["match", "--disparities", "128", "--quiet"]);
    for side in ["left", "right"] {
        let (from, to) = (scene.join(side).with_extension("png"), folder.join(side).with_extension("png"));
        let picture = image::open(&from).map_err(|e| failed(&from, &e))?.into_luma8();
        resize(&picture, SIZE.0, SIZE.1, FilterType::Triangle).save(&to).map_err(|e| failed(&to, &e))?;
        run.arg(format!("--{side}")).arg(to);
    }
    output_of(run.args(["--focal-px", "650", "--baseline-mm", "80", "--out"]).arg(&folder))?;

    let mut page = opened(&url_of(&folder.join("report.html")))?;
    let width = page.browser.value("state.planes.width")?;
    hold(width.as_u64() < Some(SIZE.0.into()), || format!("the page's picture has {width} columns"))?;
    pixels_are_those_of_the_files(&mut page, &folder)?;
    let thrown = page.thrown();
    hold(thrown.is_empty(), || format!("not caught: {thrown:?}"))
}
