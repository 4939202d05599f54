//! `cargo xtask profile`: where the nanoseconds of a desktop's frame go, by stage.
//!
//! `perf` says four thousand times a second where the program is; its debug information says in which files
//! that is, with all that is inlined there. Each machine has its own figures, so no test holds the table.

use crate::firmware::tables::{Part, splice};
use crate::setup;
use crate::steps::{Failure, Outcome, cargo, command, output_of, root, run as run_command, target_dir};
use clap::Args;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use stereopsis_host::run::MethodName;

/// The options of `profile`.
#[derive(Args)]
pub struct Arguments {
    /// Writes the table into docs/performance.md.
    #[arg(long)]
    readme: bool,
}

/// The part of docs/performance.md.
const PART: Part = Part { name: "profile", command: "cargo xtask profile --readme" };
const METHODS: [MethodName; 3] = [MethodName::Fast, MethodName::Block, MethodName::Sgm];
const DISPARITIES: &str = "64";
/// Frames of the built-in scene, some seconds, and samples a second.
const FRAMES: &str = "400";
const SAMPLES: &str = "4000";

/// The stages, with words of which one is in the paths of their files below src/matching and src/imaging, and
/// in no path of a stage before.
const STAGES: [(&str, &[&str]); 8] = [
    ("census, features", &["census", "features", "row_codes"]),
    ("cost", &["columns", "cost", "candidates"]),
    ("aggregation, selection", &["windows", "sgm/", "method/"]),
    ("left-right, sub-pixel", &["consistency", "left_right", "subpixel"]),
    ("fattening, repeats", &["fattening", "edges", "open", "repeats"]),
    ("smoothing", &["smooth", "vertical", "median"]),
    ("speckle", &["speckle"]),
    ("fill", &["fill"]),
];
/// Files that several stages have in them.
const SHARED: [&str; 7] = ["memory/", "row.rs", "x86.rs", "avx", "sse2", "registers", "lanes"];

/// Where samples fell: in each stage, and in the rest of the library.
#[derive(Default, PartialEq, Debug)]
struct Samples {
    stages: [u64; STAGES.len()],
    rest: u64,
}

/// Builds, measures, prints or writes.
pub fn run(arguments: &Arguments) -> Outcome {
    for (program, package) in [("perf", "linux-perf"), ("addr2line", "binutils")] {
        let missing = |_| Failure::new(format!("{program} is needed: apt-get install {package}"));
        output_of(&mut command(program, &["--version"])).map_err(missing)?;
    }
    let stereo = build()?;
    let folder = tempfile::tempdir().map_err(|e| Failure::new(e.to_string()))?;
    let scene = folder.path().join("scene");
    output_of(command(&stereo, &["demo", "--out"]).arg(&scene))?;
    let names = STAGES.map(|(name, _)| name).join(" | ");
    let mut table = format!("| method | kernel | ns a pixel | {names} | the rest |\n| --- | --- |");
    table += &" ---: |".repeat(STAGES.len() + 2);
    table += "\n";
    for method in METHODS {
        table += &measure(&stereo, &scene, folder.path(), method)?;
    }
    let _ = writeln!(table, "\nProcessor: {}.", processor()?);
    println!("{table}");
    if arguments.readme { splice(&PART, &table) } else { Ok(()) }
}

/// The program with what says which file an instruction comes from, at addresses that do not move.
fn build() -> Outcome<PathBuf> {
    let host = setup::host()?;
    let folder = root().join(target_dir()).join("profile");
    let mut build = cargo(&["build", "--locked", "--release", "-p", "stereopsis-host", "--bin", "stereo"]);
    build.args(["--target", &host]).env("CARGO_TARGET_DIR", &folder);
    build.env("CARGO_PROFILE_RELEASE_DEBUG", "line-tables-only");
    run_command(build.env("RUSTFLAGS", "-C relocation-model=static"))?;
    Ok(folder.join(host).join("release/stereo"))
}

/// A line of the table.
fn measure(stereo: &Path, scene: &Path, scratch: &Path, method: MethodName) -> Outcome<String> {
    let data = scratch.join("perf.data");
    let name = method.to_string();
    let mut record = command("perf", &["record", "-q", "-e", "cpu-clock", "-F", SAMPLES, "-o"]);
    record.arg(&data).arg("--").arg(stereo).arg("bench");
    record.arg("--left").arg(scene.join("left.png")).arg("--right").arg(scene.join("right.png"));
    record.args(["--disparities", DISPARITIES, "--method", &name, "--repeat", FRAMES]);
    let bench: Bench = serde_json::from_str(&output_of(&mut record)?)
        .map_err(|e| Failure::new(format!("stereo bench: {e}")))?;
    let mut places = BTreeMap::<u64, u64>::new();
    for line in output_of(command("perf", &["script", "-F", "ip", "-i"]).arg(&data))?.lines() {
        if let Ok(place) = u64::from_str_radix(line.trim(), 16) {
            *places.entry(place).or_default() += 1;
        }
    }
    let list: String = places.keys().map(|place| format!("{place:#x}\n")).collect();
    let asked = scratch.join("places");
    fs::write(&asked, list).map_err(|e| Failure::new(e.to_string()))?;
    let mut ask = command("addr2line", &["-a", "-i", "-e"]);
    ask.arg(stereo).arg(format!("@{}", asked.display()));
    let samples = sorted(&places, &output_of(&mut ask)?);
    let all: u64 = samples.stages.iter().sum::<u64>() + samples.rest;
    let pixels = f64::from(bench.width) * f64::from(bench.height);
    let whole = bench.frame_ms.iter().copied().fold(f64::INFINITY, f64::min) * 1e6 / pixels;
    let mut line = format!("| `{name}` | {} | {whole:.2} |", bench.kernel);
    for part in samples.stages.into_iter().chain([samples.rest]) {
        let _ = write!(line, " {:.2} |", whole * part as f64 / all.max(1) as f64);
    }
    Ok(line + "\n")
}

/// What `stereo bench` prints.
#[derive(serde::Deserialize)]
struct Bench {
    frame_ms: Vec<f64>,
    kernel: String,
    width: u32,
    height: u32,
}

/// Sorts samples by stage. `files` has the address of each place and below it the files of what is inlined
/// there, the innermost first: the first one that is a stage's own counts. What is in no file of the library
/// reads images or starts, and is left out; what is in none at all is a library's or the system's.
fn sorted(places: &BTreeMap<u64, u64>, files: &str) -> Samples {
    let mut samples = Samples::default();
    let mut lines = files.lines().peekable();
    while let Some(line) = lines.next() {
        let place = line.strip_prefix("0x").and_then(|place| u64::from_str_radix(place, 16).ok());
        let count = place.and_then(|place| places.get(&place)).copied().unwrap_or(0);
        let (mut found, mut is_own, mut is_known) = (None, false, false);
        while let Some(file) = lines.next_if(|line| !line.starts_with("0x")) {
            is_known |= !file.starts_with("??");
            is_own |= ["matching", "imaging", "pipeline"].iter().any(|of| below(of, file).is_some());
            found = found.or_else(|| stage(file));
        }
        match found {
            Some(stage) => samples.stages[stage] += count,
            None if is_own || !is_known => samples.rest += count,
            None => {}
        }
    }
    samples
}

/// The stage that a file belongs to alone.
fn stage(file: &str) -> Option<usize> {
    let path = below("matching", file).or_else(|| below("imaging", file))?;
    let is_shared = SHARED.iter().any(|word| path.contains(word));
    let stage = || STAGES.iter().position(|(_, words)| words.iter().any(|word| path.contains(word)));
    if is_shared { None } else { stage() }
}

/// The path of a file of a module, below it.
fn below<'a>(module: &str, file: &'a str) -> Option<&'a str> {
    file.split_once(&format!("src/{module}/")).map(|(_, path)| path)
}

/// The name of this machine's processor.
fn processor() -> Outcome<String> {
    let text =
        fs::read_to_string("/proc/cpuinfo").map_err(|e| Failure::new(format!("/proc/cpuinfo: {e}")))?;
    let name = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    Ok(name.map_or("unknown", |(_, name)| name).to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_belong_to_the_innermost_stage() {
        let places = BTreeMap::from([(0x10, 5), (0x20, 3), (0x30, 2), (0x40, 7), (0x50, 1)]);
        let files = "0x0000000000000010\n/lib/src/num.rs:3\n/x/src/matching/memory/winners.rs:1\n\
                     /x/src/matching/backend/portable/sgm/passes/cost.rs:9\n/x/src/matching/method/sgm.rs:2\n\
                     0x0000000000000020\n/x/src/matching/backend/simd/speckle.rs:4\n\
                     0x0000000000000030\n/x/src/pipeline/rows.rs:7\n0x0000000000000040\n/png/filter.rs:1\n\
                     0x0000000000000050\n??:0\n";
        let mut expected = Samples { rest: 3, ..Samples::default() };
        (expected.stages[1], expected.stages[6]) = (5, 3);
        assert_eq!(sorted(&places, files), expected);
    }
}
