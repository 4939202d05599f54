//! `stereo view`: the page as a file, and what is refused. The step "live page" of `cargo xtask test` opens
//! it.

use super::support::{Bench, HEIGHT, WIDTH, stereo, text};
use serde_json::{Value, json};
use std::fs;
use std::net::TcpListener;
use std::process::Command;

/// The smallest module.
const MODULE: &[u8] = b"\0asm\x01\0\0\0";

#[test]
fn the_page_has_the_pair_and_the_cameras_in_it() {
    let bench = Bench::new();
    let [left, right, module, out] =
        ["left.png", "right.png", "m.wasm", "page"].map(|name| bench.path(name).display().to_string());
    bench.put("m.wasm", MODULE);
    bench.put(
        "P.txt",
        b"P0: 50.1 0 48.25 0 0 50.1 24.6 0 0 0 1 0\nP1: 50.1 0 51.5 -5.01 0 50.1 24.6 0 0 0 1 0\n",
    );
    let calib = bench.path("P.txt").display().to_string();
    let words = ["view", "--left", &left, "--right", &right, "--calib", &calib, "--disparities", "40"];
    let run = stereo(words.into_iter().chain(["--module", &module, "--out", &out, "--write-only"]));
    assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
    let page = fs::read_to_string(bench.path("page/index.html")).expect("the page");
    let line = |begin: &str| page.lines().find_map(|line| line.strip_prefix(begin)).expect("a line");
    assert_eq!(line("const MODULE = "), "\"AGFzbQEAAAA=\";");
    let data: Value = serde_json::from_str(line("const DATA = ").trim_end_matches(';')).expect("JSON");
    let given = &data["given"];
    assert_eq!((&given["left"]["name"], &given["disparities"]), (&"left.png".into(), &32.into()));
    // Without digits that the file does not have.
    let rig =
        json!({ "focal_px": 50.1, "baseline_mm": 100.0, "offset_px": 3.25, "centre_px": [48.25, 24.6] });
    assert_eq!(given["rig"], rig);
    assert_eq!(data["scene"]["disparities"], 64);
    assert!(WIDTH >= 40 && HEIGHT > 0 && !page.contains("/*S"), "styles and scripts are in their places");
}

#[test]
fn what_cannot_be_shown_is_refused() {
    let bench = Bench::new();
    let [left, out] = ["left.png", "page"].map(|name| bench.path(name).display().to_string());
    let module = bench.put("m.wasm", MODULE).display().to_string();
    let wrong = bench.put("wrong.wasm", b"no module").display().to_string();
    bench
        .refused(&["view", "--write-only", "--out", &out, "--module", &wrong], "is no module of WebAssembly");
    bench.refused(&["view", "--write-only", "--out", &out, "--module", "nothing.wasm"], "nothing.wasm");
    bench.refused(&["view", "--write-only", "--out", &out, "--module", &module, "--left", &left], "--right");
    bench.refused(
        &["view", "--write-only", "--out", &out, "--module", &module, "--left", &left, "--right", "no.png"],
        "no.png",
    );
    let taken = TcpListener::bind(("127.0.0.1", 0)).expect("a free port");
    let port = taken.local_addr().expect("its address").port().to_string();
    bench.refused(&["view", "--port", &port, "--out", &out, "--module", &module], "--port");
    for bad in ["-1", "65536", "x"] {
        bench.refused(
            &["view", "--port", bad, "--out", &out, "--module", &module],
            "for '--port <PORT>': a whole number from 0 to 65535 is needed",
        );
    }
}

/// A program without the module beside it says what builds it.
#[test]
fn without_the_module_it_says_what_to_run() {
    let bench = Bench::new();
    let alone = bench.path("alone").with_extension(std::env::consts::EXE_EXTENSION);
    fs::copy(env!("CARGO_BIN_EXE_stereo"), &alone).expect("a copy");
    let run = Command::new(alone).args(["view", "--write-only"]).output().expect("it starts");
    bench.is_refusal(&run, "run `cargo xtask view`", "without the module");
}
