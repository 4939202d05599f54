//! What firmware expects of every public type: `Debug`, and of those that are data `defmt::Format` and
//! serde's pair behind their features.
//!
//! Data is what can be cloned and borrows nothing. What is an error is printed and logged, not stored.

use crate::names;
use crate::paths::module_of;
use crate::source::{self, end_of_item, inside, is_sign, tokens, word};
use proc_macro2::{Delimiter, TokenTree};
use std::collections::BTreeSet;

/// Public types without `Debug`, each with the reason.
const NO_DEBUG: [(&str, &[&str]); 3] = [
    ("tens of kilobytes of working memory", &["Matcher", "Pipeline", "Guarded", "WinnerPipeline"]),
    (
        "an end of a queue: looking at it needs what the other end may be changing",
        &[
            "LineProducer",
            "LineConsumer",
            "HandedLines",
            "PolledLines",
            "LineNotifier",
            "LineListener",
            "Covariances",
        ],
    ),
    (
        "opaque to C",
        &[
            "DetectorHandle",
            "DriveHandle",
            "FocusHandle",
            "FreeSpaceHandle",
            "Handle",
            "Instance",
            "LineQueueHandle",
            "ObstaclesHandle",
            "OdometryHandle",
            "PairMonitorHandle",
            "Rectifier",
            "RectifierHandle",
            "WinnersHandle",
        ],
    ),
];

/// Types that can be cloned and are no data: neither `Format` nor serde's pair.
const NO_DATA: [(&str, &[&str]); 5] = [
    (
        "a word in a type, which has no value",
        &["Block", "Capacity", "External", "Fast", "Sgm", "SgmEdge", "SgmLean"],
    ),
    ("lines and pixels in work", &["Patch", "Remap", "RemapPair", "Template"]),
    ("made again from a rig or a scale, which is stored", &["DepthTable", "RemapTable", "Warp"]),
    (
        "in the middle of its work",
        &[
            "Adjustment",
            "Autofocus",
            "BalancedPair",
            "Bands",
            "Column",
            "CornerSlot",
            "CrossBlock",
            "DriveRule",
            "Filling",
            "FocusCell",
            "FocusSearch",
            "FreeSpace",
            "MatchSlot",
            "NoiseMeter",
            "PairMonitor",
            "PointMatch",
            "RowMeter",
            "Track",
            "ViewSlot",
        ],
    ),
    (
        "C's, which C code stores as bytes",
        &[
            "CAgreement",
            "CBalance",
            "CCameras",
            "CConfig",
            "CCounters",
            "CDetection",
            "CDetectionCounts",
            "CDriveConfig",
            "CFeature",
            "CFocusConfig",
            "CFocusPeak",
            "CGround",
            "CHistogram",
            "CLine",
            "CMatch",
            "CNoiseMeter",
            "CObstacleConfig",
            "COdometryConfig",
            "CPicture",
            "CPinhole",
            "CPoint",
            "CPose",
            "CRig",
            "CRow",
            "CScan",
            "CSearch",
            "CSector",
            "CStep",
            "CStixel",
            "CTemporal",
            "CVerdict",
            "CWinner",
            "Status",
        ],
    ),
];

/// Data that is logged and not stored: `Format` alone.
const NOT_STORED: [(&str, &[&str]); 7] = [
    ("between a core and a device, as bytes and offsets", &["Register", "WinnerRecord"]),
    ("made again from a rig, which is stored", &["DepthScale", "OdometryRig", "Rectification", "TwoViews"]),
    (
        "made again from a matrix or segments, which are stored",
        &["Epipole", "Line", "PlaneMotion", "VanishingPoint"],
    ),
    ("candidates within a computation", &["P3pPoses", "PatchOrientation", "ProjectionJacobian"]),
    ("gathered anew in every frame", &["AutoExposure", "Band", "Histogram", "PingPong"]),
    (
        "said by one part of a program to another",
        &["FocusSearchStep", "LensCommand", "LensEvent", "WinnerSearch"],
    ),
    ("why there is no answer, or a choice of colours", &["DisparityColours", "LineFault", "NoFocus"]),
];

/// A type as it is declared.
struct Declared {
    name: String,
    /// What it derives or has an implementation of.
    has: BTreeSet<String>,
    borrows: bool,
}

/// The words of an attribute and of all groups in it.
fn words(tokens: &[TokenTree], into: &mut BTreeSet<String>) {
    for token in tokens {
        match token {
            TokenTree::Group(group) => words(&group.stream().into_iter().collect::<Vec<_>>(), into),
            token => {
                into.insert(word(Some(token)));
            }
        }
    }
}

/// The types that a file declares, and what it implements by hand or by `deserialize_checked!`.
fn declared(tokens: &[TokenTree]) -> Vec<Declared> {
    let mut found: Vec<Declared> = Vec::new();
    let mut implemented = Vec::new();
    let mut derived = BTreeSet::new();
    let mut i = 0;
    while i < tokens.len() {
        let (here, next) = (word(tokens.get(i)), word(tokens.get(i + 1)));
        if is_sign(tokens.get(i), '#') && is_sign(tokens.get(i + 1), '!') {
            i += 3; // What is said of the file.
            continue;
        }
        if is_sign(tokens.get(i), '#') {
            let attribute = inside(tokens.get(i + 1), Delimiter::Bracket).unwrap_or_default();
            if matches!(word(attribute.first()).as_str(), "derive" | "cfg_attr") {
                words(&attribute, &mut derived);
            }
            i += 2;
            continue;
        }
        if here == "pub" && matches!(next.as_str(), "struct" | "enum" | "union") {
            let borrows = is_sign(tokens.get(i + 3), '<') && is_sign(tokens.get(i + 4), '\'');
            let has = std::mem::take(&mut derived);
            found.push(Declared { name: word(tokens.get(i + 2)), has, borrows });
        }
        if here == "impl" {
            let end = end_of_item(tokens, i);
            let head: BTreeSet<_> = tokens[i..end].iter().map(|token| word(Some(token))).collect();
            if head.contains("Debug") && head.contains("for") {
                implemented.extend(head.into_iter().map(|name| (name, "Debug")));
            }
        }
        if here == "deserialize_checked" {
            let body = inside(tokens.get(i + 2), Delimiter::Brace).unwrap_or_default();
            implemented.push((word(body.first()), "Deserialize"));
        }
        derived.clear();
        i = end_of_item(tokens, i);
    }
    for (name, what) in implemented {
        for of_name in found.iter_mut().filter(|t| t.name == name) {
            of_name.has.insert(what.to_owned());
        }
    }
    found
}

/// What a type lacks, by the rules above.
fn lacks(t: &Declared) -> Vec<&'static str> {
    let listed = |list: &[(&str, &[&str])]| list.iter().any(|(_, names)| names.contains(&t.name.as_str()));
    let is_data = t.has.contains("Clone") && !t.borrows && !listed(&NO_DATA);
    let is_stored = is_data && !t.name.ends_with("Error") && !listed(&NOT_STORED);
    let wanted = [
        ("Debug", !listed(&NO_DEBUG)),
        ("Format", is_data),
        ("Serialize", is_stored),
        ("Deserialize", is_stored),
    ];
    wanted.iter().filter(|(what, needed)| *needed && !t.has.contains(*what)).map(|(what, _)| *what).collect()
}

/// The crate's public types.
fn public_types() -> Vec<Declared> {
    let names = names::of_the_core();
    let files = source::core_files();
    // A name may be that of a private type elsewhere: a public one stands in its file's module or above.
    let is_public = |file: &str, t: &Declared| {
        let module = module_of("src", file).join("/");
        names.get(&t.name).is_some_and(|modules| modules.iter().any(|m| module.starts_with(m.as_str())))
    };
    let of = |(file, text): &(String, String)| {
        declared(&tokens(file, text)).into_iter().filter(|t| is_public(file, t)).collect::<Vec<_>>()
    };
    files.iter().flat_map(of).collect()
}

#[test]
fn public_types_have_what_firmware_expects() {
    let types = public_types();
    assert!(types.len() > 200, "few types were found: {}", types.len());
    let wrong = types.iter().filter(|t| !lacks(t).is_empty());
    let wrong: Vec<_> = wrong.map(|t| format!("{} lacks {}", t.name, lacks(t).join(", "))).collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// An exception that is none any more has to go.
#[test]
fn every_exception_is_one() {
    let types = public_types();
    let of = |name: &str| types.iter().find(|t| t.name == name);
    let mut wrong = Vec::new();
    for (list, what) in [(&NO_DEBUG[..], "Debug"), (&NO_DATA, "Format"), (&NOT_STORED, "Deserialize")] {
        for name in list.iter().flat_map(|(_, names)| *names) {
            if of(name).is_none_or(|t| t.has.contains(what)) {
                wrong.push(format!("{name} is no public type without {what}"));
            }
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn what_is_missing_is_found() {
    let text = "//! A file.
        #[derive(Clone, Debug)] #[cfg_attr(feature = \"defmt\", derive(defmt::Format))]
        pub struct Half { x: u8 }
        #[derive(Clone)] pub enum Bare { A }
        #[derive(Clone, Debug)] #[cfg_attr(feature = \"defmt\", derive(defmt::Format))] pub enum AnError { A }
        pub struct Work(u8);
        impl core::fmt::Debug for Work { fn fmt(&self) {} }
        #[derive(Clone, Debug)] pub struct Lent<'a>(&'a u8);
        #[derive(Clone, Debug)]
        #[cfg_attr(feature = \"defmt\", derive(defmt::Format))]
        #[cfg_attr(feature = \"serde\", derive(serde::Serialize))]
        pub struct Checked { x: u8 }
        deserialize_checked! { Checked { x: u8 } by |c| Ok(Self { x: c.x }) }";
    let all: Vec<_> = declared(&tokens("x.rs", text)).iter().map(|t| (t.name.clone(), lacks(t))).collect();
    let of = |name: &str| &all.iter().find(|(n, _)| n == name).expect("declared").1;
    assert_eq!(of("Half"), &["Serialize", "Deserialize"]);
    assert_eq!(of("Bare"), &["Debug", "Format", "Serialize", "Deserialize"]);
    for name in ["AnError", "Work", "Lent", "Checked"] {
        assert!(of(name).is_empty(), "{name}: {:?}", of(name));
    }
}
