//! Mutants woven into one source: each stands beside the code that it replaces, and a number chooses which
//! one runs, so that a program with thousands of mutants is built once.
//!
//! Roland H. Untch, A. Jefferson Offutt, Mary Jean Harrold, "Mutation Analysis Using Mutant Schemata", 1993.

use serde::Deserialize;
use std::ops::Range;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{Arm, Block, Expr, ExprBinary, ExprConst, ExprMatch, ExprRepeat, ExprStruct, ExprUnary, Pat};
use syn::{
    GenericArgument, ImplItemConst, ImplItemFn, ItemConst, ItemFn, ItemStatic, ReturnType, Signature,
    TraitItemConst, TraitItemFn, Type, TypeArray,
};

/// A mutant as `cargo mutants --list --json` prints it.
#[derive(Clone, Deserialize)]
pub struct Mutant {
    /// The source file, from the root.
    pub file: String,
    /// What it does, and where.
    pub name: String,
    /// The kind of change.
    pub genre: String,
    /// What stands in place of the code.
    pub replacement: String,
    /// The code that is replaced.
    span: Span,
}

/// Where a stretch of source begins.
#[derive(Clone, Deserialize)]
struct Span {
    start: Place,
}

/// A character of a source: line and column from 1.
#[derive(Clone, Deserialize)]
struct Place {
    line: usize,
    column: usize,
}

/// A source with mutants in it.
pub struct Woven {
    /// The text.
    pub text: String,
    /// Where the mutants stand, the outer ones first.
    pub spots: Vec<Spot>,
    /// The mutants that this cannot express.
    pub left_out: Vec<u32>,
}

/// Where a mutant stands in the text.
pub struct Spot {
    pub number: u32,
    /// The bytes of the mutant.
    pub mutant: Range<usize>,
    /// The bytes of the code that it stands beside.
    pub code: Range<usize>,
}

/// Text around a stretch of the source.
struct Edit {
    number: u32,
    range: Range<usize>,
    before: String,
    after: &'static str,
}

/// Weaves numbered mutants of one file into its source.
pub fn weave(source: &str, mutants: &[(u32, &Mutant)]) -> syn::Result<Woven> {
    let file = syn::parse_file(source)?;
    let mut seek = Seek { source, edits: Vec::new(), mutants: Vec::new(), has_rest: false };
    for (number, mutant) in mutants {
        seek.mutants.push((*number, mutant, offset(source, &mutant.span.start)));
    }
    seek.visit_file(&file);
    let Seek { edits, .. } = seek;
    let is_woven = |number: u32| edits.iter().any(|edit| edit.number == number);
    let left_out = mutants.iter().map(|(number, _)| *number).filter(|number| !is_woven(*number)).collect();
    let (text, spots) = insert(source, edits);
    Ok(Woven { text, spots, left_out })
}

/// The text with all edits, and where they came to stand.
fn insert(source: &str, mut edits: Vec<Edit>) -> (String, Vec<Spot>) {
    // Outer edits first: those that begin before others, or end behind them.
    edits.sort_by_key(|edit| (edit.range.start, usize::MAX - edit.range.end));
    let (mut text, mut spots) = (String::new(), Vec::<Spot>::new());
    let mut open: Vec<usize> = Vec::new();
    let mut at = 0;
    let mut close = |text: &mut String, open: &mut Vec<usize>, spots: &mut Vec<Spot>, to: usize| {
        while let Some(edit) = open.pop_if(|edit| edits[*edit].range.end <= to) {
            text.push_str(&source[at..edits[edit].range.end]);
            at = edits[edit].range.end;
            text.push_str(edits[edit].after);
            spots[edit].code.end = text.len();
        }
        text.push_str(&source[at..to]);
        at = to;
    };
    for (index, edit) in edits.iter().enumerate() {
        // What ends where this one begins stands before it; what is empty has nothing within.
        close(&mut text, &mut open, &mut spots, edit.range.start);
        let start = text.len();
        text.push_str(&edit.before);
        let end = text.len();
        spots.push(Spot { number: edit.number, mutant: start..end, code: end..end });
        open.push(index);
    }
    close(&mut text, &mut open, &mut spots, source.len());
    (text, spots)
}

/// The byte of a place.
fn offset(source: &str, place: &Place) -> usize {
    let line: usize = source.split_inclusive('\n').take(place.line - 1).map(str::len).sum();
    let within = source[line..].char_indices().nth(place.column - 1);
    line + within.map_or(source.len() - line, |(byte, _)| byte)
}

/// Finds the code of each mutant.
struct Seek<'a> {
    source: &'a str,
    /// Numbers, mutants, and the bytes that their code begins at.
    mutants: Vec<(u32, &'a Mutant, usize)>,
    edits: Vec<Edit>,
    /// Whether the innermost match has an arm for whatever the others leave.
    has_rest: bool,
}

impl Seek<'_> {
    /// The numbers and replacements of a kind's mutants of a stretch of the source.
    fn of(&self, genre: &str, range: &Range<usize>) -> Vec<(u32, String)> {
        let here = self.mutants.iter().filter(|(_, mutant, at)| mutant.genre == genre && *at == range.start);
        here.map(|(number, mutant, _)| (*number, mutant.replacement.clone())).collect()
    }

    /// The mutants of a place as one or the other expression.
    fn either(&mut self, mutants: Vec<(u32, String)>, range: &Range<usize>, other: impl Fn(&str) -> String) {
        for (number, replacement) in mutants {
            let before = format!("(if crate::mutant::on({number}) {{ {} }} else {{ ", other(&replacement));
            self.edits.push(Edit { number, range: range.clone(), before, after: " })" });
        }
    }

    fn function(&mut self, signature: &Signature, block: &Block) {
        // Something simple and the code are of two types.
        if matches!(&signature.output, ReturnType::Type(_, given) if matches!(**given, Type::ImplTrait(_))) {
            return;
        }
        let Some(first) = block.stmts.first() else { return };
        let inside = block.brace_token.span.open().byte_range().end;
        for (number, replacement) in self.of("FnValue", &first.span().byte_range()) {
            let before = format!(" if crate::mutant::on({number}) {{ return {replacement}; }} ");
            self.edits.push(Edit { number, range: inside..inside, before, after: "" });
        }
    }
}

impl<'ast> Visit<'ast> for Seek<'_> {
    fn visit_item_fn(&mut self, node: &'ast ItemFn) {
        self.function(&node.sig, &node.block);
        visit::visit_item_fn(self, node);
    }

    fn visit_impl_item_fn(&mut self, node: &'ast ImplItemFn) {
        self.function(&node.sig, &node.block);
        visit::visit_impl_item_fn(self, node);
    }

    fn visit_trait_item_fn(&mut self, node: &'ast TraitItemFn) {
        if let Some(block) = &node.default {
            self.function(&node.sig, block);
        }
        visit::visit_trait_item_fn(self, node);
    }

    // What runs while the crate is compiled has no mutant.
    fn visit_item_const(&mut self, _: &'ast ItemConst) {}

    fn visit_impl_item_const(&mut self, _: &'ast ImplItemConst) {}

    fn visit_trait_item_const(&mut self, _: &'ast TraitItemConst) {}

    fn visit_item_static(&mut self, _: &'ast ItemStatic) {}

    fn visit_expr_const(&mut self, _: &'ast ExprConst) {}

    fn visit_type_array(&mut self, node: &'ast TypeArray) {
        self.visit_type(&node.elem);
    }

    fn visit_expr_repeat(&mut self, node: &'ast ExprRepeat) {
        self.visit_expr(&node.expr);
    }

    fn visit_generic_argument(&mut self, node: &'ast GenericArgument) {
        if !matches!(node, GenericArgument::Const(_)) {
            visit::visit_generic_argument(self, node);
        }
    }

    fn visit_expr_binary(&mut self, node: &'ast ExprBinary) {
        let mutants = self.of("BinaryOperator", &node.op.span().byte_range());
        // `let` stands in no brackets.
        if !has_let(&node.left) && !has_let(&node.right) {
            let [left, right] = [&node.left, &node.right].map(|e| &self.source[e.span().byte_range()]);
            let (left, right) = (left.to_owned(), right.to_owned());
            self.either(mutants, &node.span().byte_range(), |op| format!("{left} {op} {right}"));
        }
        visit::visit_expr_binary(self, node);
    }

    fn visit_expr_unary(&mut self, node: &'ast ExprUnary) {
        let mutants = self.of("UnaryOperator", &node.op.span().byte_range());
        let operand = self.source[node.expr.span().byte_range()].to_owned();
        self.either(mutants, &node.span().byte_range(), |op| format!("{op}{operand}"));
        visit::visit_expr_unary(self, node);
    }

    fn visit_expr_struct(&mut self, node: &'ast ExprStruct) {
        let whole = node.span().byte_range();
        for field in &node.fields {
            let range = field.span().byte_range();
            let mutants = self.of("StructField", &range);
            if mutants.is_empty() {
                continue;
            }
            // A base follows, and so a comma.
            let end = range.end + self.source[range.end..].find(',').map_or(0, |comma| comma + 1);
            let without = [&self.source[whole.start..range.start], &self.source[end..whole.end]].concat();
            self.either(mutants, &whole, |_| without.clone());
        }
        visit::visit_expr_struct(self, node);
    }

    fn visit_expr_match(&mut self, node: &'ast ExprMatch) {
        let is_rest = |arm: &Arm| matches!(arm.pat, Pat::Wild(_));
        let outer = std::mem::replace(&mut self.has_rest, node.arms.iter().any(is_rest));
        visit::visit_expr_match(self, node);
        self.has_rest = outer;
    }

    fn visit_arm(&mut self, node: &'ast Arm) {
        let pattern = node.pat.span().byte_range();
        let guard =
            if let Pat::Guard(guarded) = &node.pat { Some(guarded.guard.span().byte_range()) } else { None };
        if let Some(guard) = &guard {
            let mutants = self.of("MatchArmGuard", guard);
            self.either(mutants, guard, str::to_owned);
        }
        // A match that lacks an arm does not compile without an arm for the rest; one with a guard is none.
        let whole = node.span().byte_range();
        let gone = if self.has_rest { self.of("MatchArm", &whole) } else { Vec::new() };
        for (number, _) in gone {
            let not = format!("!crate::mutant::on({number})");
            self.edits.push(match &guard {
                Some(guard) => {
                    Edit { number, range: guard.clone(), before: format!("{not} && ("), after: ")" }
                }
                None => {
                    Edit { number, range: pattern.end..pattern.end, before: format!(" if {not}"), after: "" }
                }
            });
        }
        visit::visit_arm(self, node);
    }
}

/// Whether an operand of a condition's chain is a `let`.
fn has_let(operand: &Expr) -> bool {
    match operand {
        Expr::Let(_) => true,
        Expr::Binary(binary) => has_let(&binary.left) || has_let(&binary.right),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mutant(genre: &str, replacement: &str, line: usize, column: usize) -> Mutant {
        Mutant {
            file: String::new(),
            name: String::new(),
            genre: genre.to_owned(),
            replacement: replacement.to_owned(),
            span: Span { start: Place { line, column } },
        }
    }

    #[test]
    fn mutants_stand_beside_the_code() {
        let source = "fn f(a: u8) -> u8 {\n    a + 1 * a\n}\nconst N: u8 = 1 + 2;\n";
        let mutants = [
            mutant("BinaryOperator", "-", 2, 7),
            mutant("BinaryOperator", "/", 2, 11),
            mutant("FnValue", "0", 2, 5),
            mutant("BinaryOperator", "-", 4, 17),
        ];
        let numbered: Vec<_> = (0..).zip(&mutants).collect();
        let woven = weave(source, &numbered).expect("it parses");
        let body = "(if crate::mutant::on(0) { a - 1 * a } else { \
                    a + (if crate::mutant::on(1) { 1 / a } else { 1 * a }) })";
        let expected = format!(
            "fn f(a: u8) -> u8 {{ if crate::mutant::on(2) {{ return 0; }} \n    {body}\n}}\n\
             const N: u8 = 1 + 2;\n"
        );
        assert_eq!(woven.text, expected);
        assert_eq!(woven.left_out, [3], "what runs while the crate is compiled");
        let of = |number: u32| woven.spots.iter().find(|spot| spot.number == number).expect("a spot");
        assert_eq!(
            &woven.text[of(1).mutant.start..of(1).code.end],
            "(if crate::mutant::on(1) { 1 / a } else { 1 * a })"
        );
    }

    #[test]
    fn what_the_compiler_runs_stays() {
        let source = "static N: u8 = 1 + 2;\nfn f(_: [u8; 1 + 2]) -> u8 {\n    let _ = [1; 1 + 2];\n    \
                      let _ = const { 1 + 2 };\n    g::<{ 1 + 2 }>() + 1\n}\n";
        let places = [(1, 18), (2, 16), (3, 19), (4, 23), (5, 13), (5, 22)];
        let mutants = places.map(|(line, column)| mutant("BinaryOperator", "-", line, column));
        let woven = weave(source, &(0..).zip(&mutants).collect::<Vec<_>>()).expect("it parses");
        assert_eq!(woven.left_out, [0, 1, 2, 3, 4], "{}", woven.text);
    }

    #[test]
    fn what_is_of_a_hidden_type_stays() {
        let source = "fn f() -> impl Iterator<Item = u8> {\n    0..9\n}\n";
        let mutant = mutant("FnValue", "::std::iter::empty()", 2, 5);
        assert_eq!(weave(source, &[(0, &mutant)]).expect("it parses").left_out, [0]);
    }

    #[test]
    fn an_arm_that_the_match_needs_stays() {
        let source = "fn f(a: Option<u8>) -> u8 {\n    match a {\n        _ if g() => 0,\n        \
                      Some(x) => x,\n        None => 1,\n    }\n}\n";
        let mutants = [mutant("MatchArm", "", 4, 9), mutant("MatchArmGuard", "true", 3, 14)];
        let woven = weave(source, &(0..).zip(&mutants).collect::<Vec<_>>()).expect("it parses");
        assert_eq!(woven.left_out, [0]);
        assert!(woven.text.contains("on(1) { true }"), "{}", woven.text);
    }

    #[test]
    fn arms_guards_and_fields_are_woven() {
        let source = "fn f(a: S) -> S {\n    match a {\n        x if g(x) => S { b: 1, ..x },\n        \
                      _ => !a,\n    }\n}\n";
        let mutants = [
            mutant("MatchArmGuard", "true", 3, 14),
            mutant("MatchArm", "", 3, 9),
            mutant("StructField", "", 3, 26),
            mutant("UnaryOperator", "", 4, 14),
        ];
        let numbered: Vec<_> = (0..).zip(&mutants).collect();
        let woven = weave(source, &numbered).expect("it parses");
        assert!(woven.left_out.is_empty(), "{:?}", woven.left_out);
        let parts =
            ["on(0) { true }", "!crate::mutant::on(1) && (g(x))", "{ S {  ..x } }", "{ a } else { !a })"];
        for part in parts {
            assert!(woven.text.contains(part), "{part}: {}", woven.text);
        }
        assert!(syn::parse_file(&woven.text).is_ok(), "{}", woven.text);
    }
}
