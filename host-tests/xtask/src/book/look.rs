//! Every page of the book in a browser: it fits a telephone and a wide window, in light and dark.

use super::chapters::CHAPTERS;
use crate::steps::{Failure, Outcome};
use crate::view::browser::Browser;
use serde_json::json;
use std::path::Path;

/// Columns of the windows that pages are looked at in.
const WIDTHS: [u32; 2] = [360, 1400];
/// What each page has to say: how far it is wider than the window, what it shows of its pictures, and whether
/// text can be told from what is behind it.
const LOOKED: &str = "(() => { const style = getComputedStyle(document.body); \
                      const { scrollWidth, clientWidth } = document.documentElement; \
                      return { over: scrollWidth - clientWidth, \
                      lost: [...document.images].filter((i) => !(i.complete && i.naturalWidth > 0)).length, \
                      colours: [style.color, style.backgroundColor], title: document.title }; })()";

/// Fails with the first page that does not fit, or lacks a picture.
pub fn every_page_fits(out: &Path) -> Outcome {
    let mut browser = Browser::start()?;
    let mut seen = Vec::new();
    for scheme in ["light", "dark"] {
        let features = json!({ "features": [{ "name": "prefers-color-scheme", "value": scheme }] });
        browser.call("Emulation.setEmulatedMedia", features)?;
        for width in WIDTHS {
            let size = json!({ "width": width, "height": 900, "deviceScaleFactor": 1, "mobile": false });
            browser.call("Emulation.setDeviceMetricsOverride", size)?;
            for name in CHAPTERS.iter().map(super::Chapter::page).chain(["index.html".to_owned()]) {
                let url = format!("file://{}", out.join(&name).display());
                browser.open(&url)?;
                let found = browser.value(LOOKED)?;
                let wrong = |what: &str| Failure::new(format!("{name} at {width} px, {scheme}: {what}"));
                if found["over"].as_i64() != Some(0) {
                    return Err(wrong(&format!("is {} px too wide", found["over"])));
                }
                if found["lost"] != 0 {
                    return Err(wrong(&format!("{} pictures are not shown", found["lost"])));
                }
                if !found["title"].as_str().is_some_and(|title| title.ends_with("stereopsis")) {
                    return Err(wrong("has no title"));
                }
                seen.push(found["colours"].clone());
            }
        }
    }
    seen.dedup();
    let asked = browser.events("Network.requestWillBeSent");
    let urls = asked.iter().filter_map(|event| event["params"]["request"]["url"].as_str());
    if let Some(url) = urls.into_iter().find(|url| !url.starts_with("file://")) {
        return Err(Failure::new(format!("the book asks for {url}")));
    }
    // One pair of colours by day, another one by night.
    if seen.len() == 2 { Ok(()) } else { Err(Failure::new(format!("the book's colours are {seen:?}"))) }
}
