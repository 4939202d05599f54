//! The report of a focus stack in a browser: what it says is what the files of the run say.

use super::page::{COLOURS, LivePage, failed, hold, numbers, url_of};
use super::report::opened;
use crate::steps::{Outcome, output_of};
use image::{GrayImage, Luma, imageops};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Columns and rows of the frames, and how many there are.
const SIZE: (u32, u32) = (120, 80);
const FRAMES: u32 = 9;
/// What can be used: five views, three sliders, the picture.
const CONTROLS: usize = 5 + 3 + 1;

/// Makes a stack that is sharp in its third frame on the left and in its sixth on the right, and holds its
/// report to the files beside it.
pub fn it_answers_as_the_files_do(stereo: &Path, folder: &Path) -> Outcome {
    let (stack, out) = (folder.join("stack"), folder.join("focus"));
    fs::create_dir(&stack).map_err(|e| failed(&stack, &e))?;
    let (width, height) = SIZE;
    let spots = GrayImage::from_fn(width, height, |x, y| {
        Luma([((x * x * 7 + y * y * 13 + x * y * 5) % 11 * 23) as u8])
    });
    let mut positions = "image_distance_mm\n".to_owned();
    for frame in 1..=FRAMES {
        let blurred = |best: u32| imageops::blur(&spots, 0.3 + 0.5 * frame.abs_diff(best) as f32);
        let (left, right) = (blurred(3), blurred(6));
        let all = GrayImage::from_fn(width, height, |x, y| {
            *if x < width / 2 { &left } else { &right }.get_pixel(x, y)
        });
        let path = stack.join(format!("frame{frame}.png"));
        all.save(&path).map_err(|e| failed(&path, &e))?;
        positions += &format!("{}\n", 4.04 + 0.01 * f64::from(frame));
    }
    let path = folder.join("positions.csv");
    fs::write(&path, positions).map_err(|e| failed(&path, &e))?;
    let mut run = Command::new(stereo);
    run.args(["focus", "--focal-length-mm", "4", "--focal-px", "150", "--frames"]).arg(&stack);
    output_of(run.arg("--positions").arg(&path).arg("--out").arg(&out))?;

    let url = url_of(&out.join("report.html"));
    let mut page = opened(&url)?;
    pixels_are_those_of_the_files(&mut page, &out)?;
    let all = page.text("figures")?;
    hold(all.ends_with(" % of the pixels have an answer that is shown."), || format!("'{all}' is said"))?;
    for (name, value) in [("least", 250), ("first", 4 * 256), ("last", 4 * 256)] {
        let start = page.browser.value(&format!("Number(byId('{name}').value)"))?.as_i64().unwrap_or(0);
        page.set(name, value)?;
        let fewer = page.text("figures")?;
        hold(fewer != all, || format!("the slider {name} changes nothing: '{fewer}'"))?;
        page.set(name, start)?;
    }
    for view in ["all-in-focus", "sharpest-frame", "confidence", "depth", "points"] {
        page.press(&format!("view-{view}"))?;
        let (colours, legend) = (page.browser.value(COLOURS)?, page.text("legend")?);
        let is_shown = colours.as_i64() > Some(2) && !legend.is_empty();
        hold(is_shown, || format!("the view {view} has {colours} colours and says '{legend}'"))?;
        let name = page.browser.value("canvas.getAttribute('aria-label')")?;
        let due = format!("{} of {}", view.replace('-', " "), stack.display());
        hold(name == due, || format!("the view {view} is called {name}, not '{due}'"))?;
    }
    page.keys_reach_everything(CONTROLS)?;
    let (requests, thrown) = (page.requests(), page.thrown());
    hold(requests == [url.as_str()] && thrown.is_empty(), || format!("{requests:?} {thrown:?}"))
}

/// The frame, the confidence and the depth of pixels all over the picture, to the digits that are said.
fn pixels_are_those_of_the_files(page: &mut LivePage, out: &Path) -> Outcome {
    let [index, confidence, depth] =
        ["index.pfm", "confidence.pfm", "depth.pfm"].map(|name| numbers(&out.join(name)));
    let (index, confidence, depth) = (index?, confidence?, depth?);
    let places: Vec<_> = (0..index.values.len()).step_by(67).collect();
    let asked: Vec<_> = places.iter().map(|at| [at % index.width, at / index.width]).collect();
    let said =
        page.browser.value(&format!("{}.map(([x, y]) => describeFocus(state, x, y))", json!(asked)))?;
    let said: Vec<_> = said.as_array().into_iter().flatten().filter_map(Value::as_str).collect();
    hold(said.len() == places.len(), || format!("{} pixels of {} are told", said.len(), places.len()))?;
    let mut answered = 0;
    for (&at, said) in places.iter().zip(said) {
        let number = |before: &str| -> Option<f32> {
            let word = said.split_once(before)?.1.split([' ', ';']).next()?;
            word.parse().ok()
        };
        if !index.values[at].is_finite() {
            hold(said.ends_with("no answer"), || format!("'{said}' of a pixel without an answer"))?;
            continue;
        }
        answered += 1;
        let near = |found: Option<f32>, due: f32, most: f32| found.is_some_and(|n| (n - due).abs() <= most);
        let is_told = near(number("in frame "), index.values[at], 0.01)
            && near(number("confidence "), confidence.values[at].max(1.0 / 255.0), 0.01)
            && near(number("depth "), depth.values[at], 0.01 * depth.values[at]);
        hold(is_told, || {
            format!("'{said}': {}, {}, {}", index.values[at], confidence.values[at], depth.values[at])
        })?;
    }
    println!("the report of a focus stack says of {answered} pixels what the files say");
    hold(answered > 50, || format!("{answered} pixels have an answer"))
}
