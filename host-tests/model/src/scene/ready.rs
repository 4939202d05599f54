//! Ready-made scenes.

use super::{Object, Scene, Shape, Texture};
use nalgebra::{Point3, Rotation3, Vector3};
use stereopsis::geometry::camera::RectifiedRig;

/// The room's camera: metres above the floor, and radians that it looks down.
const CAMERA_HEIGHT: f64 = 0.55;
const CAMERA_PITCH: f64 = 0.26;

/// Room coordinates (X right, Y down with the floor at 0, Z forward, origin below the left camera) to the
/// camera's.
struct Room {
    look: Rotation3<f64>,
}

impl Room {
    fn new() -> Self {
        Self { look: Rotation3::from_axis_angle(&Vector3::x_axis(), CAMERA_PITCH) }
    }

    /// The point `height` metres above the floor.
    fn point(&self, x: f64, height: f64, z: f64) -> Point3<f64> {
        Point3::from(self.look * Vector3::new(x, CAMERA_HEIGHT - height, z))
    }

    /// A body at that point, turned by an angle around the vertical.
    fn put(&self, shape: Shape, texture: Texture, at: (f64, f64, f64), turn_rad: f64) -> Object {
        let turn = Rotation3::from_axis_angle(&Vector3::y_axis(), turn_rad);
        Object::new(shape, texture, self.point(at.0, at.1, at.2)).turned(self.look * turn)
    }
}

impl Scene {
    /// A room: a floor, a slanted back wall with a blank board, boxes, a ball and a pole, 0.75 m to 4.6 m
    /// away. 640 x 480 px, 64 disparities.
    pub fn demo() -> Self {
        Self::room(640, 480)
    }

    /// The room of [`Scene::demo`] in any size of picture. The field of view is the demo's along the longer
    /// side, and the disparities are in proportion, at least 16.
    ///
    /// # Panics
    ///
    /// When a side is 0.
    pub fn small(width: u16, height: u16) -> Self {
        Self::room(width, height)
    }

    fn room(width: u16, height: u16) -> Self {
        assert!(width > 0 && height > 0, "a picture has at least one pixel");
        let scale = (f32::from(width) / 640.0).max(f32::from(height) / 480.0);
        let rig = RectifiedRig::new(
            500.0 * scale,
            0.08,
            (f32::from(width) - 1.0) / 2.0,
            (f32::from(height) - 1.0) / 2.0,
        )
        .expect("the numbers are in range");
        let disparities = ((64.0 * scale).ceil() as u16).clamp(16, 256);
        let room = Room::new();
        let half = |x, y, z| Vector3::new(x, y, z) / 2.0;
        let floor = Object::plane(
            room.point(0.0, 0.0, 0.0),
            room.look * Vector3::new(0.0, -1.0, 0.0),
            Texture::new(11, 0.50, 0.16).with_octaves(0.04, 4),
        );
        Self::new(rig, width, height, disparities)
            .with_light(room.point(-1.3, 2.6, 0.1), 0.3)
            .with(floor)
            // The back wall comes nearer on the right.
            .with(room.put(
                Shape::Plane,
                Texture::new(23, 0.78, 0.09).with_octaves(0.12, 4),
                (0.0, 1.0, 3.3),
                0.42,
            ))
            // A blank board on the wall: nothing to match.
            .with(room.put(
                Shape::Rectangle { half_width: 0.5, half_height: 0.28 },
                Texture::flat(0.97),
                (-0.85, 0.88, 3.65),
                0.42,
            ))
            // A cupboard of upright grain, two stacked boxes, a ball close by, a pole.
            .with(room.put(
                Shape::Cuboid { half: half(0.42, 0.62, 0.42) },
                Texture::new(31, 0.55, 0.16).with_octaves(0.06, 4).with_stretch(1.0, 8.0, 1.0),
                (0.74, 0.31, 2.1),
                0.5,
            ))
            .with(room.put(
                Shape::Cuboid { half: half(0.34, 0.24, 0.28) },
                Texture::new(37, 0.72, 0.14).with_octaves(0.03, 4),
                (-0.60, 0.12, 1.45),
                -0.45,
            ))
            .with(room.put(
                Shape::Cuboid { half: half(0.2, 0.2, 0.2) },
                Texture::new(41, 0.34, 0.22).with_octaves(0.03, 4),
                (-0.56, 0.34, 1.47),
                0.25,
            ))
            .with(room.put(
                Shape::Sphere { radius: 0.12 },
                Texture::new(43, 0.85, 0.16).with_octaves(0.03, 4),
                (0.10, 0.12, 0.78),
                0.0,
            ))
            .with(room.put(
                Shape::Cylinder { radius: 0.03, half_height: 1.2 },
                Texture::new(47, 0.6, 0.25).with_octaves(0.04, 4),
                (-0.12, 1.2, 2.3),
                0.0,
            ))
    }

    /// One textured plane, slanted both ways: 320 x 240 px, 64 disparities. The true disparity at column u
    /// and row v is exactly
    ///
    /// `d = 26 + 0.06 (u - 159.5) + 0.02 (v - 119.5)` px.
    pub fn slanted_plane() -> Self {
        let (width, height) = (320, 240);
        let (focal, baseline, middle) = (400.0, 0.1, 26.0);
        let rig = RectifiedRig::new(focal, baseline, 159.5, 119.5).expect("the numbers are in range");
        let fb = f64::from(focal) * f64::from(baseline);
        // n P = f b with P = Z ((u - cx) / f, (v - cy) / f, 1) gives f b / Z = n_x (u - cx) / f + n_y (v -
        // cy) / f + n_z.
        let n = Vector3::new(0.06 * f64::from(focal), 0.02 * f64::from(focal), middle);
        let point = Point3::from(n * (fb / n.norm_squared()));
        let texture = Texture::new(7, 0.5, 0.25).with_octaves(0.08, 5);
        Self::new(rig, width, height, 64).with(Object::plane(point, n, texture))
    }
}
