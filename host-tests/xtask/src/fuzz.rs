//! Campaigns of fuzzing: libFuzzer looks for bytes that break a property of `host-tests/fuzz`.
//!
//! The program is built with the coverage that libFuzzer is led by, the address sanitizer, debug assertions
//! and overflow checks. The stable compiler's flags for the first are stable; the sanitizer's is not, and is
//! unlocked by `RUSTC_BOOTSTRAP`. The crate itself is the one that ships.

use crate::parallel;
use crate::setup;
use crate::steps::{Failure, Outcome, cargo, command, root, run as run_command, target_dir};
use clap::Args;
use std::fs;
use std::path::{Path, PathBuf};
use stereopsis_fuzz::TARGETS;

/// What libFuzzer is led by, and what looks at memory.
const FLAGS: &str = "-Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
    -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
    -Cllvm-args=-sanitizer-coverage-trace-compares -Zsanitizer=address";
/// The program of all targets.
pub const CAMPAIGN: &str = "host-tests/fuzz/campaign/Cargo.toml";
/// The longest input, bytes; the seconds after which a case hangs; the most memory of a program, MB.
const MOST_BYTES: u32 = 4096;
const HANGS_S: u32 = 10;
const MOST_MB: u32 = 2048;

/// What is run.
#[derive(Args)]
pub struct Arguments {
    /// The targets, by default all of them.
    #[arg(value_name = "TARGET")]
    targets: Vec<String>,
    /// Minutes for each target; two run at a time.
    #[arg(long, value_name = "N", default_value_t = 1.0)]
    minutes: f64,
    /// Runs this input once, of one target, in place of a campaign.
    #[arg(long, value_name = "FILE")]
    input: Option<PathBuf>,
}

/// Runs the campaign, or an input.
pub fn run(arguments: &Arguments) -> Outcome {
    let all: Vec<_> = TARGETS.iter().map(|target| target.name).collect();
    if let Some(unknown) = arguments.targets.iter().find(|name| !all.contains(&name.as_str())) {
        return Err(Failure::new(format!("{unknown} is no target; the targets are {}", all.join(", "))));
    }
    if !(arguments.minutes > 0.0 && arguments.minutes < 1e6) {
        return Err(Failure::new("--minutes: give a number over 0"));
    }
    let of = |name: &&str| arguments.targets.is_empty() || arguments.targets.iter().any(|t| t == *name);
    let targets: Vec<_> = all.into_iter().filter(of).collect();
    let program = build()?;
    if let Some(input) = &arguments.input {
        let [target] = targets[..] else {
            return Err(Failure::new("--input: name the one target it is for"));
        };
        // From where the command was typed, not from the root.
        let input = std::path::absolute(input).map_err(|e| Failure::new(format!("--input: {e}")))?;
        let mut once = command(&program, &[&input.to_string_lossy()]);
        return run_command(once.env("STEREOPSIS_FUZZ", target));
    }
    let seconds = (arguments.minutes * 60.0).ceil() as u32;
    println!("target          inputs    per s  cover  corpus");
    parallel::work(targets, |target| campaign(&program, target, seconds)).map(|_| ())
}

/// Builds the program of all targets.
fn build() -> Outcome<PathBuf> {
    let host = setup::host()?;
    let folder = root().join(target_dir()).join("fuzz");
    // A target beside the flags, so that build scripts and macros are built without them.
    let mut build =
        cargo(&["build", "--locked", "--release", "--manifest-path", CAMPAIGN, "--target", &host]);
    build.env("CARGO_TARGET_DIR", &folder).env("RUSTFLAGS", FLAGS).env("RUSTC_BOOTSTRAP", "1");
    run_command(&mut build)?;
    Ok(folder.join(host).join("release/campaign").with_extension(std::env::consts::EXE_EXTENSION))
}

/// Runs a target for some seconds, from its seeds and from what earlier campaigns kept.
fn campaign(program: &Path, target: &str, seconds: u32) -> Outcome {
    let folder = root().join(target_dir()).join("fuzz");
    let (corpus, found) = (folder.join("corpus").join(target), folder.join("found"));
    for folder in [&corpus, &found] {
        fs::create_dir_all(folder).map_err(|e| Failure::new(format!("{}: {e}", folder.display())))?;
    }
    let mut fuzz = command(program, &[]);
    fuzz.env("STEREOPSIS_FUZZ", target)
        .arg(format!("-max_total_time={seconds}"))
        .arg(format!("-max_len={MOST_BYTES}"))
        .arg(format!("-timeout={HANGS_S}"))
        .arg(format!("-rss_limit_mb={MOST_MB}"))
        .args(["-print_final_stats=1", "-seed=1"])
        .arg(format!("-artifact_prefix={}/{target}-", found.display()))
        .arg(&corpus);
    let seeds = root().join("host-tests/fuzz/seeds").join(target);
    if seeds.is_dir() {
        fuzz.arg(seeds);
    }
    let output = fuzz.output().map_err(|e| Failure::new(format!("{}: {e}", program.display())))?;
    let log = String::from_utf8_lossy(&output.stderr);
    if !output.status.success() {
        // What broke stands before libFuzzer's own report, and the bytes are in a file that it names.
        let said = |words: &str| log.lines().rfind(|line| line.contains(words)).unwrap_or_default();
        let broke = log.lines().skip_while(|line| !line.contains("panicked at")).nth(1).unwrap_or_default();
        let file = said("Test unit written to").rsplit(' ').next().unwrap_or_default();
        return Err(Failure::new(format!(
            "{target}: {broke} {}; again: cargo xtask fuzz {target} --input {file}",
            said("ERROR:")
        )));
    }
    let last = log.lines().rfind(|line| line.contains("cov:")).unwrap_or_default();
    let number = |name: &str, line: &str| -> String {
        let mut words = line.split_whitespace().skip_while(|word| *word != name);
        words.nth(1).unwrap_or("?").to_owned()
    };
    let of = |name: &str| number(name, log.lines().find(|l| l.starts_with(name)).unwrap_or_default());
    let [inputs, rate] = ["stat::number_of_executed_units:", "stat::average_exec_per_sec:"].map(of);
    let (cover, kept) = (number("cov:", last), number("corp:", last));
    println!("{target:14} {inputs:>8} {rate:>8} {cover:>6}  {kept}");
    Ok(())
}
