//! Every stage equals its twin.

use super::{C, config, detect, matched, rows_aligned};
use image::GrayImage;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use stereopsis::features::{
    Epipolar, FeatureConfig, Level, Match, MatchConfig, Orientation, drop_duplicates, fast_scores,
};
use stereopsis_host::correspond::shrunk;
use stereopsis_host::scene::Random;
use stereopsis_host::scene::pattern::Pattern;
use stereopsis_host::twin::{Picture, features as twin};

const PATTERNS: [Pattern; 10] = [
    Pattern::Constant(0),
    Pattern::Constant(255),
    Pattern::Noise,
    Pattern::Saturated,
    Pattern::FewLevels(3),
    Pattern::Columns(3),
    Pattern::Diagonals(2),
    Pattern::Checkerboard(5),
    Pattern::Ramp(9),
    Pattern::HalfBlank,
];

fn picture(pattern: Pattern, width: u32, height: u32, seed: u64) -> GrayImage {
    pattern.pair(width, height, seed).0
}

/// Compares all features; how many there are.
fn compare(config: &FeatureConfig, image: &GrayImage) -> usize {
    let (core, counts) = detect(config, image);
    let (expected, corners) = twin::features(config, image);
    assert_eq!(core.len(), expected.len(), "{config:?}");
    for (core, twin) in core.iter().zip(&expected) {
        assert_eq!(core, twin, "{config:?}");
    }
    assert_eq!((counts.corners, counts.dropped), (corners, 0), "{config:?}");
    assert_eq!(counts.crowded_out as usize, corners as usize - core.len(), "{config:?}");
    core.len()
}

#[test]
fn scores_of_rows_of_every_width() {
    for pattern in PATTERNS {
        for width in [0, 1, 6, 7, 8, 15, 16, 17, 40] {
            let image = picture(pattern, width.max(1), 7, u64::from(width));
            let rows: Vec<_> =
                image.as_raw().chunks_exact(width.max(1) as usize).map(|r| &r[..width as usize]).collect();
            for threshold in [0, 1, 12, 200, 255] {
                let mut scores = vec![99; width as usize + 2];
                fast_scores(rows.as_slice().try_into().expect("seven"), threshold, &mut scores);
                let twin = Picture::new(&image);
                for (x, &score) in scores.iter().enumerate().take(width as usize) {
                    let inner = x >= 3 && x + 3 < width as usize;
                    let expected = if inner { twin::fast_score(&twin, threshold, x as isize, 3) } else { 0 };
                    assert_eq!(score, expected, "{pattern:?}, column {x} of {width}, threshold {threshold}");
                }
                assert_eq!(scores[width as usize..], [99; 2]);
            }
        }
    }
}

#[test]
fn features_of_pictures_of_awkward_sizes() {
    let mut found = 0;
    for pattern in PATTERNS {
        for (width, height) in [(1, 1), (34, 35), (35, 34), (35, 35), (36, 51), (51, 36), (67, 49), (98, 83)]
        {
            let image = picture(pattern, width, height, 3);
            found += compare(&config(&image), &image);
        }
    }
    assert!(found > 200, "{found} features in all");
}

#[test]
fn shrunk_pictures_of_awkward_sizes() {
    for (width, height) in [(1, 1), (2, 3), (3, 3), (5, 7), (16, 16), (33, 50)] {
        for pattern in [Pattern::Noise, Pattern::Saturated, Pattern::Constant(255)] {
            let image = picture(pattern, width, height, 5);
            for (core, n) in [(shrunk::<2>(&image), 2), (shrunk::<3>(&image), 3), (shrunk::<16>(&image), 16)]
            {
                let twin = twin::shrunk(&image, n);
                // A picture without columns has no rows that could be counted.
                if twin.width() > 0 {
                    assert_eq!(core, twin, "{width}x{height}, {n}");
                } else {
                    assert!(core.as_raw().is_empty());
                }
            }
        }
    }
}

/// A picture and the same with other noise, as features.
fn two_lists(seed: u64, width: u32, height: u32) -> [Vec<stereopsis::features::Feature>; 2] {
    let (left, right) = Pattern::Shifted { most: 9, noise_grey: 3.0 }.pair(width, height, seed);
    [left, right].map(|image| detect(&FeatureConfig { cell_px: 16, per_cell: 3, ..config(&image) }, &image).0)
}

#[test]
fn matches_under_every_search() {
    let [left, mut right] = two_lists(8, 150, 90);
    // Equally good partners, on other levels too.
    right.extend_from_within(..right.len() / 2);
    right.iter_mut().step_by(3).for_each(|feature| feature.level = 2);
    // Rows differ by whole 64ths of a pixel: no distance is so near to these that rounding could decide.
    let along_rows = |tolerance_px| Some(Epipolar { fundamental: rows_aligned(), tolerance_px });
    let every = MatchConfig::new();
    let searches = [
        every,
        MatchConfig { ratio_percent: 100, ..every },
        MatchConfig { ratio_percent: 1, ..every },
        MatchConfig { apart_px: 0.0, ..every },
        MatchConfig { apart_px: 50.0, most_different: 256, ..every },
        MatchConfig { most_different: 0, ..every },
        MatchConfig { levels_apart: 2, ..every },
        MatchConfig { along_px: 5.0, across_px: 0.5, ..every },
        MatchConfig { epipolar: along_rows(0.507), ..every },
        MatchConfig { epipolar: along_rows(0.007), ..every },
    ];
    let mut found = Vec::new();
    for search in searches {
        let core = matched(&left, &right, &search);
        assert_eq!(core, twin::matches(&left, &right, &search), "{search:?}");
        found.push(core.len());
    }
    assert!(found[0] >= 10 && found[2] < found[0] && found[4] > found[0], "{found:?}");
    // With no distance asked for, every other partner competes, but not the best one with itself.
    assert!(found[3] > 0 && found[3] <= found[0], "{found:?}");
    assert_eq!(matched(&left, &[], &every), []);
    assert_eq!(matched(&[], &right, &every), []);
}

#[test]
fn matches_without_repeats() {
    let (left, right) = Pattern::Shifted { most: 9, noise_grey: 3.0 }.pair(150, 90, 8);
    let lists = [left, right].map(|image| {
        let smaller = shrunk::<4>(&image);
        let mut list = detect(&config(&image), &image).0;
        let level = Level::FULL.downsampled::<4>();
        list.extend(detect(&FeatureConfig { level, ..config(&smaller) }, &smaller).0);
        list
    });
    let matches = matched(
        &lists[0],
        &lists[1],
        &MatchConfig { ratio_percent: 100, most_different: 256, ..MatchConfig::new() },
    );
    let mut left_over = Vec::new();
    for apart_px in [f32::NAN, 0.0, 0.5, 1.5, 6.0, 1e9] {
        let mut core = Box::new(heapless::Vec::<Match, 4096>::new());
        core.extend_from_slice(&matches).expect("room for all");
        let dropped = drop_duplicates(&lists[0], &lists[1], core.as_mut_view(), apart_px);
        let expected = twin::without_repeats(&lists[0], &lists[1], &matches, apart_px);
        assert_eq!((&core[..], dropped), (&expected[..], matches.len() - expected.len()), "{apart_px} px");
        left_over.push(core.len());
    }
    assert_eq!([left_over[0], left_over[1], left_over[5]], [matches.len(), matches.len(), 1]);
    assert!(left_over[2] >= left_over[3] && left_over[3] > left_over[4], "{left_over:?}");
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 24,
        rng_seed: RngSeed::Fixed(4),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn any_picture_and_configuration(
        width in 1u32..200, height in 1u32..110, threshold: u8, cell_px in 16u16..70, per_cell in 1u16..8,
        centroid: bool, smooth in 0u32..3, seed: u64,
    ) {
        let noise = picture(*Random::new(seed).pick(&PATTERNS[2..5]), width, height, seed);
        // Larger structures have other directions and fewer corners than noise.
        let image = if smooth == 0 { noise } else { image::imageops::blur(&noise, smooth as f32) };
        let orientation = if centroid { Orientation::Centroid } else { Orientation::Upright };
        let threshold = threshold / 4;
        let config = FeatureConfig {
            threshold, cell_px, per_cell, orientation, level: Level::FULL.downsampled::<3>(), ..config(&image)
        };
        prop_assume!(config.slots() <= C);
        compare(&config, &image);
    }
}
