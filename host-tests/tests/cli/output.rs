//! Results appear together or not at all.

use super::support::{Bench, HEIGHT, WIDTH, calibration, names, program, stereo, text};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

const PLAIN: [&str; 7] = [
    "confidence.png",
    "disparity.pfm",
    "disparity.png",
    "disparity_colour.png",
    "flags.png",
    "report.html",
    "summary.json",
];

#[test]
fn a_folder_is_made_with_its_parents_and_holds_the_results_alone() {
    let bench = Bench::new();
    let out = bench.path("new/deep/out");
    bench.matched(&[("--out", &out.display().to_string())]);
    assert_eq!(names(&out), PLAIN);
}

#[test]
fn the_results_replace_those_of_an_earlier_run_and_nothing_else() {
    let bench = Bench::new();
    let calib = bench.put("calib.txt", calibration(WIDTH, HEIGHT).as_bytes()).display().to_string();
    bench.matched(&[("--calib", &calib)]);
    bench.put("out/notes.txt", b"mine");
    let out = bench.path("out");
    assert_eq!(names(&out).len(), PLAIN.len() + 4);
    // Depths of another run beside these disparities would mislead.
    bench.matched(&[]);
    let mut expected: Vec<&str> = PLAIN.to_vec();
    expected.insert(5, "notes.txt");
    assert_eq!(names(&out), expected);
}

#[test]
fn a_place_that_cannot_be_written_is_named() {
    let bench = Bench::new();
    let file = bench.put("file", b"content").display().to_string();
    bench.refused(&bench.arguments(&[("--out", &file)]), &file);
    let below = format!("{file}/below/it");
    bench.refused(&bench.arguments(&[("--out", &below)]), &below);
    // Kernel file systems refuse new files even to the superuser.
    for place in ["/proc/stereo-results", "/proc"] {
        bench.refused(&bench.arguments(&[("--out", place)]), place);
    }
    bench.refused(&["demo", "--out", &file], &file);
    std::fs::create_dir_all(bench.path("taken/flags.png")).expect("a folder in the way");
    let taken = bench.path("taken").display().to_string();
    bench.refused(&bench.arguments(&[("--out", &taken)]), "flags.png");
    // The pair's own folder holds pictures with the names of the demo's.
    bench.refused(&["demo", "--out", &bench.path("").display().to_string()], "left.png");
}

/// Runs `match` where no file may grow beyond `blocks` of 512 bytes or more: to the program a disk that fills
/// up.
#[cfg(unix)]
fn matched_on_a_full_disk(bench: &Bench, blocks: u32) -> std::process::Output {
    let mut shell = Command::new("sh");
    shell.args(["-c", &format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\"")]);
    shell.arg(program().get_program()).args(bench.arguments(&[]));
    shell.output().expect("a shell")
}

#[cfg(unix)]
#[test]
fn a_full_disk_leaves_nothing_behind() {
    let bench = Bench::new();
    let before = bench.everything();
    for blocks in [0, 1, 8, 30] {
        let run = matched_on_a_full_disk(&bench, blocks);
        bench.is_refusal(&run, &bench.path("out").display().to_string(), &format!("{blocks} blocks"));
        assert!(before == bench.everything(), "{blocks} blocks: something is left");
    }
}

#[cfg(unix)]
#[test]
fn a_full_disk_leaves_an_earlier_run_as_it_was() {
    let bench = Bench::new();
    bench.matched(&[("--method", "fast"), ("--filter", "dense")]);
    let before = bench.everything();
    let run = matched_on_a_full_disk(&bench, 8);
    bench.is_refusal(&run, "out", "8 blocks");
    assert!(before == bench.everything());
}

#[test]
fn what_an_interrupted_run_left_goes_and_what_is_being_written_stays() {
    let bench = Bench::new();
    let [left, held, other] =
        [".stereo-unfinished-1", ".stereo-unfinished-2", "mine"].map(|name| bench.path("out").join(name));
    for folder in [&left, &held, &other] {
        std::fs::create_dir_all(folder).expect("a folder");
        std::fs::write(folder.join("lock"), "").expect("a file");
        std::fs::write(folder.join("depth.pfm"), "half").expect("a file");
    }
    let lock = std::fs::File::open(held.join("lock")).expect("the file");
    lock.lock().expect("nobody else has it");
    bench.matched(&[]);
    assert!(!left.exists() && held.exists() && other.exists());
}

#[cfg(target_os = "linux")]
#[test]
fn an_interrupted_run_leaves_nothing() {
    let bench = Bench::new();
    let before = bench.everything();
    let walk = || {
        // Whoever runs the tests may ignore signals, and the program goes on to.
        let mut walk = Command::new("env");
        walk.arg("--default-signal=INT,TERM,HUP").arg(program().get_program());
        walk.args(["walk", "--frames", "2000", "--out"]).arg(bench.path("new/walk"));
        walk.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it starts")
    };
    let end = |mut walk: Child, signal: &str| {
        // Again until it ends: before `env` has set signals to their defaults one may be ignored.
        while walk.try_wait().expect("a child").is_none() {
            let sent = Command::new("kill").args([signal, &walk.id().to_string()]).status();
            assert!(sent.expect("kill starts").success());
            std::thread::sleep(Duration::from_millis(20));
        }
        let run = walk.wait_with_output().expect("it ends");
        assert!(before == bench.everything(), "{signal} left something behind");
        run
    };
    for signal in ["-INT", "-TERM"] {
        let walk = walk();
        let left = bench.path("new/walk/left");
        // Until a frame is being written, or for a minute.
        for _ in 0..600 {
            let is_begun = left.is_dir() && !names(&left).is_empty();
            std::thread::sleep(Duration::from_millis(100));
            if is_begun {
                break;
            }
        }
        let run = end(walk, signal);
        assert_eq!(run.status.code(), Some(130), "{signal}: {}", text(&run.stderr));
    }
    // While the folders are being made.
    for tenths_ms in 0..60 {
        let walk = walk();
        std::thread::sleep(Duration::from_micros(100 * tenths_ms));
        end(walk, "-INT");
    }
}

#[test]
fn a_reader_that_closes_early_is_no_error() {
    let bench = Bench::new();
    let mut arguments = bench.arguments(&[]);
    arguments[0] = "bench".into();
    let out = arguments.iter().position(|a| a == "--out").expect("an option");
    arguments.drain(out..out + 2);
    let mut child =
        program().args(&arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it starts");
    drop(child.stdout.take());
    let run = child.wait_with_output().expect("it ends");
    assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
}

#[cfg(target_os = "linux")]
#[test]
fn standard_output_that_takes_nothing_is_an_error() {
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("Linux has it");
    let run = program().arg("--help").stdout(full).output().expect("it starts");
    assert_eq!(run.status.code(), Some(1));
    assert!(text(&run.stderr).starts_with("stereo: standard output: "), "{}", text(&run.stderr));
}

/// A link to where the output goes is no place for a result: it would be replaced, not written to.
#[cfg(target_os = "linux")]
#[test]
fn a_link_to_standard_output_is_kept() {
    let bench = Bench::new();
    let link = bench.path("link");
    std::os::unix::fs::symlink("/proc/self/fd/1", &link).expect("a link");
    let to = std::fs::File::create(bench.path("to")).expect("a file");
    let walk = bench.path("walk").display().to_string();
    assert!(stereo(["walk", "--out", &walk, "--frames", "2", "--width", "160"]).status.success());
    let calib = format!("{walk}/calib.txt");
    let mut odometry = program();
    odometry.args(["odometry", "--sequence", &walk, "--calib", &calib, "--out"]).arg(&link);
    let run = odometry.stdout(to).output().expect("it starts");
    assert_eq!(run.status.code(), Some(1), "{}", text(&run.stderr));
    assert!(text(&run.stderr).contains("link"), "{}", text(&run.stderr));
    assert!(link.is_symlink());
}
