//! The report of images that are larger than its pictures.

use super::page::{LivePage, failed, hold, numbers, url_of};
use super::report::{opened, pixels_are_those_of_the_files};
use crate::steps::{Outcome, output_of};
use image::imageops::{FilterType, resize};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Columns and rows: those of the page's pictures are fewer by shares that differ.
const SIZE: (u32, u32) = (1344, 391);
/// Focal length, px, and the axis, which is not in the middle of the images; the cameras look apart, so that
/// what is far is behind infinity.
const FOCAL_PX: f32 = 650.0;
const AXIS: [f32; 2] = [600.0, 150.0];
const CAMERAS: &str = "cam0=[650 0 600; 0 650 150; 0 0 1]
cam1=[650 0 580; 0 650 150; 0 0 1]
doffs=-20
baseline=2000
width=1344
height=391
ndisp=128
";
/// Up to this depth the page shows points and has colours, m.
const FARTHEST_M: f32 = 65.535;

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
    let calibration = folder.join("calib.txt");
    fs::write(&calibration, CAMERAS).map_err(|e| failed(&calibration, &e))?;
    output_of(run.arg("--calib").arg(&calibration).arg("--out").arg(&folder))?;

    let mut page = opened(&url_of(&folder.join("report.html")))?;
    let width = page.browser.value("state.planes.width")?;
    hold(width.as_u64() < Some(SIZE.0.into()), || format!("the page's picture has {width} columns"))?;
    pixels_are_those_of_the_files(&mut page, &folder)?;
    what_is_far_has_a_colour_and_a_distance(&mut page)?;
    points_are_those_of_the_cameras(&mut page, &folder)?;
    let thrown = page.thrown();
    hold(thrown.is_empty(), || format!("not caught: {thrown:?}"))
}

/// What is beyond all colours has the last one, and the legend says so; at infinity the slider says that.
fn what_is_far_has_a_colour_and_a_distance(page: &mut LivePage) -> Outcome {
    page.press("view-depth")?;
    let black = page.browser.value(
        "(() => { const words = new Uint32Array(image.data.buffer); return [...state.planes.disparity.keys()]\
         .filter((i) => state.planes.disparity[i] !== NO_ANSWER && words[i] === BLACK).length; })()",
    )?;
    let (legend, far) = (page.text("legend")?, page.text("far-says")?);
    let is_said = legend.contains(" m and beyond") && far.starts_with("infinity (");
    hold(black == 0 && is_said, || format!("{black} answers are black; '{legend}', '{far}'"))
}

/// The points reach as far to the left and right, up, down and away as those of the files' depths do.
fn points_are_those_of_the_cameras(page: &mut LivePage, run: &Path) -> Outcome {
    page.press("view-points")?;
    let found = page.browser.value(
        "[0, 1, 2].map((axis) => { const all = cloud.points.places.filter((_, i) => i % 3 === axis); \
         return [all.reduce((a, b) => Math.min(a, b)), all.reduce((a, b) => Math.max(a, b))]; })",
    )?;
    let path = run.join("depth.pfm");
    let depth = numbers(&path)?;
    let mut due = [[f32::INFINITY, f32::NEG_INFINITY]; 3];
    for (i, &z) in depth.values.iter().enumerate().filter(|&(_, &z)| z <= FARTHEST_M) {
        let across = [i % depth.width, i / depth.width].map(|at| at as f32);
        let [x, y] = [0, 1].map(|axis| (across[axis] - AXIS[axis]) * z / FOCAL_PX);
        // Up and back, as the page has them.
        for ([least, most], value) in due.iter_mut().zip([x, -y, -z]) {
            (*least, *most) = (least.min(value), most.max(value));
        }
    }
    // A pixel that the page leaves out may be the outermost one.
    let is_near = |axis: usize, end: usize| {
        let length = due[axis][1] - due[axis][0];
        found[axis][end].as_f64().is_some_and(|n| (n as f32 - due[axis][end]).abs() < 0.02 * length)
    };
    let holds = (0..3).all(|axis| is_near(axis, 0) && is_near(axis, 1));
    hold(holds, || format!("points reach to {found}, those of {} to {due:?}", path.display()))
}
