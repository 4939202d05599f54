//! All sizes, ranges, pictures and checks.

use super::{HALVES, Twin, W, compare, compare_with, emulated, pipeline};
use std::collections::BTreeSet;
use stereopsis::imaging::Noise;
use stereopsis::matching::{Block, Checks, Config, Fast, Penalties, Row, Sgm, SgmEdge, SgmLean};
use stereopsis::pipeline::Pipeline;
use stereopsis::units::{Disparity, PixelFlags};
use stereopsis_model::scene::Random;
use stereopsis_model::scene::pattern::Pattern;

/// The values of the deterministic list: every one of each is used.
fn widths() -> Vec<u16> {
    let awkward = [
        47, 48, 49, 63, 64, 65, 79, 100, 127, 128, 129, 255, 256, 257, 319, 320, 321, 639, 640, 641, 699,
        700, 704,
    ];
    (1..=40).chain(awkward).collect()
}

fn heights() -> Vec<u16> {
    (1..=20).chain([23, 31, 32, 33, 40, 59, 60]).collect()
}

const DISPARITIES: [u16; 13] = [16, 17, 31, 32, 33, 48, 63, 64, 100, 127, 128, 255, 256];
const MIN_DISPARITIES: [u16; 7] = [0, 0, 1, 7, 40, 0, 705];

pub(super) const PATTERNS: [Pattern; 31] = [
    Pattern::Noise,
    Pattern::Constant(0),
    Pattern::Shifted { most: 20, noise_grey: 0.0 },
    Pattern::Constant(127),
    Pattern::Columns(1),
    Pattern::Shifted { most: 9, noise_grey: 3.0 },
    Pattern::Columns(2),
    Pattern::Columns(5),
    Pattern::Shifted { most: 60, noise_grey: 8.0 },
    Pattern::Columns(16),
    Pattern::Rows(1),
    Pattern::Saturated,
    Pattern::Rows(3),
    Pattern::Shifted { most: 14, noise_grey: 20.0 },
    Pattern::Diagonals(1),
    Pattern::Diagonals(3),
    Pattern::Shifted { most: 255, noise_grey: 0.0 },
    Pattern::Diagonals(8),
    Pattern::Checkerboard(1),
    Pattern::HalfBlank,
    Pattern::Checkerboard(2),
    Pattern::Checkerboard(7),
    Pattern::Shifted { most: 3, noise_grey: 1.0 },
    Pattern::Ramp(1),
    Pattern::Ramp(4),
    Pattern::FewLevels(2),
    Pattern::Ramp(37),
    Pattern::Shifted { most: 31, noise_grey: 2.0 },
    Pattern::FewLevels(3),
    Pattern::Constant(255),
    Pattern::Shifted { most: 100, noise_grey: 1.0 },
];

/// Checks chosen by chance, the extremes among them; what they ask of surfaces by another.
fn random_checks(random: &mut Random, of_surfaces: &mut Random) -> Checks {
    Checks {
        left_right_px: *random.pick(&[None, Some(0), Some(1), Some(2), Some(9), Some(255)]),
        uniqueness_percent: *random.pick(&[None, Some(0), Some(1), Some(5), Some(15), Some(60), Some(99)]),
        refuse_flat: random.below(2) == 1,
        texture_gradient: *random.pick(&[0, 1, 2, 10, 80, 255]),
        texture_pixels: *random.pick(&[0, 1, 3, 20, 63, 81, 255]),
        refuse_ceiling: random.below(2) == 1,
        smoothing_radius: random.below(usize::from(Checks::MOST_SMOOTHING) + 1) as u8,
        speckle_pixels: *random.pick(&[0, 1, 2, 5, 40, 100, 254, u8::MAX]),
        surface_step: Disparity::from_raw(*random.pick(&[0, 1, 2, 16, 31, 32])),
        median: random.below(2) == 1,
        fill_pixels: *random.pick(&[0, 1, 2, 3, 16, 40, u8::MAX]),
        fill_step: Disparity::from_raw(*random.pick(&[0, 1, 32, 100, u16::MAX])),
        speckle_run: *of_surfaces.pick(&[0, 1, 2, 15, 100, u8::MAX]),
        fattening_slope: Disparity::from_raw(*of_surfaces.pick(&[
            0,
            1,
            16,
            24,
            100,
            9000,
            u16::MAX,
            u16::MAX,
        ])),
        open_run: *of_surfaces.pick(&[0, 1, 5, u8::MAX]),
        open_margin: *of_surfaces.pick(&[0, 0, 1, 40, 126, 127]),
        refuse_repeats: of_surfaces.below(2) == 1,
    }
}

/// Penalties chosen by chance, of those that there can be.
pub(super) fn random_penalties(random: &mut Random) -> Penalties {
    let cost = 1 + random.below(40) as u8;
    let step = 1 + random.below(usize::from((126 - cost) / 2)) as u8;
    // Cost + step + jump at most 127, three costs and two jumps at most 254.
    let most = (127 - cost - step).min((254 - 3 * cost) / 2).max(step);
    let step = step.min(most);
    let step = [step, 1 + random.below(usize::from(step)) as u8];
    let mut jump = |least: u8| least + random.below(usize::from(most - least) + 1) as u8;
    let jump = [jump(step[0]), jump(step[1]), jump(step[1])];
    let edge = random.below(256) as u8;
    let edges = [edge, edge.saturating_add(random.below(60) as u8)];
    Penalties {
        gradient: 1 + random.below(usize::from(Penalties::MOST_GRADIENT)) as u8,
        cost,
        step,
        jump,
        edges,
    }
}

/// The deterministic list: every width with `rounds` choices of the rest.
fn list(rounds: usize) -> Vec<(Config, Pattern, u64)> {
    let (widths, heights) = (widths(), heights());
    let (mut random, mut of_surfaces) = (Random::new(2011), Random::new(1985));
    let mut cases = Vec::new();
    for i in 0..rounds * widths.len() {
        // The lists' lengths have no common factor with the steps, so all values of each come up in turn.
        let width = widths[i % widths.len()];
        let height = heights[i * 5 % heights.len()];
        let checks = match i % 5 {
            0 => Checks::DENSE,
            1 => Checks::DEFAULT,
            2 => Checks::STRICT,
            _ => random_checks(&mut random, &mut of_surfaces),
        };
        let penalties = if i % 3 == 0 { Penalties::DEFAULT } else { random_penalties(&mut random) };
        let config = Config {
            min_disparity: MIN_DISPARITIES[i * 3 % MIN_DISPARITIES.len()],
            checks,
            penalties,
            confidence: i % 4 > 0,
            min_confidence: [0, 0, 90, 0, 0, 0, 140][i % 7],
            noise: [Noise::None, Noise::Low, Noise::None, Noise::High][i / 2 % 4],
            ..Config::for_method::<Block>(width, height, DISPARITIES[i * 4 % DISPARITIES.len()])
        };
        cases.push((config, PATTERNS[i * 2 % PATTERNS.len()], random.bits()));
    }
    cases
}

fn run_list<S: Twin>() {
    // Each value of each list comes up in the first round.
    let (rounds, fewest, kinds_of_confidence) = if emulated() { (1, 5_000, 100) } else { (4, 100_000, 150) };
    let cases = list(rounds);
    let mut pipeline = pipeline::<S>();
    let mut of_halves = Box::new(Pipeline::<S, W, HALVES>::new());
    let (mut answers, mut flags, mut confidences) = (0, PixelFlags::CLEAR, [false; 256]);
    for (config, pattern, seed) in &cases {
        let pair = pattern.pair(u32::from(config.width), u32::from(config.height), *seed);
        let map = compare(&mut pipeline, config, &pair).unwrap_or_else(|e| panic!("{pattern:?}: {e}"));
        if usize::from(config.disparities) <= HALVES {
            compare_with(&map, &mut of_halves, config, &pair)
                .unwrap_or_else(|e| panic!("capacity {HALVES}: {pattern:?}: {e}"));
        }
        answers += map.disparity.iter().filter(|d| d.is_some()).count();
        flags = map.flags.iter().fold(flags, |all, f| all.union(*f));
        map.confidence.iter().for_each(|&c| confidences[usize::from(c)] = true);
    }
    // The list says something: there are answers, fractions of all kinds of flags, and every value was used.
    assert!(answers > fewest, "{answers} answers");
    // A matcher loses no lines.
    let mut seen =
        PixelFlags::NAMES.iter().map(|(flag, _)| flags.contains(*flag) != (*flag == PixelFlags::DAMAGED));
    assert!(seen.all(|is_right| is_right), "flags seen: {flags:?}");
    let kinds = confidences.iter().filter(|&&c| c).count();
    assert!(
        kinds > kinds_of_confidence
            && confidences.iter().skip(usize::from(Row::MOST_CONFIDENCE) + 1).all(|&c| !c),
        "{kinds} confidences"
    );
    let used = |value: fn(&Config) -> u16| cases.iter().map(|(c, ..)| value(c)).collect::<BTreeSet<_>>();
    assert_eq!(used(|c| c.width), widths().into_iter().collect());
    assert_eq!(used(|c| c.height), heights().into_iter().collect());
    assert_eq!(used(|c| c.disparities), DISPARITIES.into_iter().collect());
    assert_eq!(used(|c| c.min_disparity), MIN_DISPARITIES.into_iter().collect());
    assert!(PATTERNS.iter().all(|p| cases.iter().any(|(_, q, _)| p == q)));
}

#[test]
fn fast_equals_its_twin_at_all_sizes_ranges_and_pictures() {
    run_list::<Fast>();
}

#[test]
fn block_equals_its_twin_at_all_sizes_ranges_and_pictures() {
    run_list::<Block>();
}

#[test]
fn sgm_lean_equals_its_twin_at_all_sizes_ranges_and_pictures() {
    run_list::<SgmLean>();
}

#[test]
fn sgm_equals_its_twin_at_all_sizes_ranges_and_pictures() {
    run_list::<Sgm>();
}

#[test]
fn sgm_edge_equals_its_twin_at_all_sizes_ranges_and_pictures() {
    run_list::<SgmEdge>();
}
