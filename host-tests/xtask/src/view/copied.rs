//! What the live page copies as Rust and as C is what compilers take.

use super::page::{LivePage, failed, hold};
use crate::steps::{Outcome, root, run};
use std::fs;
use std::path::Path;
use std::process::Command;

/// The compiler of the C text.
pub const GCC: &str = "gcc";
/// Places in lists and ends of sliders: method, filter and noise, the search, then checks and penalties that
/// are not the filter's.
const SETTINGS: [(&str, i64); 17] = [
    ("method", 3),
    ("filter", 2),
    ("noise", 2),
    ("disparities", 96),
    ("min_disparity", 3),
    ("min_confidence", 20),
    ("left_right_px", -1),
    ("uniqueness_percent", 7),
    ("texture_gradient", 9),
    ("surface_step", 12),
    ("fill_step", -1),
    ("fattening_slope", -1),
    ("refuse_repeats", 0),
    ("cost", 15),
    ("step[0]", 9),
    ("edges[1]", 31),
    ("median", 0),
];
/// The test that has the text in Rust, and compares it with what these settings are.
const IN_RUST: &str = "host-tests/tests/harness/copied.rs";

/// Copies these settings: the text in Rust is that of a test, and the text in C compiles without a warning.
pub fn it_compiles(page: &mut LivePage, folder: &Path) -> Outcome {
    for (name, value) in SETTINGS {
        page.set(name, value)?;
    }
    let mut copied = |button: &str| -> Outcome<String> {
        page.press(button)?;
        let text = page.browser.value("byId('copied').value")?;
        Ok(text.as_str().unwrap_or_default().to_owned())
    };
    let (in_rust, in_c) = (copied("copy-rust")?, copied("copy-c")?);
    let path = root().join(IN_RUST);
    let test = fs::read_to_string(&path).map_err(|e| failed(&path, &e))?;
    hold(test.contains(&format!("Config {{\n{in_rust}\nconfig\n}}")), || {
        format!("{IN_RUST} has another text than the page, which copies\n{in_rust}")
    })?;
    let path = folder.join("copied.c");
    let body = format!(
        "#include \"stereopsis.h\"\nvoid use(const stereopsis_config *);\nvoid copied(void);\n\
         void copied(void) {{\n{in_c}\nuse(&config);\n}}\n"
    );
    fs::write(&path, body).map_err(|e| failed(&path, &e))?;
    let mut compiler = Command::new(GCC);
    compiler.args(["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror", "-fsyntax-only"]);
    run(compiler.arg("-I").arg(root().join("src/ffi")).arg(&path))?;
    for (name, value) in [("filter", 1), ("noise", 0), ("disparities", 64)] {
        page.set(name, value)?;
    }
    for name in ["min_disparity", "min_confidence"] {
        page.set(name, 0)?;
    }
    page.press("restore")?;
    let said = page.text("message")?;
    hold(said.is_empty(), || format!("after the filter's button: {said}"))
}
