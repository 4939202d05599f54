//! Matches and options that `fundamental` and `pose` refuse.

use super::two_view::{arguments, bench, matches};

#[test]
fn bad_matches() {
    let bench = bench("");
    for (content, culprit) in [
        ("", "empty"),
        ("x1,y1,x2\n1,2,3\n", "y2"),
        ("x1,y1,x2,y2\n1,2,nan,4\n", "line 2: x2"),
        ("x1,y1,x2,y2\n1,2,3,4\n1,2\n", "line 3: x2"),
        ("x1,y1,x2,y2\n1,2,3,4\n", "eight"),
        ("x1,y1,x2,y2\n", "eight"),
        ("\u{0}\u{1}\u{2}", "m.csv"),
    ] {
        bench.put("m.csv", content.as_bytes());
        for command in ["fundamental", "pose"] {
            for method in ["ransac", "eight-point"] {
                bench.refused(&arguments(&bench, command, &["--method", method]), culprit);
                bench.refused(&arguments(&bench, command, &["--method", method]), "m.csv");
            }
        }
    }
    bench.put("m.csv", &[0xff, 0xfe, b',', 0xc0]);
    bench.refused(&arguments(&bench, "fundamental", &[]), "m.csv");
    bench.put("m.csv", "1,2,3,4\n".repeat(50).as_bytes());
    bench.refused(&arguments(&bench, "fundamental", &[]), "m.csv");
    bench.put("m.csv", matches(60, false, true).as_bytes());
    bench.refused(&arguments(&bench, "fundamental", &[]), "plane");
    bench.refused(&arguments(&bench, "fundamental", &["--method", "eight-point"]), "plane");
    let still: String = (0..40).map(|i| format!("{0},{1},{0},{1}\n", 37 * i % 640, 91 * i % 480)).collect();
    bench.put("m.csv", format!("x1,y1,x2,y2\n{still}").as_bytes());
    for command in ["fundamental", "pose"] {
        bench.refused(&arguments(&bench, command, &[]), "no match moves");
    }
    // On a line in both images, exactly and with noise.
    for noise in [0.0, 0.2] {
        let line = |i: u32| {
            let (t, off) = (f64::from(i), noise * (f64::from(i * 7919 % 17) / 8.0 - 1.0));
            format!(
                "{},{},{},{}\n",
                60.0 + 2.5 * t,
                90.0 + 1.5 * t + off,
                40.0 + 2.4 * t + off,
                95.0 + 1.4 * t
            )
        };
        let lines: String = (0..200).map(line).collect();
        bench.put("m.csv", format!("x1,y1,x2,y2\n{lines}").as_bytes());
        for (command, seed) in [("fundamental", "0"), ("pose", "0"), ("pose", "1"), ("pose", "2")] {
            bench.refused(&arguments(&bench, command, &["--seed", seed]), "on a line");
        }
    }
    let missing = bench.path("none.csv").display().to_string();
    bench.refused(&["fundamental", "--matches", &missing, "--out", "answer.json"], "none.csv");
}

#[test]
fn bad_options_of_two_views() {
    let bench = bench(&matches(60, true, false));
    for bad in ["0", "-1", "nan", "inf", "x", "1e9"] {
        bench.refused(&arguments(&bench, "fundamental", &["--threshold", bad]), "--threshold");
        bench.refused(&arguments(&bench, "pose", &["--threshold", bad]), "--threshold");
    }
    for bad in ["-1", "1.5", "x", "99999999999999999999"] {
        bench.refused(&arguments(&bench, "fundamental", &["--seed", bad]), "--seed");
    }
    bench.refused(&arguments(&bench, "fundamental", &["--method", "seven"]), "--method");
    let matches = bench.path("m.csv").display().to_string();
    let folder = bench.path("").display().to_string();
    bench.refused(&["fundamental", "--matches", &matches, "--out", &folder], "--out");
    bench.refused(&["fundamental", "--matches", &matches], "--out");
    bench.refused(&["fundamental", "--out", "answer.json"], "--matches");
    bench.refused(&["pose", "--matches", &matches, "--out", "answer.json"], "--calib");
    bench.put("calib.txt", b"cam0=[500 0 320; 0 500 240; 0 0 1]\n");
    bench.refused(&arguments(&bench, "pose", &[]), "cam1");
    bench.put("calib.txt", b"hello");
    bench.refused(&arguments(&bench, "pose", &[]), "calib.txt");
}
