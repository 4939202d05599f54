//! The live page's cameras: calibration files, one camera, two cameras.

use super::page::{LivePage, SHOWN, failed, hold};
use super::program::as_the_program;
use crate::steps::{Outcome, output_of};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Cameras that are turned against each other, with lenses, as OpenCV writes them; the size is left out.
const RAW: &str = "%YAML:1.0
---
K1: !!opencv-matrix { rows: 3, cols: 3, dt: d, data: [520., 0., 322., 0., 521., 238., 0., 0., 1.] }
D1: !!opencv-matrix { rows: 1, cols: 5, dt: d, data: [-0.11, 0.03, 0.0004, -0.0006, 0.] }
K2: !!opencv-matrix { rows: 3, cols: 3, dt: d, data: [518., 0., 317., 0., 519., 243., 0., 0., 1.] }
D2: !!opencv-matrix { rows: 1, cols: 5, dt: d, data: [-0.12, 0.04, 0.0002, 0.0005, 0.] }
R: !!opencv-matrix { rows: 3, cols: 3, dt: d,
   data: [0.9998500102, 0., 0.0173191341, 0., 1., 0., -0.0173191341, 0., 0.9998500102] }
T: !!opencv-matrix { rows: 3, cols: 1, dt: d, data: [-80.0, 0.4, 0.9] }
";

/// Files of every kind give the metres of the program, and rectify as it does, to the bit.
pub fn a_calibration_gives_metres_and_rectifies(page: &mut LivePage, stereo: &Path, scene: &Path) -> Outcome {
    let sized = |name: &str, width: u32, height: u32| {
        let path = scene.join(name);
        let text = format!("{RAW}image_width: {width}\nimage_height: {height}\n");
        fs::write(&path, text).map_err(|e| failed(&path, &e)).map(|()| path)
    };
    let raw = sized("stereo.yml", 640, 480)?;
    let record = scene.join("rig.bin");
    let mut convert = Command::new(stereo);
    convert.args(["calib", "convert", "--to", "record", "--unit", "mm", "--calib"]).arg(&raw);
    output_of(convert.arg("--out").arg(&record))?;

    page.give("pick-two", &[scene.join("left.png"), scene.join("right.png")])?;
    page.give("pick-calibration", &[scene.join("calib.txt")])?;
    told(page, "calib.txt: Middlebury, of rectified pictures")?;
    as_the_program(page, stereo, scene)?;
    // Such a file may rectify as well, by a rotation of nothing.
    page.set("rectify", 1)?;
    told(page, "calib.txt: Middlebury, by which the pair is rectified")?;
    as_the_program(page, stereo, scene)?;

    // In metres 80 is no baseline.
    page.give("pick-calibration", std::slice::from_ref(&raw))?;
    let said = page.text("message")?;
    hold(said.contains("a baseline of 80.0") && said.contains("is not likely"), || {
        format!("of millimetres: '{said}'")
    })?;
    page.set("unit", 3)?;
    told(page, "stereo.yml: OpenCV, by which the pair is rectified")?;
    as_the_program(page, stereo, scene)?;
    // A pair is rectified by the files though a hand has been at the fields.
    let focal_px = page.browser.value("Number(byId('focal_px').value)")?.as_f64().unwrap_or(0.0);
    page.set_number("focal_px", focal_px)?;
    as_the_program(page, stereo, scene)?;
    let copied = page.browser.value("calibration.isTyped && byId('copied').value")?;
    let notes = ["--rectify", "# depths are those of the calibration"];
    hold(copied.as_str().is_some_and(|text| notes.iter().all(|note| text.contains(note))), || {
        format!("of typed cameras beside a calibration: {copied}")
    })?;
    for (name, value) in [("method", 1), ("filter", 2), ("noise", 3)] {
        page.set(name, value)?;
    }
    as_the_program(page, stereo, scene)?;
    let rectified = page.plane("disparity")?;
    page.set("unit", 0)?;
    page.give("pick-calibration", &[record])?;
    told(page, "rig.bin: record, by which the pair is rectified")?;
    hold(page.plane("disparity")? == rectified, || "a record's cameras are others".to_owned())?;
    as_the_program(page, stereo, scene)?;
    for (name, value) in [("method", 3), ("filter", 1), ("noise", 0)] {
        page.set(name, value)?;
    }

    // A pair of another size is not that of the file, and the first one is again.
    page.give("pick-calibration", &[sized("small.yml", 320, 240)?])?;
    let said = page.text("message")?;
    let line = "small.yml: width says 320, but the images have 640 pixels; the calibration of these images \
                is needed";
    hold(said == line, || format!("'{said}' is said, not '{line}'"))?;
    told_of_none(page, "small.yml: not used")
}

/// Of cameras that cannot be it is said what is wrong, there are no depths, and the other views go on.
pub fn impossible_ones_leave_the_other_views(page: &mut LivePage) -> Outcome {
    page.press("scene")?;
    page.browser.value("new Promise((done) => setTimeout(done, 500))")?;
    let baseline_mm = page.browser.value("Number(byId('baseline_mm').value)")?.as_f64().unwrap_or(0.0);
    page.set_number("baseline_mm", 1e42)?;
    let shown = page.browser.value(SHOWN)?;
    page.set("method", 0)?;
    let (said, has_depth) = (page.text("message")?, page.browser.value("state.hasDepth")?);
    hold(!said.is_empty() && has_depth == false, || format!("of impossible cameras '{said}' is said"))?;
    hold(page.browser.value(SHOWN)? != shown, || "with impossible cameras the picture stays".to_owned())?;
    page.set("method", 3)?;
    page.set_number("baseline_mm", baseline_mm)?;
    let (said, has_depth) = (page.text("message")?, page.browser.value("state.hasDepth")?);
    hold(said.is_empty() && has_depth == true, || format!("of the scene's own cameras: {said}"))
}

/// What is no calibration is named; the built-in scene has its own cameras.
pub fn a_calibration_that_is_none_is_named(page: &mut LivePage, scene: &Path) -> Outcome {
    let wrong = scene.join("wrong.txt");
    fs::write(&wrong, "no cameras\n").map_err(|e| failed(&wrong, &e))?;
    page.give("pick-calibration", std::slice::from_ref(&wrong))?;
    let said = page.text("message")?;
    hold(said.starts_with("wrong.txt: is no calibration of two cameras"), || format!("'{said}' is said"))?;
    page.give("pick-calibration", &[wrong, scene.join("calib.txt"), scene.join("stereo.yml")])?;
    let said = page.text("message")?;
    hold(said.starts_with("more than two calibration files"), || format!("'{said}' is said"))?;
    page.press("scene")?;
    page.browser.value("new Promise((done) => setTimeout(done, 500))")?;
    told(page, "")?;
    let depth = page.browser.value(
        "state.hasDepth && state.rig.centre_px.length === 2 && state.planes.depth.some((mm) => mm > 0)",
    )?;
    hold(depth == true, || "the scene has no depths, or its cameras no axis".to_owned())
}

/// Whether the page says this of a calibration that the pair is matched without.
fn told_of_none(page: &mut LivePage, line: &str) -> Outcome {
    let (said, pixel) = (page.text("calibration")?, page.browser.value("state.hasDepth")?);
    hold(said == line && pixel == false, || format!("'{said}' is said, not '{line}'; depths: {pixel}"))
}

/// Whether the page says this of a calibration, and nothing else is wrong.
fn told(page: &mut LivePage, line: &str) -> Outcome {
    let (message, said) = (page.text("message")?, page.text("calibration")?);
    hold(message.is_empty() && said == line, || format!("'{said}' is said, not '{line}'; {message}"))
}

/// The browser's camera, a test pattern, gives one result after the other until it is stopped.
pub fn a_camera_is_matched_frame_by_frame(page: &mut LivePage) -> Outcome {
    page.press("camera")?;
    let name = frames(page)?;
    hold(name == "camera", || format!("{name} is matched, not the camera"))?;
    let (said, pair) = (page.text("message")?, page.text("pair-names")?);
    hold(said.is_empty() && pair.starts_with("camera, side by side: "), || format!("{pair} {said}"))?;
    stop(page)
}

/// Two cameras, two test patterns, are left and right; one of them twice is refused.
pub fn two_cameras_are_matched_frame_by_frame(page: &mut LivePage) -> Outcome {
    page.press("cameras")?;
    let name = frames(page)?;
    let names = page
        .browser
        .value("['camera-left', 'camera-right'].map((id) => byId(id).selectedOptions[0].text)")?;
    hold(name == names[0] && names[0] != names[1], || format!("{name} is matched, of {names}"))?;
    let (said, pair) = (page.text("message")?, page.text("pair-names")?);
    hold(said.is_empty() && pair.ends_with(": 640 x 480"), || format!("{pair} {said}"))?;
    let chosen = page.browser.value(
        "{ const [left, right] = ['camera-left', 'camera-right'].map(byId); right.value = left.value; \
         right.dispatchEvent(new Event('change')); new Promise((done) => setTimeout(done, 1500)) }",
    );
    chosen?;
    let said = page.text("message")?;
    hold(said == "Left and right are one camera: choose two.", || format!("of one twice '{said}' is said"))?;
    stop(page)
}

/// Waits for three frames; the left picture's name.
fn frames(page: &mut LivePage) -> Outcome<serde_json::Value> {
    page.browser.value(
        "new Promise((done) => { const { show } = moving; let count = 0; \
         moving.show = (pair) => { show(pair); \
         count += 1; if (count === 3) { moving.show = show; done(pair.left.name); } }; })",
    )
}

/// Stops what moves.
fn stop(page: &mut LivePage) -> Outcome {
    page.press("stop")?;
    let is_on = page.browser.value("moving.isOn || !byId('stop').hidden")?;
    hold(is_on == false, || "the camera is not stopped".to_owned())
}
