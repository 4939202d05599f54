//! `bundle`: a problem in BAL's format in, the refined one out, or one line and nothing.

use super::support::{Bench, stereo, text};
use std::fmt::Write;

/// Three cameras abreast, 0.5 apart, and a cube of points 4 before them, with the middle camera 0.05 off.
fn problem() -> String {
    let mut points = Vec::new();
    for x in [-1.0, 0.0, 1.0] {
        for y in [-1.0, 0.3, 1.0] {
            points.push([x, y, -4.0 - 0.5 * x * y - 0.3 * y]);
        }
    }
    let mut text = format!("3 {} {}\n", points.len(), 3 * points.len());
    for (point, [x, y, z]) in points.iter().enumerate() {
        for camera in 0..3 {
            let shift = 0.5 * f64::from(camera);
            writeln!(text, "{camera} {point}     {:e} {:e}", -500.0 * (x - shift) / z, -500.0 * y / z)
                .expect("text");
        }
    }
    for camera in 0..3 {
        let off = if camera == 1 { 0.05 } else { 0.0 };
        writeln!(text, "0\n0\n0\n{}\n{off}\n0\n500\n0\n0", -0.5 * f64::from(camera)).expect("text");
    }
    points.iter().flatten().for_each(|x| writeln!(text, "{x}").expect("text"));
    text
}

fn arguments(bench: &Bench, extra: &[&str]) -> Vec<String> {
    let file = |name: &str| bench.path(name).display().to_string();
    let all =
        ["bundle".to_owned(), "--problem".into(), file("p.txt"), "--out".into(), file("out/refined.txt")];
    all.into_iter().chain(extra.iter().map(|&word| word.to_owned())).collect()
}

/// The number behind a word.
fn after(said: &str, word: &str) -> f64 {
    let line = said.lines().find_map(|line| line.strip_prefix(word)).expect(word);
    line.trim().parse().expect("a number")
}

#[test]
fn costs_are_reported_and_the_problem_is_refined() {
    let bench = Bench::new();
    bench.put("p.txt", problem().as_bytes());
    for extra in [&[][..], &["--loss", "huber", "--width", "0.5"]] {
        let run = stereo(arguments(&bench, extra));
        assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
        let said = text(&run.stdout);
        assert!(said.starts_with("3 cameras, 9 points, 27 observations\n"), "{said}");
        // The middle camera sees all points about 500 * 0.05 / 4 px off.
        let initial = after(&said, "initial cost:");
        assert!((initial - 0.5 * 9.0 * 6.25 * 6.25).abs() < 40.0, "{said}");
        assert!(after(&said, "final cost:") < 1e-12 * initial, "{said}");
        assert!(said.contains("half the sum of squared residuals") && said.contains("stopped: "), "{said}");
        // The refined problem is one, with nothing left to do.
        let refined = std::fs::read_to_string(bench.path("out/refined.txt")).expect("the result");
        assert_eq!(refined.split_whitespace().count(), problem().split_whitespace().count());
        let again =
            ["bundle".to_owned(), "--problem".into(), bench.path("out/refined.txt").display().to_string()];
        let out = ["--out".to_owned(), bench.path("out/again.txt").display().to_string()];
        let said = text(&stereo(again.into_iter().chain(out)).stdout);
        assert!(after(&said, "initial cost:") < 1e-12 * initial, "{said}");
    }
    let run = stereo(arguments(&bench, &["--width", "2"]));
    assert!(run.status.code() == Some(2) && text(&run.stderr).contains("--loss huber"), "{run:?}");
    let run = stereo(arguments(&bench, &["--iterations", "1", "--tolerance", "1e-12"]));
    assert!(text(&run.stdout).contains("the iterations are used up"), "{}", text(&run.stdout));
}

#[test]
fn what_is_no_problem_is_named() {
    let good = problem();
    let (short, _) = good.trim_end().rsplit_once('\n').expect("lines");
    let bench = Bench::new();
    for (content, culprit) in [
        (short.as_bytes(), "p.txt: ends where number 3 of point 8 is due"),
        (
            good.replacen("\n0 0 ", "\n7 0 ", 1).as_bytes(),
            "p.txt: line 2: '7' is not the camera of observation 0",
        ),
        (good.replacen("\n500\n", "\ninf\n", 1).as_bytes(), "p.txt: line 35: number 7 of camera 0: 'inf'"),
        (b"BZh91AY&SY", "p.txt: is compressed; unpack it with bunzip2"),
        (b"", "p.txt: the file is empty"),
        (b"\xff\xd8\xff\xe0", "p.txt: is no text"),
    ] {
        bench.put("p.txt", content);
        bench.refused(&arguments(&bench, &[]), culprit);
    }
    bench.put("p.txt", good.as_bytes());
    bench.refused(&arguments(&bench, &["--loss", "cauchy"]), "--loss");
    bench.refused(&arguments(&bench, &["--width", "0"]), "--width");
    bench.refused(&arguments(&bench, &["--iterations", "0"]), "--iterations");
    bench.refused(&arguments(&bench, &["--tolerance", "1"]), "--tolerance");
    let missing = ["bundle", "--problem", "nowhere.txt", "--out", "out.txt"];
    bench.refused(&missing, "nowhere.txt: cannot be read");
}
