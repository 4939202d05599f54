//! What the program says of itself: its commands, completions, manual, and this machine.

use super::support::{Bench, names, program, stereo, text};
use serde_json::Value;
use std::fs;
use stereopsis::matching::Kernel;

#[test]
fn one_who_gives_no_command_is_told_five() {
    let run = stereo::<&str>([]);
    assert_eq!(run.status.code(), Some(2));
    assert!(run.stdout.is_empty());
    let told = text(&run.stderr);
    assert!(told.starts_with("stereo: a command is missing"), "{told}");
    let commands: Vec<_> = told.lines().filter_map(|line| line.strip_prefix("  stereo ")).collect();
    assert_eq!(commands.len(), 5, "{told}");
    for command in commands {
        let mut words = command.split_whitespace();
        let name = words.next().expect("a command");
        let help = text(&stereo([name, "--help"]).stdout);
        for option in words.filter(|word| word.starts_with("--")) {
            assert!(help.contains(&format!("{option} ")), "{name} has no {option}");
        }
    }
}

#[test]
fn completions_name_the_commands() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let run = stereo(["completions", shell]);
        assert!(run.status.success() && run.stderr.is_empty(), "{shell}: {}", text(&run.stderr));
        let script = text(&run.stdout);
        for word in ["demo", "match", "plan", "disparities"] {
            assert!(script.contains(word), "{shell}: no {word}");
        }
    }
    Bench::new().refused(&["completions", "cobol"], "possible values: bash");
}

#[test]
fn every_command_has_a_page_of_the_manual() {
    let bench = Bench::new();
    let out = bench.path("man");
    let run = stereo(["man", "--out", &out.display().to_string()]);
    assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
    let pages = names(&out);
    for page in ["stereo.1", "stereo-match.1", "stereo-eval.1", "stereo-calib-check.1", "stereo-man.1"] {
        assert!(pages.iter().any(|name| name == page), "{page} in {pages:?}");
    }
    let page = fs::read_to_string(out.join("stereo-match.1")).expect("a page");
    assert!(page.contains(".TH stereo-match 1") && page.contains("disparities"), "{page}");
    let file = bench.put("file", b"").display().to_string();
    bench.refused(&["man", "--out", &file], &file);
}

#[test]
fn the_doctor_says_what_this_machine_has() {
    let run = stereo(["doctor", "--json"]);
    assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
    let found: Value = serde_json::from_slice(&run.stdout).expect("JSON");
    let kernels: Vec<_> = Kernel::available().map(Kernel::name).collect();
    assert_eq!(found["kernels"], serde_json::json!(kernels));
    assert_eq!(found["kernel"], Kernel::detect().name());
    assert_eq!(found["version"], env!("CARGO_PKG_VERSION"));
    assert!(found["threads"].as_u64().is_some_and(|threads| threads > 0));
    let first = kernels[0];
    let by_variable = program().arg("doctor").env("STEREO_KERNEL", first).output().expect("it starts");
    let told = text(&by_variable.stdout);
    assert!(told.contains(&format!("chosen       {first}: STEREO_KERNEL names it")), "{told}");
    let bad = program().arg("doctor").env("STEREO_KERNEL", "abacus").output().expect("it starts");
    Bench::new().is_refusal(&bad, "STEREO_KERNEL", "a kernel that is none");
}
