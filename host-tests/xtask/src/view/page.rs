//! The live page in a browser: opened, its controls moved, its planes read.

use super::browser::Browser;
use crate::steps::{Failure, Outcome};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use stereopsis_host::pfm::{self, FloatMap};

/// Waits until what was moved is matched: it happens before the picture after the next one.
const SETTLED: &str = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))";
/// Waits until the page has matched once or has said what is wrong.
const READY: &str = "new Promise((done) => { const look = () => state.settings !== null \
                     || byId('message').textContent !== '' ? done(true) : setTimeout(look, 20); look(); })";

/// How many colours the picture has.
pub const COLOURS: &str =
    "new Set(new Uint32Array(context.getImageData(0, 0, canvas.width, canvas.height).data.buffer)).size";

/// A number for what the picture shows.
pub const SHOWN: &str = "context.getImageData(0, 0, canvas.width, canvas.height).data\
                         .reduce((sum, byte, i) => (sum * 31 + byte + i) % 1e9, 0)";

/// The page.
pub struct LivePage {
    pub browser: Browser,
}

impl LivePage {
    /// A page that is open.
    pub fn of(browser: Browser) -> Self {
        Self { browser }
    }

    /// Opens a place in a browser and waits for the first result.
    pub fn open(mut browser: Browser, url: &str) -> Outcome<Self> {
        browser.call("Page.navigate", json!({ "url": url }))?;
        let loaded = "new Promise((done) => document.readyState === 'complete' ? done(true) \
                      : addEventListener('load', () => done(true)))";
        // Before the navigation is through, an expression is the empty page's.
        let mut page = Self { browser };
        for _ in 0..200 {
            let there = page.browser.value(loaded).and_then(|_| page.browser.value("typeof state"));
            if there.is_ok_and(|kind| kind == "object") {
                page.browser.value(READY)?;
                return Ok(page);
            }
            std::thread::sleep(std::time::Duration::from_millis(20));
        }
        Err(Failure::new(format!("{url}: does not load")))
    }

    /// Moves a control as a hand does, and waits for the result.
    pub fn set(&mut self, name: &str, value: i64) -> Outcome {
        let name = json!(name);
        self.browser.value(&format!(
            "{{ const input = byId({name}); if (input.type === 'checkbox') input.checked = {value} !== 0; \
             else input.value = {value}; input.dispatchEvent(new Event('input')); }}"
        ))?;
        self.settle()
    }

    /// Writes a number that may have a fraction into a field.
    pub fn set_number(&mut self, name: &str, value: f64) -> Outcome {
        let name = json!(name);
        self.browser.value(&format!(
            "{{ const input = byId({name}); input.value = {value}; \
             input.dispatchEvent(new Event('input')); }}"
        ))?;
        self.settle()
    }

    /// Presses a button, and waits for the result.
    pub fn press(&mut self, id: &str) -> Outcome {
        self.browser.value(&format!("byId({}).click()", json!(id)))?;
        self.settle()
    }

    fn settle(&mut self) -> Outcome {
        self.browser.value(SETTLED).map(drop)
    }

    /// What an element says.
    pub fn text(&mut self, id: &str) -> Outcome<String> {
        let text = self.browser.value(&format!("byId({}).textContent", json!(id)))?;
        Ok(text.as_str().unwrap_or_default().to_owned())
    }

    /// The bytes of a plane.
    pub fn plane(&mut self, name: &str) -> Outcome<Vec<u8>> {
        let text = self.browser.value(&format!(
            "{{ const plane = state.planes[{}]; \
             const bytes = new Uint8Array(plane.buffer, plane.byteOffset, plane.byteLength); let text = ''; \
             for (let i = 0; i < bytes.length; i += 8192) \
             text += String.fromCharCode(...bytes.subarray(i, i + 8192)); btoa(text) }}",
            json!(name)
        ))?;
        let bytes = text.as_str().and_then(|text| STANDARD.decode(text).ok());
        bytes.ok_or_else(|| Failure::new(format!("the plane {name} is not told")))
    }

    /// Gives files to one of the page's openers, and waits for what comes of them.
    pub fn give(&mut self, opener: &str, files: &[PathBuf]) -> Outcome {
        let document = self.browser.call("DOM.getDocument", json!({}))?;
        let query = json!({ "nodeId": document["root"]["nodeId"], "selector": format!("#{opener}") });
        let node = self.browser.call("DOM.querySelector", query)?;
        // What is said of earlier files is gone before.
        self.browser.value("complain(null); state.settings = null")?;
        let files: Vec<_> = files.iter().map(|file| file.display().to_string()).collect();
        let params = json!({ "nodeId": node["nodeId"], "files": files });
        self.browser.call("DOM.setFileInputFiles", params)?;
        self.browser.value(READY).map(drop)
    }

    /// Presses a key on the element that has the focus.
    pub fn key(&mut self, key: &str) -> Outcome {
        for kind in ["keyDown", "keyUp"] {
            self.browser.call("Input.dispatchKeyEvent", json!({ "type": kind, "key": key, "code": key }))?;
        }
        self.settle()
    }

    /// Everything that can be used, so many elements, has a name and, if it is not hidden or at rest, gets
    /// the focus by the tabulator: of the views the one that is shown, for arrows lead to the others.
    pub fn keys_reach_everything(&mut self, count: usize) -> Outcome {
        let found = self.browser.value(
            "(() => { const all = [...document.querySelectorAll('input, select, button, textarea, canvas, \
             summary')]; return { count: all.length, unnamed: all.filter((e) => e.tabIndex < 0 || \
             !(e.labels?.length || e.getAttribute('aria-label') || e.textContent.trim()))\
             .map((e) => e.outerHTML) }; })()",
        )?;
        hold(found["unnamed"] == json!([]), || format!("without a name or the focus: {}", found["unnamed"]))?;
        hold(found["count"] == count, || format!("{} controls, {count} are looked at", found["count"]))?;
        self.browser.value(
            "document.querySelectorAll('details').forEach((d) => { d.open = true; }); \
             document.activeElement.blur(); window.reached = new Set()",
        )?;
        // Beside those that are counted there are regions that scroll.
        for _ in 0..2 * count {
            for kind in ["keyDown", "keyUp"] {
                let tab = json!({ "type": kind, "key": "Tab", "code": "Tab", "windowsVirtualKeyCode": 9 });
                self.browser.call("Input.dispatchKeyEvent", tab)?;
            }
            self.browser.value("void reached.add(document.activeElement)")?;
        }
        let missed = self.browser.value(
            "[...document.querySelectorAll('input, select, button, textarea, canvas, summary')]\
             .filter((e) => !e.disabled && !e.closest('[hidden]') && !(e.type === 'radio' && !e.checked) \
             && !reached.has(e))\
             .map((e) => e.outerHTML)",
        )?;
        hold(missed == json!([]), || format!("the tabulator does not reach {missed}"))?;
        let role = self.browser.value("canvas.getAttribute('role')")?;
        // Of a picture alone a screen reader would keep the arrow keys.
        hold(role == "application", || format!("the picture is {role}, to which no keys are given"))
    }

    /// The addresses that the page asked for since it was last asked, but data of its own.
    pub fn requests(&mut self) -> Vec<String> {
        let events = self.browser.events("Network.requestWillBeSent");
        let urls = events.iter().filter_map(|event| event["params"]["request"]["url"].as_str());
        let is_own = |url: &&str| url.starts_with("data:") || url.starts_with("blob:");
        urls.filter(|url| !is_own(url)).map(str::to_owned).collect()
    }

    /// What was thrown and not caught.
    pub fn thrown(&mut self) -> Vec<Value> {
        self.browser.events("Runtime.exceptionThrown")
    }
}

/// A file's address.
pub fn url_of(path: &Path) -> String {
    format!("file://{}", path.display())
}

/// The numbers of a file.
pub fn numbers(path: &Path) -> Outcome<FloatMap> {
    let bytes = fs::read(path).map_err(|e| failed(path, &e))?;
    pfm::read(&mut bytes.as_slice()).map_err(|e| failed(path, &e))
}

/// Fails with a line unless it holds.
pub fn hold(holds: bool, line: impl FnOnce() -> String) -> Outcome {
    if holds { Ok(()) } else { Err(Failure::new(line())) }
}

/// What is wrong with a file.
pub fn failed(path: &Path, e: &dyn std::fmt::Display) -> Failure {
    Failure::new(format!("{}: {e}", path.display()))
}
