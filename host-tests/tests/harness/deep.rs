//! Frames with 16 bits a sample: one number of bits is significant in a whole stack or sequence.

use image::{ImageBuffer, Luma};
use std::fs;
use std::path::Path;
use stereopsis_host::focus::stack::Stack;
use stereopsis_host::mock::{MockCamera, significant_bits};
use stereopsis_host::odometry::sequence::Sequence;

/// A frame of samples of 1000, with one brighter.
fn put(folder: &Path, name: &str, brightest: u16) {
    fs::create_dir_all(folder).expect("a folder");
    let samples = |x, _| Luma([if x == 3 { brightest } else { 1000 }]);
    ImageBuffer::<Luma<u16>, _>::from_fn(16, 16, samples).save(folder.join(name)).expect("room");
}

#[test]
fn frames_of_a_stack_are_equally_bright() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, brightest) in [("1.png", 2000), ("2.tif", 2047), ("3.png", 2048), ("4.pgm", 1000)] {
        put(folder.path(), name, brightest);
    }
    let stack = Stack::open(folder.path()).expect("a stack");
    for frame in 0..4 {
        let frame = stack.frame(frame).expect("a frame");
        // 12 bits are significant: 16 steps are a level.
        assert_eq!((frame.grey[(0, 0)].0, frame.colours[(0, 0)].0), ([62], [62; 3]));
    }
    assert_eq!(stack.frame(2).expect("a frame").grey[(3, 0)].0, [128]);
}

#[test]
fn frames_of_a_sequence_are_equally_bright_left_and_right() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (frame, left, right) in [(0, 1000, 1000), (1, 1000, 5000), (2, 1500, 1000)] {
        put(&folder.path().join("left"), &format!("{frame}.png"), left);
        put(&folder.path().join("right"), &format!("{frame}.png"), right);
    }
    let sequence = Sequence::open(folder.path()).expect("a sequence");
    for frame in 0..3 {
        let (left, right) = sequence.frame(frame).expect("a frame");
        // 13 bits are significant: 32 steps are a level.
        assert_eq!((left[(0, 0)].0, right.expect("a right one")[(0, 0)].0), ([31], [31]));
    }
}

#[test]
fn images_of_8_bits_have_no_significant_ones_of_16() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let [shallow, text] = ["shallow.png", "text.png"].map(|name| folder.path().join(name));
    image::GrayImage::new(16, 16).save(&shallow).expect("room");
    fs::write(&text, b"no image").expect("room");
    assert_eq!(significant_bits(&[shallow.clone(), text, folder.path().into()]), None);
    let camera = MockCamera::open(&shallow).expect("a camera").with_bits(Some(12));
    assert_eq!(camera.grey_picture(), image::GrayImage::new(16, 16));
}
