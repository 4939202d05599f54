//! `stereo plan`: figures worked by hand, the limits, and what is refused.

use super::support::{Bench, stereo, text};
use serde_json::Value;
use stereopsis_host::run::MethodName;

/// 420 px x 60 mm: 25.2 px m.
const RIG: [&str; 9] =
    ["plan", "--baseline-mm", "60", "--focal-px", "420", "--size", "320x240", "--nearest", "0.4"];

fn said(more: &[&str]) -> String {
    let run = stereo(RIG.iter().chain(more));
    assert!(run.status.success() && run.stderr.is_empty(), "{more:?}: {}", text(&run.stderr));
    text(&run.stdout)
}

fn json(more: &[&str]) -> Value {
    serde_json::from_str(&said(&[more, &["--json"]].concat())).expect("one JSON object")
}

#[test]
fn depths_are_those_of_the_formula() {
    let plan = json(&["--farthest", "5"]);
    // 63 px at 0.4 m and 5.04 px at 5 m, and one more on either side: 61, which is 64 in steps of 16.
    let search = ["disparities", "min_disparity", "needed"].map(|name| plan["search"][name].as_u64());
    assert_eq!(search, [64, 1, 64].map(Some));
    let far = plan["depths"].as_array().and_then(|depths| depths.last()).expect("depths");
    let number = |of: &Value| of.as_f64().expect("a number");
    assert!((number(&far["disparity_px"]) - 5.04).abs() < 1e-9);
    assert!((number(&far["sigma_m"]) - 25.0 / 25.2 * 0.15).abs() < 1e-9);
    assert!((number(&far["overlap"]) - (320.0 - 5.04) / 320.0).abs() < 1e-9);
    assert!((number(&plan["reach_m"]) - 0.05 * 25.2 / 0.15).abs() < 1e-9);
    assert!((number(&plan["field_of_view_deg"][0]) - 41.7).abs() < 0.1);
    assert_eq!((&plan["limits"], &plan["changes"]), (&Value::Array(vec![]), &Value::Array(vec![])));
    assert!(said(&["--farthest", "5"]).contains("  at  2.00 m    12.6 px, +- 23.8 mm for 0.15 px\n"));
}

#[test]
fn work_is_what_was_measured() {
    let plan = json(&["--farthest", "5", "--core", "m4", "--method", "sgm", "--clock-mhz", "100"]);
    let [work] = plan["work"].as_array().expect("a list").as_slice() else { panic!("one core and method") };
    // Of 320x240 pixels and 64 disparities, which docs/performance.md has.
    let page = include_str!("../../../docs/performance.md");
    let line = page.split("| m4 | `sgm` | 320x240 | 64 | ").nth(1).expect("the line");
    let mut cells = line.split(" | ").map(|cell| cell.parse::<f64>().expect("a number"));
    let instructions = cells.next().expect("instructions");
    assert!((work["instructions"].as_f64().expect("a number") - instructions).abs() < 1.0);
    let per_second = work["frames_per_s"].as_f64().expect("a number");
    assert!((per_second * instructions - 1e8).abs() < 1e3);
    // After the instructions for an evaluation, the program's static RAM.
    assert_eq!(work["ram_bytes"].as_f64(), cells.nth(1));
    assert_eq!(work["ram_is_measured"], true);
}

#[test]
fn memory_that_was_not_measured_is_said_to_be_a_bound() {
    let mut rig = RIG.to_vec();
    rig[6] = "324x240";
    let run = stereo(rig.iter().chain(&["--farthest", "5", "--core", "m4", "--method", "sgm", "--json"]));
    let plan: Value = serde_json::from_slice(&run.stdout).expect("JSON");
    // What the matcher takes at most, and ten lines and some of the cameras.
    assert_eq!(plan["work"][0]["ram_bytes"], MethodName::Sgm.state_bytes(324, 64) + 10 * 324 + 48);
    assert_eq!(plan["work"][0]["ram_is_measured"], false);
}

#[test]
fn memory_that_was_measured_is_enough() {
    // 210 px x 60 mm at 0.45 m are 28 px: 32 disparities of 160 columns, where firmware for the M3 was
    // measured to take 16524 bytes and 1240 of stack at most, and firmware for the M4 18332.
    let small = ["--size", "160x120", "--focal-px", "210", "--nearest", "0.45", "--farthest", "4"];
    let small = [&small[..], &["--method", "fast", "--ram-kb", "18"]].concat();
    let plan = |core: &str| {
        let run = stereo(["plan", "--baseline-mm", "60", "--core", core].iter().chain(&small));
        assert!(run.status.success(), "{}", text(&run.stderr));
        text(&run.stdout)
    };
    let m3 = plan("m3");
    assert!(m3.contains("limit        none") && m3.contains("RAM as measured, of the"), "{m3}");
    let m4 = plan("m4");
    assert!(m4.contains("limit        the memory: fast takes 19532 bytes of RAM with its stack"), "{m4}");
}

#[test]
fn the_three_ways_to_say_a_focal_length_agree() {
    let focal = |lens: &[&str]| {
        let rig = ["plan", "--baseline-mm", "60", "--size", "320x240", "--nearest", "1", "--farthest", "5"];
        let run = stereo(rig.iter().chain(lens).chain(&["--json"]));
        assert!(run.status.success(), "{lens:?}: {}", text(&run.stderr));
        let plan: Value = serde_json::from_slice(&run.stdout).expect("JSON");
        plan["rig"]["focal_px"].as_f64().expect("a number")
    };
    assert_eq!(focal(&["--focal-px", "160"]), 160.0);
    assert!((focal(&["--focal-mm", "1.44", "--sensor-width-mm", "2.88"]) - 160.0).abs() < 1e-9);
    assert!((focal(&["--field-of-view", "90"]) - 160.0).abs() < 1e-9);
    assert!((focal(&["--fov", "90"]) - 160.0).abs() < 1e-9);
}

#[test]
fn what_limits_is_named_with_what_would_help() {
    // 1 % at 5 m: sigma is 2.98 %, so a baseline of 60 mm x 2.98 has it.
    let text = said(&["--farthest", "5", "--accuracy", "1"]);
    assert!(text.contains("limit        the accuracy: at 5 m the deviation is 2.98 %"), "{text}");
    assert!(text.contains("change       a baseline of 179 mm would reach 5 m within 1 %"), "{text}");
    assert!(!said(&["--farthest", "5", "--accuracy", "3"]).contains("the accuracy: "));
    // That baseline is enough, and one a millimetre shorter is not.
    for (mm, is_enough) in [("179", true), ("178", false)] {
        let mut rig = RIG.to_vec();
        rig[2] = mm;
        let run = stereo(rig.iter().chain(&["--farthest", "5", "--accuracy", "1"]));
        assert_eq!(!String::from_utf8_lossy(&run.stdout).contains("the accuracy: "), is_enough, "{mm} mm");
    }

    let mut near = RIG.to_vec();
    near[8] = "0.05";
    let run = stereo(near.iter().chain(&["--farthest", "5"]));
    let near = String::from_utf8_lossy(&run.stdout);
    assert!(near.contains("limit        the search: depths from 0.05 m take 512 disparities"), "{near}");
    assert!(near.contains(" mm would begin at 0.05 m"), "{near}");

    let small = said(&["--farthest", "5", "--method", "sgm", "--ram-kb", "64"]);
    assert!(small.contains("limit        the memory: sgm takes "), "{small}");
    assert!(small.contains("change       images "), "{small}");
    let fast = said(&["--farthest", "5", "--core", "m4", "--method", "fast", "--frame-rate", "25"]);
    assert!(fast.contains("limit        the work: fast on m4 at 168 MHz gives about 6."), "{fast}");
    assert!(fast.contains("change       images of 160 x 120 px and 48 disparities"), "{fast}");
}

#[test]
fn what_cannot_be_planned_is_named() {
    let bench = Bench::new();
    let refused = |change: &[&str], culprit: &str| {
        bench.refused(&[&RIG, change].concat(), culprit);
    };
    refused(&[], "--farthest");
    refused(&["--farthest", "0.4"], "--nearest 0.4: is not nearer");
    refused(&["--farthest", "nan"], "--farthest");
    refused(&["--farthest", "5", "--accuracy", "0"], "--accuracy");
    refused(&["--farthest", "5", "--core", "m9"], "the cores are m0, m3, m4, m7, m33, m55, rv32, rv32v");
    refused(&["--farthest", "5", "--field-of-view", "60"], "--field-of-view");
    refused(&["--farthest", "5", "--sensor-width-mm", "3"], "--sensor-width-mm");
    let rig = ["plan", "--baseline-mm", "60", "--nearest", "1", "--farthest", "5"];
    let with = |more: &[&'static str]| [&rig, more].concat();
    bench.refused(&with(&["--size", "320x240"]), "--focal-px");
    bench.refused(&with(&["--size", "320x240", "--field-of-view", "180"]), "--field-of-view");
    bench.refused(&with(&["--size", "320x240", "--focal-mm", "2"]), "--sensor-width-mm");
    bench.refused(&with(&["--size", "15x240", "--focal-px", "100"]), "--size 15x240");
    bench.refused(&with(&["--size", "320", "--focal-px", "100"]), "--size");
}

/// A number after some words of a text.
fn after(text: &str, words: &str) -> f64 {
    let rest = text.split(words).nth(1).unwrap_or_else(|| panic!("{words}: {text}"));
    let number: String = rest.chars().take_while(|c| c.is_ascii_digit() || *c == '.').collect();
    number.parse().expect("a number")
}

#[test]
fn what_would_help_does() {
    // Principal points that are 31 px apart, as Middlebury's are, and a range that ends before infinity.
    for (doffs, farthest) in [(31.1, 20.0), (0.0, 5.0)] {
        let bench = Bench::new();
        let check = |scale: f64, baseline: f64| {
            let (f, cx, far) = (999.4 / scale, 294.2 / scale, (294.2 + doffs) / scale);
            let [w, h, doffs] = [741.0, 497.0, doffs].map(|side| side / scale);
            let calib = format!(
                "cam0=[{f} 0 {cx}; 0 {f} 252; 0 0 1]\ncam1=[{f} 0 {far}; 0 {f} 252; 0 0 1]\ndoffs={doffs}\n\
                 baseline={baseline}\nwidth={}\nheight={}\nndisp=64\n",
                w.floor(),
                h.floor()
            );
            let calib = bench.put("calib.txt", calib.as_bytes()).display().to_string();
            let range = ["--nearest", "0.5", "--farthest", &farthest.to_string()];
            let run = stereo([&["calib", "check", "--calib", &calib], &range[..]].concat());
            assert!(run.status.success(), "{}", text(&run.stderr));
            text(&run.stdout)
        };
        let told = check(1.0, 193.0);
        let shorter = check(1.0, after(&told, "a baseline of "));
        let reach = after(&told, "would begin at 0.5 m, and reach ");
        assert!(after(&shorter, "within 5 % up to ") >= reach - 0.06, "{told}{shorter}");
        assert!(!shorter.contains("depths from 0.5 m take"), "{shorter}");
        let half = check(2.0, 193.0);
        let disparities = after(&told, "half the size, would begin at 0.5 m with ");
        assert!(half.contains(&format!("--disparities {disparities}")), "{told}{half}");
    }
}
