//! Every kind of picture, rendered scenes, and what looks beyond a row: gaps, medians and surfaces.

use super::list::PATTERNS;
use super::{Any, Twin, W, compare, emulated, long, pipeline};
use image::{GrayImage, Luma};
use stereopsis::matching::{Block, Checks, Config, Fast, Sgm, SgmEdge, SgmLean};
use stereopsis::units::{Disparity, PixelFlags};
use stereopsis_model::scene::Scene;
use stereopsis_model::scene::pattern::Pattern;
use stereopsis_model::twin::match_pair;

/// Checks of which every stage does something.
const ALL_STAGES: Checks =
    Checks { median: true, fill_pixels: 16, fill_step: Disparity::NONE, ..Checks::STRICT };

/// Every picture with each of the ready-made checks, at a size that has all kinds of borders.
fn every_pattern<S: Twin>() {
    let mut pipeline = pipeline::<S>();
    for (i, pattern) in PATTERNS.into_iter().enumerate() {
        let pair = pattern.pair(71, 22, i as u64);
        let mut presets = [Checks::DENSE, Checks::DEFAULT, Checks::STRICT, ALL_STAGES];
        presets.rotate_left(i % 4);
        for checks in long(presets, 4) {
            let config = Config { checks, confidence: true, ..Config::for_method::<Block>(71, 22, 32) };
            compare(&mut pipeline, &config, &pair).unwrap_or_else(|e| panic!("{pattern:?}: {e}"));
        }
    }
}

#[test]
fn every_pattern_with_every_preset() {
    every_pattern::<Fast>();
    every_pattern::<Block>();
    every_pattern::<SgmLean>();
    every_pattern::<Sgm>();
    every_pattern::<SgmEdge>();
}

fn rendered<S: Twin>(pipeline: &mut Any<S>, scene: &Scene, pair: &(GrayImage, GrayImage)) {
    for checks in long([ALL_STAGES, Checks::DENSE, Checks::DEFAULT, Checks::STRICT], 4) {
        for min_disparity in long([5, 0], 2) {
            let config = Config {
                checks,
                min_disparity,
                confidence: true,
                ..Config::for_method::<Block>(scene.width(), scene.height(), scene.disparities())
            };
            let map = compare(pipeline, &config, pair).unwrap_or_else(|e| panic!("{e}"));
            let answers = map.disparity.iter().filter(|d| d.is_some()).count();
            assert!(answers * 3 > map.disparity.len(), "{answers} answers");
        }
    }
}

#[test]
fn a_rendered_scene_equals_the_twin() {
    let scene = if emulated() { Scene::small(120, 90) } else { Scene::small(200, 150) };
    let pair = scene.render();
    rendered::<Fast>(&mut pipeline(), &scene, &pair);
    rendered::<Block>(&mut pipeline(), &scene, &pair);
    rendered::<SgmLean>(&mut pipeline(), &scene, &pair);
    rendered::<Sgm>(&mut pipeline(), &scene, &pair);
    rendered::<SgmEdge>(&mut pipeline(), &scene, &pair);
}

/// The median and the filling at every width around that of a group of lanes, and every height around that of
/// the band; gaps of all lengths around those that are filled.
fn filtered<S: Twin>() {
    let mut pipeline = pipeline::<S>();
    // Such that gaps are many and short.
    let gaps = Checks { uniqueness_percent: Some(20), speckle_pixels: 4, ..Checks::DEFAULT };
    let (mut filled, mut moved) = (0, 0);
    for (width, height) in (1..=40).flat_map(|width| [1, 2, 3, 5, 6, 9].map(|height| (width, height))) {
        let pair = Pattern::Shifted { most: 9, noise_grey: 9.0 }.pair(width, height, u64::from(width));
        let config = |checks| Config {
            checks,
            confidence: true,
            ..Config::for_method::<Block>(width as u16, height as u16, 16)
        };
        let plain = match_pair(&S::TWIN, &config(gaps), &pair.0, &pair.1);
        let mut stages = [(true, 2), (false, 1), (true, u8::MAX), (false, 5), (true, 0)];
        stages.rotate_left((width + height) as usize % 5);
        for (median, fill_pixels) in long(stages, 2) {
            let fill_step = if fill_pixels > 1 { Disparity::NONE } else { Disparity::ONE_PIXEL };
            let checks = Checks { median, fill_pixels, fill_step, ..gaps };
            let map = compare(&mut pipeline, &config(checks), &pair).unwrap_or_else(|e| panic!("{e}"));
            for (i, (flags, disparity)) in map.flags.iter().zip(&map.disparity).enumerate() {
                filled += usize::from(flags.contains(PixelFlags::FILLED));
                moved += usize::from(plain.disparity[i].is_some() && *disparity != plain.disparity[i]);
            }
        }
    }
    assert!(filled > 100 && moved > 1000, "{filled} filled, {moved} moved");
}

#[test]
fn median_and_filling_equal_the_twins_at_all_borders() {
    filtered::<Fast>();
    filtered::<Block>();
    filtered::<Sgm>();
    filtered::<SgmEdge>();
}

/// One surface over the whole picture, against thresholds around its size and around the powers of two.
fn whole_surface<S: Twin>() {
    let mut pipeline = pipeline::<S>();
    let same = Pattern::Shifted { most: 0, noise_grey: 0.0 }.pair(W as u32, 60, 1);
    for speckle_pixels in long([128, 127, 129, 255, 254], 5) {
        let checks = Checks { speckle_pixels, ..Checks::DENSE };
        let config = Config { checks, ..Config::for_method::<Block>(W as u16, 60, 16) };
        compare(&mut pipeline, &config, &same).unwrap_or_else(|e| panic!("{e}"));
    }
}

#[test]
fn surfaces_of_any_size_are_counted() {
    whole_surface::<Fast>();
    whole_surface::<Block>();
    whole_surface::<SgmLean>();
    whole_surface::<Sgm>();
    whole_surface::<SgmEdge>();
}

/// A wall whose disparity is beside the ends of words of candidates: its neighbours are in other words.
fn wall_at_ends_of_words<S: Twin>() {
    let mut pipeline = pipeline::<S>();
    let texture = Pattern::Noise.pair(288, 12, 5).0;
    for (disparities, shift) in [(32, 15), (32, 16), (64, 31), (64, 32), (128, 63), (128, 64), (128, 96)] {
        let seen = |by: u32| GrayImage::from_fn(160, 12, |x, y| Luma([texture.get_pixel(x + by, y).0[0]]));
        let config = Config { checks: Checks::DENSE, ..Config::for_method::<S>(160, 12, disparities) };
        let map = compare(&mut pipeline, &config, &(seen(0), seen(shift))).unwrap_or_else(|e| panic!("{e}"));
        let near = |answer: &&Disparity| answer.to_f32().is_some_and(|px| (px - shift as f32).abs() < 0.6);
        assert!(map.disparity.iter().filter(near).count() > 500, "{shift} px");
    }
}

#[test]
fn winners_have_their_neighbours_in_other_words() {
    wall_at_ends_of_words::<Fast>();
    wall_at_ends_of_words::<Block>();
    wall_at_ends_of_words::<Sgm>();
}
