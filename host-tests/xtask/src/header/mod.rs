//! `cargo xtask header`: `src/ffi/stereopsis.h`, made by cbindgen.
//!
//! cbindgen reads Rust files and expands no macros, and the functions stand in macros: `instantiate_c_api`
//! and those beside it. So it is given the macros' own text as a file, with plain paths instead of `$crate`;
//! types and constants it reads from the files of `src/ffi`. How many bytes a method takes is worked out by
//! the crate and put in as macros.
//!
//! [`portable()`] makes it one for C++98, and adds the functions with a prefix.

mod portable;

use crate::steps::{Failure, Outcome, root};
use cbindgen::{Builder, Config, DocumentationLength, DocumentationStyle, Language, RenameRule, Style};
use portable::portable;
use proc_macro2::{Delimiter, Group, Ident, Span, TokenStream, TokenTree};
use std::fs;
use stereopsis::ffi::{memory_bytes, rectifier_bytes};
use stereopsis::matching::{Block, Fast, Method, Sgm, SgmEdge, SgmLean};

/// The header, from the repository's root.
const HEADER: &str = "src/ffi/stereopsis.h";
/// The files with macros, and the macros, in the header's order.
const MACROS: [(&str, &str); 4] = [
    ("src/ffi/names.rs", "instantiate_c_api"),
    ("src/ffi/names_rectifier.rs", "c_api_of_rectification"),
    ("src/ffi/names_plain.rs", "c_api_without_state"),
    ("src/ffi/names_two_view.rs", "c_api_of_two_views"),
];
/// The files that cbindgen reads as they are, in the header's order.
const FILES: [&str; 11] = [
    "src/ffi/status.rs",
    "src/ffi/state.rs",
    "src/ffi/config.rs",
    "src/ffi/row.rs",
    "src/ffi/faults.rs",
    "src/ffi/noise.rs",
    "src/ffi/rectifying.rs",
    "src/ffi/record.rs",
    "src/ffi/rig.rs",
    "src/ffi/points.rs",
    "src/ffi/two_view.rs",
];
/// Names that Rust spells in its own way.
const NAMES: [(&str, &str); 14] = [
    ("Handle", "stereopsis"),
    ("Status", "stereopsis_status"),
    ("CConfig", "stereopsis_config"),
    ("CRow", "stereopsis_row"),
    ("CCounters", "stereopsis_counts"),
    ("CNoiseMeter", "stereopsis_noise_meter"),
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
   is an error and nothing has changed.

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
        after_includes: Some(format!(
            "\n{}\n{}\n{}\n{}\n{}\n{}",
            bytes_macro::<Fast>()?,
            bytes_macro::<Block>()?,
            bytes_macro::<SgmLean>()?,
            bytes_macro::<Sgm>()?,
            bytes_macro::<SgmEdge>()?,
            rectifier_macro()?,
        )),
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

/// How many bytes a method takes, as a macro: `a + b width + c disparities + d width disparities`, by trying.
fn bytes_macro<S: Method>() -> Outcome<String> {
    let bytes = |width: usize, disparities: usize| memory_bytes::<S>(width, disparities) as i64;
    let [w, d, step_w, step_d] = [256, 16, 256, 16];
    let (by_w, by_d) = (bytes(512, 16) - bytes(256, 16), bytes(256, 32) - bytes(256, 16));
    let both = (bytes(512, 32) - bytes(256, 16) - by_w - by_d) / (step_w * step_d);
    let (by_w, by_d) = (by_w / step_w - both * d, by_d / step_d - both * w);
    let fixed = bytes(256, 16) - by_w * w - by_d * d - both * w * d;
    for (width, disparities) in [(16, 16), (160, 32), (320, 64), (333, 240), (640, 128), (4096, 256)] {
        let (w, d) = (width as i64, disparities as i64);
        if fixed + by_w * w + by_d * d + both * w * d != bytes(width, disparities) {
            return Err(Failure::new(format!(
                "{}: memory_bytes is no sum of products at {width}x{disparities}",
                S::NAME
            )));
        }
    }
    let method = S::NAME.to_uppercase().replace('-', "_");
    Ok(format!(
        "/**\n * Bytes that are enough for a matcher of method {}, on any target. `disparities` is a \
         multiple of 16, and\n * `width` at least as large, as the library was built with.\n */\n#define \
         STEREOPSIS_{method}_BYTES(width, disparities) \\\n  ((size_t){fixed} + (size_t){by_w} * (width) + \
         (size_t){by_d} * (disparities) + \\\n   (size_t){both} * (width) * (disparities))\n",
        S::NAME
    ))
}

/// The macro of a rectifier's bytes.
const RECTIFIER_BYTES: &str = "/**
 * Bytes that are enough for a rectifier, on any target, with the library's longest line, the rows of its
 * largest rectified image, and the raw lines of each camera that it holds.
 */
#define STEREOPSIS_RECTIFIER_BYTES(width, height, lines) \\
  ((size_t)80 + (size_t)2 * (width) * ((size_t)(lines) + 1) + \\
   (size_t)16 * ((((size_t)(width) + 15) / 16 + 3) * (((size_t)(height) + 15) / 16 + 3) + \\
                 ((size_t)(height) + 1) / 2))
";

/// How many bytes a rectifier takes, as a macro.
fn rectifier_macro() -> Outcome<String> {
    let expected = |width: usize, height: usize, lines: usize| {
        let lattice = (width.div_ceil(16) + 3) * (height.div_ceil(16) + 3);
        80 + 16 * (lattice + height.div_ceil(2)) + 2 * width * (lines + 1)
    };
    for (width, height, lines) in [(16, 2, 3), (160, 120, 33), (333, 241, 40), (4096, 4096, 4097)] {
        if expected(width, height, lines) != rectifier_bytes(width, height, lines) {
            return Err(Failure::new("rectifier_bytes is not what STEREOPSIS_RECTIFIER_BYTES says"));
        }
    }
    Ok(RECTIFIER_BYTES.to_owned())
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
