//! The crate as a registry would hand it out: its files, its dependencies, and that it builds away from the
//! repository. `cargo xtask publish` adds what takes tools of its own. Nothing is published.

use crate::cross;
use crate::setup;
use crate::steps::{
    Failure, Outcome, Steps, cargo, command, output_of, root, run as run_command, target_dir,
};
use serde::Deserialize;
use spdx::{Expression, ParseMode};
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;

/// What the package holds besides `src` and `docs`; what begins with `Cargo` or a dot is cargo's own.
const FILES: [&str; 6] =
    ["CHANGELOG.md", "LICENSE-APACHE", "LICENSE-MIT", "README.md", "build.rs", "docs/library.md"];

/// Its version 0.3 is a bridge to the first one, for crates that stand between.
const WITH_A_BRIDGE: &str = "defmt";

/// A core that the unpacked package is checked for, beside this machine: one whose dependencies the cross
/// checks have checked.
const TARGET: &str = cross::NOT_BUILT[0];

/// The test step.
pub fn run() -> Outcome {
    setup::targets(&[TARGET])?;
    files()?;
    dependencies()?;
    licences()?;
    builds_unpacked()
}

/// `cargo xtask publish`: the test step; the program `stereo` as its users build it, and by the oldest
/// compiler; then licences and known weaknesses of all dependencies, and what the public interface breaks
/// since the last tag.
pub fn publish() -> Outcome {
    let mut steps = Steps::new(None);
    steps.step("package", run)?;
    steps.step("program", || run_command(&mut cargo(&["build", "--locked", "--release"])))?;
    steps.step("stated rust-version", || stated_rust_version(&["stereopsis", "stereopsis-host"]))?;
    steps.step("licences, bans and sources", || deny(&["licenses", "bans", "sources"]))?;
    steps.step("advisories", advisories)?;
    steps.step("interface since the last tag", interface)?;
    steps.summary()
}

/// The oldest compiler that these packages say they build with checks them, with features that add code.
pub fn stated_rust_version(packages: &[&str]) -> Outcome {
    let version = setup::rust_version()?;
    let mut check = command("rustup", &["run", &version, "cargo", "check", "--locked"]);
    check.args(packages.iter().flat_map(|package| ["-p", package]));
    check.args(["--features", "stereopsis/defmt,stereopsis/ffi,stereopsis/serde"]);
    // Two compilers that take turns in one folder lock each other out and tidy away each other's products.
    run_command(check.env("CARGO_TARGET_DIR", target_dir().join("rust-version")))
}

/// The package has what its reader needs and nothing of the repository's own.
fn files() -> Outcome {
    let list = output_of(&mut cargo(&["package", "--list", "--allow-dirty", "-p", "stereopsis"]))?;
    let is_own = |file: &str| file.starts_with("Cargo") || file.starts_with('.');
    let is_due = |file: &str| {
        FILES.contains(&file)
            || (file.starts_with("docs/") || file.starts_with("src/")) && !file.contains("/.")
    };
    if let Some(stray) = list.lines().find(|file| !is_own(file) && !is_due(file)) {
        return Err(Failure::new(format!("the package has {stray}: exclude it in Cargo.toml")));
    }
    match FILES.iter().find(|file| !list.lines().any(|line| line == **file)) {
        Some(missing) => Err(Failure::new(format!("the package lacks {missing}"))),
        None => Ok(()),
    }
}

/// The core depends on one version of each crate, and each has a licence that lets its users choose MIT or
/// Apache 2.0.
fn dependencies() -> Outcome {
    let words = "tree --locked -p stereopsis --all-features -e normal --target all --prefix none --format";
    let tree = output_of(cargo(&words.split_whitespace().collect::<Vec<_>>()).arg("{p}|{l}"))?;
    let mut versions = BTreeMap::new();
    for line in tree.lines() {
        let (package, licence) = line.split_once('|').unwrap_or((line, ""));
        let mut words = package.split_whitespace();
        let (name, version) = (words.next().unwrap_or_default(), words.next().unwrap_or_default());
        let is_free = |word: &str| ["MIT", "Apache-2.0"].contains(&word.trim_matches(['(', ')']));
        if !licence.split(['/', ' ']).any(is_free) {
            let line = format!("{name} {version} has the licence \"{licence}\": MIT or Apache-2.0 is needed");
            return Err(Failure::new(line));
        }
        let first = versions.entry(name.to_owned()).or_insert_with(|| version.to_owned());
        if first != version && name != WITH_A_BRIDGE {
            let line = format!("the core depends on {name} {first} and {version}: one is enough");
            return Err(Failure::new(line));
        }
    }
    println!("{} crates with all features, the core among them", versions.len());
    Ok(())
}

/// Where cargo-deny reads which licences are accepted, and this step as well.
const DENY: &str = ".cargo/deny.toml";

/// What [`DENY`] says of licences.
#[derive(Deserialize)]
struct Deny {
    licenses: Accepted,
}

#[derive(Deserialize)]
struct Accepted {
    allow: Vec<String>,
    exceptions: Vec<Exception>,
}

#[derive(Deserialize)]
struct Exception {
    #[serde(rename = "crate")]
    name: String,
    allow: Vec<String>,
}

/// What cargo says of the packages that the workspace is built of.
#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
}

#[derive(Deserialize)]
struct Package {
    name: String,
    license: Option<String>,
}

/// Every package of the workspace, the tests' own tools among them, has a licence that is accepted.
fn licences() -> Outcome {
    let failed = |e: &dyn std::fmt::Display| Failure::new(format!("{DENY}: {e}"));
    let text = fs::read_to_string(root().join(DENY)).map_err(|e| failed(&e))?;
    let Deny { licenses } = toml::from_str(&text).map_err(|e| failed(&e.message()))?;
    let metadata =
        output_of(&mut cargo(&["metadata", "--locked", "--all-features", "--format-version", "1"]))?;
    let metadata: Metadata =
        serde_json::from_str(&metadata).map_err(|e| Failure::new(format!("cargo metadata: {e}")))?;
    for Package { name, license } in &metadata.packages {
        let licence = license.as_deref().unwrap_or_default();
        if !licenses.accepts(name, licence) {
            return Err(Failure::new(format!("{name} has the licence \"{licence}\": {DENY} accepts none")));
        }
    }
    println!("{} packages of the workspace have accepted licences", metadata.packages.len());
    Ok(())
}

impl Accepted {
    /// Whether a package may have a licence, or one of several.
    fn accepts(&self, package: &str, licence: &str) -> bool {
        let exceptions = self.exceptions.iter().filter(|exception| exception.name == package);
        let allowed: Vec<_> = exceptions.flat_map(|exception| &exception.allow).chain(&self.allow).collect();
        Expression::parse_mode(licence, ParseMode::LAX).is_ok_and(|expression| {
            expression.evaluate(|wanted| {
                wanted.addition.is_none()
                    && wanted.license.id().is_some_and(|id| allowed.iter().any(|name| *name == id.name))
            })
        })
    }
}

/// The package, unpacked elsewhere, builds for this machine and for a core with all features.
fn builds_unpacked() -> Outcome {
    run_command(&mut cargo(&["package", "--locked", "--allow-dirty", "--no-verify", "-p", "stereopsis"]))?;
    let package = format!("stereopsis-{}", env!("CARGO_PKG_VERSION"));
    let packed = root().join(target_dir()).join("package").join(format!("{package}.crate"));
    let folder = tempfile::tempdir().map_err(|e| Failure::new(format!("a temporary folder: {e}")))?;
    // As of now: a packed file's own time is the same in every package, so that a folder of targets that
    // another one has filled would keep its build script.
    run_command(command("tar", &["-xzmf"]).arg(&packed).arg("-C").arg(folder.path()))?;
    for target in [&[][..], &["--target", TARGET]] {
        let mut check = cargo(&["check", "--all-features"]);
        let check = check.args(target).env("CARGO_TARGET_DIR", cross::folder());
        run_command(check.env("RUSTFLAGS", "-D warnings").current_dir(folder.path().join(&package)))?;
    }
    Ok(())
}

/// Checks of cargo-deny, by `.cargo/deny.toml`.
fn deny(checks: &[&str]) -> Outcome {
    let deny = tool("cargo-deny")?;
    run_command(command(deny, &["--workspace", "--config", ".cargo/deny.toml", "check"]).args(checks))
}

/// The known weaknesses of dependencies, whose list is fetched.
fn advisories() -> Outcome {
    deny(&["advisories"]).inspect_err(|_| println!("the list of advisories has to be within reach"))
}

/// What a user of the last tag would have to change. Without a tag there is none.
fn interface() -> Outcome {
    let tags = output_of(&mut command("git", &["tag", "--list", "v*", "--sort=-v:refname"]))?;
    let Some(last) = tags.lines().next() else {
        println!("NOT RUN: there is no tag v... to compare with");
        return Ok(());
    };
    let checks = tool("cargo-semver-checks")?;
    run_command(
        command(checks, &["semver-checks", "-p", "stereopsis", "--baseline-rev", last]).arg("--all-features"),
    )
}

/// A tool of cargo's, built among this repository's products when the machine has none.
fn tool(name: &str) -> Outcome<PathBuf> {
    if output_of(&mut command(name, &["--version"])).is_ok() {
        return Ok(name.into());
    }
    let folder = root().join(target_dir()).join("tools");
    let tool = folder.join("bin").join(name).with_extension(std::env::consts::EXE_EXTENSION);
    if !tool.exists() {
        run_command(cargo(&["install", "--locked", name, "--root"]).arg(&folder))?;
    }
    Ok(tool)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_of_several_licences_is_enough_and_all_of_a_sum_are_needed() {
        let one = Exception { name: "tool".to_owned(), allow: vec!["MPL-2.0".to_owned()] };
        let accepted = Accepted { allow: vec!["MIT".to_owned(), "Zlib".to_owned()], exceptions: vec![one] };
        for licence in ["MIT", "MIT/Apache-2.0", "GPL-3.0-only OR MIT", "(Apache-2.0 OR MIT) AND Zlib"] {
            assert!(accepted.accepts("library", licence), "{licence}");
        }
        for licence in ["", "GPL-3.0-only", "MIT AND GPL-3.0-only", "MPL-2.0", "no licence"] {
            assert!(!accepted.accepts("library", licence), "{licence}");
        }
        assert!(accepted.accepts("tool", "MPL-2.0"));
    }
}
