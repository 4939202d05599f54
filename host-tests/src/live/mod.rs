//! The live page: the core in a browser, with sliders.
//!
//! In: the module of the package `stereopsis-live`, compiled for WebAssembly, and a pair to begin with where
//! there is one. Out: one file that opens without a network: scripts, styles, pictures and the module are in
//! it.
//!
//! * [`page`]: the file. `data`: the figures and pictures that its scripts look at. [`SHARED`], [`STYLE`],
//!   [`looks`]: what the report's page has of it.

mod data;

pub use data::{Given, in_script, looks};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::io;

/// The module's file, as cargo names it.
pub const MODULE_FILE: &str = "stereopsis_live.wasm";

const INDEX: &str = include_str!("../../live/page/index.html");
/// The style of every page.
pub const STYLE: &str = include_str!("../../live/page/style.css");
/// The scripts that the report has too, each of which uses those before it: pictures, views and the cursor.
pub const SHARED: [&str; 5] = [
    include_str!("../../live/page/elements.js"),
    include_str!("../../live/page/pictures.js"),
    include_str!("../../live/page/paint.js"),
    include_str!("../../live/page/cloud.js"),
    include_str!("../../live/page/viewer.js"),
];
/// The page's own scripts, which use these and those before them.
const SCRIPTS: [&str; 7] = [
    include_str!("../../live/page/controls.js"),
    include_str!("../../live/page/core.js"),
    include_str!("../../live/page/moving.js"),
    include_str!("../../live/page/work.js"),
    include_str!("../../live/page/copy.js"),
    include_str!("../../live/page/listen.js"),
    include_str!("../../live/page/main.js"),
];

/// The page with a module; it begins with the given pair, else with the built-in scene.
pub fn page(module: &[u8], given: Option<&Given<'_>>) -> io::Result<String> {
    let data = data::json(given)?;
    let module = STANDARD.encode(module);
    let script = format!(
        "\"use strict\";\nconst MODULE = \"{module}\";\nconst DATA = {data};\n{}\n{}",
        SHARED.join("\n"),
        SCRIPTS.join("\n")
    );
    let lost = || io::Error::other("index.html has no place for styles and scripts");
    let (head, rest) = INDEX.split_once("/*STYLE*/").ok_or_else(lost)?;
    let (body, end) = rest.split_once("/*SCRIPT*/").ok_or_else(lost)?;
    Ok([head, STYLE, body, &script, end].concat())
}

/// Whether these are a module's bytes.
pub fn is_module(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\0asm\x01\0\0\0")
}
