//! The ground of a street and of a road that a car drives through, beside the true pose of each frame.

use super::support::Cameras;
use image::GrayImage;
use std::fmt::Write as _;
use stereopsis::geometry::camera::Pose;
use stereopsis::matching::{Block, Method, Sgm};
use stereopsis::obstacles::{Ground, ObstacleConfig};
use stereopsis_host::scene::{MovingScene, Scene};

/// Frames of each drive.
const FRAMES: usize = 60;

/// A drive as `stereo walk` draws it, with noise of two grey levels.
struct Drive {
    name: &'static str,
    scene: Scene,
    pictures: Vec<(GrayImage, GrayImage)>,
    poses: Vec<Pose<f64>>,
}

impl Drive {
    fn of(name: &'static str, scene: MovingScene) -> Self {
        let scene = scene.with_noise(2.0);
        let pictures = (0..scene.len()).map(|i| scene.frame(i)).collect();
        Self { name, pictures, poses: scene.truth(), scene: scene.scene().clone() }
    }

    /// The grounds of all frames through a method, carried from one to the next or each by itself.
    fn grounds<M: Method>(&self, is_carried: bool) -> Grounds {
        let fresh = || Cameras::<M>::of(&self.scene, &ObstacleConfig::default(), true);
        let mut cameras = fresh();
        let mut grounds = Grounds::default();
        for ((left, right), pose) in self.pictures.iter().zip(&self.poses) {
            if !is_carried {
                cameras = fresh();
            }
            let view = cameras.frame(left, right).finder.as_mut_view();
            // Y points down in the scene, as it does in the camera.
            let pitch = pose.rotation()[(1, 2)].asin();
            let off = |ground: Ground| (f64::from(ground.pitch_rad()) - pitch).to_degrees().abs();
            grounds.planes.extend(view.plane().map(off));
            grounds.told.extend(view.ground().map(off));
        }
        grounds
    }
}

/// How far the pitches of planes are off, and those of the grounds that were told, degrees.
#[derive(Default, Debug)]
struct Grounds {
    planes: Vec<f64>,
    told: Vec<f64>,
}

fn within(offs: &[f64], most_deg: f64) -> usize {
    offs.iter().filter(|off| **off <= most_deg).count()
}

/// A method's lines of the table.
fn through<M: Method>(drive: &Drive, table: &mut String) {
    for is_carried in [false, true] {
        let Grounds { planes, told } = drive.grounds::<M>(is_carried);
        let _ = writeln!(
            table,
            "| `{}` | {} | {} | {FRAMES} | {} | {} | {} | {} | {:.2} |",
            M::NAME,
            drive.name,
            if is_carried { "carried" } else { "of each frame" },
            within(&planes, 0.5),
            within(&planes, 1.2),
            told.len(),
            told.len() - within(&told, 0.5),
            told.iter().copied().fold(0.0, f64::max),
        );
        let case = format!("{} {}, carried: {is_carried}", M::NAME, drive.name);
        assert!(drive.name != "street" || within(&told, 0.5) == FRAMES, "{case}: {told:?}");
        assert_eq!(within(&told, 1.0), told.len(), "{case}: {told:?}");
    }
}

/// The table's lines.
pub fn drives() -> String {
    let street = MovingScene::street(320, 160, FRAMES, 0.5, 7);
    let road = MovingScene::road(320, FRAMES, 1.2, 3);
    let mut table = String::new();
    for drive in [Drive::of("street", street), Drive::of("road", road)] {
        through::<Block>(&drive, &mut table);
        through::<Sgm>(&drive, &mut table);
    }
    table
}
