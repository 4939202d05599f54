//! Worked geometry: poses, heights, bearings, scans, decisions.

use super::support::{Map, floor, rig};
use stereopsis::obstacles::{
    BlindReason, Decision, DriveConfig, DriveRule, FreeSpace, GroundSource, Hysteresis, ObstacleConfig,
    ObstacleError, SectorState, StixelKind, speed_mm_s,
};
use stereopsis::units::{Disparity, PixelFlags};

/// A floor 0.3 m below a camera that looks down by `pitch_rad`, and a box from column 70 to 90 that stands on
/// it at 1 m, 0.2 m high.
fn box_ahead(pitch_rad: f64) -> Map {
    let rig = rig();
    let (f, b) = (f64::from(rig.focal_px()), f64::from(rig.baseline_m()));
    let at = f * b;
    let row = |height: f64| 59.5 + f * ((0.3 - height) - pitch_rad.tan());
    Map::of(rig, [160, 120], |u, v| {
        let standing = (70.0..90.0).contains(&u) && (row(0.2)..row(0.0)).contains(&v);
        if standing { Some(at) } else { floor(&rig, 0.3, pitch_rad, v) }
    })
}

#[test]
fn a_box_has_its_distance_bearing_and_height() {
    let map = box_ahead(0.1);
    let mut finder = map.finder(&ObstacleConfig::default());
    map.rows(&mut finder, |_| true);
    assert_eq!(finder.finish(), Ok(()));
    let view = finder.as_mut_view();
    let standing: Vec<_> =
        (0..view.columns()).filter(|&x| view.stixel(x).kind != StixelKind::Nothing).collect();
    assert_eq!(standing, [17, 18, 19, 20, 21, 22], "cells that the box has a quarter of");
    let sectors: Vec<_> = (0..view.sectors()).map(|i| view.sector(i)).collect();
    for (i, sector) in sectors.iter().enumerate() {
        let boxed = sector.state == SectorState::Obstacle;
        assert_eq!(boxed, (6..10).contains(&i), "sector {i}: {sector:?}");
        if !boxed {
            assert_eq!(sector.state, SectorState::Free, "sector {i}: {sector:?}");
            assert!(sector.seen_mm > 2000, "sector {i}: {sector:?}");
            continue;
        }
        assert_eq!(sector.depth_mm, 1000);
        assert!((1000..1010).contains(&sector.range_mm) && (8..16).contains(&sector.sigma_mm), "{sector:?}");
        // The middle of the uppermost cell of the box is up to 5 rows, 4 cm, below its edge.
        assert!((150..=210).contains(&sector.height_mm), "{sector:?}");
        assert!((300..=500).contains(&sector.pixels), "{sector:?}");
        assert!(sector.bearing_mrad.abs() < 80, "{sector:?}");
    }
    let mut ranges = [0.0; 32];
    let scan = view.laser_scan(&mut ranges);
    assert_eq!(scan.count, 16);
    assert!((scan.angle_max - scan.angle_min - 15.0 * scan.angle_increment).abs() < 1e-5, "{scan:?}");
    assert!((scan.angle_max - 15.0 / 32.0 * 2.0 * (79.5_f32 / 130.0).atan()).abs() < 1e-3, "{scan:?}");
    for (i, range) in ranges.iter().take(16).enumerate() {
        assert_eq!(range.is_infinite(), !(6..10).contains(&i), "range {i}");
    }
    assert!((ranges[7] - 1.0).abs() < 0.02, "{ranges:?}");
    let part = view.laser_scan(&mut ranges[..3]);
    assert_eq!((part.count, part.angle_min), (3, scan.angle_min));
    assert!((part.angle_max - scan.angle_min - 2.0 * scan.angle_increment).abs() < 1e-5, "{part:?}");
    let seen = sectors.iter().filter(|s| s.state == SectorState::Free).map(|s| s.seen_mm).min();
    assert_eq!(scan.range_max, f32::from(seen.expect("free sectors")) / 1000.0);
    assert!((2.0..8.0).contains(&scan.range_max), "{scan:?}");
    // 64 px are searched: 130 * 0.1 / 64 m.
    assert!((scan.range_min - 0.203).abs() < 1e-3, "{scan:?}");
}

#[test]
fn a_table_ends_where_it_ends() {
    // A table 0.3 m below the camera that ends 1 m ahead, and the floor 0.7 m below that.
    let (rig, pitch) = (rig(), 0.35_f64);
    let edge = 59.5 + 130.0 * ((0.3_f64).atan2(1.0) - pitch).tan();
    let map = Map::of(rig, [160, 120], |_, v| floor(&rig, if v > edge { 0.3 } else { 1.0 }, pitch, v));
    let mut finder = map.finder(&ObstacleConfig::default());
    map.rows(&mut finder, |_| true);
    assert_eq!(finder.finish(), Ok(()));
    let view = finder.as_mut_view();
    assert!((280..320).contains(&view.plane().expect("the table").height_mm), "{:?}", view.plane());
    for i in 0..view.sectors() {
        let sector = view.sector(i);
        assert_eq!(sector.state, SectorState::Drop, "{sector:?}");
        assert!((900..1250).contains(&sector.depth_mm), "{sector:?}");
    }
    let mut rule = DriveRule::new(DriveConfig::default());
    let verdict = rule.decide(&view, 600);
    assert!(matches!(verdict.decision, Decision::Slow(850..1200)), "{verdict:?}");
    assert_eq!(verdict.nearest, StixelKind::Drop);
    // Within the next frame nothing of it is left.
    finder.begin();
    let verdict = rule.decide(&finder.as_mut_view(), 600);
    assert_eq!(verdict.decision, Decision::Blind(BlindReason::NoFrame));
    assert_eq!(verdict.nearest, StixelKind::Nothing);
}

#[test]
fn decisions_follow_the_stopping_distance() {
    let map = box_ahead(0.1);
    let mut finder = map.finder(&ObstacleConfig::default());
    map.rows(&mut finder, |_| true);
    assert_eq!(finder.finish(), Ok(()));
    let view = finder.as_mut_view();
    let config = DriveConfig { slow_ms: 0, ..DriveConfig::default() };
    let decide = |speed| DriveRule::new(config).decide(&view, speed);
    // 200 mm + 100 ms v + v^2 / 2 m/s^2: 225, 390, 795 and 1060 mm; the box is at 1000 mm less two sigma.
    let verdicts = [150, 525, 995, 1220].map(decide);
    assert_eq!(verdicts.map(|v| v.stopping_mm), [226, 389, 794, 1066]);
    assert_eq!(verdicts[0].decision, Decision::Clear);
    assert_eq!(verdicts[1].decision, Decision::Clear);
    assert!(matches!(verdicts[2].decision, Decision::Slow(970..1000)), "{:?}", verdicts[2]);
    assert!(matches!(verdicts[3].decision, Decision::Stop(970..1000)), "{:?}", verdicts[3]);
    let contact = verdicts[3].contact_ms.expect("it moves");
    assert!((795..820).contains(&contact), "{contact} ms");
    // Two seconds before contact, it slows down.
    let slow = DriveRule::new(DriveConfig::default()).decide(&view, 525);
    assert!(matches!(slow.decision, Decision::Slow(_)), "{slow:?}");
    // A corridor that passes the box on its left, as the optical axis is its middle: all of the box is in it
    // unless it is narrower than a column.
    let narrow = DriveConfig { corridor_mm: 10, ..config };
    assert!(matches!(DriveRule::new(narrow).decide(&view, 1220).decision, Decision::Stop(_)));
    assert_eq!((speed_mm_s(20, 40_000), speed_mm_s(1, 0), speed_mm_s(60_000, 1)), (500, u16::MAX, u16::MAX));
}

#[test]
fn what_is_beside_the_corridor_does_not_stop() {
    // A box from 0.35 m to 0.55 m right of the axis, 1 m ahead.
    let rig = rig();
    let map = Map::of(rig, [160, 120], |u, v| {
        let standing = (125.0..151.0).contains(&u) && (60.0..98.0).contains(&v);
        if standing { Some(13.0) } else { floor(&rig, 0.3, 0.0, v) }
    });
    let mut finder = map.finder(&ObstacleConfig::default());
    map.rows(&mut finder, |_| true);
    assert_eq!(finder.finish(), Ok(()));
    let decide = |corridor_mm| {
        let mut finder = map.finder(&ObstacleConfig::default());
        map.rows(&mut finder, |_| true);
        assert_eq!(finder.finish(), Ok(()));
        DriveRule::new(DriveConfig { corridor_mm, ..DriveConfig::default() })
            .decide(&finder.as_mut_view(), 1220)
            .decision
    };
    assert_eq!(decide(400), Decision::Clear);
    assert!(matches!(decide(900), Decision::Stop(_)));
}

#[test]
fn hysteresis_holds_and_confirms() {
    let (clear, boxed) = (Map::of(rig(), [160, 120], |_, v| floor(&rig(), 0.3, 0.1, v)), box_ahead(0.1));
    let mut finder = clear.finder(&ObstacleConfig::default());
    let mut space = FreeSpace::new(Hysteresis { confirm: 2, release: 1 });
    let mut shown = Vec::new();
    for map in [&clear, &boxed, &boxed, &clear, &clear] {
        map.rows(&mut finder, |_| true);
        assert_eq!(finder.finish(), Ok(()));
        space.update(&finder.as_mut_view());
        shown.push(space.sector(7).state);
    }
    use SectorState::{Blind, Free, Obstacle};
    assert_eq!(shown, [Free, Blind, Obstacle, Obstacle, Free]);
    assert_eq!(space.sector(99).state, Blind);
}

#[test]
fn what_is_held_outlasts_a_blind_frame() {
    let (clear, boxed) = (Map::of(rig(), [160, 120], |_, v| floor(&rig(), 0.3, 0.1, v)), box_ahead(0.1));
    let dark = Map::of(rig(), [160, 120], |_, _| None);
    let mut finder = clear.finder(&ObstacleConfig::default());
    let mut space = FreeSpace::new(Hysteresis { confirm: 1, release: 2 });
    let mut shown = Vec::new();
    for map in [&boxed, &boxed, &dark, &clear, &clear] {
        map.rows(&mut finder, |_| true);
        let _ = finder.finish();
        space.update(&finder.as_mut_view());
        shown.push(space.sector(7));
    }
    use SectorState::{Blind, Free, Obstacle};
    assert_eq!(
        shown.iter().map(|sector| sector.state).collect::<Vec<_>>(),
        [Obstacle, Obstacle, Blind, Obstacle, Free]
    );
    assert_eq!(shown[3], shown[1], "the surface that was seen last");
}

#[test]
fn no_ground_and_no_answers_are_never_clear() {
    let mut rule = DriveRule::new(DriveConfig::default());
    let mut finder = box_ahead(0.1).finder(&ObstacleConfig::default());
    assert_eq!(rule.decide(&finder.as_mut_view(), 100).decision, Decision::Blind(BlindReason::NoFrame));
    // All is 40 m away: there is no ground, and nothing near.
    let far = Map::of(rig(), [160, 120], |_, _| Some(0.325));
    far.rows(&mut finder, |_| true);
    assert_eq!(finder.finish(), Ok(()));
    assert_eq!(rule.decide(&finder.as_mut_view(), 100).decision, Decision::Blind(BlindReason::NoGround));
    // In the air that is clear.
    let mut flying =
        far.finder(&ObstacleConfig { ground: GroundSource::Absent, ..ObstacleConfig::default() });
    far.rows(&mut flying, |_| true);
    assert_eq!(flying.finish(), Ok(()));
    assert_eq!(rule.decide(&flying.as_mut_view(), 100).decision, Decision::Clear);
    // A floor that ends half a metre ahead in nothing that has an answer.
    let white = Map::of(rig(), [160, 120], |_, v| floor(&rig(), 0.3, 0.1, v).filter(|p| *p > 12.0));
    let mut finder = white.finder(&ObstacleConfig::default());
    white.rows(&mut finder, |_| true);
    assert_eq!(finder.finish(), Ok(()));
    assert_eq!(rule.decide(&finder.as_mut_view(), 800).decision, Decision::Blind(BlindReason::Unseen));
}

#[test]
fn wrong_configurations_and_sizes_are_named() {
    let map = box_ahead(0.0);
    let scale = stereopsis::depth::DepthScale::new(&map.rig).expect("a scale");
    let mut small = stereopsis::obstacles::Obstacles::<10, 8>::new();
    let mut refused = |change: &dyn Fn(&mut ObstacleConfig), size| {
        let mut config = ObstacleConfig::default();
        change(&mut config);
        small.start(&config, &scale, size, Disparity::from_pixels(32)).err()
    };
    assert_eq!(refused(&|_| (), [43, 44]), None);
    assert_eq!(refused(&|_| (), [44, 40]), Some(ObstacleError::Columns { needed: 11 }));
    assert_eq!(refused(&|_| (), [3, 40]), Some(ObstacleError::Columns { needed: 1 }));
    assert_eq!(refused(&|_| (), [40, 45]), Some(ObstacleError::Rows { needed: 9 }));
    assert_eq!(refused(&|c| c.cell_width = 0, [40, 40]), Some(ObstacleError::Cells));
    assert_eq!(refused(&|c| (c.cell_width, c.cell_height) = (16, 16), [40, 40]), Some(ObstacleError::Cells));
    assert_eq!(refused(&|c| c.sectors = 33, [40, 40]), Some(ObstacleError::Sectors));
    assert_eq!(refused(&|c| c.sigma_steps = 0, [40, 40]), Some(ObstacleError::Limits));
    let flat = GroundSource::Given { pitch_mrad: 501, roll_mrad: 0, height_mm: 300 };
    assert_eq!(refused(&|c| c.ground = flat, [40, 40]), Some(ObstacleError::Pose));
    assert!(small.finish().is_err(), "a refused start leaves nothing to finish");
    // Rows out of place, too short, and before a start are ignored.
    small.push(0, &[Disparity::ZERO; 160], &[PixelFlags::CLEAR; 160], &[]);
    assert_eq!(small.as_mut_view().cell(0, 0), Disparity::NONE);
    let mut wide = map.finder(&ObstacleConfig::default());
    map.rows(&mut wide, |_| true);
    assert_eq!(wide.finish(), Ok(()));
    let view = wide.as_mut_view();
    assert!(view.cell(39, 23).is_some());
    let outside = [(40, 23), (39, 24), (0, usize::MAX), (usize::MAX, 0), (usize::MAX, usize::MAX)];
    assert!(outside.iter().all(|&(column, row)| view.cell(column, row).is_none()));
    // The memory of the 160 columns of a small camera.
    let bytes = size_of::<stereopsis::obstacles::Obstacles<40, 24>>();
    assert!(bytes <= 4096, "{bytes} bytes");
}
