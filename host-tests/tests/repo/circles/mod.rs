//! Inside a module, too, data moves one way: in every folder, no files or folders use each other in a circle.
//! Where a `mod.rs` lists its modules in running order, an arrow goes only to what stands above.
//!
//! A name is followed through re-exports to the file that has it: `pub use` hides no arrow and is none.

mod items;
mod shown_to_fail;

pub use items::declared;

use crate::layering::HOUSE;
use crate::paths::{Named, module_of, named};
use crate::source::{self, root, tokens};
use items::{calls, definitions, without_tests};
use std::collections::{BTreeMap, BTreeSet};

/// Folders whose `mod.rs` lists the modules in running order.
const IN_ORDER: [&str; 16] = [
    "matching",
    "geometry",
    "geometry/absolute",
    "geometry/camera",
    "geometry/known_shape",
    "geometry/linear",
    "geometry/rectify",
    "geometry/robust",
    "geometry/two_view",
    "motion",
    "features",
    "focus",
    "motion/bundle",
    "motion/odometry",
    "motion/structure",
    "obstacles",
];

/// The program `stereo`, the harness below it, and the repository's chores.
const PACKAGES: [&str; 5] = [
    "host-tests/src/bin/stereo",
    "host-tests/src",
    "host-tests/model/src",
    "host-tests/rig/src",
    "host-tests/xtask/src",
];

/// Folders whose `mod.rs` has what its parts share and runs them, too: among the parts there is no circle.
const SHARED_BY_ITS_PARTS: [&str; 8] = [
    "matching/backend/armv7em",
    "matching/backend/armv7em/sgm",
    "matching/backend/mve",
    "matching/backend/portable/planes",
    "matching/backend/portable/sgm",
    "matching/backend/portable/sgm/passes",
    "matching/backend/simd",
    "matching/backend",
];

/// The node of what a `mod.rs` has itself.
const OWN: &str = "mod.rs";

/// A file of the tree of modules.
#[derive(Default)]
struct Module {
    file: String,
    children: Vec<String>,
    named: Vec<Named>,
    /// Macros that the file calls, with the lines.
    calls: Vec<(String, usize)>,
    /// What it defines at its top.
    defines: BTreeSet<String>,
}

/// An arrow between two files: from, to, where.
type Arrow = (Vec<String>, Vec<String>, String);

#[derive(Default)]
struct Tree {
    modules: BTreeMap<Vec<String>, Module>,
    /// Whether every `mod.rs` may have what its parts share and run them, too.
    maps_share: bool,
}

impl Tree {
    fn new(root: &str, files: &[(String, String)]) -> Self {
        let mut tree = Self::default();
        for (file, text) in files {
            let (path, tokens) = (module_of(root, file), without_tests(&tokens(file, text)));
            let children = declared(&tokens);
            let named = named(&tokens, &path, &children);
            let mut module = Module { file: file.clone(), children, named, ..Module::default() };
            definitions(&tokens, &mut module.defines);
            calls(&tokens, &mut module.calls);
            tree.modules.insert(path, module);
        }
        tree
    }

    /// The files that have what a path names.
    fn owners(&self, path: &[String], depth: usize, found: &mut BTreeSet<Vec<String>>) {
        let at = (0..=path.len()).rev().find(|&n| self.modules.contains_key(&path[..n]));
        let Some((at, module)) = at.and_then(|n| Some((n, self.modules.get(&path[..n])?))) else { return };
        let (here, rest) = path.split_at(at);
        let Some(name) = rest.first() else {
            found.insert(here.to_vec());
            return;
        };
        let before = found.len();
        let passed_on = module.named.iter().filter(|_| depth < 8 && !module.defines.contains(name));
        for one in passed_on.filter(|one| one.path != path) {
            let target = match one.used_as.as_deref() {
                Some("*") => one.path[..one.path.len() - 1].iter().cloned().chain([name.clone()]).collect(),
                Some(used_as) if used_as == name => one.path.clone(),
                _ => continue,
            };
            if one.used_as.as_deref() == Some("*") && !self.has(&target) {
                continue;
            }
            self.owners(&[target, rest[1..].to_vec()].concat(), depth + 1, found);
        }
        if found.len() == before {
            found.insert(here.to_vec());
        }
    }

    /// Whether the module before the last name defines that.
    fn has(&self, path: &[String]) -> bool {
        let Some((name, module)) = path.split_last() else { return false };
        self.modules
            .get(module)
            .is_some_and(|module| module.defines.contains(name) || module.children.contains(name))
    }

    /// All arrows, re-exports left out.
    fn arrows(&self) -> Vec<Arrow> {
        let mut arrows = Vec::new();
        for (from, module) in &self.modules {
            for one in module.named.iter().filter(|one| !one.public) {
                let path = if one.used_as.as_deref() == Some("*") {
                    &one.path[..one.path.len() - 1]
                } else {
                    one.path.as_slice()
                };
                let mut owners = BTreeSet::new();
                self.owners(path, 0, &mut owners);
                let place = format!("{}:{}: {}", module.file, one.line, one.path.join("::"));
                arrows.extend(owners.into_iter().map(|to| (from.clone(), to, place.clone())));
            }
            for (name, line) in &module.calls {
                let definers =
                    self.modules.iter().filter(|(_, other)| other.defines.contains(&format!("{name}!")));
                let definers: Vec<_> = definers.map(|(path, _)| path.clone()).collect();
                if let ([to], false) = (definers.as_slice(), definers.contains(from)) {
                    arrows.push((from.clone(), to.clone(), format!("{}:{line}: {name}!", module.file)));
                }
            }
        }
        arrows
    }

    /// The arrows among what stands in `folder`: names of its modules, and a place for each.
    fn inside(&self, folder: &[String]) -> BTreeMap<(String, String), String> {
        let node = |path: &[String]| path.get(folder.len()).cloned().unwrap_or_else(|| OWN.to_owned());
        let here = |arrow: &Arrow| arrow.0.starts_with(folder) && arrow.1.starts_with(folder);
        let arrows = self.arrows().into_iter().filter(here);
        let between = arrows.map(|(from, to, place)| ((node(&from), node(&to)), place));
        let is_shared = self.maps_share || SHARED_BY_ITS_PARTS.contains(&folder.join("/").as_str());
        let counts = |from: &str, to: &str| from != to && !(is_shared && [from, to].contains(&OWN));
        between.filter(|((from, to), _)| counts(from, to)).collect()
    }

    /// The folders at and below `top`.
    fn folders<'a>(&'a self, top: &'a [String]) -> impl Iterator<Item = &'a Vec<String>> {
        let folders =
            self.modules.iter().filter(|(path, module)| path.starts_with(top) && !module.children.is_empty());
        folders.map(|(path, _)| path)
    }

    /// The circles at and below a folder, with a line for each arrow in one.
    fn circles(&self, top: &str) -> Vec<String> {
        let top = module_of("", top);
        assert!(self.folders(&top).count() > 0, "{top:?} is no module with modules");
        let mut found = Vec::new();
        for folder in self.folders(&top) {
            let arrows = self.inside(folder);
            let reached = |start: &str| {
                let mut reached = BTreeSet::from([start.to_owned()]);
                loop {
                    let next =
                        arrows.keys().filter(|(from, to)| reached.contains(from) && !reached.contains(to));
                    let next: Vec<_> = next.map(|(_, to)| to.clone()).collect();
                    if next.is_empty() {
                        return reached;
                    }
                    reached.extend(next);
                }
            };
            let in_circle = arrows.iter().filter(|((from, to), _)| reached(to).contains(from));
            let name = folder.join("::");
            found.extend(in_circle.map(|((from, to), place)| format!("{name}: {from} -> {to}: {place}")));
        }
        found
    }

    /// The arrows of a folder that go up: to what is declared below.
    fn upward(&self, folder: &str) -> Vec<String> {
        let folder = &module_of("", folder);
        let Some(module) = self.modules.get(folder) else { return vec![format!("{folder:?} is no module")] };
        let place = |name: &String| module.children.iter().position(|child| child == name);
        let up = |(from, to): &(String, String)| match (place(from), place(to)) {
            (Some(from), Some(to)) => from < to,
            _ => false,
        };
        let arrows = self.inside(folder).into_iter().filter(|(ends, _)| up(ends));
        arrows.map(|((from, to), place)| format!("{}: {from} -> {to}: {place}", folder.join("::"))).collect()
    }
}

fn core() -> Tree {
    Tree::new("src", &source::core_files())
}

/// A package's files, without programs of their own in its folder `bin`.
fn package(root: &str) -> Tree {
    let programs = format!("{root}/bin/");
    let files = source::rust_files(root).into_iter().filter(|(file, _)| !file.starts_with(&programs));
    Tree { maps_share: true, ..Tree::new(root, &files.collect::<Vec<_>>()) }
}

#[test]
fn no_circle_inside_a_module() {
    let tree = core();
    let folders: Vec<_> = HOUSE.into_iter().filter(|name| root().join("src").join(name).is_dir()).collect();
    assert!(folders.len() > 10, "the modules of src are {folders:?}");
    let wrong: Vec<_> = folders.iter().flat_map(|folder| tree.circles(folder)).collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn no_circle_in_a_package_on_the_host() {
    let wrong: Vec<_> = PACKAGES.iter().flat_map(|root| package(root).circles("")).collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn arrows_inside_a_module_go_up_its_list() {
    let tree = core();
    let wrong: Vec<_> = IN_ORDER.iter().flat_map(|folder| tree.upward(folder)).collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// `cargo test --test repo circles -- --ignored --nocapture` prints what is left to do.
#[test]
#[ignore = "prints every circle and the number of upward arrows of each folder"]
fn what_is_left() {
    let print = |tree: Tree| {
        tree.circles("").iter().for_each(|line| println!("{line}"));
        for folder in tree.folders(&[]) {
            println!("{}: {} upward", folder.join("::"), tree.upward(&folder.join("/")).len());
        }
    };
    print(core());
    PACKAGES.iter().for_each(|root| print(package(root)));
}
