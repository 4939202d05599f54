//! What counts: things that stand out of the ground in parts, answers in the sky, and a known height.

use super::support::{Map, floor, rig};
use std::ops::Range;
use stereopsis::obstacles::{
    BlindReason, Decision, DriveConfig, DriveRule, GroundSource, ObstacleConfig, StixelKind,
};

#[test]
fn a_known_height_is_the_grounds() {
    // The slope that 7 rows of cells show is that of a camera 4 % higher, the parallax half-way is right.
    let (rig, pitch) = (rig(), 0.15_f64);
    let seen = |height_m: f64, v: f64| floor(&rig, height_m, pitch, v).unwrap_or(0.0);
    let off = seen(0.3, 100.0) - seen(0.312, 100.0);
    let map = Map::of(rig, [160, 120], |_, v| Some(seen(0.312, v) + off).filter(|_| v >= 82.0));
    let ground = |heights_mm: [u16; 2]| {
        let source = GroundSource::Searched {
            least_height_mm: heights_mm[0],
            most_height_mm: heights_mm[1],
            most_pitch: 500,
            most_roll: 120,
        };
        let mut finder = map.finder(&ObstacleConfig { ground: source, ..ObstacleConfig::default() });
        map.rows(&mut finder, |_| true);
        assert_eq!(finder.finish(), Ok(()));
        finder.as_mut_view().ground().map(|ground| (ground.height_mm, f64::from(ground.pitch_rad()) - pitch))
    };
    let (free, tilt) = ground([100, 3000]).expect("a ground");
    assert!((305..318).contains(&free) && tilt.to_degrees() > 0.7, "{free} mm, {tilt} rad");
    let (height, tilt) = ground([300, 300]).expect("a ground");
    assert!(height == 300 && tilt.to_degrees().abs() < 0.1, "{height} mm, {tilt} rad");
    // What is more than an eighth off is not the ground.
    assert_eq!(ground([360, 400]), None);
}

#[test]
fn what_stands_out_of_the_ground_in_two_cells_is_not_passed_over() {
    let rig = rig();
    // Something of a height above the ground, in these columns and rows.
    let decide = |height_m: f64, columns: Range<f64>, rows: Range<f64>| {
        let map = Map::of(rig, [160, 120], |u, v| {
            let standing = columns.contains(&u) && rows.contains(&v);
            floor(&rig, if standing { 0.3 - height_m } else { 0.3 }, 0.15, v)
        });
        let mut finder = map.finder(&ObstacleConfig::default());
        map.rows(&mut finder, |_| true);
        assert_eq!(finder.finish(), Ok(()));
        // It looks 1.03 m ahead.
        DriveRule::new(DriveConfig::default()).decide(&finder.as_mut_view(), 700).decision
    };
    for height_m in [0.03, 0.1] {
        assert_eq!(
            decide(height_m, 80.0..88.0, 80.0..90.0),
            Decision::Blind(BlindReason::Unseen),
            "{height_m} m"
        );
        // A single cell is chance, and what is 0.3 m beside the axis is beside the corridor.
        assert_eq!(decide(height_m, 80.0..88.0, 85.0..90.0), Decision::Clear, "{height_m} m");
        assert_eq!(decide(height_m, 128.0..136.0, 80.0..90.0), Decision::Clear, "{height_m} m");
    }
    // What is wide enough for its height to be known is passed over if it is low.
    assert_eq!(decide(0.03, 60.0..100.0, 80.0..90.0), Decision::Clear);
    assert_ne!(decide(0.1, 60.0..100.0, 80.0..90.0), Decision::Clear);
}

#[test]
fn unsure_answers_above_the_horizon_do_not_count() {
    // A surface 1 m ahead, of 40 x 20 px, above the horizon at row 39.5, and one below it.
    let (rig, pitch) = (rig(), 0.1526);
    for (top, sure, counts) in [(10.0, 99, false), (10.0, 100, true), (60.0, 1, true)] {
        let mut map = Map::of(rig, [160, 120], |u, v| {
            let standing = (60.0..100.0).contains(&u) && (top..top + 20.0).contains(&v);
            if standing { Some(13.0) } else { floor(&rig, 0.3, pitch, v).or(Some(0.0)) }
        });
        map.confidences = vec![sure; map.disparities.len()];
        let mut finder = map.finder(&ObstacleConfig { sky_confidence: 100, ..ObstacleConfig::default() });
        for _ in 0..2 {
            map.rows(&mut finder, |_| true);
            assert_eq!(finder.finish(), Ok(()));
        }
        let is_standing = finder.as_mut_view().stixel(20).kind == StixelKind::Obstacle;
        assert_eq!(is_standing, counts, "from row {top}, confidence {sure}");
    }
}
