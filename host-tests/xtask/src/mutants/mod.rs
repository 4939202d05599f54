//! `cargo xtask mutants`: whether the tests see it when the code does something else.
//!
//! cargo-mutants lists the mutants: another operator, an arm or a guard that is gone, a function that returns
//! something simple. They are woven ([`weave`]) into a copy of the tree in `target/mutants`, whose test
//! programs are built once ([`tree`]) and run once for each mutant ([`judge`]), until a test fails.
//!
//! Left out: files that this machine does not compile, and code that runs while the crate is compiled. What
//! no test sees is printed, to be read: some mutants do what the code does.

mod judge;
mod tree;
mod weave;

use crate::parallel;
use crate::steps::{Failure, Outcome, command, output_of};
use clap::Args;
use judge::Verdict;
use std::collections::BTreeSet;
use std::str::FromStr;
use weave::Mutant;

/// A part of the crate, and the tests that are to see its mutants.
struct Module {
    name: &'static str,
    /// Where its files are, and words in the paths of those that this machine does not compile.
    folder: &'static str,
    but: &'static [&'static str],
    /// Those that see most soonest first.
    tests: &'static [Test],
}

/// A test program.
#[derive(PartialEq, Eq)]
struct Test {
    package: &'static str,
    name: &'static str,
    /// Words in the names of the tests that are run; none for all.
    words: &'static [&'static str],
}

impl Test {
    /// The name of a package's own tests, beside its code.
    const OWN: &'static str = "";

    const fn new(package: &'static str, name: &'static str, words: &'static [&'static str]) -> Self {
        Self { package, name, words }
    }
}

const MODULES: [Module; 4] = [
    Module {
        name: "matching",
        folder: "src/matching/",
        // Nor those that the kernels of other processors alone call.
        but: &["/armv7em/", "/mve/", "/neon.rs", "/simd128.rs", "/no_x86.rs", "/plain.rs"],
        // Where the twins see nothing, tests of how good the answers are see nothing either.
        tests: &[
            Test::new("stereopsis", Test::OWN, &["matching"]),
            Test::new("stereopsis-model", "kernels", &[]),
            Test::new("stereopsis-host", "matching", &["traced", "dump", "nothing_else_changes"]),
            Test::new("stereopsis-host", "pipeline", &["winners", "mapped", "unsure"]),
        ],
    },
    Module {
        name: "pipeline",
        folder: "src/pipeline/",
        but: &[],
        tests: &[
            Test::new(
                "stereopsis-host",
                "pipeline",
                &["push", "due", "numbers", "bands", "mapped", "winners", "waited"],
            ),
            Test::new("stereopsis-host", "pipeline", &["faults", "unsure"]),
            Test::new("stereopsis-host", "matching", &["threads"]),
            Test::new("stereopsis-model", "kernels", &["frames", "external", "moved"]),
        ],
    },
    Module {
        name: "imaging",
        folder: "src/imaging/",
        but: &[],
        tests: &[
            Test::new("stereopsis", Test::OWN, &["imaging"]),
            Test::new("stereopsis-host", "camera", &["formats"]),
            Test::new("stereopsis-host", "imaging", &[]),
            Test::new("stereopsis-model", "kernels", &["list", "pictures"]),
        ],
    },
    Module {
        name: "robust",
        folder: "src/geometry/robust/",
        but: &[],
        tests: &[
            Test::new("stereopsis", Test::OWN, &["geometry::robust"]),
            Test::new("stereopsis-host", "geometry", &[]),
        ],
    },
];

/// What is run.
#[derive(Args)]
pub struct Arguments {
    /// The parts of the crate, by default all of them: matching, pipeline, imaging, robust.
    #[arg(value_name = "MODULE")]
    modules: Vec<String>,
    /// Every N-th mutant alone, from the K-th on; K counts from 0.
    #[arg(long, value_name = "K/N")]
    shard: Option<Shard>,
}

/// Weaves, builds, runs, and prints what no test saw and the share of what one saw.
pub fn run(arguments: &Arguments) -> Outcome {
    let names = MODULES.map(|module| module.name);
    if let Some(unknown) = arguments.modules.iter().find(|name| !names.contains(&name.as_str())) {
        return Err(Failure::new(format!("{unknown}: the modules are {}", names.join(", "))));
    }
    if output_of(&mut command("cargo", &["mutants", "--version"])).is_err() {
        return Err(Failure::new("cargo-mutants lists the mutants: cargo install cargo-mutants --locked"));
    }
    let of =
        |module: &&Module| arguments.modules.is_empty() || arguments.modules.iter().any(|m| m == module.name);
    let modules: Vec<_> = MODULES.iter().filter(of).collect();
    let all = list()?;
    let lists: Vec<_> = modules.iter().map(|module| module.mutants(&all, arguments.shard)).collect();
    let mutants = lists.concat();
    let tests: Vec<_> = modules.iter().flat_map(|module| module.tests).collect();
    let tree = tree::build(&mutants, &tests)?;
    let (mut lines, mut first) = (Vec::new(), 0);
    for (module, list) in modules.iter().zip(&lists) {
        let numbers = first..first + list.len() as u32;
        first = numbers.end;
        let programs = module.tests.iter().map(|test| tree.program(test)).collect::<Outcome<Vec<_>>>()?;
        let limit = judge::limit(&programs)?;
        let of = |of: &BTreeSet<u32>| of.iter().copied().filter(|n| numbers.contains(n)).collect::<Vec<_>>();
        let verdicts = parallel::work(of(&tree.woven), |number| {
            let verdict = judge::judge(&programs, number, limit)?;
            if verdict == Verdict::Missed {
                println!("missed: {}", mutants[number as usize].name);
            }
            Ok(verdict)
        })?;
        let count = |which| verdicts.iter().filter(|verdict| **verdict == which).count();
        let [caught, ended, missed] = [Verdict::Caught, Verdict::Ended, Verdict::Missed].map(count);
        lines.push(format!(
            "{:10} {:7} {:8} {:9} {caught:6} {ended:5} {missed:6}  {:.1} %",
            module.name,
            list.len(),
            of(&tree.refused).len(),
            of(&tree.left_out).len(),
            100.0 * (caught + ended) as f64 / verdicts.len().max(1) as f64
        ));
    }
    println!("module     mutants no code not woven caught ended missed  seen");
    lines.iter().for_each(|line| println!("{line}"));
    Ok(())
}

/// All mutants of the crate, in the order of the source.
fn list() -> Outcome<Vec<Mutant>> {
    let text = output_of(&mut command("cargo", &["mutants", "--list", "--json", "--package", "stereopsis"]))?;
    serde_json::from_str(&text).map_err(|e| Failure::new(format!("cargo mutants --list --json: {e}")))
}

impl Module {
    /// The module's own among all mutants, or its share of them.
    fn mutants(&self, all: &[Mutant], shard: Option<Shard>) -> Vec<Mutant> {
        let is_own = |mutant: &&Mutant| {
            mutant.file.starts_with(self.folder) && !self.but.iter().any(|word| mutant.file.contains(word))
        };
        let Shard { first, every } = shard.unwrap_or(Shard { first: 0, every: 1 });
        all.iter().filter(is_own).skip(first).step_by(every).cloned().collect()
    }
}

/// Every so many mutants, from one on.
#[derive(Clone, Copy)]
struct Shard {
    first: usize,
    every: usize,
}

impl FromStr for Shard {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let numbers = text.split_once('/').and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
        match numbers {
            Some((first, every)) if first < every => Ok(Self { first, every }),
            _ => Err("give K/N, with K from 0 to N - 1"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_are_parts() {
        assert!("3/4".parse::<Shard>().is_ok_and(|shard| (shard.first, shard.every) == (3, 4)));
        assert!(["4/4", "1", "a/b", "-1/3"].iter().all(|text| text.parse::<Shard>().is_err()));
    }
}
