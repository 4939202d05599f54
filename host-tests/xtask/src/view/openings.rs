//! What the live page makes of openings that overtake each other, or that there is no room for.

use super::page::{LivePage, hold};
use crate::steps::Outcome;
use std::path::Path;

/// Makes what a picture or a camera is opened by slow, or as it was.
const SLOW_PICTURES: &str = "window.quick = createImageBitmap; \
                             window.createImageBitmap = (...words) => \
                             new Promise((done) => setTimeout(done, 700)).then(() => quick(...words))";
const QUICK_PICTURES: &str = "window.createImageBitmap = quick";
const SLOW_CAMERA: &str = "navigator.mediaDevices.getUserMedia = (asked) => \
                           new Promise((done) => setTimeout(done, 700)).then(() => \
                           MediaDevices.prototype.getUserMedia.call(navigator.mediaDevices, asked))";
const QUICK_CAMERA: &str = "delete navigator.mediaDevices.getUserMedia";
/// Waits until what is slow is ready.
const WAIT: &str = "new Promise((done) => setTimeout(done, 1500))";

/// Of two openings the later one is shown, though the earlier one is ready after it.
pub fn the_later_one_counts(page: &mut LivePage, folder: &Path) -> Outcome {
    // Side by side, as the faults' check has left it.
    let both = folder.join("both.png");
    for (opener, slow, quick) in
        [("scene", SLOW_PICTURES, QUICK_PICTURES), ("camera", SLOW_CAMERA, QUICK_CAMERA)]
    {
        page.browser.value(slow)?;
        page.press(opener)?;
        page.browser.value(quick)?;
        page.give("pick-one", std::slice::from_ref(&both))?;
        page.browser.value(WAIT)?;
        let (said, pair) = (page.text("message")?, page.text("pair-names")?);
        hold(said.is_empty() && pair == "both.png, side by side: 640 x 480", || {
            format!("after a slow {opener}: {pair} {said}")
        })?;
        let is_on = page.browser.value("moving.isOn || moving.eyes.some(({ video }) => video.srcObject)")?;
        hold(is_on == false, || format!("the slow {opener} is not given up"))?;
    }
    Ok(())
}

/// Without room for pictures nothing is shown, all that can be pressed is without effect, and pictures of the
/// size before are matched again.
pub fn without_room_nothing_is_shown(page: &mut LivePage, folder: &Path) -> Outcome {
    page.press("scene")?;
    page.browser.value(WAIT)?;
    let before = page.plane("disparity")?;
    page.browser
        .value("state.core.begin = function begin() { delete this.begin; return this.begin(5000, 5000); }")?;
    let small = folder.join("b.png");
    page.give("pick-two", &[small.clone(), small])?;
    let said = page.text("message")?;
    let line = "5000 x 5000: there is no memory for pictures of this size.";
    hold(said == line, || format!("'{said}' is said, not '{line}'"))?;
    let planes = page.browser.value("state.planes === null && image === null")?;
    hold(planes == true, || "the page keeps pictures that the module has freed".to_owned())?;
    for id in ["view-points", "view-depth", "view-disparity", "copy-rust", "copy-c", "copy-command"] {
        page.press(id)?;
    }
    page.set("method", 1)?;
    page.set("method", 3)?;
    page.browser.value("canvas.focus()")?;
    page.key("ArrowRight")?;
    page.press("scene")?;
    page.browser.value(WAIT)?;
    let said = page.text("message")?;
    hold(said.is_empty() && page.plane("disparity")? == before, || format!("after no memory: {said}"))
}

/// Frames of a video that are larger than what is matched are refused, as pictures are.
pub fn large_frames_are_refused(page: &mut LivePage) -> Outcome {
    let said = page.browser.value(
        "{ const eye = new Eye(); eye.video = { videoWidth: 9000, videoHeight: 600 }; let said = ''; \
         try { eye.frame('wide.webm', 2); } catch (error) { said = error.message; } said }",
    )?;
    let line = "wide.webm: is 4500 x 600; up to 4096 x 4096 are matched.";
    hold(said == line, || format!("'{said}' is said, not '{line}'"))
}
