//! The repository's own files, for the tests that hold them to the house rules.
//!
//! Rust files are read as tokens, so that comments, doc examples and strings are never taken for code.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The repository's root.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("host-tests stands below the root").to_owned()
}

/// Every file that git tracks or would track, relative to the root, with slashes.
pub fn files() -> Vec<String> {
    let listed = Command::new("git")
        .args(["ls-files", "--cached", "--others", "--exclude-standard"])
        .current_dir(root())
        .output()
        .expect("git is needed: these tests read the list of tracked files");
    assert!(listed.status.success(), "git ls-files: {}", String::from_utf8_lossy(&listed.stderr));
    let names = String::from_utf8(listed.stdout).expect("file names in UTF-8");
    // A file that was deleted and not committed yet is still listed.
    names.lines().filter(|name| root().join(name).is_file()).map(str::to_owned).collect()
}

/// A file's text; bytes that are not UTF-8 are replaced.
pub fn text(name: &str) -> String {
    let bytes = std::fs::read(root().join(name)).unwrap_or_else(|e| panic!("{name}: {e}"));
    String::from_utf8_lossy(&bytes).into_owned()
}

/// The core's files: name and text.
pub fn core_files() -> Vec<(String, String)> {
    rust_files("src")
}

/// The Rust files below a folder: name and text.
pub fn rust_files(folder: &str) -> Vec<(String, String)> {
    let is_below = |name: &String| name.starts_with(&format!("{folder}/")) && name.ends_with(".rs");
    let files: Vec<_> =
        files().into_iter().filter(is_below).map(|name| (name.clone(), text(&name))).collect();
    assert!(!files.is_empty(), "the files of {folder} were not found");
    files
}

/// The tokens of a Rust file.
pub fn tokens(name: &str, text: &str) -> Vec<TokenTree> {
    let stream: TokenStream = text.parse().unwrap_or_else(|e| panic!("{name}: {e}"));
    stream.into_iter().collect()
}

/// The word of an identifier, a raw one as a plain one; empty for any other token, or none.
pub fn word(token: Option<&TokenTree>) -> String {
    match token {
        Some(TokenTree::Ident(ident)) => ident.to_string().trim_start_matches("r#").to_owned(),
        _ => String::new(),
    }
}

/// Whether a token is this sign.
pub fn is_sign(token: Option<&TokenTree>, sign: char) -> bool {
    matches!(token, Some(TokenTree::Punct(punct)) if punct.as_char() == sign)
}

/// The tokens inside a group with this delimiter.
pub fn inside(token: Option<&TokenTree>, delimiter: Delimiter) -> Option<Vec<TokenTree>> {
    match token {
        Some(TokenTree::Group(group)) if group.delimiter() == delimiter => {
            Some(group.stream().into_iter().collect())
        }
        _ => None,
    }
}

/// The line that a token begins in.
pub fn line(token: &TokenTree) -> usize {
    token.span().start().line
}

/// Whether a token is the bracket of `#[cfg(test)]`.
pub fn is_test_attribute(token: Option<&TokenTree>) -> bool {
    let Some(attribute) = inside(token, Delimiter::Bracket) else { return false };
    let arguments = inside(attribute.get(1), Delimiter::Parenthesis).unwrap_or_default();
    word(attribute.first()) == "cfg" && arguments.len() == 1 && word(arguments.first()) == "test"
}

/// The place behind an item: it ends with its braces or a semicolon.
pub fn end_of_item(tokens: &[TokenTree], start: usize) -> usize {
    let ends = |t: &TokenTree| inside(Some(t), Delimiter::Brace).is_some() || is_sign(Some(t), ';');
    tokens[start..].iter().position(ends).map_or(tokens.len(), |at| start + at + 1)
}
