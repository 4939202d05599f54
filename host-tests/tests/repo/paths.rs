//! What a file names by paths: the absolute paths behind `crate::`, `super::`, `self::` and the names of
//! child modules, in `use` trees, expressions, types and macros.

use crate::source::{inside, is_sign, line, word};
use proc_macro2::{Delimiter, TokenTree};

/// A path from the crate's root.
#[derive(Clone, Debug)]
pub struct Named {
    pub line: usize,
    /// Ends in `*` for a glob.
    pub path: Vec<String>,
    /// Under which name a `use` brings it in.
    pub used_as: Option<String>,
    /// Whether that `use` passes it on.
    pub public: bool,
}

/// Where a file stands in the tree of modules below `root`: `a/b.rs` is `a::b`, `a/mod.rs` is `a`, `lib.rs`
/// nothing.
pub fn module_of(root: &str, name: &str) -> Vec<String> {
    let path = name.strip_prefix(root).unwrap_or(name).trim_start_matches('/').trim_end_matches(".rs");
    path.split('/').filter(|part| !matches!(*part, "" | "mod" | "lib" | "main")).map(str::to_owned).collect()
}

/// The paths that `tokens` in `module` name. A path may begin with a name of `children`, too.
pub fn named(tokens: &[TokenTree], module: &[String], children: &[String]) -> Vec<Named> {
    let mut reader = Reader { children, found: Vec::new(), used: None };
    reader.read(tokens, module);
    reader.found
}

struct Reader<'a> {
    children: &'a [String],
    found: Vec<Named>,
    /// In a `use`: whether it is public.
    used: Option<bool>,
}

impl Reader<'_> {
    fn read(&mut self, tokens: &[TokenTree], module: &[String]) {
        let mut i = 0;
        while let Some(token) = tokens.get(i) {
            let here = word(Some(token));
            let follows_path = i >= 2 && is_sign(tokens.get(i - 1), ':') && is_sign(tokens.get(i - 2), ':');
            let starts_path = is_sign(tokens.get(i + 1), ':') && is_sign(tokens.get(i + 2), ':');
            match here.as_str() {
                "mod" => {
                    if let Some(body) = inside(tokens.get(i + 2), Delimiter::Brace) {
                        let inner: Vec<_> = module.iter().cloned().chain([word(tokens.get(i + 1))]).collect();
                        self.read(&body, &inner);
                        i += 2;
                    }
                }
                "use" => {
                    let public = i >= 1 && (word(tokens.get(i - 1)) == "pub" || is_visibility(tokens, i - 1));
                    let end =
                        (i..tokens.len()).find(|&j| is_sign(tokens.get(j), ';')).unwrap_or(tokens.len());
                    self.used = Some(public);
                    self.tree(&tokens[i + 1..end], &[], module);
                    self.used = None;
                    i = end;
                }
                // What follows `pub(in` is no item.
                "in" if i == 0 && !starts_path => return,
                "crate" | "super" | "self" if starts_path && !follows_path => {
                    i = self.path(tokens, i, module)
                }
                child if starts_path && !follows_path && self.children.iter().any(|c| c == child) => {
                    i = self.path(tokens, i, module);
                }
                _ => {
                    if let TokenTree::Group(group) = token {
                        self.read(&group.stream().into_iter().collect::<Vec<_>>(), module);
                    }
                }
            }
            i += 1;
        }
    }

    /// Reads a path in an expression from its first name on; the last index that was read.
    fn path(&mut self, tokens: &[TokenTree], first: usize, module: &[String]) -> usize {
        let mut end = first;
        while is_sign(tokens.get(end + 1), ':') && is_sign(tokens.get(end + 2), ':') {
            // `::<` begins arguments.
            if word(tokens.get(end + 3)).is_empty() {
                break;
            }
            end += 3;
        }
        self.tree(&tokens[first..=end], &[], module);
        end
    }

    /// Reads a `use` tree, or a plain path, behind the names `before`.
    fn tree(&mut self, tokens: &[TokenTree], before: &[String], module: &[String]) {
        let mut path = before.to_vec();
        for (i, token) in tokens.iter().enumerate() {
            if let Some(group) = inside(Some(token), Delimiter::Brace) {
                for entry in group.split(|token| is_sign(Some(token), ',')) {
                    self.tree(entry, &path, module);
                }
                return;
            }
            match word(Some(token)).as_str() {
                "as" => {
                    self.add(token, path, Some(word(tokens.get(i + 1))), module);
                    return;
                }
                "" if is_sign(Some(token), '*') => path.push("*".to_owned()),
                "" => {}
                name => path.push(name.to_owned()),
            }
        }
        if let Some(last) = tokens.last() {
            self.add(last, path, None, module);
        }
    }

    fn add(&mut self, at: &TokenTree, mut names: Vec<String>, alias: Option<String>, module: &[String]) {
        if names.last().is_some_and(|last| last == "self") && names.len() > 1 {
            names.pop();
        }
        let Some(first) = names.first().cloned() else { return };
        let up = names.iter().take_while(|name| *name == "super").count();
        let base = match first.as_str() {
            "crate" => &[],
            "super" => &module[..module.len().saturating_sub(up)],
            "self" => module,
            child if self.children.iter().any(|c| c == child) => module,
            _ => return,
        };
        let rest = names.iter().skip_while(|name| matches!(name.as_str(), "crate" | "super" | "self"));
        let path: Vec<_> = base.iter().chain(rest).cloned().collect();
        let used_as = self.used.and_then(|_| alias.or_else(|| path.last().cloned()));
        self.found.push(Named { line: line(at), path, used_as, public: self.used == Some(true) });
    }
}

/// Whether the token at `i` is the bracket of `pub(..)`.
fn is_visibility(tokens: &[TokenTree], i: usize) -> bool {
    i >= 1 && word(tokens.get(i - 1)) == "pub" && inside(tokens.get(i), Delimiter::Parenthesis).is_some()
}
