//! Data moves down the list of modules in `src/lib.rs`: a file uses only what stands above it.

use crate::paths::{Named, module_of, named};
use crate::source::{self, is_sign, line, tokens, word};
use proc_macro2::TokenTree;

/// The modules of the finished crate, in running order.
pub const HOUSE: [&str; 16] = [
    "errors",
    "units",
    "math",
    "dsp",
    "stored",
    "geometry",
    "camera",
    "imaging",
    "matching",
    "depth",
    "focus",
    "features",
    "motion",
    "obstacles",
    "pipeline",
    "ffi",
];

/// The modules that `lib.rs` declares, in its order.
fn declared(lib: &str) -> Vec<String> {
    let tokens = tokens("src/lib.rs", lib);
    let ends = |i: usize| is_sign(tokens.get(i + 2), ';');
    (0..tokens.len())
        .filter(|&i| word(tokens.get(i)) == "mod" && ends(i))
        .map(|i| word(tokens.get(i + 1)))
        .collect()
}

/// What a file does that the order of modules forbids.
fn upward(order: &[String], name: &str, text: &str) -> Vec<String> {
    let module = module_of("src", name);
    let Some(own) = module.first() else { return Vec::new() };
    let Some(own_place) = order.iter().position(|m| m == own) else {
        return vec![format!("{name}: the module {own} is not declared in src/lib.rs")];
    };
    let judge = |Named { line, path, .. }: Named| {
        let top = path.first()?;
        match order.iter().position(|m| m == top) {
            Some(place) if place <= own_place => None,
            Some(_) => Some(format!("{name}:{line}: {own} uses {top}, which stands below it")),
            None => Some(format!("{name}:{line}: crate::{top} is no module: name the module that has it")),
        }
    };
    let mut found: Vec<_> = named(&tokens(name, text), &module, &[]).into_iter().filter_map(judge).collect();
    found.dedup();
    found
}

/// The lines of a file that name `wanted` as an identifier.
fn lines_naming(name: &str, text: &str, wanted: &str) -> Vec<String> {
    fn search(tokens: &[TokenTree], wanted: &str, lines: &mut Vec<usize>) {
        for token in tokens {
            match token {
                TokenTree::Group(group) => {
                    search(&group.stream().into_iter().collect::<Vec<_>>(), wanted, lines)
                }
                TokenTree::Ident(ident) if ident == wanted => lines.push(line(token)),
                _ => {}
            }
        }
    }
    let mut lines = Vec::new();
    search(&tokens(name, text), wanted, &mut lines);
    lines.into_iter().map(|line| format!("{name}:{line}: names {wanted}")).collect()
}

/// Whether `unsafe` is allowed in a file.
fn may_be_unsafe(name: &str) -> bool {
    const PLACES: [&str; 6] = [
        "src/camera/queue.rs",
        "src/dsp.rs",
        "src/imaging/remap/armv7em.rs",
        "src/matching/backend/",
        "src/matching/memory/",
        "src/ffi/",
    ];
    PLACES.iter().any(|place| name.starts_with(place))
}

#[test]
fn modules_stand_in_running_order() {
    let order = declared(&source::text("src/lib.rs"));
    assert!(order.len() >= 8, "src/lib.rs declares {order:?}");
    let places: Vec<_> = order.iter().map(|m| HOUSE.iter().position(|h| h == m)).collect();
    assert!(places.iter().all(Option::is_some), "a module of {order:?} is not one of {HOUSE:?}");
    assert!(places.is_sorted(), "src/lib.rs declares {order:?}, the order is {HOUSE:?}");
}

#[test]
fn no_file_uses_what_stands_below_it() {
    let order = declared(&source::text("src/lib.rs"));
    let wrong: Vec<_> =
        source::core_files().iter().flat_map(|(name, text)| upward(&order, name, text)).collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn one_file_names_libm() {
    let files = source::core_files();
    let others = files.iter().filter(|(name, _)| name != "src/math.rs");
    let wrong: Vec<_> = others.flat_map(|(name, text)| lines_naming(name, text, "libm")).collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn unsafe_stays_where_it_is_allowed() {
    let files = source::core_files();
    let others = files.iter().filter(|(name, _)| !may_be_unsafe(name));
    let wrong: Vec<_> = others.flat_map(|(name, text)| lines_naming(name, text, "unsafe")).collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// The checks above, on files that break the rules.
mod shown_to_fail {
    use super::*;

    fn order() -> Vec<String> {
        declared(
            "//! Map.\npub mod units;\nmod math;\npub mod camera;\n#[cfg(feature = \"x\")]\npub mod \
             matching;",
        )
    }

    fn count(name: &str, text: &str) -> usize {
        upward(&order(), name, text).len()
    }

    #[test]
    fn order_is_read_from_the_declarations() {
        assert_eq!(order(), ["units", "math", "camera", "matching"]);
    }

    #[test]
    fn downward_and_sideways_edges_pass() {
        assert_eq!(
            count("src/matching/row.rs", "use crate::{units::Disparity, camera::{self, LineFormat}};"),
            0
        );
        assert_eq!(
            count("src/matching/row.rs", "use super::config::Config; use super::super::units::Px;"),
            0
        );
        assert_eq!(count("src/camera/mod.rs", "pub(crate) mod pair; pub(in crate::camera) fn f() {}"), 0);
        assert_eq!(
            count("src/camera/mod.rs", "/// [`crate::matching::Config`]\nfn f() {} // crate::matching"),
            0
        );
    }

    #[test]
    fn upward_edges_are_found_in_every_form() {
        let name = "src/camera/pair.rs";
        assert_eq!(count(name, "use crate::matching::Config;"), 1);
        assert_eq!(count(name, "use crate::{units::Px, matching::{Config, Checks}};"), 1);
        assert_eq!(count(name, "use super::super::matching::Config;"), 1);
        assert_eq!(count(name, "mod tests { use super::super::super::matching::Config; }"), 1);
        assert_eq!(count(name, "fn f(c: crate::matching::Config) {}"), 1);
        assert_eq!(count(name, "fn f() { assert!(crate::matching::state_bytes(1) > 0); }"), 1);
        assert_eq!(count(name, "macro_rules! m { () => { $crate::matching::f() } }"), 1);
        assert_eq!(count("src/math.rs", "use super::camera::LineFormat;"), 1);
    }

    #[test]
    fn names_at_the_root_hide_no_edge() {
        assert_eq!(count("src/units.rs", "use crate::Config;"), 1);
        assert_eq!(count("src/units.rs", "use crate::*;"), 1);
        assert_eq!(count("src/units.rs", "use super::*;"), 1);
        assert_eq!(count("src/elsewhere.rs", ""), 1);
    }

    #[test]
    fn names_are_found_in_code_alone() {
        let text = "//! libm, unsafe\nfn f() { let s = \"libm\"; unsafe { g(libm::sqrtf(1.0)) } }";
        assert_eq!(lines_naming("src/x.rs", text, "libm"), ["src/x.rs:2: names libm"]);
        assert_eq!(lines_naming("src/x.rs", text, "unsafe"), ["src/x.rs:2: names unsafe"]);
        assert!(may_be_unsafe("src/matching/backend/simd/x86.rs") && !may_be_unsafe("src/matching/row.rs"));
    }
}
