//! docs/lecture.md: every equation names a function, and every function that it names is there and public.

use crate::source::{inside, is_sign, tokens, word};
use proc_macro2::{Delimiter, TokenTree};

/// The items of a page's lists, each with its continued lines.
pub fn items(text: &str) -> Vec<String> {
    let mut items: Vec<String> = Vec::new();
    let mut is_item = false;
    for line in text.lines() {
        if let Some(rest) = line.strip_prefix("* ") {
            items.push(rest.to_owned());
            is_item = true;
        } else if let (true, Some(rest), Some(item)) = (is_item, line.strip_prefix("  "), items.last_mut()) {
            *item += " ";
            *item += rest;
        } else {
            is_item = false;
        }
    }
    items
}

/// The names and the files of an item's links.
pub fn links(item: &str) -> Vec<(&str, &str)> {
    let link = |rest: &'_ str| -> Option<usize> { rest.find(')') };
    item.split("[`")
        .skip(1)
        .filter_map(|rest| {
            let (name, rest) = rest.split_once("`](")?;
            Some((name, &rest[..link(rest)?]))
        })
        .collect()
}

/// Whether a file has a public function or type of this name: `Type::function`, `function` or `Type`.
pub fn has(file: &str, text: &str, name: &str) -> bool {
    let all = tokens(file, text);
    match name.split_once("::") {
        Some((owner, function)) => bodies_of(&all, owner).any(|body| has_item(&body, &["fn"], function)),
        None => has_item(&all, &["fn", "struct", "enum", "trait"], name),
    }
}

/// The bodies of the blocks `impl` of a type.
fn bodies_of(all: &[TokenTree], owner: &str) -> impl Iterator<Item = Vec<TokenTree>> {
    let starts = (0..all.len()).filter(|&i| word(all.get(i)) == "impl");
    starts.filter_map(move |i| {
        let end = (i..all.len()).find(|&j| inside(all.get(j), Delimiter::Brace).is_some())?;
        let is_owner = all[i..end].iter().any(|token| word(Some(token)) == owner);
        if is_owner { inside(all.get(end), Delimiter::Brace) } else { None }
    })
}

/// Whether a public item of one of these kinds has the name.
fn has_item(all: &[TokenTree], kinds: &[&str], name: &str) -> bool {
    (0..all.len()).any(|i| {
        let is_named = kinds.contains(&word(all.get(i)).as_str()) && word(all.get(i + 1)) == name;
        // `pub const fn name`: back to the end of what stands before.
        let before = || {
            all[..i].iter().rev().take_while(|token| {
                !is_sign(Some(token), ';') && inside(Some(token), Delimiter::Brace).is_none()
            })
        };
        is_named && before().any(|token| word(Some(token)) == "pub")
    })
}

#[test]
fn items_links_and_names_are_read() {
    let text = "* $a$: one,\n  [`A::b`](x.rs) and [`c`](y.rs).\n\n* two\nnot an item\n";
    let items = items(text);
    assert_eq!(items.len(), 2);
    assert_eq!(links(&items[0]), [("A::b", "x.rs"), ("c", "y.rs")]);
    let code = "pub struct A; impl<T> A { pub const fn b() {} fn hidden() {} } pub fn c() {} fn d() {} \
                impl B { pub fn e() {} }";
    for name in ["A", "A::b", "c", "B::e"] {
        assert!(has("x.rs", code, name), "{name}");
    }
    for name in ["A::hidden", "d", "A::e", "A::c", "b", "Z"] {
        assert!(!has("x.rs", code, name), "{name}");
    }
}
