//! What a file has of its own: modules, items, macros that it calls.

use crate::source::{self, is_sign, word};
use proc_macro2::TokenTree;
use std::collections::BTreeSet;

/// Tokens without what stands behind `#[cfg(test)]`.
pub fn without_tests(tokens: &[TokenTree]) -> Vec<TokenTree> {
    let mut kept = Vec::new();
    let mut i = 0;
    while let Some(token) = tokens.get(i) {
        if is_sign(Some(token), '#') && source::is_test_attribute(tokens.get(i + 1)) {
            i = source::end_of_item(tokens, i + 2);
            continue;
        }
        kept.push(token.clone());
        i += 1;
    }
    kept
}

/// The modules that a file declares, in its order.
pub fn declared(tokens: &[TokenTree]) -> Vec<String> {
    let ends = |i: usize| is_sign(tokens.get(i + 2), ';');
    let mods = (0..tokens.len()).filter(|&i| word(tokens.get(i)) == "mod" && ends(i));
    mods.map(|i| word(tokens.get(i + 1))).collect()
}

/// The names of a file's items; of macros with a `!`.
pub fn definitions(tokens: &[TokenTree], found: &mut BTreeSet<String>) {
    const ITEMS: [&str; 8] = ["fn", "struct", "enum", "trait", "type", "const", "static", "union"];
    for (i, token) in tokens.iter().enumerate() {
        let name = word(tokens.get(i + 1));
        if ITEMS.contains(&word(Some(token)).as_str()) {
            found.insert(name);
        } else if word(Some(token)) == "macro_rules" {
            found.insert(format!("{}!", word(tokens.get(i + 2))));
            found.insert(word(tokens.get(i + 2)));
        }
    }
}

/// The macros that are called by a plain name.
pub fn calls(tokens: &[TokenTree], found: &mut Vec<(String, usize)>) {
    for (i, token) in tokens.iter().enumerate() {
        if let TokenTree::Group(group) = token {
            calls(&group.stream().into_iter().collect::<Vec<_>>(), found);
        }
        let is_call =
            is_sign(tokens.get(i + 1), '!') && matches!(tokens.get(i + 2), Some(TokenTree::Group(_)));
        let of_path = i >= 1 && is_sign(tokens.get(i - 1), ':');
        if is_call && !of_path {
            found.push((word(Some(token)), source::line(token)));
        }
    }
}
