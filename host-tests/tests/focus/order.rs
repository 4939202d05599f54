//! Frames out of order, spoiled frames, and what is no focus stack.

use crate::stacks::usual;
use image::{GrayImage, Luma};
use stereopsis_host::focus::evaluation;
use stereopsis_host::focus::order::{Look, Order, order, restlessness};
use stereopsis_host::scene::{MovingScene, Random};

fn looks(frames: &[GrayImage]) -> Vec<Look> {
    frames.iter().map(Look::new).collect()
}

#[test]
fn a_stack_is_one() {
    let (_, frames) = usual();
    assert_eq!(order(&looks(frames)), Order::Stack(Vec::new()));
    // Backwards, and half of it.
    let mut back = frames.clone();
    back.reverse();
    assert_eq!(order(&looks(&back)), Order::Stack(Vec::new()));
    assert_eq!(order(&looks(&frames[..12])), Order::Stack(Vec::new()));
}

#[test]
fn a_noisy_stack_is_one() {
    for stack in evaluation::stacks() {
        assert_eq!(order(&looks(&stack.frames(10.0))), Order::Stack(Vec::new()), "{}", stack.name);
    }
}

#[test]
fn a_frame_in_the_wrong_place_is_named() {
    let (_, frames) = usual();
    for (from, to) in [(18, 5), (4, 20), (12, 16)] {
        let mut moved = frames.clone();
        let frame = moved.remove(from);
        moved.insert(to, frame);
        assert_eq!(order(&looks(&moved)), Order::Stack(vec![to]), "{from} {to}");
    }
}

#[test]
fn a_spoiled_frame_is_named() {
    let (_, frames) = usual();
    let mut random = Random::new(5);
    let (width, height) = frames[0].dimensions();
    let noise = GrayImage::from_fn(width, height, |_, _| Luma([random.byte()]));
    let stray = MovingScene::street(width as u16, height as u16, 1, 0.5, 7).frame(0).0;
    for spoiled in [GrayImage::new(width, height), noise, stray] {
        for place in [0, 9, frames.len() - 1] {
            let mut all = frames.clone();
            all[place] = spoiled.clone();
            assert_eq!(order(&looks(&all)), Order::Stack(vec![place]));
        }
    }
}

#[test]
fn a_drive_is_no_stack() {
    let drive = MovingScene::street(160, 80, 50, 0.7, 7).with_noise(2.0);
    let frames: Vec<_> = (0..50).map(|i| drive.frame(i).0).collect();
    let (drive, stack) = (restlessness(&looks(&frames)), restlessness(&looks(&usual().1)));
    println!("a drive is restless by {drive:?}, a stack by {stack:?}");
    assert_eq!(order(&looks(&frames)), Order::None, "{drive:?} {stack:?}");
}
