//! What leaves the picture at a side while it is in the corridor, and a corridor that is wider than the
//! picture.

use super::support::{Finder, Map, floor};
use std::ops::Range;
use stereopsis::geometry::camera::RectifiedRig;
use stereopsis::obstacles::{BlindReason, Decision, DriveConfig, DriveRule, GroundSource, ObstacleConfig};

/// Speed, mm/s: it stops within 275 mm, and drives 10 mm from frame to frame.
const SPEED: u16 = 300;

/// A floor 0.3 m below cameras, and a board 0.3 m high that is so far away and so far to the right, m.
fn board(focal_px: f32, across_m: Range<f64>, depth_m: f64) -> Map {
    let rig = RectifiedRig::new(focal_px, 0.06, 79.5, 59.5).expect("a rig");
    let (f, b) = (f64::from(focal_px), 0.06);
    Map::of(rig, [160, 120], |u, v| {
        let right = (u - 79.5) / f * depth_m;
        let stands = (0.0..0.3).contains(&((v - 59.5) / f * depth_m));
        let parallax = if stands && across_m.contains(&right) {
            Some(f * b / depth_m)
        } else {
            floor(&rig, 0.3, 0.0, v)
        };
        // What is left of the right picture has no partner.
        parallax.or(Some(0.0)).filter(|parallax| u >= *parallax)
    })
}

fn finder(map: &Map) -> Box<Finder> {
    let ground = GroundSource::Given { pitch_mrad: 0, roll_mrad: 0, height_mm: 300 };
    map.finder(&ObstacleConfig { ground, ..ObstacleConfig::default() })
}

fn decide(rule: &mut DriveRule, map: &Map) -> Decision {
    let mut finder = finder(map);
    map.rows(&mut finder, |_| true);
    assert_eq!(finder.finish(), Ok(()));
    rule.decide(&finder.as_mut_view(), SPEED).decision
}

/// Distances, mm, and decisions of a drive past or into a board.
fn drive(focal_px: f32, across_m: &Range<f64>) -> Vec<(u32, Decision)> {
    let mut rule = DriveRule::new(DriveConfig::default());
    let depths = (0..80).map(|i| 900 - 10 * i);
    depths
        .map(|mm| (mm, decide(&mut rule, &board(focal_px, across_m.clone(), f64::from(mm) / 1000.0))))
        .collect()
}

#[test]
fn what_leaves_the_picture_in_the_corridor_stops_the_vehicle() {
    for across_m in [0.16..0.3, -0.3..-0.16, 0.1..0.3, -0.3..-0.1, 0.19..0.4, 0.0..0.3] {
        let decisions = drive(140.0, &across_m);
        let stop = decisions.iter().position(|(_, decision)| matches!(decision, Decision::Stop(_)));
        let stop = stop.unwrap_or_else(|| panic!("{across_m:?}: {decisions:?}"));
        let (mm, _) = decisions[stop];
        // Not before the corridor is wider than what both cameras see, and not after the stopping distance.
        let whole_mm = if across_m.start < 0.0 { 475 } else { 365 };
        assert!((270..=whole_mm).contains(&mm), "{across_m:?}: {mm} mm");
        for (mm, decision) in &decisions[stop..] {
            assert!(matches!(decision, Decision::Stop(_)), "{across_m:?}, {mm} mm: {decision:?}");
        }
        for (mm, decision) in decisions[..stop].iter().filter(|(mm, _)| *mm < 600) {
            assert_ne!(*decision, Decision::Clear, "{across_m:?}, {mm} mm");
        }
    }
}

#[test]
fn what_is_beside_the_corridor_or_goes_in_sight_is_let_go_of() {
    for across_m in [0.22..0.4, -0.4..-0.22] {
        for (mm, decision) in drive(140.0, &across_m) {
            assert!(!matches!(decision, Decision::Stop(_)), "{across_m:?}, {mm} mm: {decision:?}");
        }
    }
    // Boards in the middle and across the picture, 0.3 m ahead, that are gone from one frame to another.
    for across_m in [-0.05..0.05, -0.3..0.3, 0.0..0.3, 0.1..0.1] {
        let mut rule = DriveRule::new(DriveConfig::default());
        let [there, gone] = [across_m.clone(), 0.0..0.0].map(|at| board(140.0, at, 0.3));
        let decisions: Vec<_> =
            [&there, &there, &there, &gone, &gone, &gone].map(|map| decide(&mut rule, map)).into();
        assert_eq!(decisions[5], Decision::Clear, "{across_m:?}: {decisions:?}");
    }
    // A single frame is not believed in.
    let mut rule = DriveRule::new(DriveConfig::default());
    let [there, gone] = [0.16..0.3, 0.0..0.0].map(|at| board(140.0, at, 0.3));
    let decisions = [&gone, &there, &gone, &gone, &gone].map(|map| decide(&mut rule, map));
    assert_eq!(decisions[4], Decision::Clear, "{decisions:?}");
}

#[test]
fn a_corridor_that_is_wider_than_the_picture_is_blind() {
    // It looks 550 mm ahead: there 280 px see 314 mm of the corridor's 400, and 225 px see 391 mm.
    for (focal_px, decision) in
        [(280.0, Decision::Blind(BlindReason::Unseen)), (225.0, Decision::Clear), (140.0, Decision::Clear)]
    {
        let mut rule = DriveRule::new(DriveConfig::default());
        assert_eq!(decide(&mut rule, &board(focal_px, 0.0..0.0, 1.0)), decision, "{focal_px} px");
    }
}
