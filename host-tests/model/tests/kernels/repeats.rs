//! Patterns that repeat along the row, whole and broken, with and without noise.

use super::{Twin, compare, emulated, pipeline};
use image::{GrayImage, Luma};
use stereopsis::imaging::Noise;
use stereopsis::matching::{Checks, Config, Filter, Sgm, SgmEdge, SgmLean};
use stereopsis::units::PixelFlags;
use stereopsis_model::scene::Random;

/// A picture of squares that are so many halves of a column wide, with stray columns, moved by `shift`
/// columns.
fn squares(size: (u32, u32), halves: u32, random: &mut Random, noise_grey: usize, shift: u32) -> GrayImage {
    let mut strays = Random::new(7);
    let stray: Vec<bool> = (0..size.0 + shift).map(|_| strays.below(40) == 0).collect();
    GrayImage::from_fn(size.0, size.1, |x, y| {
        let x = x + shift;
        let is_bright = (2 * x / halves + y / 6) % 2 == 1 || (stray[x as usize] && y / 15 % 2 == 0);
        let noise = random.below(2 * noise_grey + 1);
        Luma([(if is_bright { 170 } else { 60 } + noise) as u8])
    })
}

fn refused<S: Twin>() {
    let mut pipeline = pipeline::<S>();
    let mut random = Random::new(1967);
    let (mut ambiguous, mut clear) = (0, 0);
    let cases = if emulated() { 12 } else { 90 };
    for case in 0..cases {
        let (width, height) = (20 + random.below(260) as u32, 1 + random.below(40) as u32);
        let (halves, noise_grey) = (5 + random.below(60) as u32, *random.pick(&[0, 0, 4, 20]));
        let shift = random.below(12) as u32;
        let left = squares((width, height), halves, &mut random, noise_grey, 0);
        let right = squares((width, height), halves, &mut random, noise_grey, shift);
        let config = Config {
            min_disparity: *random.pick(&[0, 0, 3]),
            noise: *random.pick(&[Noise::None, Noise::Low, Noise::High]),
            confidence: random.below(2) == 1,
            min_confidence: *random.pick(&[0, 0, 40]),
            ..Config::for_method::<Sgm>(width as u16, height as u16, *random.pick(&[16, 32, 64]))
        };
        let config = config.with_filter::<Sgm>(*random.pick(&[Filter::Default, Filter::Strict]));
        let checks = Checks { uniqueness_percent: None, ..config.checks };
        let map = compare(&mut pipeline, &Config { checks, ..config }, &(left, right))
            .unwrap_or_else(|e| panic!("case {case}: {e}"));
        let count = map.flags.iter().filter(|flags| flags.contains(PixelFlags::AMBIGUOUS)).count();
        ambiguous += count;
        clear += map.flags.len() - count;
    }
    let least = 220 * cases;
    assert!(ambiguous > least && clear > least, "{ambiguous} ambiguous, {clear} not");
}

#[test]
fn patterns_that_repeat_equal_the_twin() {
    refused::<Sgm>();
    refused::<SgmLean>();
    refused::<SgmEdge>();
}

#[test]
fn a_search_may_begin_beyond_the_row() {
    let mut pipeline = pipeline::<Sgm>();
    let picture = squares((50, 12), 12, &mut Random::new(0), 0, 0);
    for min_disparity in [49, 50, 60] {
        let config = Config { min_disparity, ..Config::for_method::<Sgm>(50, 12, 32) };
        compare(&mut pipeline, &config, &(picture.clone(), picture.clone()))
            .unwrap_or_else(|e| panic!("from {min_disparity} px on: {e}"));
    }
}
