//! `cargo xtask header`: `src/ffi/stereopsis.h`, made by cbindgen.
//!
//! cbindgen reads Rust files and expands no macros, and the functions stand in macros: `instantiate_c_api`
//! and those beside it. So it is given the macros' own text as a file, with plain paths instead of `$crate`;
//! types and constants it reads from the files of `src/ffi`. [`bytes`] makes macros of how much memory
//! everything takes.
//!
//! [`portable()`] makes it one for C++98, and adds the functions with a prefix.

mod bytes;
mod portable;

use crate::steps::{Failure, Outcome, root};
use cbindgen::{Builder, Config, DocumentationLength, DocumentationStyle, Language, RenameRule, Style};
use portable::portable;
use proc_macro2::{Delimiter, Group, Ident, Span, TokenStream, TokenTree};
use std::fs;

/// The header, from the repository's root.
const HEADER: &str = "src/ffi/stereopsis.h";
/// The files with macros, and the macros, in the header's order.
const MACROS: [(&str, &str); 11] = [
    ("src/ffi/names.rs", "instantiate_c_api"),
    ("src/ffi/names_winners.rs", "c_api_of_winners"),
    ("src/ffi/names_line_queue.rs", "c_api_of_line_queues"),
    ("src/ffi/names_rectifier.rs", "c_api_of_rectification"),
    ("src/ffi/names_plain.rs", "c_api_without_state"),
    ("src/ffi/names_after.rs", "c_api_before_and_after"),
    ("src/ffi/names_features.rs", "c_api_of_features"),
    ("src/ffi/names_two_view.rs", "c_api_of_two_views"),
    ("src/ffi/names_focus.rs", "c_api_of_focus_and_motion"),
    ("src/ffi/names_obstacles.rs", "c_api_of_obstacles"),
    ("src/ffi/names_drive.rs", "c_api_of_driving"),
];
/// The files that cbindgen reads as they are, in the header's order.
const FILES: [&str; 29] = [
    "src/ffi/status.rs",
    "src/ffi/state.rs",
    "src/ffi/config.rs",
    "src/ffi/row.rs",
    "src/ffi/faults.rs",
    "src/ffi/noise.rs",
    "src/ffi/winner.rs",
    "src/ffi/winners.rs",
    "src/ffi/line_queue.rs",
    "src/ffi/balance.rs",
    "src/ffi/rectifying.rs",
    "src/ffi/record.rs",
    "src/ffi/rig.rs",
    "src/ffi/points.rs",
    "src/ffi/after.rs",
    "src/ffi/detection.rs",
    "src/ffi/features.rs",
    "src/ffi/feature_matches.rs",
    "src/ffi/two_view.rs",
    "src/ffi/focus_types.rs",
    "src/ffi/focus.rs",
    "src/ffi/odometry_types.rs",
    "src/ffi/odometry.rs",
    "src/ffi/pair_monitor.rs",
    "src/ffi/obstacles_config.rs",
    "src/ffi/obstacles_types.rs",
    "src/ffi/obstacles.rs",
    "src/ffi/drive_types.rs",
    "src/ffi/drive.rs",
];
/// Names that Rust spells in its own way.
const NAMES: [(&str, &str); 44] = [
    ("Handle", "stereopsis"),
    ("Status", "stereopsis_status"),
    ("CConfig", "stereopsis_config"),
    ("CRow", "stereopsis_row"),
    ("CCounters", "stereopsis_counts"),
    ("CNoiseMeter", "stereopsis_noise_meter"),
    ("WinnersHandle", "stereopsis_winners"),
    ("CWinner", "stereopsis_winner"),
    ("LineQueueHandle", "stereopsis_line_queue"),
    ("CLine", "stereopsis_line"),
    ("CHistogram", "stereopsis_histogram"),
    ("CBalance", "stereopsis_balance"),
    ("CTemporal", "stereopsis_temporal"),
    ("DetectorHandle", "stereopsis_detector"),
    ("CDetection", "stereopsis_detection"),
    ("CDetectionCounts", "stereopsis_detection_counts"),
    ("CFeature", "stereopsis_feature"),
    ("CSearch", "stereopsis_search"),
    ("FocusHandle", "stereopsis_focus"),
    ("CFocusConfig", "stereopsis_focus_config"),
    ("CFocusPeak", "stereopsis_focus_peak"),
    ("OdometryHandle", "stereopsis_odometry"),
    ("COdometryConfig", "stereopsis_odometry_config"),
    ("CPicture", "stereopsis_picture"),
    ("CStep", "stereopsis_step"),
    ("PairMonitorHandle", "stereopsis_pair_monitor"),
    ("ObstaclesHandle", "stereopsis_obstacles"),
    ("CObstacleConfig", "stereopsis_obstacles_config"),
    ("CGround", "stereopsis_ground"),
    ("CStixel", "stereopsis_stixel"),
    ("CSector", "stereopsis_sector"),
    ("CScan", "stereopsis_scan"),
    ("DriveHandle", "stereopsis_drive"),
    ("CDriveConfig", "stereopsis_drive_config"),
    ("CVerdict", "stereopsis_verdict"),
    ("FreeSpaceHandle", "stereopsis_free_space"),
    ("RectifierHandle", "stereopsis_rectifier"),
    ("CCameras", "stereopsis_cameras"),
    ("CRig", "stereopsis_rig"),
    ("CPoint", "stereopsis_point"),
    ("CMatch", "stereopsis_match"),
    ("CPinhole", "stereopsis_pinhole"),
    ("CPose", "stereopsis_pose"),
    ("CAgreement", "stereopsis_agreement"),
];

const TOP: &str = "/* Depth from two cameras, line by line: the functions of libstereopsis.a.

   The caller gives memory, a configuration and lines, and gets rows of disparities. Nothing is allocated, \
                   nothing is
   kept of a caller's pointer but the memory given to stereopsis_init. Every function answers with a status; \
                   below 0 it
   is an error and nothing has changed unless the function says so.

     static uint64_t memory[STEREOPSIS_BLOCK_BYTES(320, 64) / 8 + 1];
     stereopsis *matcher;
     stereopsis_config config;
     stereopsis_row row;
     stereopsis_init(memory, sizeof memory, &matcher);
     stereopsis_config_default(320, 240, 64, STEREOPSIS_PRESET_DEFAULT, &config);
     stereopsis_start(matcher, &config);
     stereopsis_begin_frame(matcher);
     for each line: stereopsis_push(matcher, left, right, 320, &row);
       or, where it was lost: stereopsis_push_lost(matcher, STEREOPSIS_LOST_DROPPED, &row);
     until STEREOPSIS_STATUS_FRAME_DONE: stereopsis_flush(matcher, &row);

   One call at a time for one handle. Pointers are checked for null, alignment and overlap; what cannot be \
                   checked is the
   caller's promise: a pointer points to as many elements as the function says. */";

/// Writes the header, or compares only.
pub fn run(check: bool) -> Outcome {
    let current = generate()?;
    let path = root().join(HEADER);
    let failed = |e: std::io::Error| Failure::new(format!("{HEADER}: {e}"));
    if !check {
        return fs::write(path, current).map_err(failed);
    }
    let stored = fs::read_to_string(path).map_err(failed)?;
    match stored.lines().zip(current.lines()).zip(1..).find(|((a, b), _)| a != b) {
        None if stored == current => Ok(()),
        difference => {
            Err(Failure::new(format!("{HEADER} is not current, run `cargo xtask header`: {difference:?}")))
        }
    }
}

/// The header's text.
fn generate() -> Outcome<String> {
    let folder = tempfile::tempdir().map_err(|e| Failure::new(format!("a temporary folder: {e}")))?;
    let functions = folder.path().join("functions.rs");
    fs::write(&functions, functions_text()?)
        .map_err(|e| Failure::new(format!("{}: {e}", functions.display())))?;
    let mut builder = Builder::new().with_config(config()?);
    for file in FILES {
        builder = builder.with_src(root().join(file));
    }
    let bindings =
        builder.with_src(functions).generate().map_err(|e| Failure::new(format!("cbindgen: {e}")))?;
    let mut text = Vec::new();
    bindings.write(&mut text);
    portable(&String::from_utf8(text).map_err(|e| Failure::new(format!("cbindgen: {e}")))?)
}

fn config() -> Outcome<Config> {
    let mut config = Config {
        language: Language::C,
        cpp_compat: true,
        header: Some(TOP.to_owned()),
        include_guard: Some("STEREOPSIS_H".to_owned()),
        autogen_warning: Some("/* Made by `cargo xtask header`. */".to_owned()),
        no_includes: true,
        sys_includes: vec!["stddef.h".to_owned(), "stdint.h".to_owned()],
        after_includes: Some(format!("\n{}", bytes::macros()?)),
        usize_is_size_t: true,
        style: Style::Both,
        documentation_style: DocumentationStyle::Doxy,
        documentation_length: DocumentationLength::Full,
        line_length: 110,
        ..Config::default()
    };
    config.enumeration.rename_variants = RenameRule::QualifiedScreamingSnakeCase;
    config.export.rename = NAMES.map(|(rust, c)| (rust.to_owned(), c.to_owned())).into();
    Ok(config)
}

/// The macros' bodies as plain Rust.
fn functions_text() -> Outcome<String> {
    MACROS.into_iter().map(body_text).collect()
}

/// A macro's body as plain Rust.
fn body_text((file, name): (&str, &str)) -> Outcome<String> {
    let wrong = |what: &str| Failure::new(format!("{file}: {what}"));
    let text = fs::read_to_string(root().join(file)).map_err(|e| wrong(&e.to_string()))?;
    let tokens: Vec<_> =
        text.parse::<TokenStream>().map_err(|e| wrong(&e.to_string()))?.into_iter().collect();
    let is_name = |token: &TokenTree| matches!(token, TokenTree::Ident(ident) if ident == name);
    // macro_rules! name { (pattern) => { body }; }
    let rules = tokens.iter().skip_while(|token| !is_name(token)).nth(1).and_then(braces);
    let body = rules.and_then(|rules| rules.into_iter().filter_map(|token| braces(&token)).last());
    let body = body.ok_or_else(|| wrong(&format!("there is no macro {name} with a body in braces")))?;
    Ok(plain(body).to_string())
}

/// What stands in a token's braces.
fn braces(token: &TokenTree) -> Option<TokenStream> {
    match token {
        TokenTree::Group(group) if group.delimiter() == Delimiter::Brace => Some(group.stream()),
        _ => None,
    }
}

/// The tokens without `$`, with the crate's name for `$crate`, and with functions' own names in C.
fn plain(tokens: TokenStream) -> TokenStream {
    let not_dollar = |token: &TokenTree| !matches!(token, TokenTree::Punct(sign) if sign.as_char() == '$');
    let word = |text: &str| TokenTree::from(Ident::new(text, Span::call_site()));
    let rename = |token: TokenTree| match token {
        TokenTree::Ident(name) if name == "crate" => word("stereopsis"),
        // `export_name = ...` in the parentheses of `unsafe`.
        TokenTree::Group(group) if group.to_string().starts_with("(export_name") => {
            Group::new(group.delimiter(), word("no_mangle").into()).into()
        }
        TokenTree::Group(group) => Group::new(group.delimiter(), plain(group.stream())).into(),
        other => other,
    };
    tokens.into_iter().filter(not_dollar).map(rename).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_header_is_current() {
        super::run(true).unwrap_or_else(|e| panic!("{e}"));
    }
}
