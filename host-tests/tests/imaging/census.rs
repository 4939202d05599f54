//! The core's census rows against the twin's, at all small widths and heights.

use image::GrayImage;
use stereopsis::imaging::{LineWindow, Noise, census_plus4, census_ring8, census_wide8};
use stereopsis_host::scene::Random;
use stereopsis_host::scene::pattern::Pattern;
use stereopsis_host::twin::Picture;
use stereopsis_host::twin::census::{PLUS4, RING8, WIDE8, census};
use stereopsis_host::twin::smooth::Seen;

const WIDEST: usize = 140;

/// All three codes of the whole picture, each as 32 bits, through the core's line window.
fn core_census(image: &GrayImage) -> [Vec<u32>; 3] {
    let (width, height) = (image.width() as usize, image.height() as usize);
    let mut window = LineWindow::<WIDEST>::new();
    window.begin(width);
    let mut lines = image.as_raw().chunks_exact(width);
    let mut codes = [Vec::new(), Vec::new(), Vec::new()];
    for y in 0..height {
        while window.count() < (y + 3).min(height) {
            window.next_line().copy_from_slice(lines.next().expect("a line for every count"));
            window.accept();
        }
        let rows = window.around(y);
        // What was in the buffer must not shine through, and what lies behind the line must stay.
        let (mut plus, mut ring, mut wide) = ([0xa5_u8; WIDEST], [0x5a_u8; WIDEST], [0x96_u8; WIDEST]);
        census_plus4(&rows, &mut plus);
        census_ring8(&rows, &mut ring);
        census_wide8(&rows, &mut wide);
        assert!(plus[width..].iter().all(|&c| c == 0xa5));
        assert!(ring[width..].iter().all(|&c| c == 0x5a));
        assert!(wide[width..].iter().all(|&c| c == 0x96));
        codes[0].extend(plus[..width].iter().map(|&c| u32::from(c)));
        codes[1].extend(ring[..width].iter().map(|&c| u32::from(c)));
        codes[2].extend(wide[..width].iter().map(|&c| u32::from(c)));
    }
    codes
}

fn compare(image: &GrayImage, what: &str) -> [Vec<u32>; 3] {
    let picture = Seen::new(Picture::new(image), Noise::None);
    let core = core_census(image);
    let twins = [&PLUS4[..], &RING8, &WIDE8].map(|neighbours| census(&picture, neighbours));
    for ((core, twin), name) in core.iter().zip(&twins).zip(["plus4", "ring8", "wide8"]) {
        let (width, height) = image.dimensions();
        let at = core.iter().zip(twin).position(|(a, b)| a != b);
        assert_eq!(at, None, "{name}, {what}, {width} x {height}: codes differ first at this place");
        assert_eq!(core.len(), twin.len());
    }
    core
}

#[test]
fn all_widths_and_heights() {
    for width in 1..=WIDEST as u32 {
        for height in 1..=12 {
            let (left, _) = Pattern::Noise.pair(width, height, u64::from(width * 100 + height));
            compare(&left, "noise");
        }
    }
}

#[test]
fn extremes_and_ties() {
    let patterns = [
        Pattern::Constant(0),
        Pattern::Constant(255),
        Pattern::Saturated,
        Pattern::FewLevels(3),
        Pattern::Columns(1),
        Pattern::Columns(2),
        Pattern::Rows(2),
        Pattern::Checkerboard(1),
        Pattern::Checkerboard(2),
        Pattern::Diagonals(2),
        Pattern::Ramp(1),
        Pattern::Ramp(29),
    ];
    for pattern in patterns {
        for (width, height) in [(1, 1), (2, 3), (5, 5), (16, 9), (33, 7), (140, 20)] {
            let codes = compare(&pattern.pair(width, height, 5).0, &format!("{pattern:?}"));
            if let Pattern::Constant(_) = pattern {
                assert!(
                    codes.iter().flatten().all(|&code| code == 0),
                    "nothing is darker in a constant picture"
                );
            }
        }
    }
}

#[test]
fn borders_of_short_lines_in_black_and_white() {
    // No line here is longer than what a code looks at to both sides and a group: every column is beside an
    // end.
    for (width, seed) in (1..=10).flat_map(|width| (0..200).map(move |seed| (width, seed))) {
        compare(&Pattern::Saturated.pair(width, 5, seed).0, &format!("black and white, seed {seed}"));
    }
}

#[test]
fn neighbours_one_grey_level_apart_are_reported_apart_everywhere_in_the_range() {
    // A signed or saturating comparison would fail at one of the steps.
    for grey in 0..255 {
        for (low, high) in [(grey, grey + 1), (0, grey + 1), (grey, 255)] {
            let image =
                GrayImage::from_fn(9, 7, |x, y| image::Luma([if (x + 2 * y) % 3 == 0 { low } else { high }]));
            let codes = compare(&image, &format!("{low} and {high}"));
            assert!(codes[2].iter().any(|&code| code != 0));
        }
    }
}

#[test]
fn brightness_and_contrast_do_not_matter() {
    let mut random = Random::new(8);
    let dark = GrayImage::from_fn(40, 11, |_, _| image::Luma([random.byte() / 4]));
    let bright = GrayImage::from_fn(40, 11, |x, y| image::Luma([dark.get_pixel(x, y).0[0] * 3 + 60]));
    assert_eq!(core_census(&dark), core_census(&bright));
}

#[test]
fn rows_and_buffers_of_unequal_length_are_taken_as_far_as_all_go() {
    let row: Vec<u8> = (0..20).map(|i| i * 7 % 13).collect();
    let mut codes = [9; 20];
    census_ring8(&[&row, &row, &row[..12], &row, &row], &mut codes);
    let mut expected = [0; 12];
    census_ring8(&[&row[..12]; 5], &mut expected);
    assert_eq!(codes[..12], expected);
    assert_eq!(codes[12..], [9; 8]);
    census_ring8(&[&row, &row, &row, &[], &row], &mut codes);
    assert_eq!(codes[..12], expected, "without a pixel nothing is written");
}
