//! `stereo replay` gives what `stereo match` gives, whatever the cameras are like.

use super::replay::{disparities, put_pair, run, summary};
use super::support::Bench;
use std::fs;
use stereopsis::camera::{FrameStart, LineFault, LineStart, StereoSource};
use stereopsis::imaging::BalancedPair;
use stereopsis_host::recording::{Ahead, Entry, Header, Playback, RecordedFault, RecordingError, Seen};
use stereopsis_host::scene::Random;
use stereopsis_host::scene::pattern::Pattern;

#[test]
fn unequal_exposures_are_played_as_match_sees_them() {
    let bench = Bench::new();
    let [left, alike] = put_pair(&bench, false);
    let brighter = bench.path("brighter.png").display().to_string();
    let mut picture = image::open(&alike).expect("a picture").into_luma8();
    picture.iter_mut().for_each(|grey| *grey = *grey / 2 + 80);
    picture.save(&brighter).expect("a file");
    let [frames, file, out, matched] =
        ["frames", "a.lines", "out", "matched"].map(|name| bench.path(name).display().to_string());
    // Every frame by its own lines: the right camera's exposure changes at once, and back.
    let rights = [&alike, &brighter, &alike, &brighter];
    for (n, right) in (1..).zip(rights) {
        for (side, image) in [("left", &left), ("right", right)] {
            fs::create_dir_all(bench.path("frames").join(side)).expect("a folder");
            fs::copy(image, bench.path("frames").join(side).join(format!("{n}.png"))).expect("a file");
        }
    }
    let sides = ["left", "right"].map(|side| bench.path("frames").join(side).display().to_string());
    run(&["record", "--left", &sides[0], "--right", &sides[1], "--out", &file]);
    let mut answers = Vec::new();
    for (matching, balanced) in [
        (&["--method", "sgm"][..], 2),
        (&["--method", "sgm-edge", "--balance", "auto"], 2),
        (&["--method", "sgm", "--balance", "none"], 0),
        (&["--method", "block"], 0),
    ] {
        for from in [&file, &frames] {
            let replay = ["replay", "--from", from, "--disparities", "16", "--out", &out];
            let told = run(&[&replay[..], matching].concat());
            assert_eq!(
                told.contains("2 with the right image in the left one's exposure"),
                balanced > 0,
                "{told}"
            );
            assert_eq!(summary(&bench, "out")["balanced_frames"], balanced, "{matching:?}");
            for (n, right) in (1..).zip(rights) {
                let pair =
                    ["match", "--left", &left, "--right", right, "--disparities", "16", "--out", &matched];
                run(&[&pair[..], matching].concat());
                let [found, expected] = [format!("out/{n:06}-disparity.pfm"), "matched/disparity.pfm".into()]
                    .map(|name| fs::read(bench.path(&name)).expect("a result"));
                assert!(found == expected, "{matching:?}, frame {n} from {from}");
                answers.push(found);
            }
        }
    }
    assert_ne!(answers[1], answers[17], "it makes a difference to sgm");

    // Those that are played are counted, and none ahead of them.
    for (frames, balanced) in [("1", 0), ("2", 1), ("3", 1), ("4", 2)] {
        let replay = ["replay", "--from", &file, "--disparities", "16", "--method", "sgm", "--out", &out];
        run(&[&replay[..], &["--frames", frames]].concat());
        assert_eq!(summary(&bench, "out")["balanced_frames"], balanced, "{frames} frames");
    }
}

#[test]
fn noisy_frames_are_played_as_match_sees_them() {
    let bench = Bench::new();
    put_pair(&bench, false);
    // Two thirds of each picture are a quiet place.
    let clean = ["left", "right"].map(|side| {
        let mut picture = image::open(bench.path(&format!("{side}.png"))).expect("a picture").into_luma8();
        picture.enumerate_pixels_mut().filter(|(x, ..)| *x >= 16).for_each(|(_, _, grey)| grey.0 = [100]);
        picture
    });
    let mut random = Random::new(3);
    let mut noise = |picture: &image::GrayImage, sigma: f64| {
        let mut picture = picture.clone();
        picture.iter_mut().for_each(|grey| {
            let by = (sigma * random.gauss()).round() as i32;
            *grey = (i32::from(*grey) + by).clamp(1, 254) as u8;
        });
        picture
    };
    let levels = [0.0, 5.0, 0.0, 2.0];
    let [frames, out, matched] =
        ["frames", "out", "matched"].map(|name| bench.path(name).display().to_string());
    for (side, picture) in ["left", "right"].into_iter().zip(&clean) {
        fs::create_dir_all(bench.path("frames").join(side)).expect("a folder");
        for (n, sigma) in (1..).zip(levels) {
            noise(picture, sigma)
                .save(bench.path("frames").join(side).join(format!("{n}.png")))
                .expect("a file");
        }
    }
    for (matching, noisy) in
        [(&[][..], 2), (&["--method", "sgm"], 2), (&["--noise", "high"], 4), (&["--noise", "none"], 0)]
    {
        let replay = ["replay", "--from", &frames, "--disparities", "16", "--out", &out];
        let told = run(&[&replay[..], matching].concat());
        assert_eq!(told.contains(&format!("{noisy} smoothed against noise")), noisy > 0, "{told}");
        assert_eq!(summary(&bench, "out")["noisy_frames"], noisy, "{matching:?}");
        assert_eq!(summary(&bench, "out")["counters"]["rows"], 4 * 30, "{matching:?}");
        let mut told = Vec::new();
        for n in 1..=levels.len() {
            let [left, right] = ["left", "right"]
                .map(|side| bench.path(&format!("frames/{side}/{n}.png")).display().to_string());
            let pair =
                ["match", "--left", &left, "--right", &right, "--disparities", "16", "--out", &matched];
            run(&[&pair[..], matching].concat());
            assert_eq!(
                disparities(&bench, &format!("out/{n:06}-disparity.pfm")),
                disparities(&bench, "matched/disparity.pfm"),
                "{matching:?}, frame {n}"
            );
            told.push(summary(&bench, "matched")["noise"].as_str().expect("a level").to_owned());
        }
        if noisy == 2 {
            assert_eq!(told, ["none", "high", "none", "low"], "{matching:?}");
        }
    }
}

/// The right lines of a frame of 48 x 30 that was started; those that came.
fn right_lines(source: &mut impl StereoSource) -> Vec<Option<[u8; 48]>> {
    let line = |_| {
        let [mut left, mut right] = [[0; 48]; 2];
        source.next_lines(&mut left, &mut right).is_ok().then_some(right)
    };
    (0..30).map(line).collect()
}

#[test]
fn frames_that_lost_lines_are_balanced_by_those_that_came() {
    let (left, right) = Pattern::Shifted { most: 12, noise_grey: 2.0 }.pair(48, 30, 5);
    let line = |image: &image::GrayImage, row: usize| image.as_raw()[48 * row..][..48].to_vec();
    let mut entries = vec![Entry::NoFrame(RecordedFault::TimedOut), Entry::Frame(FrameStart::default())];
    for row in 0..30 {
        entries.push(match row {
            0 | 11 | 12 => Entry::NoLine(RecordedFault::Line(LineFault::Torn)),
            _ => Entry::Line {
                start: LineStart { row: row as u16, timestamp_us: 0 },
                left: line(&left, row),
                right: line(&right, row).iter().map(|grey| grey / 4 + 10).collect(),
            },
        });
    }
    let header = Header { width: 48, height: 30, max_row_skew_us: 0 };
    // The core's own pair sees the frame, and then again.
    let twice = entries.iter().chain(&entries[1..]).cloned().map(Ok::<_, RecordingError>);
    let mut pair = BalancedPair::new(Playback::new(twice, header, false));
    assert!(pair.start_frame().is_err(), "none began");
    let seen = [(); 2].map(|()| {
        pair.start_frame().expect("a frame");
        right_lines(&mut pair)
    });
    let frames = Seen::default();
    let ahead = Ahead::new(entries.into_iter().map(Ok), header, true, &frames);
    let mut playback = Playback::new(ahead, header, false);
    assert!(playback.start_frame().is_err(), "none began");
    playback.start_frame().expect("a frame");
    assert_eq!(frames.balanced_frames(), 0, "nothing was asked for yet");
    let found = right_lines(&mut playback);
    assert_eq!(frames.balanced_frames(), 1);
    assert!(!playback.has_frame());
    assert!(found[11].is_none() && found[13].is_some() && found != seen[0]);
    assert_eq!(found, seen[1]);
}
