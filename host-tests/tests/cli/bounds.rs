//! Inputs without an end, too large or nested too deep are named, within a moment.

use crate::guarded::{path, pipe, run};
use crate::support::{Bench, text};
use std::io::Write;
use std::process::Output;
use std::time::{Duration, Instant};

/// Every command that reads a text, from a pipe that is fed for ever: named within a moment.
#[test]
fn a_pipe_without_an_end_is_named() {
    let bench = Bench::new();
    let out = path(&bench, "result");
    for (number, (command, option, fed)) in [
        ("bundle", "--problem", &b"1 2 3 4 5 6\n"[..]),
        ("bundle", "--problem", b"\0\0\0\0\0\0\0\0"),
        ("fundamental", "--matches", b"\0\0\0\0\0\0\0\0"),
        ("fundamental", "--matches", b"1,2,3,4\n"),
    ]
    .into_iter()
    .enumerate()
    {
        let fifo = pipe(&bench, &format!("endless{number}"));
        let at = Instant::now();
        let run = fed_for_ever(&fifo, fed, &[command, option, &fifo, "--out", &out]);
        let said = text(&run.stderr);
        assert_eq!(run.status.code(), Some(1), "{command}");
        assert!(said.contains("64 MiB") || said.contains("more than 100000 matches"), "{command}: {said}");
        assert!(said.contains(&fifo) && said.lines().count() == 1, "{said}");
        assert!(at.elapsed() < Duration::from_secs(5), "{command}: {:?}", at.elapsed());
        assert!(!bench.path("result").exists());
    }
}

/// Runs a command while these bytes go into a pipe, over and over, until nobody reads any more.
fn fed_for_ever(fifo: &str, fed: &[u8], line: &[&str]) -> Output {
    let (block, to) = (fed.repeat((1 << 16) / fed.len()), fifo.to_owned());
    let writer = std::thread::spawn(move || {
        let mut to = std::fs::File::options().write(true).open(to).expect("a reader comes");
        while to.write_all(&block).is_ok() {}
    });
    let run = run(line);
    // A command that never opened the pipe leaves its writer waiting for a reader.
    while !writer.is_finished() {
        drop(std::fs::File::options().read(true).write(true).open(fifo));
        std::thread::sleep(Duration::from_millis(1));
    }
    writer.join().expect("the writer ends");
    run
}

/// Every file of `eval` is named: one without an end, one that is too long, one whose header promises more
/// than any picture has.
#[test]
fn what_eval_cannot_read_whole_is_named() {
    let bench = Bench::new();
    let good = path(&bench, "good.pfm");
    std::fs::write(&good, [b"Pf\n96 48\n-1\n".as_slice(), &5.0_f32.to_le_bytes().repeat(96 * 48)].concat())
        .expect("a file");
    let huge = path(&bench, "huge");
    std::fs::File::create(&huge).and_then(|file| file.set_len(3 << 30)).expect("a sparse file");
    let wide = bench.put("wide.pgm", b"P5\n60000 60000\n255\n").display().to_string();
    let promised = bench.put("promised.pfm", b"Pf\n16384 16384\n-1\n").display().to_string();
    let fifo = pipe(&bench, "endless");
    for option in ["--found", "--truth", "--mask", "--confidence", "--depths-by"] {
        let line = |file: &str| -> Vec<String> {
            let mut line = vec!["eval".to_owned()];
            for name in ["--found", "--truth"].into_iter().filter(|name| *name != option) {
                line.extend([name.to_owned(), good.clone()]);
            }
            line.extend([option.to_owned(), file.to_owned()]);
            line
        };
        for file in [&huge, &wide, &promised, &fifo] {
            let line = line(file);
            let line: Vec<_> = line.iter().map(String::as_str).collect();
            let at = Instant::now();
            let run = if *file == fifo { fed_for_ever(&fifo, &[0], &line) } else { run(&line) };
            let said = text(&run.stderr);
            assert_eq!(run.status.code(), Some(1), "{line:?}");
            assert!(said.contains(file.as_str()) && said.lines().count() == 1, "{line:?}: {said}");
            assert!(at.elapsed() < Duration::from_secs(5), "{line:?}: {:?}", at.elapsed());
        }
    }
}

/// Frames, positions and pictures that are pipes or too long are named.
#[test]
fn what_focus_and_dump_cannot_read_whole_is_named() {
    let bench = Bench::new();
    let (left, out) = (path(&bench, "left.png"), path(&bench, "out"));
    let frames = bench.path("frames");
    std::fs::create_dir(&frames).expect("a folder");
    for number in 0..3 {
        std::fs::copy(&left, frames.join(format!("{number}.png"))).expect("a frame");
    }
    let frames = path(&bench, "frames");
    let (huge, fifo) = (path(&bench, "huge"), pipe(&bench, "endless"));
    std::fs::File::create(&huge).and_then(|file| file.set_len(3 << 30)).expect("a sparse file");
    let dump =
        ["dump", "--disparities", "16", "--method", "fast", "--stage", "census", "--out", &out, "--left"];
    for file in [&huge, &fifo] {
        let focus = ["focus", "--frames", &frames, "--focal-length-mm", "4", "--out", &out, "--positions"];
        let swapped: Vec<_> = dump.iter().copied().chain([file.as_str(), "--right", &left]).collect();
        for line in [focus.into_iter().chain([file.as_str()]).collect(), swapped] {
            let at = Instant::now();
            let run = if *file == fifo { fed_for_ever(&fifo, b"1\n", &line) } else { run(&line) };
            let said = text(&run.stderr);
            assert_eq!(run.status.code(), Some(1), "{line:?}");
            assert!(said.contains(file.as_str()) && said.lines().count() == 1, "{line:?}: {said}");
            assert!(at.elapsed() < Duration::from_secs(5), "{line:?}: {:?}", at.elapsed());
        }
    }
    // A pipe among the frames.
    pipe(&bench, "frames/3.png");
    let said = text(&run(&["focus", "--frames", &frames, "--out", &out]).stderr);
    assert!(said.contains("3.png: is not a file"), "{said}");
}

/// `plan` reads numbers alone: the largest and the smallest of them end at once.
#[test]
fn a_plan_of_any_size_ends() {
    let numbers = ["1e-38", "1e-9", "1", "1e9", "1e38", "3.4e38"];
    for size in ["16x1", "65535x65535", "4096x4096", "65536x1", "99999999999x1"] {
        for (at, number) in numbers.into_iter().enumerate() {
            for farther in &numbers[at..] {
                let began = Instant::now();
                let line = ["plan", "--focal-px", number, "--size", size, "--nearest", number];
                let more = ["--farthest", *farther, "--frame-rate", *farther, "--baseline-mm", *farther];
                let all: Vec<_> = line.into_iter().chain(more).collect();
                let run = run(&all);
                let said = text(&run.stderr);
                assert!(run.status.success() || said.lines().count() == 1, "{all:?}: {said}");
                assert!(!text(&run.stdout).contains("NaN"), "{all:?}: {}", text(&run.stdout));
                assert!(began.elapsed() < Duration::from_secs(5), "{all:?}");
            }
        }
    }
}

/// A file that is too long for an image is not read first: a sparse one of 3 GiB is named at once.
#[test]
fn a_huge_image_is_named() {
    let bench = Bench::new();
    let huge = path(&bench, "huge.pgm");
    std::fs::File::create(&huge).and_then(|file| file.set_len(3 << 30)).expect("a sparse file");
    let (right, out) = (path(&bench, "right.png"), path(&bench, "out"));
    for line in [
        ["features", "--left", &huge, "--right", &right, "--out", &out].as_slice(),
        &["match", "--left", &huge, "--right", &right, "--disparities", "16", "--out", &out],
    ] {
        let at = Instant::now();
        let said = text(&run(line).stderr);
        assert!(said.contains("huge.pgm: the file has more than 402653184 bytes"), "{said}");
        assert!(at.elapsed() < Duration::from_secs(5), "{line:?}: {:?}", at.elapsed());
    }
}

#[test]
fn too_many_matches_are_named() {
    let bench = Bench::new();
    let lines: String =
        (0..100_001).map(|i| format!("{},{},{},{}\n", i % 640, i % 479, i % 637, i % 477)).collect();
    let matches = bench.put("many.csv", lines.as_bytes()).display().to_string();
    let run = run(&["fundamental", "--matches", &matches, "--out", &path(&bench, "f.json")]);
    assert!(text(&run.stderr).contains("more than 100000 matches"), "{}", text(&run.stderr));
}

/// Elements in elements would take the parser's stack.
#[test]
fn deep_xml_is_named() {
    let bench = Bench::new();
    for (name, open, close, depth) in
        [("a", "<a>", "</a>", 10_000), ("b", "<a b='>'>", "</a>", 1_000_000 / 13)]
    {
        let text_of = format!("<?xml version='1.0'?>\n{}{}", open.repeat(depth), close.repeat(depth));
        let calib = bench.put(&format!("{name}.xml"), text_of.as_bytes()).display().to_string();
        let run = run(&["calib", "check", "--calib", &calib]);
        let said = text(&run.stderr);
        assert_eq!(run.status.code(), Some(1), "{said}");
        assert!(said.contains("elements are nested more than 64 deep"), "{said}");
    }
}

/// What is no rotation is no pose, however large.
#[test]
fn a_truth_without_rotations_is_named() {
    let bench = Bench::new();
    let drive = path(&bench, "drive");
    let walked = run(&["walk", "--frames", "3", "--width", "160", "--out", &drive]);
    assert!(walked.status.success(), "{}", text(&walked.stderr));
    let calib = path(&bench, "drive/calib.txt");
    for number in ["0.1", "2", "1e10", "1e30", "1e300", "-1"] {
        let lines = format!("{number} 0 0 0 0 1 0 0 0 0 1 0\n").repeat(3);
        let truth = bench.put("truth.txt", lines.as_bytes()).display().to_string();
        let at = Instant::now();
        let out = path(&bench, "poses.txt");
        let args = ["odometry", "--sequence", &drive, "--calib", &calib, "--truth", &truth, "--out", &out];
        let said = text(&run(&args).stderr);
        assert!(said.contains("truth.txt: line 1 is no pose"), "{number}: {said}");
        assert!(at.elapsed() < Duration::from_secs(20), "{number}");
    }
}

/// A recording of frames without lines: its files are synchronised together, not one by one.
#[test]
fn many_frames_without_lines_end() {
    let bench = Bench::new();
    let mut recording =
        b"stereopsis recording 1\n{\"width\":64,\"height\":32,\"max_row_skew_us\":0}\n".to_vec();
    for sequence in 0..1200_u32 {
        recording.push(b'F');
        recording.extend(sequence.to_le_bytes());
        recording.extend((u64::from(sequence) * 33_333).to_le_bytes());
        recording.extend(1000_u32.to_le_bytes());
    }
    let from = bench.put("headers.lines", &recording).display().to_string();
    let at = Instant::now();
    let run = run(&["replay", "--from", &from, "--disparities", "16", "--out", &path(&bench, "out")]);
    assert!(at.elapsed() < Duration::from_secs(8), "{:?}: {}", at.elapsed(), text(&run.stderr));
}
