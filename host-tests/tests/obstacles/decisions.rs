//! Decisions, free space and the watchdog of the core beside their naive twins, to the bit, over sequences.

use super::support::{Map, rig};
use super::twins::{has_tie, in_words, map, rows_that_come, scene};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::collections::BTreeMap;
use std::sync::LazyLock;
use stereopsis::imaging::PairMonitor;
use stereopsis::obstacles::{
    BlindReason, Decision, DriveConfig, DriveRule, FreeSpace, GroundSource, Hysteresis, ObstacleConfig,
    SectorState,
};
use stereopsis::units::Disparity;
use stereopsis_host::scene::{Random, RobotScene};
use stereopsis_host::twin::obstacles::{Decided, Driver, Scene, find, free_space, sectors};

const SIZE: [u16; 2] = [160, 120];

/// What is known of the cameras of a frame: nothing, or a monitor and what it says against them.
type Judged = (Option<PairMonitor>, Option<BlindReason>);

/// Cameras that nobody watches, good ones, a covered one, and swapped ones.
static CAMERAS: LazyLock<Vec<Judged>> = LazyLock::new(|| {
    let (left, right) = RobotScene::BoxAt(600).scene(1).render();
    let black = image::GrayImage::new(160, 120);
    let watched = |left: &image::GrayImage, right: &image::GrayImage| {
        let mut monitor = PairMonitor::new(32);
        monitor.begin();
        for (left, right) in left.as_raw().chunks(160).zip(right.as_raw().chunks(160)) {
            monitor.lines(left, right);
        }
        Some(monitor)
    };
    vec![
        (None, None),
        (watched(&left, &right), None),
        (watched(&left, &black), Some(BlindReason::Camera)),
        (watched(&right, &left), Some(BlindReason::Swapped)),
    ]
});

/// A frame to drive through, with low and thin things; one of eight has answers in few pixels only.
fn frame(random: &mut Random) -> Map {
    let mut map = map(random, rig(), SIZE);
    for _ in 0..random.below(4) {
        let (left, top, share) = (random.below(150), 50 + random.below(60), 1.0 + 0.25 * random.unit());
        let (right, bottom) = (left + 4 + random.below(30), top + 5 + random.below(20));
        for y in top..bottom.min(120) {
            for d in &mut map.disparities[160 * y + left..160 * y + right.min(160)] {
                let nearer = Disparity::from_raw((f64::from(d.raw()) * share) as u16);
                *d = if d.is_some() { nearer } else { *d };
            }
        }
    }
    if random.below(8) == 0 {
        map.disparities.iter_mut().filter(|_| random.below(50) > 0).for_each(|d| *d = Disparity::NONE);
    }
    map
}

/// How a sequence is driven through.
#[derive(Clone, Copy, Debug)]
struct Drive {
    config: DriveConfig,
    limits: ObstacleConfig,
    /// Of how many frames one has a fault of its cameras.
    faults: usize,
}

/// Drives through so many frames of a seed, and compares; returns the decisions.
fn drive(seed: u64, frames: usize, drive: &Drive) -> Result<Vec<Decision>, TestCaseError> {
    let (mut random, judged) = (Random::new(seed), &*CAMERAS);
    let Drive { config, limits, faults } = *drive;
    let (mut rule, mut twin_rule) = (DriveRule::new(config), Driver::new(config));
    let (mut space, mut history) = (FreeSpace::new(config.hysteresis), Vec::new());
    let mut carried = (None, 0);
    let mut shown = frame(&mut random);
    let mut finder = shown.finder(&limits);
    let mut decisions = Vec::new();
    for number in 0..frames {
        // What is shown stays for some frames.
        if random.byte() & 1 == 1 {
            shown = frame(&mut random);
        }
        let came = rows_that_come(&mut random, SIZE[1]);
        let (monitor, cameras) = &judged[if random.below(faults) == 0 { random.below(4) } else { 1 }];
        let scene = Scene { cameras: *cameras, ..scene(&shown, limits, &came) };
        let found = find(&scene, &mut carried);
        finder.begin();
        if let Some(monitor) = monitor {
            finder.as_mut_view().cameras(monitor);
        }
        shown.rows_of_begun(&mut finder, |y| came[y]);
        prop_assert_eq!(finder.finish().err(), found.blind, "frame {}", number);
        let speed = *random.pick(&[0, 1, 300, 700, 3000, u16::MAX]);
        let view = finder.as_mut_view();
        let verdict = rule.decide(&view, speed);
        let decided = Decided {
            decision: verdict.decision,
            nearest: verdict.nearest,
            contact_ms: verdict.contact_ms.map(i128::from),
            stopping_mm: verdict.stopping_mm.into(),
        };
        prop_assert_eq!(decided, twin_rule.decide(&scene, &found, speed.into()), "frame {}", number);
        space.update(&view);
        prop_assert!(!has_tie(&scene), "bearings of this rig are rounded as the twin's");
        history.push(sectors(&scene, &found));
        for (i, expected) in free_space(&history, config.hysteresis).iter().enumerate() {
            prop_assert_eq!(&in_words(space.sector(i)), expected, "frame {}, sector {}", number, i);
        }
        prop_assert_eq!(space.sector(history[0].len()).state, SectorState::Blind);
        decisions.push(verdict.decision);
    }
    Ok(decisions)
}

fn brakes() -> impl Strategy<Value = DriveConfig> {
    let hysteresis = (0u8..4, prop_oneof![4 => 0u8..4, 1 => Just(u8::MAX)]);
    let lengths = (prop_oneof![0u16..2000, any::<u16>()], 0u16..1000);
    (lengths, 0u16..500, prop_oneof![0u16..3000, any::<u16>()], any::<u16>(), hysteresis).prop_map(
        |((corridor_mm, margin_mm), reaction_ms, brake_mm_s2, slow_ms, (confirm, release))| DriveConfig {
            corridor_mm,
            margin_mm,
            reaction_ms,
            brake_mm_s2,
            slow_ms,
            hysteresis: Hysteresis { confirm, release },
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 100,
        rng_seed: RngSeed::Fixed(2727),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn drives_are_those_of_the_twin_to_the_bit(
        seed in any::<u64>(),
        config in brakes(),
        limits in (10u16..200, 10u16..200, 1u16..400),
        shares in (0u8..40, 0u8..20),
        sectors in 1u8..33,
        absent in prop::bool::weighted(0.2),
    ) {
        let default = ObstacleConfig::default();
        let limits = ObstacleConfig {
            obstacle_mm: limits.0,
            drop_mm: limits.1,
            min_pixels: limits.2,
            least_answered: shares.0,
            most_lost: shares.1,
            sectors,
            ground: if absent { GroundSource::Absent } else { default.ground },
            ..default
        };
        drive(seed, 6, &Drive { config, limits, faults: 4 })?;
    }
}

/// What is compared are decisions of every kind, each often.
#[test]
fn the_drives_have_decisions_of_every_kind() {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for seed in 0..40 {
        let default = Drive { config: DriveConfig::default(), limits: ObstacleConfig::default(), faults: 4 };
        for decision in drive(seed, 8, &default).expect("the twin agrees") {
            let name = match decision {
                Decision::Blind(reason) => format!("{reason:?}"),
                Decision::Slow(_) => "Slow".to_owned(),
                Decision::Stop(_) => "Stop".to_owned(),
                Decision::Clear => "Clear".to_owned(),
            };
            *counts.entry(name).or_default() += 1;
        }
    }
    for name in ["Clear", "Slow", "Stop", "RowsLost", "FewAnswers", "Camera", "Swapped", "NoGround", "Unseen"]
    {
        assert!(counts.get(name).is_some_and(|&n| n >= 3), "{name} of {counts:?}");
    }
}
