//! What a small robot drives towards: scenes with a ground of known pose.

use super::{Object, Scene, Shape, Texture};
use nalgebra::{Point3, Rotation3, Vector3};
use stereopsis::geometry::camera::RectifiedRig;

/// A scene before a robot whose cameras stand 0.3 m above the ground and look down by 0.15 rad.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum RobotScene {
    /// A corridor 3 m wide with a wall 6 m ahead.
    Corridor,
    /// A street with houses on both sides, under a faint sky.
    Street,
    /// Nothing but the ground and a sky with hardly any texture.
    Sky,
    /// A table that ends 0.9 m ahead, 0.7 m above the floor.
    Table,
    /// The corridor, with poles of 2 cm at 0.6 m and 0.8 m.
    Poles,
    /// The corridor, with a wall without texture 0.8 m ahead.
    WhiteWall,
    /// The corridor, with a box of 20 x 20 cm whose front is at this distance along the ground, mm.
    BoxAt(u16),
    /// The corridor, with a pole of 2 cm at this distance along the ground and to the right, mm.
    PoleAt(u16, i16),
}

impl RobotScene {
    /// Height of the cameras above the ground, m.
    pub const HEIGHT_M: f64 = 0.3;
    /// Downward pitch of the cameras, rad.
    pub const PITCH_RAD: f64 = 0.15;
    /// Scenes without anything to drive into.
    pub const EMPTY: [Self; 3] = [Self::Corridor, Self::Street, Self::Sky];

    /// The cameras: 160 x 120 px, a focal length of 130 px, a baseline of 0.1 m.
    ///
    /// # Panics
    ///
    /// Never: the numbers are a rig's.
    pub fn rig() -> RectifiedRig {
        RectifiedRig::new(130.0, 0.1, 79.5, 59.5).expect("numbers of a rig")
    }

    /// The scene, without noise, with textures of a seed; 32 disparities.
    pub fn scene(self, seed: u32) -> Scene {
        let ground_m = if self == Self::Table { -0.7 } else { 0.0 };
        let empty = Scene::new(Self::rig(), 160, 120, 32)
            .with_light(point(-1.0, 4.0, -2.0), 0.6)
            .with_noise(0.0, 1)
            .with(Object::plane(
                point(0.0, ground_m, 0.0),
                look() * Vector3::y(),
                Texture::new(seed, 0.5, 0.35).with_octaves(0.16, 6),
            ));
        let rough = |n: u32, brightness: f64| {
            Texture::new(seed.wrapping_mul(31) + n, brightness, 0.4).with_octaves(0.2, 6)
        };
        let cuboid = |size: [f64; 3]| Shape::Cuboid { half: Vector3::from(size) / 2.0 };
        let pole = Shape::Cylinder { radius: 0.01, half_height: 0.5 };
        let walls = |scene: Scene| {
            scene
                .with(put(cuboid([0.2, 4.0, 20.0]), rough(1, 0.45), [-1.6, 2.0, 5.0]))
                .with(put(cuboid([0.2, 4.0, 20.0]), rough(2, 0.6), [1.6, 2.0, 5.0]))
                .with(put(cuboid([4.0, 4.0, 0.2]), rough(3, 0.5), [0.0, 2.0, 6.1]))
        };
        let sky = |scene: Scene| {
            let faint = Texture::new(seed + 7, 0.85, 0.004).with_octaves(400.0, 5);
            scene.with(Object::plane(Point3::new(0.0, 0.0, 1000.0), Vector3::z(), faint))
        };
        match self {
            Self::Corridor => walls(empty),
            Self::Street => (0..6).fold(sky(empty), |scene, n| {
                let side = if n % 2 == 0 { -3.5 } else { 3.5 };
                let at = [side, 2.0, 4.0 + 3.0 * f64::from(n)];
                scene.with(put(cuboid([3.0, 4.0, 3.0]), rough(10 + n, 0.4), at))
            }),
            Self::Sky => sky(empty),
            Self::Table => {
                walls(empty).with(put(cuboid([2.0, 0.04, 1.5]), rough(4, 0.6), [0.0, -0.02, 0.15]))
            }
            Self::Poles => walls(empty).with(put(pole.clone(), rough(5, 0.8), [0.02, 0.5, 0.6])).with(put(
                pole,
                rough(6, 0.2),
                [-0.15, 0.5, 0.8],
            )),
            Self::PoleAt(mm, right_mm) => {
                let [z, x] = [f64::from(mm), f64::from(right_mm)].map(|mm| mm / 1000.0);
                walls(empty).with(put(pole, rough(9, 0.2 * f64::from(1 + seed % 4)), [x, 0.5, z]))
            }
            Self::WhiteWall => {
                walls(empty).with(put(cuboid([2.9, 4.0, 0.1]), Texture::flat(0.9), [0.0, 2.0, 0.85]))
            }
            Self::BoxAt(mm) => {
                let at = [0.0, 0.1, f64::from(mm) / 1000.0 + 0.1];
                walls(empty).with(put(cuboid([0.2; 3]), rough(8, 0.55), at))
            }
        }
    }
}

/// Coordinates of the ground (X right, Y down, Z ahead, origin below the left camera) to the camera's.
fn look() -> Rotation3<f64> {
    Rotation3::from_axis_angle(&Vector3::x_axis(), RobotScene::PITCH_RAD)
}

/// The point at a height above the ground, m.
fn point(x: f64, height: f64, z: f64) -> Point3<f64> {
    Point3::from(look() * Vector3::new(x, RobotScene::HEIGHT_M - height, z))
}

/// A body whose middle is at x, height and z.
fn put(shape: Shape, texture: Texture, [x, height, z]: [f64; 3]) -> Object {
    Object::new(shape, texture, point(x, height, z)).turned(look())
}
