//! Cameras that `odometry` refuses, and rows that it corrects.

use super::odometry::walk;
use super::support::{Bench, stereo, text};
use std::path::Path;

#[test]
fn swapped_cameras_are_refused_unless_forced() {
    let bench = Bench::new();
    let street = walk(&bench, "2");
    let swapped = bench.path("swapped");
    for (from, to) in [("left", "right"), ("right", "left")] {
        let to = swapped.join(to);
        std::fs::create_dir_all(&to).expect("a folder");
        for file in std::fs::read_dir(Path::new(&street).join(from)).expect("a folder") {
            let file = file.expect("a file");
            std::fs::copy(file.path(), to.join(file.file_name())).expect("a copy");
        }
    }
    let (swapped, calib) = (swapped.display().to_string(), format!("{street}/calib.txt"));
    let out = bench.path("found.txt").display().to_string();
    let mut args = vec!["odometry", "--sequence", &swapped, "--calib", &calib, "--out", &out];
    bench.refused(&args, "exchange left and right");
    args.push("--force");
    assert!(stereo(&args).status.success());
    // One folder in the place of both.
    for file in std::fs::read_dir(bench.path("swapped/left")).expect("a folder") {
        let file = file.expect("a file");
        std::fs::copy(file.path(), bench.path("swapped/right").join(file.file_name())).expect("a copy");
    }
    args.pop();
    bench.refused(&args, "the same picture");
}

#[test]
fn where_all_frames_are_lost_is_no_success() {
    let bench = Bench::new();
    let street = walk(&bench, "4");
    let (calib, out) = (format!("{street}/calib.txt"), bench.path("found.txt"));
    let follow = || {
        let to = out.display().to_string();
        stereo(["odometry", "--sequence", &street, "--calib", &calib, "--force", "--out", &to])
    };
    let change = |change: &dyn Fn(&mut image::GrayImage), frames: std::ops::Range<u32>| {
        for path in frames.map(|n| bench.path(&format!("street/right/{n:06}.png"))) {
            let mut picture = image::open(&path).expect("a frame").into_luma8();
            change(&mut picture);
            picture.save(path).expect("room");
        }
    };
    change(&|picture| picture.fill(0), 0..4);
    let run = follow();
    let said = text(&run.stderr);
    assert!(run.status.code() == Some(1) && said.contains("street: 3 of 3 frames are lost"), "{said}");
    assert_eq!(std::fs::read_to_string(out).expect("poses").lines().count(), 4, "they are written");
}

#[test]
fn rows_that_are_off_are_named_and_corrected() {
    let bench = Bench::new();
    let street = walk(&bench, "4");
    for path in (0..4).map(|n| bench.path(&format!("street/right/{n:06}.png"))) {
        let picture = image::open(&path).expect("a frame").into_luma8();
        let lower = image::GrayImage::from_fn(200, 100, |x, y| *picture.get_pixel(x, y.saturating_sub(3)));
        lower.save(path).expect("room");
    }
    let (calib, out) = (format!("{street}/calib.txt"), bench.path("found.txt").display().to_string());
    let mut args = vec!["odometry", "--sequence", &street, "--calib", &calib, "--out", &out];
    let run = stereo(&args);
    let (said, warned) = (text(&run.stdout), text(&run.stderr));
    assert!(run.status.success() && said.contains("frames       3 tracked"), "{said}{warned}");
    assert!(
        warned.contains("street: the rows of the images are 3.") && warned.lines().count() == 1,
        "{warned}"
    );
    args.push("--keep-rig");
    let run = stereo(&args);
    let warned = text(&run.stderr);
    assert!(run.status.code() == Some(1) && warned.contains("3 of 3 frames are lost"), "{warned}");
}
