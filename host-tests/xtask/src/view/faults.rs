//! What the live page says of what it cannot match.

use super::browser::Browser;
use super::page::{LivePage, failed, hold};
use crate::steps::Outcome;
use serde_json::json;
use std::fs;
use std::path::{Path, PathBuf};

/// Files that are no pair: a line each, and the page goes on with the next.
pub fn what_is_wrong_is_said(page: &mut LivePage, folder: &Path, scene: &Path) -> Outcome {
    let (text, small, odd, both) =
        (folder.join("a.png"), folder.join("b.png"), folder.join("odd.png"), folder.join("both.png"));
    fs::write(&text, "no picture").map_err(|e| failed(&text, &e))?;
    let left = scene.join("left.png");
    let pictures = ["left.png", "right.png"].map(|name| image::open(scene.join(name)));
    let [Ok(first), Ok(second)] = pictures.map(|picture| picture.map(|picture| picture.into_luma8())) else {
        return Err(failed(scene, &"has no pictures"));
    };
    let mut side_by_side = image::GrayImage::new(2 * first.width(), first.height());
    image::imageops::replace(&mut side_by_side, &first, 0, 0);
    image::imageops::replace(&mut side_by_side, &second, i64::from(first.width()), 0);
    for (path, picture) in [
        (&small, &image::imageops::crop_imm(&first, 0, 0, 320, 240).to_image()),
        (&odd, &image::imageops::crop_imm(&first, 0, 0, 321, 240).to_image()),
        (&both, &side_by_side),
    ] {
        picture.save(path).map_err(|e| failed(path, &e))?;
    }
    let video = folder.join("c.webm");
    fs::write(&video, "no video").map_err(|e| failed(&video, &e))?;
    let expected: [(&str, &[&PathBuf], &str); 5] = [
        ("pick-video", &[&video], "c.webm: is no picture or video that this browser reads."),
        ("pick-two", &[&text, &left], "a.png: is no picture that this browser reads."),
        ("pick-two", &[&small, &left], "b.png is 320 x 240, left.png is 640 x 480: both must have one size."),
        (
            "pick-one",
            &[&odd],
            "odd.png: 321 columns are no two halves; open two pictures, or one side by side.",
        ),
        (
            "pick-two",
            &[&small, &left, &odd],
            "3 files: of a sequence each number stands in the names of two pictures, left and right, or in \
             that of one with both side by side.",
        ),
    ];
    for (opener, files, line) in expected {
        page.give(opener, &files.iter().map(|path| path.to_path_buf()).collect::<Vec<_>>())?;
        let said = page.text("message")?;
        hold(said == line, || format!("'{said}' is said, not '{line}'"))?;
    }
    page.press("scene")?;
    page.give("pick-two", &[scene.join("right.png"), left])?;
    let one = page.plane("disparity")?;
    page.give("pick-one", &[both])?;
    let said = page.text("message")?;
    hold(said.is_empty() && one == page.plane("disparity")?, || format!("side by side: {said}"))
}

/// A browser without the instructions says that it has none.
pub fn without_simd_it_says_so(url: &str) -> Outcome {
    let mut browser = Browser::start()?;
    let script = json!({ "source": "WebAssembly.validate = () => false;" });
    browser.call("Page.addScriptToEvaluateOnNewDocument", script)?;
    let said = LivePage::open(browser, url)?.text("message")?;
    hold(said.contains("no WebAssembly with SIMD"), || format!("without SIMD '{said}' is said"))
}
