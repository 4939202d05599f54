//! The live page's loop over a video and over a sequence of pictures, and how many frames a second it shows.

use super::page::{LivePage, failed, hold};
use super::program::as_the_program;
use crate::steps::{Failure, Outcome};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::fs;
use std::path::Path;

/// Records the pair that is shown, side by side, for two seconds: the bytes of a video in base64.
const RECORD: &str = "new Promise((done) => {
  const { left, right } = state.pair;
  const canvas = document.createElement('canvas');
  [canvas.width, canvas.height] = [2 * left.width, left.height];
  const context = canvas.getContext('2d');
  const recorder = new MediaRecorder(canvas.captureStream(30),
    { mimeType: 'video/webm;codecs=vp8', videoBitsPerSecond: 2e7 });
  const parts = [];
  recorder.ondataavailable = ({ data }) => parts.push(data);
  recorder.onstop = async () => {
    const bytes = new Uint8Array(await new Blob(parts).arrayBuffer());
    let text = '';
    for (let i = 0; i < bytes.length; i += 8192) text += String.fromCharCode(...bytes.subarray(i, i + 8192));
    done(btoa(text));
  };
  recorder.start();
  const draw = (frames) => {
    [left, right].forEach(({ pixels, width, height }, i) =>
      context.putImageData(new ImageData(new Uint8ClampedArray(pixels), width, height), i * width, 0));
    if (frames > 0) setTimeout(() => draw(frames - 1), 33);
    else recorder.stop();
  };
  draw(60);
})";

/// Waits for as many frames as the rate is told of; the rate, and the median of the module's times, ms.
const RATE: &str = "new Promise((done) => { const { show } = moving; const times = []; \
                    moving.show = (pair) => { show(pair); times.push(state.timeMs); \
                    if (times.length < TIMED) return; moving.show = show; \
                    times.sort((a, b) => a - b); done([moving.rate, times[TIMED >> 1]]); }; })";
/// Lets 20 frames take a fifth of a second each; how fast the video plays then.
const SLOW: &str = "new Promise((done) => { const { show } = moving; let count = 0; \
                    moving.show = (pair) => { const began = performance.now(); \
                    while (performance.now() - began < 200); show(pair); count += 1; \
                    if (count < 20) return; moving.show = show; \
                    done(moving.eyes[0].video.playbackRate); }; })";
/// Frames a second that are asked for.
const LEAST_RATE: f64 = 15.0;
/// Where the machine is too slow or too busy for that, a frame takes this many times as long as the module,
/// at most: decoding, reading, painting and showing take one to two times as long as matching does.
const MOST_OF_MODULE: f64 = 4.0;

/// Frames a second, and the module's part of one, ms.
fn timed(page: &mut LivePage) -> Outcome<[f64; 2]> {
    let timed = page.browser.value(RATE)?;
    Ok([0, 1].map(|i| timed[i].as_f64().unwrap_or(0.0)))
}

fn is_fast([rate, module_ms]: [f64; 2]) -> bool {
    rate >= LEAST_RATE || 1000.0 / rate <= MOST_OF_MODULE * module_ms
}

/// A video of the built-in scene with both pictures side by side is matched as its pictures are, as far as
/// its compression lets it, and the page says how many frames a second it shows. What nobody looks at is not
/// worked out in each frame.
pub fn a_video_is_matched_frame_by_frame(page: &mut LivePage, folder: &Path) -> Outcome {
    page.press("scene")?;
    page.browser.value("new Promise((done) => setTimeout(done, 500))")?;
    let pictures = disparities(page)?;
    let video = page.browser.value(RECORD)?;
    let bytes = video.as_str().and_then(|text| STANDARD.decode(text).ok()).unwrap_or_default();
    let path = folder.join("pair.webm");
    fs::write(&path, bytes).map_err(|e| failed(&path, &e))?;

    page.browser.value("document.activeElement.blur()")?;
    page.give("pick-video", &[path])?;
    let mut timed = timed(page)?;
    // A machine may be busy for a while: the best of three.
    for _ in 1..3 {
        if is_fast(timed) {
            break;
        }
        timed = self::timed(page)?;
    }
    let [rate, module_ms] = timed;
    let (said, pair) = (page.text("message")?, page.text("pair-names")?);
    hold(said.is_empty() && pair == "pair.webm, side by side: 640 x 480", || format!("{pair} {said}"))?;
    // It is said anew twice a second.
    let told = "byId('figures').textContent.includes(' frames a second are shown')";
    page.browser.value(&format!(
        "new Promise((done) => {{ const look = () => {told} ? done() : setTimeout(look, 20); look(); }})"
    ))?;
    let frame = disparities(page)?;
    let both = || pictures.iter().zip(&frame).filter(|(a, b)| **a != u16::MAX && **b != u16::MAX);
    let near = both().filter(|(a, b)| a.abs_diff(**b) <= 32).count();
    hold(near * 100 > both().count() * 95 && both().count() * 2 > frame.len(), || {
        format!("of a video {near} of {} answers are those of its pictures", both().count())
    })?;
    let sure = "state.planes.confidence.reduce((sum, sure) => sum + Number(sure > 0), 0)";
    let unseen = page.browser.value(sure)?;
    hold(unseen == 0, || format!("{unseen} pixels have a confidence that nobody looks at"))?;
    page.browser.value("canvas.focus()")?;
    page.key("ArrowRight")?;
    page.browser.value(RATE)?;
    let (said, seen) = (page.text("pixel")?, page.browser.value(sure)?);
    let is_told = said.contains("; confidence ") || said.contains("no answer");
    hold(is_told && seen.as_u64() > Some(frame.len() as u64 / 2), || {
        format!("in a frame: '{said}', {seen}")
    })?;
    page.browser.value("document.activeElement.blur()")?;
    let pace = page.browser.value(SLOW)?;
    hold(pace.as_f64().is_some_and(|pace| pace < 0.8), || {
        format!("{pace} is the pace of a video that is matched slowly")
    })?;
    page.press("stop")?;
    let told = page.browser.value("state.planes.sigma.filter((sigma) => sigma > 0).length")?;
    hold(told.as_u64() > Some(frame.len() as u64 / 2), || format!("{told} pixels have a deviation"))?;
    println!(
        "a video, in the page: {rate:.1} frames a second of 640 x 480 with 64 disparities, {module_ms:.1} ms \
         each in the module"
    );
    hold(is_fast(timed), || {
        format!("a frame takes {:.1} ms, and {module_ms:.1} ms of it in the module", 1000.0 / rate)
    })
}

/// Pictures of a sequence, two for a frame or one with both, are matched one after the other; the one at
/// which it is stopped as the program matches it.
pub fn a_sequence_is_matched_frame_by_frame(page: &mut LivePage, stereo: &Path, scene: &Path) -> Outcome {
    let sides = ["left", "right"].map(|side| {
        let path = scene.join(side).with_extension("png");
        image::open(&path).map(|picture| picture.into_luma8()).map_err(|e| failed(&path, &e))
    });
    let [left, right] = sides;
    let upright = [left?, right?];
    let turned = upright.each_ref().map(image::imageops::flip_vertical);
    let (mut pairs, mut singles) = (Vec::new(), Vec::new());
    for (number, [left, right]) in [(2, &upright), (10, &turned)] {
        let mut both = image::GrayImage::new(2 * left.width(), left.height());
        image::imageops::replace(&mut both, left, 0, 0);
        image::imageops::replace(&mut both, right, left.width().into(), 0);
        for (name, picture) in [("l", left), ("r", right), ("both", &both)] {
            let path = scene.join(format!("{name}{number}.png"));
            picture.save(&path).map_err(|e| failed(&path, &e))?;
            if name == "both" { &mut singles } else { &mut pairs }.push(path);
        }
    }
    for (opener, files, begin) in [
        ("pick-two", pairs, "2 pairs from l2.png, r2.png: 640 x 480"),
        ("pick-one", singles, "2 pairs from both2.png, side by side: 640 x 480"),
    ] {
        page.give(opener, &files)?;
        let said = page.text("pair-names")?;
        hold(said == begin, || format!("'{said}' is said, not '{begin}'"))?;
        let shown = page.browser.value(
            "new Promise((done) => { const { show } = moving; const names = []; \
             moving.show = (pair) => { show(pair); names.push(pair.left.name); \
             if (names.length === 4) { moving.show = show; done(names); } }; })",
        )?;
        let names: Vec<_> = shown.as_array().into_iter().flatten().collect();
        hold(
            names.len() == 4 && names[0] != names[1] && names[0] == names[2] && names[1] == names[3],
            || format!("the sequence shows {names:?}"),
        )?;
        page.press("stop")?;
        as_the_program(page, stereo, scene)?;
    }
    Ok(())
}

/// A sequence ends at a picture that is none, which is said; the frame that stays is matched as the program
/// does it, with the confidences of all pixels, which were not asked for while it moved.
pub fn a_sequence_ends_with_a_whole_frame(
    page: &mut LivePage,
    stereo: &Path,
    folder: &Path,
    scene: &Path,
) -> Outcome {
    let none = ["l3.png", "r3.png"].map(|name| folder.join(name));
    for path in &none {
        fs::write(path, "no picture").map_err(|e| failed(path, &e))?;
    }
    page.press("view-disparity")?;
    page.browser.value("document.activeElement.blur()")?;
    page.give("pick-two", &[["l2.png", "r2.png"].map(|name| scene.join(name)), none].concat())?;
    page.browser.value(
        "new Promise((done) => { const look = () => byId('message').textContent !== '' ? done() : \
         setTimeout(look, 20); look(); })",
    )?;
    as_the_program(page, stereo, scene)?;
    let (said, is_on) = (page.text("message")?, page.browser.value("moving.isOn || !byId('stop').hidden")?);
    hold(said == "l3.png: is no picture that this browser reads." && is_on == false, || {
        format!("at the end of a sequence '{said}' is said")
    })
}

/// The disparities that are shown.
fn disparities(page: &mut LivePage) -> Outcome<Vec<u16>> {
    let bytes = page.plane("disparity")?;
    let (pairs, rest) = bytes.as_chunks();
    if pairs.is_empty() || !rest.is_empty() {
        return Err(Failure::new("the page has no disparities"));
    }
    Ok(pairs.iter().map(|raw| u16::from_le_bytes(*raw)).collect())
}
