//! The live page: the core in a browser, with sliders.
//!
//! In: the module of the package `stereopsis-live`, compiled for WebAssembly, and a pair to begin with where
//! there is one. Out: one file that opens without a network: scripts, styles, pictures and the module are in
//! it.
//!
//! * [`page`]: the file. `data`: the figures and pictures that its scripts look at. [`SHARED`], [`STYLE`],
//!   [`looks`], [`cameras`]: what the report's page has of it. [`LOOK`], [`COLOURS`]: what every page has.

mod data;

pub use data::{Given, cameras, in_script, looks};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use std::io;

/// The module's file, as cargo names it.
pub const MODULE_FILE: &str = "stereopsis_live.wasm";

const INDEX: &str = include_str!("../../live/page/index.html");
/// The colours of every page and drawing, by day and by night.
pub const COLOURS: &str = include_str!("../../live/page/colours.css");
/// The colours and the text of every page, the book's too.
pub const LOOK: &str =
    concat!(include_str!("../../live/page/colours.css"), include_str!("../../live/page/look.css"));
/// The style of the pages with views.
pub const STYLE: &str = concat!(
    include_str!("../../live/page/colours.css"),
    include_str!("../../live/page/look.css"),
    include_str!("../../live/page/style.css")
);
/// The scripts that the report has too, each of which uses those before it: the library that draws points,
/// pictures, views and the cursor.
pub const SHARED: [&str; 6] = [
    include_str!("../../live/vendor/ogl.bundle"),
    include_str!("../../live/page/elements.js"),
    include_str!("../../live/page/pictures.js"),
    include_str!("../../live/page/paint.js"),
    include_str!("../../live/page/cloud.js"),
    include_str!("../../live/page/viewer.js"),
];
/// The page's own scripts, which use these and those before them.
const SCRIPTS: [&str; 10] = [
    include_str!("../../live/page/controls.js"),
    include_str!("../../live/page/core.js"),
    include_str!("../../live/page/moving.js"),
    include_str!("../../live/page/work.js"),
    include_str!("../../live/page/copy.js"),
    include_str!("../../live/page/rig.js"),
    include_str!("../../live/page/plan.js"),
    include_str!("../../live/page/open.js"),
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
