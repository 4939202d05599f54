//! The live page's loop over a video, and how many frames a second it shows.

use super::page::{LivePage, failed, hold};
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

/// Waits until the rate is that of as many frames as it is told of, and tells it.
const RATE: &str = "new Promise((done) => { const look = () => moving.times.length === TIMED \
                    ? done(moving.rate) : setTimeout(look, 20); look(); })";

/// A video of the built-in scene with both pictures side by side is matched as its pictures are, as far as
/// its compression lets it, and the page says how many frames a second it shows.
pub fn a_video_is_matched_frame_by_frame(page: &mut LivePage, folder: &Path) -> Outcome {
    page.press("scene")?;
    page.browser.value("new Promise((done) => setTimeout(done, 500))")?;
    let pictures = disparities(page)?;
    let video = page.browser.value(RECORD)?;
    let bytes = video.as_str().and_then(|text| STANDARD.decode(text).ok()).unwrap_or_default();
    let path = folder.join("pair.webm");
    fs::write(&path, bytes).map_err(|e| failed(&path, &e))?;

    page.give("pick-video", &[path])?;
    let rate = page.browser.value(RATE)?.as_f64().unwrap_or(0.0);
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
    page.press("stop")?;
    let told = page.browser.value("state.planes.sigma.filter((sigma) => sigma > 0).length")?;
    hold(told.as_u64() > Some(frame.len() as u64 / 2), || format!("{told} pixels have a deviation"))?;
    println!("a video, in the page: {rate:.1} frames a second of 640 x 480 with 64 disparities");
    Ok(())
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
