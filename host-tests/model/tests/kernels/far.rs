//! Searches up to the largest disparities, of which there are twice as many as a number with a sign has.

use super::{Twin, compare, emulated};
use image::{GrayImage, Luma};
use stereopsis::matching::{Block, Checks, Config, Fast, Sgm, SgmEdge, SgmLean};
use stereopsis::pipeline::Pipeline;
use stereopsis::units::{Disparity, PixelFlags};
use stereopsis_model::scene::Random;

/// Columns that have a candidate.
const SEEN: u32 = 160;
const HEIGHT: u32 = 12;

/// A picture of few edges from column `first` on.
fn stripes(first: u32, random: &mut Random) -> GrayImage {
    let mut picture = GrayImage::new(first + SEEN, HEIGHT);
    let mut begin = first;
    while begin < picture.width() {
        let end = (begin + 6 + random.below(34) as u32).min(picture.width());
        let grey = 30 + random.below(180);
        for (y, x) in (0..HEIGHT).flat_map(|y| (begin..end).map(move |x| (y, x))) {
            // Too faint for an edge.
            picture.put_pixel(x, y, Luma([(grey + random.below(2)) as u8]));
        }
        begin = end;
    }
    picture
}

fn refused<S: Twin>() {
    let mut pipeline = Box::new(Pipeline::<S, 2176, 32>::new());
    let steep = Checks {
        left_right_px: Some(1),
        fattening_slope: Disparity::from_raw(u16::MAX - 1),
        ..Checks::DENSE
    };
    let [default, strict] = [S::DEFAULT, S::STRICT];
    for first in if emulated() { &[1008][..] } else { &[0, 992, 1008, 1024, 2015] } {
        let mut untextured = 0;
        for (seed, checks) in
            [steep, Checks { open_margin: 1, ..steep }, default, strict].into_iter().enumerate()
        {
            // Where the right image has edges, answers change without one in the left.
            let mut random = Random::new(seed as u64);
            let (left, others) = (stripes(*first, &mut random), stripes(0, &mut random));
            let mut right = GrayImage::new(left.width(), HEIGHT);
            image::imageops::replace(&mut right, &others, 0, 0);
            let (width, min_disparity) = (left.width() as u16, *first as u16);
            let config =
                Config { min_disparity, checks, ..Config::for_method::<S>(width, HEIGHT as u16, 32) };
            let map = compare(&mut pipeline, &config, &(left, right))
                .unwrap_or_else(|e| panic!("from {first} px on: {e}"));
            let of = |flags: &&PixelFlags| flags.contains(PixelFlags::UNTEXTURED);
            untextured += map.flags.iter().filter(of).count();
        }
        assert!(untextured > 100, "{}, from {first} px on: {untextured}", S::NAME);
    }
}

#[test]
fn checks_at_any_disparity_equal_the_twin() {
    refused::<Fast>();
    refused::<Block>();
    refused::<SgmLean>();
    refused::<Sgm>();
    refused::<SgmEdge>();
}
