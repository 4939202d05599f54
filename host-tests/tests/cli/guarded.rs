//! Results take the place of regular files alone, and never of what is read.

use crate::support::{Bench, program, text};
use std::os::unix::fs::FileTypeExt;
use std::os::unix::net::UnixListener;
use std::path::Path;
use std::process::{Command, Output};

const MATCHES: &str = "x1,y1,x2,y2\n";

pub fn run(args: &[&str]) -> Output {
    program().args(args).output().expect("it starts")
}

pub fn path(bench: &Bench, name: &str) -> String {
    bench.path(name).display().to_string()
}

pub fn pipe(bench: &Bench, name: &str) -> String {
    let made = Command::new("mkfifo").arg(bench.path(name)).status().expect("mkfifo starts");
    assert!(made.success());
    path(bench, name)
}

/// Matches of a square that is seen from two places.
fn matches(bench: &Bench) -> String {
    let lines = (0..40).map(|i| {
        let (u, v, d) = (f64::from(i * 37 % 90), f64::from(i * 53 % 47), 3.0 + f64::from(i * 29 % 17));
        format!("{u},{v},{},{v}\n", u - d)
    });
    let text: String = std::iter::once(MATCHES.to_owned()).chain(lines).collect();
    bench.put("matches.csv", text.as_bytes()).display().to_string()
}

#[test]
fn what_is_no_regular_file_is_not_replaced() {
    let bench = Bench::new();
    let (left, right, matches) = (path(&bench, "left.png"), path(&bench, "right.png"), matches(&bench));
    let fifo = pipe(&bench, "fifo");
    let socket = path(&bench, "socket");
    let _listener = UnixListener::bind(&socket).expect("a socket");
    let link = path(&bench, "link");
    std::os::unix::fs::symlink(&fifo, &link).expect("a link");
    for place in [&fifo, &socket, &link] {
        for args in [
            &["fundamental", "--matches", &matches, "--out", place][..],
            &["record", "--left", &left, "--right", &right, "--out", place],
            &["features", "--left", &left, "--right", &right, "--out", place],
        ] {
            let run = run(args);
            let said = text(&run.stderr);
            assert_eq!(run.status.code(), Some(1), "{args:?}");
            assert!(said.contains(&format!("{place}: is no regular file")), "{args:?}: {said}");
            assert_eq!(said.lines().count(), 1, "{said}");
        }
    }
    let kind = |name: &str| std::fs::symlink_metadata(bench.path(name)).expect("it stands").file_type();
    assert!(kind("fifo").is_fifo() && kind("socket").is_socket() && kind("link").is_symlink());
    // One of several results of a folder.
    std::fs::create_dir(bench.path("out")).expect("a folder");
    pipe(&bench, "out/flags.png");
    let run = run(&bench.arguments(&[]).iter().map(String::as_str).collect::<Vec<_>>());
    assert!(text(&run.stderr).contains("flags.png: is no regular file"), "{}", text(&run.stderr));
    assert!(kind("out/flags.png").is_fifo());
}

/// A link to a file is replaced; what it points to stays.
#[test]
fn a_link_is_replaced_and_its_file_stays() {
    let bench = Bench::new();
    let (matches, kept) = (matches(&bench), bench.put("kept", b"kept"));
    for target in [kept.as_path(), Path::new("nothing")] {
        let link = path(&bench, "link");
        let _ = std::fs::remove_file(&link);
        std::os::unix::fs::symlink(target, &link).expect("a link");
        let run = run(&["fundamental", "--matches", &matches, "--out", &link, "--threshold", "2"]);
        assert!(run.status.success(), "{}", text(&run.stderr));
        assert!(std::fs::symlink_metadata(&link).expect("a result").is_file());
        assert_eq!(std::fs::read(&kept).expect("it stays"), b"kept");
    }
}

#[test]
fn a_result_is_no_input_of_its_run() {
    let bench = Bench::new();
    let (left, right, matches) = (path(&bench, "left.png"), path(&bench, "right.png"), matches(&bench));
    std::fs::create_dir(bench.path("out")).expect("a folder");
    std::fs::copy(&left, bench.path("out/disparity.png")).expect("a copy");
    let inside = path(&bench, "out/disparity.png");
    std::os::unix::fs::symlink(&matches, bench.path("alias.csv")).expect("a link");
    let before = bench.everything();
    let around = format!("{}/out/../left.png", bench.path("").display());
    let (alias, out) = (path(&bench, "alias.csv"), path(&bench, "out"));
    for (args, named) in [
        (&["features", "--left", &left, "--right", &right, "--out", &left][..], "left.png"),
        (&["features", "--left", &left, "--right", &right, "--out", &around], "left.png"),
        (&["fundamental", "--matches", &matches, "--out", &matches], "matches.csv"),
        (&["fundamental", "--matches", &alias, "--out", &matches], "matches.csv"),
        (&["fundamental", "--matches", &alias, "--out", &alias], "alias.csv"),
        (
            &["match", "--left", &inside, "--right", &right, "--disparities", "16", "--out", &out],
            "disparity.png",
        ),
    ] {
        let run = run(args);
        let said = text(&run.stderr);
        assert_eq!(run.status.code(), Some(1), "{args:?}");
        assert!(said.contains(named) && said.contains("is an input of this run"), "{args:?}: {said}");
        assert!(before == bench.everything(), "{args:?}");
    }
}
