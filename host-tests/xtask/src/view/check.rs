//! The test step of the live page, in a browser.

use super::browser::Browser;
use super::faults::{what_is_wrong_is_said, without_simd_it_says_so};
use super::page::{COLOURS, LivePage, SHOWN, failed, hold, url_of};
use super::program::as_the_program;
use super::{cameras, copied, focus, openings, plan, report, video, wide};
use crate::steps::{Failure, Outcome, output_of};
use serde_json::Value;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};

/// Settings that are matched by the page and by the command that the page says: places in the lists of
/// methods, filters and noise, then disparities, least disparity and least confidence.
const MATCHED: [[i64; 6]; 7] = [
    [3, 1, 0, 64, 0, 0],
    [0, 1, 0, 64, 0, 0],
    [1, 2, 2, 96, 0, 0],
    [2, 0, 0, 64, 3, 0],
    [4, 1, 1, 48, 8, 30],
    [3, 2, 3, 128, 0, 60],
    [1, 0, 1, 16, 20, 0],
];
/// What can be used: 33 settings, 3 numbers and 2 choices of the cameras, 14 fields of the plan, 7 views, 4
/// openers, 9 buttons, 2 lists of cameras, 2 that unfold, the picture and the text to copy.
const CONTROLS: usize = 33 + 5 + 14 + 7 + 4 + 9 + 2 + 2 + 2;
const SEARCH: [&str; 6] = ["method", "filter", "noise", "disparities", "min_disparity", "min_confidence"];

/// The program that serves the page, until this is dropped.
struct Served {
    child: Child,
    url: String,
}

impl Served {
    fn start(stereo: &Path, module: &Path, out: &Path) -> Outcome<Self> {
        let mut command = Command::new(stereo);
        command.args(["view", "--port", "0", "--module"]).arg(module).arg("--out").arg(out);
        let mut child = command.stdout(Stdio::piped()).spawn().map_err(|e| failed(stereo, &e))?;
        let lines = child.stdout.take().into_iter().flat_map(|out| BufReader::new(out).lines());
        let mut words = lines
            .map_while(Result::ok)
            .flat_map(|line| line.split(' ').map(str::to_owned).collect::<Vec<_>>());
        let url = words.find(|word| word.starts_with("http://127.0.0.1:")).unwrap_or_default();
        Ok(Self { child, url })
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Builds the module and holds the page to the program `stereo`, which is built.
pub fn sample(stereo: &Path) -> Outcome {
    super::set_up()?;
    let module = super::module()?;
    let folder = tempfile::tempdir().map_err(|e| Failure::new(e.to_string()))?;
    let folder = folder.path();
    let (scene, out) = (folder.join("scene"), folder.join("view"));
    output_of(Command::new(stereo).arg("demo").arg("--out").arg(&scene))?;
    let served = Served::start(stereo, &module, &out)?;
    let mut page = LivePage::open(Browser::start()?, &served.url)?;
    hold(page.text("message")?.is_empty(), || "the built-in scene is not matched".to_owned())?;
    every_setting_matches_as_the_program(&mut page, stereo, &scene)?;
    every_control_says_what_it_stands_at(&mut page)?;
    copied::it_compiles(&mut page, folder)?;
    the_work_is_that_of_plan(&mut page, stereo)?;
    every_view_shows_something(&mut page)?;
    keys_and_names_reach_everything(&mut page)?;
    what_is_wrong_is_said(&mut page, folder, &scene)?;
    cameras::impossible_ones_leave_the_other_views(&mut page)?;
    openings::the_later_one_counts(&mut page, folder)?;
    openings::without_room_nothing_is_shown(&mut page, folder)?;
    openings::large_frames_are_refused(&mut page)?;
    cameras::a_calibration_gives_metres_and_rectifies(&mut page, stereo, &scene)?;
    cameras::a_calibration_that_is_none_is_named(&mut page, &scene)?;
    plan::it_is_that_of_the_program(&mut page, stereo)?;
    cameras::a_camera_is_matched_frame_by_frame(&mut page)?;
    cameras::two_cameras_are_matched_frame_by_frame(&mut page)?;
    video::a_video_is_matched_frame_by_frame(&mut page, folder)?;
    video::a_sequence_is_matched_frame_by_frame(&mut page, stereo, &scene)?;
    video::a_sequence_ends_with_a_whole_frame(&mut page, stereo, folder, &scene)?;
    let requests = page.requests();
    hold(requests == [served.url.as_str()], || format!("the page asks for {requests:?}"))?;
    let thrown = page.thrown();
    hold(thrown.is_empty(), || format!("not caught: {thrown:?}"))?;
    drop(page);

    let url = url_of(&out.join("index.html"));
    let mut page = LivePage::open(Browser::start()?, &url)?;
    let (said, figures) = (page.text("message")?, page.text("figures")?);
    hold(said.is_empty() && figures.contains(" ms a frame"), || format!("as a file: {said}"))?;
    let requests = page.requests();
    hold(requests == [url.as_str()], || format!("as a file the page asks for {requests:?}"))?;
    println!("{figures}");
    without_simd_it_says_so(&url)?;
    report::it_answers_as_the_files_do(&scene)?;
    report::without_depths_it_tells_no_keys_of_points(stereo, &scene)?;
    wide::it_answers_as_the_files_do(stereo, &scene)?;
    focus::it_answers_as_the_files_do(stereo, folder)
}

/// Disparities, flags and confidences are those of the command line that the page says, to the bit.
fn every_setting_matches_as_the_program(page: &mut LivePage, stereo: &Path, scene: &Path) -> Outcome {
    for settings in MATCHED {
        for (name, value) in SEARCH.into_iter().zip(settings) {
            page.set(name, value)?;
        }
        as_the_program(page, stereo, scene)?;
    }
    Ok(())
}

/// Every slider and switch moves its setting in the module, and a slider says another thing at its other end;
/// the filter's button takes them back.
fn every_control_says_what_it_stands_at(page: &mut LivePage) -> Outcome {
    page.set("method", 3)?;
    page.set("filter", 1)?;
    let list = "CONTROLS.map(({ name, min, max, words, say }) => ({ name, min, max, list: words?.length }))";
    let Value::Array(controls) = page.browser.value(list)? else {
        return Err(Failure::new("the page has no controls"));
    };
    hold(controls.len() == 33, || format!("{} controls", controls.len()))?;
    for (place, control) in controls.iter().enumerate() {
        let name = control["name"].as_str().unwrap_or_default();
        if control["list"].is_u64() {
            continue;
        }
        let ends = ["min", "max"].map(|end| control[end].as_i64());
        let [low, high] = if let [Some(low), Some(high)] = ends { [low, high] } else { [0, 1] };
        let mut said = Vec::new();
        for value in [low, high] {
            page.set(name, value)?;
            let setting = page.browser.value(&format!("state.core.settings[{place}]"))?;
            hold(setting == value, || format!("{name} at {value}: the module has {setting}"))?;
            if control["min"].is_i64() {
                said.push(page.text(&format!("{name}-says"))?);
            }
        }
        hold(said.is_empty() || said[0] != said[1], || format!("{name} says {said:?}"))?;
    }
    // Many of them at their ends are too much together, which is said.
    hold(!page.text("message")?.is_empty(), || "penalties out of order are not refused".to_owned())?;
    page.set("disparities", 64)?;
    page.set("min_disparity", 0)?;
    page.set("min_confidence", 0)?;
    page.press("restore")?;
    let said = page.text("message")?;
    hold(said.is_empty(), || format!("after the filter's button: {said}"))
}

/// Memory and instructions for a frame are those that `stereo plan` says.
fn the_work_is_that_of_plan(page: &mut LivePage, stereo: &Path) -> Outcome {
    for (place, method) in ["fast", "block", "sgm-lean", "sgm", "sgm-edge"].into_iter().enumerate() {
        page.set("method", place as i64)?;
        let mut plan = Command::new(stereo);
        plan.args(["plan", "--baseline-mm", "80", "--focal-px", "500", "--size", "640x480", "--json"]);
        plan.args(["--nearest", "0.65", "--farthest", "50", "--method", method]);
        let plan: Value =
            serde_json::from_str(&output_of(&mut plan)?).map_err(|e| Failure::new(e.to_string()))?;
        let disparities = plan["search"]["disparities"].as_i64().unwrap_or(0);
        page.set("disparities", disparities)?;
        let memory = page.text("memory")?;
        for work in plan["work"].as_array().into_iter().flatten() {
            let (core, bytes) = (&work["core"], &work["ram_bytes"]);
            hold(memory.contains(&format!(": {bytes} bytes")), || format!("{memory} {core}: {bytes}"))?;
            let count = page.browser.value(&format!(
                "instructions({core}, state.settings[at('method')], 640 * 480, {disparities})"
            ))?;
            let [count, planned] = [&count, &work["instructions"]].map(|n| n.as_f64().unwrap_or(f64::NAN));
            hold((count / planned - 1.0).abs() < 1e-5, || format!("{method} {core}: {count}, {planned}"))?;
        }
    }
    page.set("method", 3)?;
    page.set("disparities", 64)
}

/// Every view paints more than one colour and says what they mean.
fn every_view_shows_something(page: &mut LivePage) -> Outcome {
    for view in ["left", "right", "disparity", "depth", "flags", "confidence", "points"] {
        page.press(&format!("view-{view}"))?;
        let colours = page.browser.value(COLOURS)?;
        let legend = page.text("legend")?;
        hold(colours.as_i64() > Some(2) && !legend.is_empty(), || {
            format!("the view {view} has {colours} colours and says '{legend}'")
        })?;
    }
    let before = page.browser.value(SHOWN)?;
    page.browser.value("canvas.focus()")?;
    page.key("ArrowLeft")?;
    let after = page.browser.value(SHOWN)?;
    hold(before != after, || "the points do not turn".to_owned())?;
    page.press("view-disparity")
}

/// Keys move the cursor, and everything that can be used has a name and can have the focus.
fn keys_and_names_reach_everything(page: &mut LivePage) -> Outcome {
    page.browser.value("cursor.x = 400; cursor.y = 300; canvas.focus()")?;
    page.key("ArrowRight")?;
    let said = page.text("pixel")?;
    let parts = ["column 401, row 300", " px, sigma ", " mm, sigma ", "confidence ", "flags: "];
    hold(parts.iter().all(|part| said.contains(part)), || format!("the pixel says '{said}'"))?;
    page.keys_reach_everything(CONTROLS)
}
