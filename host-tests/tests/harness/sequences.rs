//! Sequences of two cameras whose names sort in another order.

use image::{GrayImage, Luma};
use std::fs;
use std::path::Path;
use stereopsis::camera::StereoSource;
use stereopsis_host::odometry::sequence::Sequence;
use stereopsis_host::real::frame;
use stereopsis_host::recording::Pictures;

fn put(folder: &Path, name: &str, grey: u8) {
    fs::create_dir_all(folder).expect("a folder");
    GrayImage::from_pixel(16, 16, Luma([grey])).save(folder.join(name)).expect("room");
}

/// Left `x9_2` stands before `x10_1`, and right `r_2` after `r_1`: what belongs together has one brightness.
#[test]
fn frames_are_of_the_images_that_belong_together() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let [left, right] = ["left", "right"].map(|side| folder.path().join(side));
    for (side, name, grey) in
        [(&left, "x10_1.png", 1), (&left, "x9_2.png", 2), (&right, "r_1.png", 1), (&right, "r_2.png", 2)]
    {
        put(side, name, grey);
    }
    let sequence = Sequence::open(folder.path()).expect("a sequence");
    let mut pictures = Pictures::open(&left, &right, 10.0).expect("pictures");
    for (index, grey) in [(0, 2), (1, 1)] {
        let (left, right) = sequence.frame(index).expect("a frame");
        assert_eq!((left[(0, 0)].0, right.expect("a right one")[(0, 0)].0), ([grey], [grey]));
        let [left, right] = frame(&mut pictures).expect("a frame");
        assert_eq!((left[(0, 0)].0, right[(0, 0)].0), ([grey], [grey]));
    }
    assert_eq!(pictures.format().height, 16);
}
