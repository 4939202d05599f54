//! A configuration for cameras with noise, told from C, is that of `with_filter`.

use super::*;
use stereopsis::ffi::{
    STEREOPSIS_NOISE_HIGH, STEREOPSIS_NOISE_NONE, STEREOPSIS_PRESET_DENSE, STEREOPSIS_PRESET_STRICT,
    config_noise,
};
use stereopsis::matching::{Fast, Filter, Sgm, SgmEdge, SgmLean};

const PRESETS: [(i32, Filter); 3] = [
    (STEREOPSIS_PRESET_DENSE, Filter::Dense),
    (STEREOPSIS_PRESET_DEFAULT, Filter::Default),
    (STEREOPSIS_PRESET_STRICT, Filter::Strict),
];
const LEVELS: [(u8, Noise); 3] = [
    (STEREOPSIS_NOISE_NONE, Noise::None),
    (STEREOPSIS_NOISE_LOW, Noise::Low),
    (STEREOPSIS_NOISE_HIGH, Noise::High),
];

/// A configuration in which every field is another than any preset's.
fn odd(width: u16, height: u16) -> CConfig {
    CConfig {
        width,
        height,
        disparities: 24,
        min_disparity: 2,
        left_right_px: 77,
        uniqueness_percent: 77,
        texture_gradient: 77,
        texture_pixels: 77,
        refuse_ceiling: 77,
        refuse_flat: 77,
        smoothing_radius: 77,
        median: 77,
        surface_step: 77,
        speckle_pixels: 77,
        gradient: 77,
        cost: 77,
        step: [77; 2],
        jump: [77; 3],
        edges: [77; 2],
        fill_pixels: 77,
        fill_step: 77,
        confidence: 77,
        noise: 77,
        speckle_run: 77,
        fattening_slope: 77,
        min_confidence: 77,
        open_run: 77,
        open_margin: 77,
        refuse_repeats: 77,
    }
}

/// The rows with every preset and level of a method, which are those of the pipeline in Rust.
fn rows_of<S: Method>() -> Vec<Vec<Found>> {
    let (width, height) = (70, 40);
    let lines = lines(width, height);
    let search = matching::Config {
        min_disparity: 2,
        confidence: true,
        min_confidence: 77,
        ..matching::Config::for_method::<matching::Block>(width, height, 24)
    };
    let mut all = Vec::new();
    for (preset, filter) in PRESETS {
        for (number, noise) in LEVELS {
            let mut config = odd(width, height);
            // SAFETY: the pointer is to a configuration.
            assert_eq!(unsafe { config_noise::<S>(preset, number, &raw mut config) }, Status::Ok);
            assert_eq!(
                (config.min_disparity, config.confidence, config.noise),
                (2, 77, number),
                "kept, and set"
            );
            let asked = matching::Config { noise, ..search }.with_filter::<S>(filter);
            let found = c_rows::<S>(&config, &lines);
            assert!(found == rows::<S>(&asked, &lines), "{}, {filter:?}, {noise:?}", S::NAME);
            all.push(found);
        }
    }
    all
}

#[test]
fn rows_for_cameras_with_noise_are_those_of_with_filter() {
    for all in
        [rows_of::<Sgm>(), rows_of::<SgmEdge>(), rows_of::<SgmLean>(), rows_of::<Block>(), rows_of::<Fast>()]
    {
        assert!(all.chunks(LEVELS.len()).all(|levels| levels[0] != levels[1]), "noise makes a difference");
        assert!(all.chunks(LEVELS.len()).is_sorted_by(|a, b| a != b), "presets do");
    }
    let levels = &rows_of::<Sgm>()[3..];
    assert!(levels[1] != levels[2], "so does how much noise");
}

#[test]
fn without_noise_it_is_the_default() {
    for (preset, _) in PRESETS {
        let [mut wanted, mut found] = [odd(WIDTH as u16, 30); 2];
        (found.min_disparity, found.disparities, found.confidence, found.min_confidence) = (0, 32, 0, 0);
        // SAFETY: the pointers are to configurations.
        unsafe {
            assert_eq!(stereopsis_config_default(WIDTH as u16, 30, 32, preset, &raw mut wanted), Status::Ok);
            assert_eq!(stereopsis_config_noise(preset, STEREOPSIS_NOISE_NONE, &raw mut found), Status::Ok);
        }
        assert_eq!(found, wanted);
    }
}

#[test]
fn what_is_no_preset_or_no_noise_changes_nothing() {
    let before = odd(50, 30);
    let mut config = before;
    // SAFETY: the pointer is to a configuration, or null.
    let mut tell = |preset, noise| unsafe { stereopsis_config_noise(preset, noise, &raw mut config) };
    assert_eq!(tell(3, STEREOPSIS_NOISE_LOW), Status::Preset);
    assert_eq!(tell(-1, 3), Status::Preset);
    assert_eq!(tell(STEREOPSIS_PRESET_DENSE, 3), Status::Noise);
    assert_eq!(tell(STEREOPSIS_PRESET_STRICT, 255), Status::Noise);
    assert_eq!(config, before);
    // SAFETY: as above.
    assert_eq!(unsafe { stereopsis_config_noise(3, 3, null_mut()) }, Status::Null);
}
