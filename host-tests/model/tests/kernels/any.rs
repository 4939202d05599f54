//! Any combination of sizes, ranges, pictures, checks and penalties.

use super::list::{PATTERNS, random_penalties};
use super::{compare, emulated, pipeline};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use stereopsis::imaging::Noise;
use stereopsis::matching::{Block, Checks, Config, Fast, Sgm, SgmEdge, SgmLean};
use stereopsis::units::Disparity;
use stereopsis_model::scene::Random;
use stereopsis_model::scene::pattern::Pattern;

prop_compose! {
    fn any_checks()(
        left_right_px in proptest::option::of(0u8..6),
        uniqueness_percent in proptest::option::of(0u8..100),
        refuse_flat: bool,
        texture_gradient in 0u8..60,
        texture_pixels in 0u8..90,
        refuse_ceiling: bool,
        smoothing_radius in 0..=Checks::MOST_SMOOTHING,
        speckle_pixels: u8,
        surface_step in (0u16..=32).prop_map(Disparity::from_raw),
        median: bool,
        fill_pixels: u8,
        fill_step in any::<u16>().prop_map(Disparity::from_raw),
        speckle_run: u8,
        fattening_slope in prop_oneof![0u16..200, Just(u16::MAX)].prop_map(Disparity::from_raw),
        open_run in prop_oneof![Just(0u8), 1u8..20, any::<u8>()],
        open_margin in prop_oneof![Just(0u8), 1u8..=127],
        refuse_repeats: bool,
    ) -> Checks {
        Checks {
            left_right_px, uniqueness_percent, refuse_flat, texture_gradient, texture_pixels, refuse_ceiling,
                smoothing_radius,
            speckle_pixels, surface_step, median, fill_pixels, fill_step,
            speckle_run, fattening_slope, open_run, open_margin, refuse_repeats,
        }
    }
}

prop_compose! {
    pub(super) fn any_config()(
        width in 1u16..=300, height in 1u16..=60, disparities in 16u16..=256, min_disparity in 0u16..60,
        checks in any_checks(), confidence: bool,
            min_confidence in proptest::sample::select(&[0, 0, 1, 2, 60, 130, 207][..]),
        noise in proptest::sample::select(&Noise::ALL[..]), seed: u64,
    ) -> Config {
        let penalties = random_penalties(&mut Random::new(seed));
        let search = Config::for_method::<Block>(width, height, disparities);
        Config { min_disparity, checks, penalties, confidence, min_confidence, noise, ..search }
    }
}

pub(super) fn any_pattern() -> impl Strategy<Value = Pattern> {
    prop_oneof![
        2 => (0usize..80, 0.0..12.0).prop_map(|(most, noise_grey)| Pattern::Shifted { most, noise_grey }),
        1 => proptest::sample::select(&PATTERNS[..]),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: if emulated() { 2 } else { 60 },
        rng_seed: RngSeed::Fixed(4),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn any_combination_equals_the_twin(config in any_config(), pattern in any_pattern(), seed: u64) {
        let pair = pattern.pair(u32::from(config.width), u32::from(config.height), seed);
        for compared in [
            compare::<Fast, _, _>(&mut pipeline(), &config, &pair),
            compare::<Block, _, _>(&mut pipeline(), &config, &pair),
            compare::<SgmLean, _, _>(&mut pipeline(), &config, &pair),
            compare::<Sgm, _, _>(&mut pipeline(), &config, &pair),
            compare::<SgmEdge, _, _>(&mut pipeline(), &config, &pair),
        ] {
            if let Err(e) = compared {
                prop_assert!(false, "{pattern:?}: {e}");
            }
        }
    }
}
