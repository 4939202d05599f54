//! The ground where it is: height, pitch and roll of the camera, and walls beside it.

use super::support::{Map, floor, rig};
use stereopsis::geometry::camera::RectifiedRig;
use stereopsis::obstacles::{GroundSource, ObstacleConfig, StixelKind};

#[test]
fn the_ground_has_the_height_and_pitch_of_the_camera() {
    for (height_m, pitch) in [(0.3, 0.0), (0.3, 0.2), (1.2, 0.1), (0.15, 0.3), (0.6, -0.1)] {
        let map = Map::of(rig(), [160, 120], |_, v| floor(&rig(), height_m, pitch, v));
        let mut finder = map.finder(&ObstacleConfig::default());
        map.rows(&mut finder, |_| true);
        assert_eq!(finder.finish(), Ok(()), "{height_m} m, {pitch} rad");
        let ground = finder.as_mut_view().plane().expect("a ground");
        let off = f64::from(ground.pitch_rad()) - pitch;
        assert!(off.abs() < 0.5_f64.to_radians(), "{height_m} m, {pitch} rad: {off}");
        let height_off = f64::from(ground.height_mm) / 1000.0 / height_m - 1.0;
        assert!(height_off.abs() < 0.03, "{height_m} m, {pitch} rad: {height_off}");
        // The same plane by the pose gives the same line, to a tenth of a px at the lowest row.
        let given = GroundSource::Given {
            pitch_mrad: (1000.0 * pitch).round() as i16,
            roll_mrad: 0,
            height_mm: (1000.0 * height_m).round() as u16,
        };
        let mut finder = map.finder(&ObstacleConfig { ground: given, ..ObstacleConfig::default() });
        map.rows(&mut finder, |_| true);
        assert_eq!(finder.finish(), Ok(()));
        let by_pose = finder.as_mut_view().ground().expect("a ground");
        let lowest = |g: &stereopsis::obstacles::Ground| (g.level + g.slope * 117) as f64 / 65_536.0;
        assert!((lowest(&ground) - lowest(&by_pose)).abs() < 3.2, "{ground:?} {by_pose:?}");
        assert_eq!(f64::from(by_pose.height_mm), (1000.0 * height_m).round());
        assert!((f64::from(by_pose.pitch_rad()) - pitch).abs() < 1e-3, "{by_pose:?}");
    }
}

/// Walls to both sides of a street 5 to 8 m wide, which show more of each disparity than the ground does.
#[test]
fn the_ground_between_walls_is_the_ground() {
    let rig = RectifiedRig::new(192.0, 0.4, 159.5, 79.5).expect("a rig");
    let (f, b) = (f64::from(rig.focal_px()), f64::from(rig.baseline_m()));
    for (left_m, right_m, pitch) in [(2.5, 2.5, 0.0), (3.0, 2.6, 0.0), (4.0, 3.0, 0.02), (2.5, 4.0, -0.02)] {
        let map = Map::of(rig, [320, 160], |u, v| {
            let wall = if u < 159.5 { (159.5 - u) / left_m } else { (u - 159.5) / right_m };
            Some(floor(&rig, 1.5, pitch, v).unwrap_or(0.0).max(wall * b).max(f * b / 60.0))
        });
        let mut finder = map.finder(&ObstacleConfig::default());
        map.rows(&mut finder, |_| true);
        assert_eq!(finder.finish(), Ok(()));
        let plane = finder.as_mut_view().plane().expect("a plane");
        let off = (f64::from(plane.pitch_rad()) - pitch).to_degrees();
        assert!(off.abs() < 0.3, "{left_m}, {right_m} m, {pitch} rad: {off} degrees, {plane:?}");
        assert!((1450..=1550).contains(&plane.height_mm), "{left_m}, {right_m} m, {pitch} rad: {plane:?}");
    }
}

#[test]
fn the_ground_leans_with_the_camera() {
    let (rig, pitch, height_m) = (rig(), 0.15_f64, 0.3);
    for roll in [-0.05_f64, 0.02, 0.05] {
        // What is seen at a column and a row of a camera that is rolled.
        let seen = |u: f64, v: f64| {
            let (x, y) = (u - 79.5, v - 59.5);
            let down = pitch.cos() * (x * roll.sin() + y * roll.cos()) + 130.0 * pitch.sin();
            Some(0.1 / height_m * down).filter(|parallax| *parallax > 0.0)
        };
        let map = Map::of(rig, [160, 120], seen);
        let given = GroundSource::Given {
            pitch_mrad: (1000.0 * pitch).round() as i16,
            roll_mrad: (1000.0 * roll).round() as i16,
            height_mm: 300,
        };
        for source in [ObstacleConfig::default().ground, given] {
            let mut finder = map.finder(&ObstacleConfig { ground: source, ..ObstacleConfig::default() });
            map.rows(&mut finder, |_| true);
            assert_eq!(finder.finish(), Ok(()));
            let view = finder.as_mut_view();
            let ground = view.ground().expect("a ground");
            let off = [f64::from(ground.roll_rad()) - roll, f64::from(ground.pitch_rad()) - pitch];
            assert!(off.iter().all(|off| off.abs() < 2e-3), "{roll} rad, {source:?}: {ground:?}");
            assert!((297..=303).contains(&ground.height_mm), "{roll} rad, {source:?}: {ground:?}");
            // Nothing stands on it, and each column sees it from the lower edge on.
            for x in 0..view.columns() {
                let stixel = view.stixel(x);
                assert_eq!(stixel.kind, StixelKind::Nothing, "{roll} rad, {source:?}, column {x}");
                assert!(stixel.seen_row < 60, "{roll} rad, {source:?}, column {x}: {stixel:?}");
            }
        }
    }
}
