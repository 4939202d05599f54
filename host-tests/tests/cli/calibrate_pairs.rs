//! `stereo calibrate` of pairs whose images do not belong together.

use super::calibrate::{arguments, pictures};
use super::support::{Bench, stereo, text};

#[test]
fn pairs_that_are_of_two_moments_are_left_out() {
    let bench = Bench::new();
    pictures(&bench);
    let copy = |from: &str, to: &str| std::fs::copy(bench.path(from), bench.path(to)).expect("a picture");
    copy("left1.png", "left7.png");
    copy("right3.png", "right7.png");
    let run = stereo(arguments(&bench, &[]));
    let (said, notes) = (text(&run.stdout), text(&run.stderr));
    assert!(run.status.success() && said.contains("5 of 7 views"), "{said}{notes}");
    assert!(notes.contains("right7.png are left out"), "{notes}");
    // Every right picture one moment late.
    for n in (2..=5).rev() {
        copy(&format!("right{n}.png"), &format!("late{n}.png"));
    }
    for n in 2..=5 {
        copy(&format!("late{n}.png"), &format!("right{}.png", n - 1));
    }
    std::fs::remove_file(bench.path("stereo.yml")).expect("the calibration");
    let [left, right] =
        ["left[1-4].png", "right[1-4].png"].map(|name| bench.path(name).display().to_string());
    bench.refused(
        &arguments(&bench, &[("--left", &left), ("--right", &right)]),
        "too many pairs are not of one moment",
    );
}

#[test]
fn images_of_one_camera_or_one_place_are_named() {
    let bench = Bench::new();
    pictures(&bench);
    let file = |name: &str| bench.path(name).display().to_string();
    let left = file("left?.png");
    bench.refused(&arguments(&bench, &[("--right", &left)]), "both lists show the same camera");
    for side in ["left", "right"] {
        for n in 2..=6 {
            std::fs::copy(file(&format!("{side}1.png")), file(&format!("{side}{n}.png"))).expect("room");
        }
    }
    bench.refused(&arguments(&bench, &[]), "all 6 boards stand alike");
    // Squares in place of corners.
    bench.refused(&arguments(&bench, &[("--pattern", "7x6")]), "give --pattern 6x5");
    for name in ["stereo.xml", "stereo.json"] {
        bench.refused(&arguments(&bench, &[("--out", &file(name))]), "the file is YAML");
    }
}

#[test]
fn a_camera_that_is_upside_down_or_mirrored_is_thought_of() {
    let bench = Bench::new();
    pictures(&bench);
    let change = |change: &dyn Fn(&image::GrayImage) -> image::GrayImage| {
        for n in 1..=6 {
            let path = bench.path(&format!("right{n}.png"));
            let picture = image::open(&path).expect("a picture").into_luma8();
            change(&picture).save(path).expect("room");
        }
    };
    change(&image::imageops::rotate180);
    bench.refused(&arguments(&bench, &[]), "upside down");
    change(&image::imageops::flip_vertical);
    bench.refused(&arguments(&bench, &[]), "mirrored");
}
