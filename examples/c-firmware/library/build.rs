//! Takes the method, the sizes and the names' prefix from six variables, which a build system
//! sets, and writes the line that makes the functions, or one for each prefix.

use std::path::PathBuf;
use std::{env, fs};

/// What the library is built for when nothing is said.
const DEFAULTS: [(&str, &str); 6] = [
    ("STEREOPSIS_METHOD", "block"),
    ("STEREOPSIS_WIDTH", "320"),
    ("STEREOPSIS_DISPARITIES", "64"),
    ("STEREOPSIS_HEIGHT", "240"),
    ("STEREOPSIS_LINES", "33"),
    ("STEREOPSIS_PREFIX", ""),
];

/// Methods as users spell them, and as the crate does.
const METHODS: [(&str, &str); 5] =
    [("fast", "Fast"), ("block", "Block"), ("sgm-lean", "SgmLean"), ("sgm", "Sgm"), ("sgm-edge", "SgmEdge")];

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if let Err(line) = write() {
        println!("cargo::error={line}");
    }
}

fn write() -> Result<(), String> {
    let choices = DEFAULTS.map(|(name, default)| {
        println!("cargo::rerun-if-env-changed={name}");
        env::var(name).ok().filter(|value| !value.is_empty()).unwrap_or_else(|| default.to_owned())
    });
    // Several instances: each choice is one for all, or as many as there are prefixes, with commas between.
    let choices = choices.each_ref().map(|values| values.split(',').collect::<Vec<_>>());
    let count = choices[5].len();
    if let Some(at) = choices.iter().position(|values| values.len() != 1 && values.len() != count) {
        return Err(format!("{} must be one, or one for each of STEREOPSIS_PREFIX: {count}", DEFAULTS[at].0));
    }
    let mut text = String::new();
    for i in 0..count {
        let line =
            instance(choices.each_ref().map(|values| if values.len() == 1 { values[0] } else { values[i] }))?;
        text += &if count == 1 { line } else { format!("mod instance_{i} {{ {line} }}\n") };
    }
    let folder = env::var_os("OUT_DIR").map(PathBuf::from).ok_or("OUT_DIR is not set")?;
    fs::write(folder.join("instance.rs"), text).map_err(|e| format!("instance.rs: {e}"))
}

/// The line that makes an instance's functions.
fn instance([method, width, disparities, height, lines, prefix]: [&str; 6]) -> Result<String, String> {
    let known = METHODS.map(|(name, _)| name).join(", ");
    let method = METHODS
        .iter()
        .find(|(name, _)| *name == method)
        .map(|(_, method)| method)
        .ok_or_else(|| format!("STEREOPSIS_METHOD is \"{method}\", known are: {known}"))?;
    let number = |at: usize, value: &str| {
        value.parse::<usize>().map_err(|_| format!("{} is \"{value}\", not a number", DEFAULTS[at].0))
    };
    let (width, disparities) = (number(1, width)?, number(2, disparities)?);
    if !disparities.is_multiple_of(16) || !(16..=256).contains(&disparities) {
        return Err(format!(
            "STEREOPSIS_DISPARITIES is {disparities}: it must be a multiple of 16, from 16 to 256"
        ));
    }
    if width < disparities || width > 6553 {
        return Err(format!(
            "STEREOPSIS_WIDTH is {width}: it must be {disparities} (the disparities) to 6553"
        ));
    }
    let (height, lines) = (number(3, height)?, number(4, lines)?);
    if !(2..=4096).contains(&height) {
        return Err(format!("STEREOPSIS_HEIGHT is {height}: it must be 2 to 4096"));
    }
    if !(3..=4097).contains(&lines) {
        return Err(format!("STEREOPSIS_LINES is {lines}: it must be 3 to 4097"));
    }
    let is_letter = |c: char| c.is_ascii_alphabetic() || c == '_';
    let is_name = prefix.chars().all(|c| is_letter(c) || c.is_ascii_digit());
    if !is_name || !prefix.is_empty() && !prefix.starts_with(is_letter) {
        return Err(format!("STEREOPSIS_PREFIX is \"{prefix}\": it must begin a name in C"));
    }
    Ok(format!(
        "stereopsis::instantiate_c_api!({method}, width = {width}, disparities = {disparities}, \
         height = {height}, lines = {lines}, prefix = \"{prefix}\");\n"
    ))
}
