//! A public name stands in one module alone, so that a reader who meets it knows what it is.

use crate::source::{self, inside, is_sign, tokens, word};
use proc_macro2::{Delimiter, TokenTree};
use std::collections::BTreeMap;

/// Words before a name that is declared.
const KINDS: [&str; 8] = ["struct", "enum", "trait", "fn", "const", "static", "type", "union"];

/// Words that stand between `const` and `fn`.
const QUALIFIERS: [&str; 4] = ["fn", "unsafe", "extern", "async"];

/// The public names of a module and of the public ones in it, each with the modules that it stands in. `read`
/// gives the text of `a/b`, in `a/b.rs` or `a/b/mod.rs`.
fn public_names(read: &dyn Fn(&str) -> Option<String>) -> BTreeMap<String, Vec<String>> {
    let mut found = BTreeMap::new();
    let text = read("lib").expect("the crate's root");
    collect(&tokens("src/lib.rs", &text), "", read, &mut found);
    found
}

fn collect(
    tokens: &[TokenTree],
    module: &str,
    read: &dyn Fn(&str) -> Option<String>,
    found: &mut BTreeMap<String, Vec<String>>,
) {
    let mut add =
        |name: String| found.entry(name).or_default().push(module.trim_start_matches('/').to_owned());
    let mut modules = Vec::new();
    for (i, token) in tokens.iter().enumerate() {
        // `pub(crate)` is not public.
        let next = |n: usize| tokens.get(i + n);
        if word(Some(token)) != "pub" || inside(next(1), Delimiter::Parenthesis).is_some() {
            continue;
        }
        match word(next(1)).as_str() {
            "use" => {
                let path: Vec<_> =
                    tokens[i + 2..].iter().take_while(|t| !is_sign(Some(t), ';')).cloned().collect();
                imported(&path).into_iter().for_each(&mut add);
            }
            "mod" => modules.push((word(next(2)), inside(next(3), Delimiter::Brace))),
            _ => {
                // `pub const unsafe extern "C" fn name`: a kind right before a name that is no kind.
                let is_kind = |n: usize| KINDS.contains(&word(next(n)).as_str());
                let name = (1..6).find(|&n| is_kind(n) && !QUALIFIERS.contains(&word(next(n + 1)).as_str()));
                name.into_iter().for_each(|n| add(word(next(n + 1))));
            }
        }
    }
    for (name, body) in modules {
        let inner = format!("{module}/{name}");
        let path = inner.trim_start_matches('/');
        let body = body.or_else(|| read(path).map(|text| source::tokens(path, &text)));
        collect(&body.unwrap_or_else(|| panic!("src/{path} is not there")), &inner, read, found);
    }
}

/// The names that the path of a `pub use` brings: the last of each of its branches, or what follows `as`.
fn imported(path: &[TokenTree]) -> Vec<String> {
    match inside(path.last(), Delimiter::Brace) {
        Some(group) => group.split(|token| is_sign(Some(token), ',')).flat_map(imported).collect(),
        None => {
            path.last().map(|last| word(Some(last))).filter(|name| !name.is_empty()).into_iter().collect()
        }
    }
}

/// The public names of the crate, each with the modules that it stands in.
pub fn of_the_core() -> BTreeMap<String, Vec<String>> {
    let files: BTreeMap<_, _> = source::core_files().into_iter().collect();
    let read = |module: &str| {
        let places = [format!("src/{module}.rs"), format!("src/{module}/mod.rs")];
        places.iter().find_map(|place| files.get(place).cloned())
    };
    public_names(&read)
}

/// What stands in several modules.
fn repeated(names: BTreeMap<String, Vec<String>>) -> Vec<String> {
    let several = names.into_iter().filter(|(_, modules)| modules.len() > 1);
    several.map(|(name, modules)| format!("{name}: {}", modules.join(", "))).collect()
}

#[test]
fn public_names_are_unique() {
    let names = of_the_core();
    assert!(names.len() > 300, "few names were found: {}", names.len());
    let wrong = repeated(names);
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn a_repeated_name_is_found() {
    let read = |module: &str| {
        let text = match module {
            "lib" => "pub mod a; pub mod b; mod c; pub use c::Top;",
            "a" => "pub mod inner { pub enum Row {} } mod d; pub use d::{Config, e::{Part as Piece, F}};",
            "b" => {
                "pub struct Row { pub x: u8 } impl Row { pub const fn config() {} } pub const unsafe fn \
                 row() {} pub extern \"C\" fn piece() {} pub trait Config {} pub(crate) struct Top; pub \
                 const Part: u8 = 1;"
            }
            _ => return None,
        };
        Some(text.to_owned())
    };
    let names = public_names(&read);
    let all = ["Config", "F", "Part", "Piece", "Row", "Top", "piece", "row"];
    assert_eq!(names.keys().collect::<Vec<_>>(), all);
    assert_eq!(repeated(names), ["Config: a, b", "Row: a/inner, b"]);
}
