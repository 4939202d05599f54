//! `stereo demo` and `stereo bench`.

use super::results::json;
use super::support::{Bench, WIDTH, names, stereo, text};
use serde_json::Value;
use std::fs;
use stereopsis_host::pfm;
use stereopsis_host::run::MethodName;

#[test]
fn bench_prints_one_json_object() {
    let bench = Bench::new();
    let (left, right) = (bench.path("left.png"), bench.path("right.png"));
    let (left, right) = (left.to_str().expect("UTF-8"), right.to_str().expect("UTF-8"));
    for (method, name, threads) in [
        (MethodName::Fast, "fast", "1"),
        (MethodName::Block, "block", "1"),
        (MethodName::Block, "block", "3"),
        (MethodName::Sgm, "sgm", "2"),
        (MethodName::SgmEdge, "sgm-edge", "1"),
    ] {
        let fixed = ["bench", "--left", left, "--right", right, "--disparities", "32", "--repeat", "3"];
        let run = stereo(fixed.into_iter().chain(["--method", name, "--threads", threads]));
        assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
        let printed: Value = serde_json::from_slice(&run.stdout).expect("one JSON object");
        let keys: Vec<&String> = printed.as_object().expect("an object").keys().collect();
        assert_eq!(keys, ["disparities", "frame_ms", "height", "kernel", "noise", "state_bytes", "width"]);
        assert_eq!(printed["state_bytes"], method.state_bytes(WIDTH as u16, 32));
        let times = printed["frame_ms"].as_array().expect("a list");
        assert!(times.len() == 3 && times.iter().all(|t| t.as_f64().is_some_and(|ms| ms > 0.0)), "{times:?}");
    }
}

#[test]
fn the_demo_writes_the_truth_beside_the_answers() {
    let bench = Bench::new();
    let out = bench.path("demo");
    let arguments = ["demo", "--out", out.to_str().expect("UTF-8")];
    let run = stereo(arguments);
    assert!(run.status.success() && run.stderr.is_empty(), "{}", text(&run.stderr));
    let expected = [
        "calib.txt",
        "cloud.ply",
        "confidence.png",
        "depth.pfm",
        "depth.png",
        "disparity.pfm",
        "disparity.png",
        "disparity_colour.png",
        "error.pfm",
        "error.png",
        "flags.png",
        "left.png",
        "report.html",
        "right.png",
        "summary.json",
        "true_depth.pfm",
        "true_disparity.pfm",
    ];
    assert_eq!(names(&out), expected);
    let read = |name: &str| {
        pfm::read(&mut fs::read(out.join(name)).expect("a result").as_slice()).expect("a float map")
    };
    let (answer, truth, error) = (read("disparity.pfm"), read("true_disparity.pfm"), read("error.pfm"));
    for ((a, t), e) in answer.values.iter().zip(&truth.values).zip(&error.values) {
        assert!(
            if a.is_finite() && t.is_finite() { a - t == *e } else { *e == f32::INFINITY },
            "{a} {t} {e}"
        );
    }
    let accuracy = &json(&out.join("summary.json"))["accuracy"];
    assert!(accuracy["density"].as_f64().is_some_and(|share| share > 0.9), "{accuracy}");
    assert!(accuracy["bad2"].as_f64().is_some_and(|share| share < 0.02), "{accuracy}");
    assert!(accuracy["within_3_sigma"].as_f64().is_some_and(|share| share > 0.98), "{accuracy}");
    let worth = &accuracy["sparsification"];
    let [area, oracle, random] =
        ["area", "oracle", "random"].map(|name| worth[name].as_f64().expect("a number"));
    assert!(oracle < area && area - oracle < 0.15 * (random - oracle), "{worth}");
    assert!(text(&run.stdout).contains("within 3 sigma_Z"));
    // Its own pictures may be replaced.
    assert!(stereo(arguments).status.success());
}
