//! What counts: things that stand out of the ground in parts, answers in the sky, a known height, and sizes.

use super::support::{Finder, Map, floor, rig};
use std::ops::Range;
use stereopsis::depth::DepthScale;
use stereopsis::obstacles::{
    BlindReason, Column, Decision, DriveConfig, DriveRule, Filling, GroundSource, Interval, ObstacleConfig,
    ObstaclesState, ObstaclesView, StixelKind,
};
use stereopsis::units::Disparity;

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
        let view = finder.as_mut_view();
        let plane = view.plane()?;
        assert_eq!(view.ground(), Some(plane).filter(|plane| plane.is_sure()));
        Some((plane.height_mm, f64::from(plane.pitch_rad()) - pitch, plane.is_sure()))
    };
    let (free, tilt, is_sure) = ground([100, 3000]).expect("a plane");
    assert!((305..318).contains(&free) && tilt.to_degrees() > 0.7, "{free} mm, {tilt} rad");
    assert!(!is_sure, "over 7 rows of cells a pitch is not sure");
    let (height, tilt, is_sure) = ground([300, 300]).expect("a ground");
    assert!(height == 300 && tilt.to_degrees().abs() < 0.1 && is_sure, "{height} mm, {tilt} rad");
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

#[test]
fn less_memory_than_was_started_is_blind() {
    let map = Map::of(rig(), [160, 120], |_, v| floor(&rig(), 0.3, 0.1, v));
    let scale = DepthScale::new(&map.rig).expect("a scale");
    let (mut state, mut cells) = (ObstaclesState::new(), [Disparity::NONE; 40 * 24]);
    let (mut filling, mut columns) = ([Filling::default(); 40], [Column::default(); 40]);
    let (mut intervals, mut labels, mut bearings) = ([Interval::default(); 24], [0; 24], [0; 40]);
    let enough = [40 * 24, 40, 24, 40, 24, 40];
    for short in [enough.len()].into_iter().chain(0..enough.len()) {
        let mut lengths = enough;
        lengths.iter_mut().skip(short).take(1).for_each(|length| *length -= 1);
        let mut view = ObstaclesView::new(
            &mut state,
            &mut cells[..lengths[0]],
            &mut filling[..lengths[1]],
            &mut intervals[..lengths[2]],
            &mut columns[..lengths[3]],
            &mut labels[..lengths[4]],
            &mut bearings[..lengths[5]],
        );
        if short == enough.len() {
            let config = ObstacleConfig::default();
            assert_eq!(view.start(&config, &scale, map.size, map.largest), Ok(()));
        }
        view.begin();
        for (y, (disparities, flags)) in map.disparities.chunks(160).zip(map.flags.chunks(160)).enumerate() {
            view.push(y, disparities, flags, &[]);
        }
        let blind = Some(BlindReason::NoFrame).filter(|_| short < enough.len());
        assert_eq!((view.finish().err(), view.blind()), (blind, blind), "piece {short}");
        let decision = DriveRule::new(DriveConfig::default()).decide(&view, 500).decision;
        assert_eq!(decision, blind.map_or(Decision::Clear, Decision::Blind), "piece {short}");
        assert_eq!(view.sectors(), if blind.is_some() { 0 } else { 16 }, "piece {short}");
    }
}

#[test]
fn rows_of_which_anything_is_too_short_are_lost() {
    let map = Map::of(rig(), [160, 120], |_, v| floor(&rig(), 0.3, 0.1, v));
    for (lengths, is_lost) in [
        ([160, 160, 160], false),
        ([160, 160, 0], false),
        ([159, 160, 160], true),
        ([160, 159, 160], true),
        ([160, 160, 159], true),
    ] {
        let mut finder = map.finder(&ObstacleConfig::default());
        for (y, (disparities, flags)) in map.disparities.chunks(160).zip(map.flags.chunks(160)).enumerate() {
            let [d, f, sure] = lengths;
            finder.push(y, &disparities[..d], &flags[..f], &[200; 160][..sure]);
        }
        let blind = Some(BlindReason::RowsLost).filter(|_| is_lost);
        assert_eq!(finder.finish().err(), blind, "{lengths:?}");
    }
}

#[test]
fn nothing_is_seen_of_a_frame_before_its_end() {
    let map = Map::of(rig(), [160, 122], |_, v| floor(&rig(), 0.3, 0.2, v));
    let mut finder = map.finder(&ObstacleConfig::default());
    let seen = |finder: &mut Finder| [0, 20, 200].map(|column| finder.as_mut_view().stixel(column).seen_row);
    assert_eq!(seen(&mut finder), [u16::MAX; 3]);
    map.rows(&mut finder, |_| true);
    assert_eq!(seen(&mut finder), [u16::MAX; 3]);
    assert_eq!(finder.finish(), Ok(()));
    let [first, middle, absent] = seen(&mut finder);
    assert!(first < 60 && middle < 60 && absent == u16::MAX, "{first} {middle} {absent}");
    finder.begin();
    assert_eq!(seen(&mut finder), [u16::MAX; 3]);
    assert_eq!(seen(&mut Finder::new()), [u16::MAX; 3]);
}
