//! Rendered scenes through `block` and the default limits: boxes are found where they are, nothing else is,
//! and the ground is where it is. `truth` tries thousands.

use super::support::{Cameras, frame};
use stereopsis::depth::DepthScale;
use stereopsis::matching::{Block, Method, Sgm};
use stereopsis::obstacles::{Decision, DriveConfig, DriveRule, ObstaclesView, SectorState};
use stereopsis_host::scene::RobotScene;

/// Speed of the robot, mm/s.
const SPEED: u16 = 500;

/// Noise of the sensors, grey levels.
const NOISES: [f64; 2] = [0.0, 3.0];

fn decide(frame: &ObstaclesView<'_>) -> Decision {
    DriveRule::new(DriveConfig::default()).decide(frame, SPEED).decision
}

/// What came of boxes at many distances.
#[derive(Default, Debug)]
struct Boxes {
    frames: usize,
    missed: usize,
    /// Sectors that show the box, and those of them whose distance is within two deviations of the truth.
    told: usize,
    within: usize,
    /// Grounds that are more than half a degree off.
    tilted: usize,
}

/// Boxes of 20 x 20 cm at every distance up to where the deviation is a tenth of their side: `Z^2 / (f b)
/// sigma = 0.02 m` at 1.31 m.
fn boxes(seeds: u32, frames: usize) -> Boxes {
    let mut found = Boxes::default();
    let scale = DepthScale::new(&RobotScene::rig()).expect("a scale");
    assert!(scale.rig().focal_px() * scale.rig().baseline_m() * 0.02 / 0.15 < 1.32 * 1.32);
    for seed in 1..=seeds {
        for mm in (500..=1300).step_by(100) {
            let scene = RobotScene::BoxAt(mm).scene(seed);
            let (pictures, mut cameras) = (scene.render(), Cameras::<Block>::new(&scene));
            // The middle of the front, 0.1 m above the ground.
            let (sin, cos) = RobotScene::PITCH_RAD.sin_cos();
            let depth_mm = f64::from(mm) * cos + 1000.0 * (RobotScene::HEIGHT_M - 0.1) * sin;
            for n in 0..frames {
                for noise in NOISES {
                    let (left, right) = frame(&pictures, noise, n);
                    let view = cameras.frame(&left, &right).finder.as_mut_view();
                    found.frames += 1;
                    let near = (0..view.sectors()).map(|i| view.sector(i)).filter(|s| {
                        s.state == SectorState::Obstacle
                            && (f64::from(s.depth_mm) / depth_mm - 1.0).abs() < 0.2
                    });
                    let off = near.map(|s| (f64::from(s.depth_mm) - depth_mm) / f64::from(s.sigma_mm));
                    let off: Vec<_> = off.collect();
                    found.missed += usize::from(off.is_empty());
                    found.told += off.len();
                    found.within += off.iter().filter(|off| off.abs() <= 2.0).count();
                    found.tilted += usize::from(tilt_deg(&view).is_none_or(|tilt| tilt.abs() > 0.5));
                }
            }
        }
    }
    found
}

/// How far the ground's pitch is off, degrees.
fn tilt_deg(frame: &ObstaclesView<'_>) -> Option<f64> {
    Some((f64::from(frame.ground()?.pitch_rad()) - RobotScene::PITCH_RAD).to_degrees())
}

/// Frames of scenes without anything to drive into in which something is said to be.
fn alarms(scene: RobotScene, seed: u32, noise_grey: f64, frames: usize) -> usize {
    let scene = scene.scene(seed);
    let (pictures, mut cameras) = (scene.render(), Cameras::<Block>::new(&scene));
    let mut alarms = 0;
    for n in 0..frames {
        let (left, right) = frame(&pictures, noise_grey, n);
        let view = cameras.frame(&left, &right).finder.as_mut_view();
        alarms += usize::from(decide(&view) != Decision::Clear);
    }
    alarms
}

#[test]
fn boxes_are_found_at_their_distance() {
    let found = boxes(2, 2);
    assert_eq!((found.frames, found.missed, found.tilted), (72, 0, 0), "{found:?}");
    assert!(100 * found.within >= 95 * found.told && found.told >= 3 * found.frames, "{found:?}");
}

#[test]
fn what_is_empty_is_clear() {
    for scene in RobotScene::EMPTY {
        for seed in 1..=3 {
            assert_eq!(alarms(scene, seed, 0.0, 4), 0, "{scene:?}, seed {seed}");
            assert_eq!(alarms(scene, seed, 3.0, 20), 0, "{scene:?}, seed {seed}, noise 3");
        }
    }
}

#[test]
fn the_ground_is_where_it_is() {
    let all = [RobotScene::Corridor, RobotScene::Street, RobotScene::Sky, RobotScene::Poles];
    for scene in all {
        for (seed, noise) in [(1, 0.0), (2, 3.0), (3, 3.0)] {
            let scene_of = scene.scene(seed);
            let (left, right) = frame(&scene_of.render(), noise, 0);
            let mut cameras = Cameras::<Block>::new(&scene_of);
            let view = cameras.frame(&left, &right).finder.as_mut_view();
            let tilt = tilt_deg(&view);
            assert!(tilt.is_some_and(|tilt| tilt.abs() < 0.5), "{scene:?}, seed {seed}: {tilt:?}");
            let height_mm = view.ground().map_or(0, |ground| ground.height_mm);
            assert!((290..=310).contains(&height_mm), "{scene:?}, seed {seed}: {height_mm} mm");
        }
    }
}

#[test]
fn the_edge_of_a_table_is_where_it_is() {
    fn edges<M: Method>(found: &mut Vec<f64>) {
        let (sin, cos) = RobotScene::PITCH_RAD.sin_cos();
        let depth_mm = 900.0 * cos + 1000.0 * RobotScene::HEIGHT_M * sin;
        for (seed, noise) in (1..=6).flat_map(|seed| NOISES.map(|noise| (seed, noise))) {
            let scene = RobotScene::Table.scene(seed);
            let (left, right) = frame(&scene.render(), noise, 0);
            let mut cameras = Cameras::<M>::new(&scene);
            let view = cameras.frame(&left, &right).finder.as_mut_view();
            let drops = (0..view.sectors()).map(|i| view.sector(i)).filter(|s| s.state == SectorState::Drop);
            found.extend(drops.map(|s| (f64::from(s.depth_mm) - depth_mm) / f64::from(s.sigma_mm)));
        }
    }
    let mut offs = Vec::new();
    edges::<Block>(&mut offs);
    edges::<Sgm>(&mut offs);
    let mean = offs.iter().sum::<f64>() / offs.len() as f64;
    let within = offs.iter().filter(|off| off.abs() <= 2.0).count();
    assert!(offs.len() >= 12 * 12, "{} sectors", offs.len());
    assert!(mean.abs() < 1.0 && 100 * within >= 95 * offs.len(), "mean {mean}, {within} of {offs:.1?}");
}

#[test]
fn a_table_is_not_driven_off_and_a_white_wall_not_into() {
    for seed in 1..=3 {
        for noise in NOISES {
            for scene in [RobotScene::Table, RobotScene::WhiteWall] {
                let pictures = scene.scene(seed).render();
                let mut cameras = Cameras::<Block>::new(&scene.scene(seed));
                for n in 0..4 {
                    let (left, right) = frame(&pictures, noise, n);
                    let view = cameras.frame(&left, &right).finder.as_mut_view();
                    // Faster than half a metre a second: what is 0.9 m ahead counts.
                    let decision = DriveRule::new(DriveConfig::default()).decide(&view, 700).decision;
                    assert_ne!(decision, Decision::Clear, "{scene:?}, seed {seed}, noise {noise}, frame {n}");
                    if scene == RobotScene::Table {
                        assert!(
                            matches!(decision, Decision::Slow(750..1000) | Decision::Stop(_)),
                            "{decision:?}"
                        );
                    }
                }
            }
        }
    }
}
