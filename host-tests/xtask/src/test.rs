//! `cargo xtask test`: every check of the repository, one step after another.

use crate::arm;
use crate::boards;
use crate::book;
use crate::c;
use crate::cross;
use crate::examples;
use crate::firmware;
use crate::fuzz::CAMPAIGN;
use crate::growth;
use crate::package;
use crate::packages;
use crate::parallel;
use crate::rtl;
use crate::setup;
use crate::steps::{Failure, Outcome, Steps, cargo, command, root, run as run_command, target_dir};
use crate::view;
use std::path::PathBuf;

/// What is printed when they are not run, so that nobody takes them for passed.
const NOT_RUN: &str = "real data: NOT RUN, set STEREO_DATA to the folder that holds stereo/";

/// A step's name and what it does.
type NamedStep = (&'static str, fn() -> Outcome);

/// Steps that run one after another, beside other rows.
type Row = &'static [NamedStep];

// Much of a step is one compiler, one linker or one emulator at a time, so two rows of steps run beside each
// other. Those that build in the same folder stand in the same row; what takes longest comes first.

/// The tests build `stereo`, which the second half runs. The firmware, the C interface and the example share
/// folders.
const FIRST: &[Row] = &[
    &[("tests", tests)],
    &[
        ("programs", programs),
        ("C interface", c::run),
        ("firmware", firmware::check_sample),
        ("quickstart", || examples::QUICKSTART.run()),
    ],
];

/// What needs `stereo`, or the folder that the tests were built in.
const SECOND: &[Row] = &[
    &[
        ("clippy", clippy),
        ("documentation", documentation),
        ("README's commands", readme_commands),
        ("match on a core", || firmware::check_as_match(&stereo())),
    ],
    &[("live page", || view::sample(&stereo())), ("book", || book::sample(&stereo()))],
    &[("package", package::run), ("gates", rtl::sample)],
];

/// What is left to be checked before a release: more processors, boards and compilers.
const BEFORE_A_RELEASE: &[Row] = &[
    &[("boards", boards::run)],
    &[
        ("kernels on Arm", arm::run),
        ("kernels on WebAssembly", view::kernels),
        ("cross checks", cross::sample),
        ("stated rust-version", rust_version),
    ],
    &[
        ("stages and profiles on cores", firmware::check_stages_and_profiles),
        ("growth", growth::sample),
        ("async", examples::executors),
        ("lints on targets", lints_on_targets),
        ("every method in C", c::every_method),
    ],
];

/// Runs the steps that every change passes, and with `all` those before a release; or those of either with
/// words in their names.
pub fn run(only: Option<String>, all: bool) -> Outcome {
    let data = real_data()?;
    if data.is_none() {
        println!("{NOT_RUN}");
    }
    let is_whole = all || only.is_some();
    let mut steps = Steps::new(only);
    steps.step("set up", set_up)?;
    steps.step("format", format)?;
    side_by_side(&mut steps, FIRST)?;
    side_by_side(&mut steps, SECOND)?;
    if is_whole {
        steps.step("compilers before a release", set_up_before_a_release)?;
        side_by_side(&mut steps, BEFORE_A_RELEASE)?;
    }
    steps.summary()?;
    if !is_whole {
        let left: Vec<_> = BEFORE_A_RELEASE.iter().copied().flatten().map(|(name, _)| *name).collect();
        println!("before a release: NOT RUN, give --all: {}", left.join(", "));
    }
    if data.is_none() {
        println!("{NOT_RUN}");
    }
    Ok(())
}

/// Runs rows of steps, two beside each other, each step as a program of its own whose output is printed when
/// it is done; or one after another those that were asked for.
fn side_by_side(steps: &mut Steps, rows: &[Row]) -> Outcome {
    if steps.is_part() {
        return rows.iter().copied().flatten().try_for_each(|(name, work)| steps.step(name, work));
    }
    let xtask = std::env::current_exe().map_err(|e| Failure::new(format!("this program: {e}")))?;
    let one = |name: &str| {
        let output = command(&xtask, &["test", "--step", name]).output();
        let output = output.map_err(|e| Failure::new(format!("{}: {e}", xtask.display())))?;
        let text = [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
        print!("{}", text.concat());
        let failed = || Failure::new(text[1].lines().last().unwrap_or(name));
        if output.status.success() { Ok(()) } else { Err(failed()) }
    };
    let names: Vec<_> =
        rows.iter().map(|row| row.iter().map(|(name, _)| *name).collect::<Vec<_>>()).collect();
    let all = names.iter().map(|row| row.join(", ")).collect::<Vec<_>>().join(" beside ");
    steps.step(&all, || parallel::work(names, |row| row.into_iter().try_for_each(one)).map(|_| ()))
}

/// The folder of real stereo pairs: has to be there in CI, and where it is named.
fn real_data() -> Outcome<Option<PathBuf>> {
    let in_ci = std::env::var("CI").is_ok_and(|ci| !matches!(ci.as_str(), "" | "0" | "false"));
    let Some(folder) = std::env::var_os("STEREO_DATA").map(PathBuf::from) else {
        let needed =
            || Failure::new("CI is set and STEREO_DATA is not: it names the folder that holds stereo/");
        return if in_ci { Err(needed()) } else { Ok(None) };
    };
    if !folder.join("stereo").is_dir() {
        return Err(Failure::new(format!("STEREO_DATA: {} has no folder stereo/", folder.display())));
    }
    Ok(Some(folder))
}

/// Adds what compilers need.
fn set_up() -> Outcome {
    setup::toolchains()?;
    setup::targets(&view::TARGETS)
}

/// Adds what the steps before a release need, so that no two of them add something at once.
fn set_up_before_a_release() -> Outcome {
    setup::before_a_release()?;
    arm::set_up()
}

/// Adds the programs of all steps but those before a release.
fn programs() -> Outcome {
    packages::install(&[setup::C.as_slice(), &setup::GATES, &view::PROGRAMS].concat())
}

fn format() -> Outcome {
    run_cargo("fmt --all --check")?;
    run_command(&mut firmware::cargo("fmt --check"))?;
    run_cargo(&format!("fmt --check --manifest-path {CAMPAIGN}"))?;
    run_command(&mut c::cargo("fmt --check"))
}

fn clippy() -> Outcome {
    run_cargo("clippy --locked --workspace --all-targets --features stereopsis/defmt -- -D warnings")?;
    run_cargo(&format!(
        "clippy --locked --no-default-features --manifest-path {CAMPAIGN} --target-dir {} -- -D warnings",
        target_dir().display()
    ))
}

/// The code that kinds of processors have of their own.
fn lints_on_targets() -> Outcome {
    for (target, features) in [("thumbv7em-none-eabihf", "large"), ("riscv32imc-unknown-none-elf", "")] {
        let words =
            format!("clippy --locked --release --target {target} --features={features} -- -D warnings");
        run_command(&mut firmware::cargo(&words))?;
    }
    let mut vectors =
        firmware::cargo("clippy --locked --release --target thumbv8m.main-none-eabihf -- -D warnings");
    run_command(vectors.env("RUSTFLAGS", firmware::VECTORS))?;
    run_command(&mut c::cargo("clippy --locked --release --target thumbv7em-none-eabihf -- -D warnings"))?;
    view::clippy()
}

/// Cargo's words for tests. All steps that run some say the same, so that none builds the dependencies anew
/// with other features.
const TEST: &str = "test --locked --workspace";

/// All tests, then those that read real stereo pairs, but for the one that needs pairs that are not here.
fn tests() -> Outcome {
    run_cargo(TEST)?;
    let real = || run_cargo(&format!("{TEST} --test real -- --ignored --skip held_back_pairs"));
    real_data()?.map_or(Ok(()), |_| real())
}

/// The program `stereo`, as the step of the tests has built it.
fn stereo() -> PathBuf {
    root().join(target_dir()).join("debug/stereo").with_extension(std::env::consts::EXE_EXTENSION)
}

fn documentation() -> Outcome {
    // The core's private items too: its comments link to them. Then what a user reads, in the same place, of
    // the features that clippy has checked.
    let readers = "--workspace --features stereopsis/defmt";
    for words in ["-p stereopsis --features async,ffi --document-private-items", readers] {
        let mut docs = cargo(&["doc", "--locked", "--no-deps"]);
        run_command(docs.args(words.split_whitespace()).env("RUSTDOCFLAGS", "-D warnings"))?;
    }
    run_command(firmware::cargo("doc --locked --release --no-deps").env("RUSTDOCFLAGS", "-D warnings"))
}

/// After the tests, which have built this one.
fn readme_commands() -> Outcome {
    run_cargo(&format!("{TEST} --test repo -- --ignored --exact readme::commands_work_in_a_fresh_clone"))
}

/// The oldest compiler that the core says it builds with, in earnest.
fn rust_version() -> Outcome {
    setup::before_a_release()?;
    package::stated_rust_version(&["stereopsis"])
}

fn run_cargo(words: &str) -> Outcome {
    run_command(&mut cargo(&words.split_whitespace().collect::<Vec<_>>()))
}
