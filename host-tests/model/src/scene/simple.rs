//! A wall, a room, and ways there that little can be told from: standing still, turning on the spot, nothing
//! near.

use super::{MovingScene, Object, Scene, Shape, Texture};
use nalgebra::{Point3, Rotation3, Vector3};
use stereopsis::geometry::camera::{Pose, RectifiedRig};

/// Metres from frame to frame where the camera moves, and its turn, radians.
const STEP_M: f64 = 0.12;
const TURN_RAD: f64 = 0.015;

impl Scene {
    /// A wall without an end, so far ahead and with this normal, and nothing else: `width` columns, two
    /// thirds of them as rows, a baseline of 0.12 m.
    pub fn wall(width: u16, distance_m: f64, normal: Vector3<f64>) -> Self {
        let wall = Object::plane(Point3::new(0.0, 0.0, distance_m), normal, texture(1, distance_m * 0.2));
        let (w, height) = (f32::from(width), width * 2 / 3);
        let rig = RectifiedRig::new(0.75 * w, 0.12, w / 2.0 - 0.5, f32::from(height) / 2.0 - 0.5);
        Self::new(rig.expect("a rig"), width, height, 64).with(wall)
    }

    /// A room, seen by the same rig: a wall ahead, a floor, boxes.
    pub fn boxes(width: u16) -> Self {
        let floor = Object::plane(Point3::new(0.0, 1.0, 0.0), Vector3::y(), texture(2, 0.6));
        let scene = Self::wall(width, 6.0, Vector3::new(0.2, 0.0, 1.0)).with(floor);
        (0..6).fold(scene, |scene, i| {
            let n = f64::from(i);
            let place = Point3::new(n * 0.9 - 2.2, 0.5 - 0.4 * (n % 3.0), 2.4 + 0.5 * (n % 4.0));
            let half = Vector3::new(0.3, 0.35, 0.3);
            let turn = Rotation3::from_axis_angle(&Vector3::y_axis(), n);
            scene.with(Object::new(Shape::Cuboid { half }, texture(5 + i, 0.4), place).turned(turn))
        })
    }
}

impl MovingScene {
    /// The room, and the rig stands.
    pub fn still(width: u16, frames: usize) -> Self {
        Self::new(Scene::boxes(width), vec![Pose::identity(); frames])
    }

    /// The room, and the rig turns on the spot.
    pub fn turning(width: u16, frames: usize) -> Self {
        Self::new(Scene::boxes(width), way(frames, 0.0))
    }

    /// A slanted wall, passed by.
    pub fn along_wall(width: u16, frames: usize) -> Self {
        Self::new(Scene::wall(width, 2.5, Vector3::new(0.3, 0.09, 1.0)), way(frames, STEP_M))
    }

    /// All is three kilometres away.
    pub fn far(width: u16, frames: usize) -> Self {
        Self::new(Scene::wall(width, 3000.0, Vector3::z()), way(frames, STEP_M))
    }
}

/// Turned a little, and moved to the right and ahead, with every frame.
fn way(frames: usize, step_m: f64) -> Vec<Pose<f64>> {
    let at = |n: usize| {
        let n = n as f64;
        let turn = Rotation3::from_axis_angle(&Vector3::y_axis(), TURN_RAD * n);
        Pose::new(*turn.matrix(), Vector3::new(step_m * n, 0.0, 0.4 * step_m * n)).expect("a rotation")
    };
    (0..frames).map(at).collect()
}

fn texture(seed: u32, coarsest_m: f64) -> Texture {
    Texture::new(seed, 0.5, 0.45).with_octaves(coarsest_m, 7)
}
