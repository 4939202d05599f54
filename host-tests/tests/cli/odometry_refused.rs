//! Cameras that `odometry` refuses.

use super::odometry::walk;
use super::support::{Bench, stereo};
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
