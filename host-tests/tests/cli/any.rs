//! Command lines by chance: each ends soon, and one that fails says one line and changes nothing.
//!
//! `STEREOPSIS_COMMANDS=5000` makes it so many lines.

use crate::support::{Bench, HEIGHT, WIDTH, calibration, program, stereo, text};
use std::process::{Output, Stdio};
use std::time::{Duration, Instant};
use stereopsis_host::scene::random::Random;

/// All but `view`, which serves until it is stopped, and what works as long as a number says.
const COMMANDS: [&str; 17] = [
    "plan",
    "match",
    "eval",
    "calibrate",
    "calib",
    "rectify",
    "features",
    "focus",
    "fundamental",
    "pose",
    "bundle",
    "odometry",
    "structure",
    "record",
    "replay",
    "dump",
    "completions",
];
/// Values that are no files of the folder.
const WORDS: [&str; 30] = [
    "0",
    "-1",
    "1",
    "2",
    "16",
    "32",
    "40",
    "99999999999999999999",
    "-0.5",
    "0.3",
    "1e30",
    "nan",
    "-inf",
    "",
    "x",
    "auto",
    "none",
    "all",
    "sgm",
    "fast",
    "strict",
    "dense",
    "c",
    "bash",
    "9x6",
    "64x48",
    "1,2,3",
    "*",
    "--",
    "-",
];
/// No command has so much to do with the files below.
const MOST: Duration = Duration::from_secs(30);

/// The long options that a command's help names.
fn options(command: &str) -> Vec<String> {
    let help = stereo([command, "--help"]);
    assert!(help.status.success(), "{command}");
    let words = text(&help.stdout);
    let words = words.split(|c: char| c.is_whitespace() || "[]=,'`".contains(c));
    let mut options: Vec<_> =
        words.filter(|word| word.starts_with("--") && word.len() > 2).map(String::from).collect();
    options.sort();
    options.dedup();
    options
}

fn lines() -> usize {
    std::env::var("STEREOPSIS_COMMANDS").map_or(40, |lines| lines.parse().expect("a number of lines"))
}

/// Runs a line to its end, which comes in time.
fn run(bench: &Bench, line: &[String]) -> Output {
    let mut program = program();
    program.current_dir(bench.path("")).args(line).stdin(Stdio::null());
    let mut running = program.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it starts");
    let began = Instant::now();
    while running.try_wait().expect("it can be waited for").is_none() {
        if began.elapsed() > MOST {
            running.kill().expect("it can be ended");
            panic!("{line:?} does not end");
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    running.wait_with_output().expect("it has ended")
}

#[test]
fn any_command_line_ends_and_says_one_line() {
    let bench = Bench::new();
    bench.put("calib.txt", calibration(WIDTH, HEIGHT).as_bytes());
    bench.put("matches.csv", b"x1,y1,x2,y2\n1,2,3,4\n5,6,7,8\n");
    bench.put("words.txt", b"no numbers\n");
    bench.put("empty", b"");
    bench.put("bytes.bin", &(0..=255).cycle().take(3000).collect::<Vec<u8>>());
    std::fs::create_dir(bench.path("folder")).expect("a folder");
    let inputs = bench.everything();
    let files: Vec<_> =
        inputs.keys().map(|path| path.file_name().expect("a name").to_string_lossy()).collect();
    let of_commands = COMMANDS.map(|command| (command, options(command)));
    let random = &mut Random::new(28);
    for number in 0..lines() {
        let (command, options) = &of_commands[random.below(COMMANDS.len())];
        let mut line = vec![(*command).to_owned()];
        for _ in 0..random.below(8) {
            match random.below(8) {
                0 => line.push(WORDS[random.below(WORDS.len())].to_owned()),
                1 => line.push(files[random.below(files.len())].to_string()),
                _ if options.is_empty() => {}
                _ => {
                    line.push(options[random.below(options.len())].clone());
                    match random.below(8) {
                        0 => {}
                        1..4 => line.push(WORDS[random.below(WORDS.len())].to_owned()),
                        4 => line.push(format!("new{number}")),
                        _ => line.push(files[random.below(files.len())].to_string()),
                    }
                }
            }
        }
        let before = bench.everything();
        let ended = run(&bench, &line);
        let said = text(&ended.stderr);
        assert!(matches!(ended.status.code(), Some(0..=2)), "{line:?}: {} {said}", ended.status);
        assert!(!said.contains("panicked"), "{line:?}: {said}");
        let now = bench.everything();
        if !ended.status.success() {
            assert!(said.lines().count() == 1 && said.starts_with("stereo: "), "{line:?}: {said}");
            assert!(now == before, "{line:?} failed and has changed the folder");
        }
        // Results may have taken the place of what the next lines read.
        for (path, bytes) in inputs.iter().filter(|(path, bytes)| now.get(*path) != Some(*bytes)) {
            std::fs::write(path, bytes).expect("the file as it was");
        }
    }
}
