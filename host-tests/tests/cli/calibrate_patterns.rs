//! `stereo calibrate` with a pattern that the board has not.

use super::calibrate::{arguments, pictures};
use super::support::Bench;
use image::{Luma, imageops};
use stereopsis_host::scene::Random;

#[test]
fn another_pattern_is_named() {
    let bench = Bench::new();
    pictures(&bench);
    for given in ["5x5", "6x4", "7x5", "7x6"] {
        bench.refused(&arguments(&bench, &[("--pattern", given)]), "6 x 5 inner corners; give --pattern 6x5");
    }
}

/// Where pictures are blurred and noisy, corners of the board are missed, so that a part of it looks like the
/// smaller pattern in as many pictures as name the board.
#[test]
fn another_pattern_is_named_where_a_part_of_the_pictures_fits_it() {
    let bench = Bench::new();
    pictures(&bench);
    let mut random = Random::new(1);
    for (n, side) in (1..=5).flat_map(|n| [(n, "left"), (n, "right")]) {
        let path = bench.path(&format!("{side}{n}.png"));
        let mut picture = imageops::blur(&image::open(&path).expect("a picture").into_luma8(), 2.0);
        for Luma([grey]) in picture.pixels_mut() {
            *grey = (f64::from(*grey) + 6.0 * random.gauss()).round().clamp(0.0, 255.0) as u8;
        }
        picture.save(path).expect("room");
    }
    bench.refused(&arguments(&bench, &[("--pattern", "6x4")]), "10 of 12 images show a board with 6 x 5");
}
