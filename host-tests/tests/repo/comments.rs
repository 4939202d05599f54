//! A doc comment stands alone: it begins with a sentence that does not lean on the one above it.

use crate::source::{self, inside, is_sign, line, tokens, word};
use proc_macro2::{Delimiter, TokenTree};

/// Openings that lean on another comment.
const LEANING: [&str; 13] = [
    "The same",
    "As above",
    "As before",
    "And ",
    "Its ",
    "Their ",
    "Likewise",
    "Also",
    "Ditto",
    "Same ",
    "Or ",
    "But ",
    "So ",
];

/// The doc comments of a file: the first line of each, and its text.
fn comments(tokens: &[TokenTree]) -> Vec<(usize, String)> {
    let (mut found, mut open) = (Vec::<(usize, String)>::new(), false);
    let mut i = 0;
    while let Some(token) = tokens.get(i) {
        let attribute = tokens.get(i + 1).filter(|_| is_sign(Some(token), '#'));
        let text = attribute.and_then(|at| inside(Some(at), Delimiter::Bracket)).and_then(|at| doc_text(&at));
        match (text, found.last_mut()) {
            (Some(text), Some((_, comment))) if open => *comment += &format!("\n{text}"),
            (Some(text), _) => found.push((line(token), text)),
            (None, _) => {
                open = false;
                if let TokenTree::Group(group) = token {
                    found.extend(comments(&group.stream().into_iter().collect::<Vec<_>>()));
                }
                i += 1;
                continue;
            }
        }
        open = true;
        i += 2;
    }
    found
}

/// The text of `doc = "..."`, which is what a doc comment is to the compiler; nothing of a text that a macro
/// makes.
fn doc_text(attribute: &[TokenTree]) -> Option<String> {
    let [name, _, TokenTree::Literal(text)] = attribute else { return None };
    let text = (word(Some(name)) == "doc").then(|| text.to_string())?;
    let text = text.strip_prefix('"')?.strip_suffix('"')?;
    Some(text.replace("\\\"", "\"").replace("\\\\", "\\").trim().to_owned())
}

/// What is wrong with a doc comment, if something is.
fn fault(comment: &str) -> Option<&'static str> {
    if LEANING.iter().any(|opening| comment.starts_with(opening)) {
        return Some("leans on another comment");
    }
    let mut paragraphs = comment.split("\n\n");
    let first = paragraphs.next().unwrap_or_default().trim();
    let begins = |c: char| c.is_uppercase() || c.is_ascii_digit() || matches!(c, '`' | '[');
    if !first.starts_with(begins) {
        return Some("begins without a capital or code");
    }
    let has_more = paragraphs.next().is_some() || first.contains("\n```") || first.contains("\n* ");
    match first.ends_with('.') || has_more && (first.ends_with(':') || first.contains(":\n")) {
        true => None,
        false => Some("does not end its first paragraph with a period"),
    }
}

/// The faults of a file's doc comments.
fn faults(name: &str, text: &str) -> Vec<String> {
    let said = |(line, comment): (usize, String)| {
        let opening = comment.lines().next().unwrap_or_default().to_owned();
        fault(&comment).map(|fault| format!("{name}:{line}: {fault}: {opening}"))
    };
    comments(&tokens(name, text)).into_iter().filter_map(said).collect()
}

#[test]
fn doc_comments_stand_alone() {
    let files = source::core_files().into_iter();
    let wrong: Vec<_> = files.flat_map(|(name, text)| faults(&name, &text)).collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn faulty_comments_are_found() {
    let text = "//! Rows of pixels.\n\n/// The same, to write.\npub fn a() {}\n\nimpl A {\n\
                /// of a row\n    pub fn b() {}\n}\n\n/// A row of pixels\n///\n/// More of it.\n\
                pub enum C {\n    /// Its end.\n    D,\n}\n";
    let expected = [
        "src/x.rs:3: leans on another comment: The same, to write.",
        "src/x.rs:7: begins without a capital or code: of a row",
        "src/x.rs:11: does not end its first paragraph with a period: A row of pixels",
        "src/x.rs:15: leans on another comment: Its end.",
    ];
    assert_eq!(faults("src/x.rs", text), expected);
}

#[test]
fn whole_comments_pass() {
    let text = "//! A map:\n//!\n//! * one\n\n/// `d` is \"raw\",\n/// in steps.\n#[inline]\n\
                /// Attributes stand between.\npub fn a() {}\n\n// The same, but no doc comment.\n\
                #[doc = $about]\nfn b() {}\n";
    assert_eq!(faults("src/x.rs", text), [""; 0]);
}
