//! The checks on files that break the rules.

use super::*;

fn tree(files: &[(&str, &str)]) -> Tree {
    let owned: Vec<_> =
        files.iter().map(|(name, text)| (format!("src/{name}"), (*text).to_owned())).collect();
    Tree::new("src", &owned)
}

/// The circles in `m`, of a `mod.rs` and two files.
fn circles(map: &str, a: &str, b: &str) -> usize {
    tree(&[("lib.rs", "mod m;"), ("m/mod.rs", map), ("m/a.rs", a), ("m/b.rs", b)]).circles("m").len()
}

const MAP: &str = "mod a; mod b; pub use a::A; pub(crate) use b::{B, f as g};";

#[test]
fn one_way_is_no_circle() {
    assert_eq!(circles(MAP, "use super::b::B; pub struct A(B);", "pub struct B; pub fn f() {}"), 0);
    assert_eq!(circles(MAP, "pub struct A(super::B);", "#[cfg(test)] mod tests { use super::super::A; }"), 0);
    assert_eq!(
        circles(MAP, "/// [`super::b::B`]\npub struct A;", "use super::A; pub struct B; // super::B"),
        0
    );
}

#[test]
fn circles_are_found_in_every_form() {
    let b = "use super::a::A; pub struct B; pub fn f() {}";
    for a in [
        "use super::b::B; pub struct A;",
        "use super::{a as other, b}; pub struct A;",
        "use crate::m::{b::{B, f}}; pub struct A;",
        "pub struct A(super::b::B);",
        "pub struct A; fn h() { assert!(super::b::f()) }",
        "pub struct A; mod inner { use super::super::b; }",
        // Through the re-exports of the map.
        "use super::B; pub struct A;",
        "use super::g; pub struct A;",
        "pub struct A; fn h(b: &[crate::m::B]) {}",
    ] {
        assert_eq!(circles(MAP, a, b), 2, "{a}");
    }
    let globs = "mod a; mod b; pub use a::*; pub use b::*;";
    assert_eq!(circles(globs, "pub struct A(super::B);", "pub struct B; fn f(a: super::A) {}"), 2);
    let (a, b) = ("pub struct A(super::b::B);", "pub struct B; fn f() { m!() } ");
    assert_eq!(circles(MAP, &format!("macro_rules! m {{ () => {{}} }} {a}"), b), 2);
}

#[test]
fn a_map_with_items_of_its_own_stands_in_circles_too() {
    let map = "mod a; mod b; pub struct Own; fn f() { a::f() }";
    assert_eq!(circles(map, "use super::Own; pub fn f() {}", ""), 2);
    assert_eq!(circles(map, "pub fn f() {}", "use super::Own;"), 0);
}

#[test]
fn folders_are_in_circles_though_their_files_are_not() {
    let files = [
        ("m/mod.rs", "mod x; mod y;"),
        ("m/x/mod.rs", "pub mod one; pub mod two;"),
        ("m/x/one.rs", "use crate::m::y::three::T; pub struct O;"),
        ("m/x/two.rs", "pub struct W;"),
        ("m/y/mod.rs", "pub mod three; pub mod four;"),
        ("m/y/three.rs", "pub struct T;"),
        ("m/y/four.rs", "use super::super::x::two::W;"),
    ];
    assert_eq!(tree(&files).circles("m").len(), 2);
    assert_eq!(tree(&files[..5]).circles("m").len(), 0);
}

#[test]
fn an_arrow_to_what_is_declared_below_is_found() {
    let upward = |a: &str, b: &str| tree(&[("m/mod.rs", MAP), ("m/a.rs", a), ("m/b.rs", b)]).upward("m");
    assert_eq!(upward("pub struct A;", "use super::a::A;").len(), 0);
    assert_eq!(upward("use super::b::B;", "pub struct B;"), ["m: a -> b: src/m/a.rs:1: m::b::B"]);
    assert_eq!(upward("pub struct A(super::B);", "pub struct B;").len(), 1);
}
