//! Scenes with what matchers see surfaces in where there are none: a sky, a white wall, a glossy box, thin
//! poles.

use super::{Object, Scene, Shape, Texture, Truth};
use nalgebra::{Point3, Rotation3, Vector3};
use stereopsis::geometry::camera::RectifiedRig;
use stereopsis::units::Disparity;

/// What of a hard scene a pixel shows.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Part {
    /// An overcast sky: faint clouds, all but infinitely far.
    Sky,
    /// A white wall with hardly any texture.
    Wall,
    /// A box that mirrors the lamp.
    Glossy,
    /// A pole of a few pixels' width.
    Pole,
    /// A chessboard: squares that repeat along the row within the search.
    Board,
    /// Anything else, all of which has texture.
    Textured,
}

/// A scene whose objects are told apart by what is hard about them.
#[derive(Clone, Debug)]
pub struct HardScene {
    /// What the scene is called.
    pub name: &'static str,
    /// The scene itself.
    pub scene: Scene,
    parts: Vec<Part>,
}

impl HardScene {
    fn new(name: &'static str, scene: Scene) -> Self {
        Self { name, scene, parts: Vec::new() }
    }

    fn with(self, part: Part, object: Object) -> Self {
        let mut parts = self.parts;
        parts.push(part);
        Self { scene: self.scene.with(object), parts, ..self }
    }

    /// The scene with a glossy body, turned so that it mirrors the lamp into the cameras.
    fn with_glossy(self, object: Object) -> Self {
        let to_lamp = (self.scene.lamp - object.position).normalize();
        let half_way = to_lamp - object.position.coords.normalize();
        let turn = Rotation3::rotation_between(&-Vector3::z(), &half_way).unwrap_or_default();
        self.with(Part::Glossy, object.turned(turn).glossy(0.6))
    }

    /// What the object of this number is, as [`Truth::objects`](super::Truth::objects) has it; an empty place
    /// is sky.
    pub fn part(&self, object: Option<usize>) -> Part {
        object.and_then(|number| self.parts.get(number).copied()).unwrap_or(Part::Sky)
    }

    /// A street under an overcast sky: houses on both sides, a tree, lamp posts before the sky and a car that
    /// shines. 640 x 240 px, 64 disparities, the rig of a car; `noise_grey` as of
    /// [`Scene::with_noise`].
    pub fn street(noise_grey: f64, seed: u64) -> Self {
        const EYE_M: f64 = 1.65;
        let rig = RectifiedRig::new(371.0, 0.54, 319.5, 119.5).expect("the numbers are in range");
        let scene = Scene::new(rig, 640, 240, 64)
            .with_light(Point3::new(-30.0, -60.0, -40.0), 0.4)
            .with_noise(noise_grey, seed);
        let body = |shape: Shape, texture: Texture, x: f64, above_ground: f64, z: f64| {
            Object::new(shape, texture, Point3::new(x, EYE_M - above_ground, z))
        };
        let house = |seed: u32, brightness: f64| Texture::new(seed, brightness, 0.3).with_octaves(1.5, 8);
        let mut hard = Self::new("street", scene)
            .with(
                Part::Sky,
                Object::plane(
                    Point3::new(0.0, 0.0, 4000.0),
                    Vector3::z(),
                    Texture::new(3, 0.83, 0.004).with_octaves(1200.0, 6),
                ),
            )
            .with(
                Part::Textured,
                Object::plane(
                    Point3::new(0.0, EYE_M, 0.0),
                    Vector3::y(),
                    Texture::new(1, 0.35, 0.08).with_octaves(2.0, 8),
                ),
            );
        for (number, (x, z, half_width, height)) in [
            (-9.5, 11.0, 3.0, 5.0),
            (-12.0, 24.0, 4.0, 8.0),
            (-14.0, 45.0, 4.0, 7.0),
            (10.0, 15.0, 3.5, 6.5),
            (13.5, 33.0, 4.5, 9.0),
            (3.0, 90.0, 6.0, 7.0),
        ]
        .into_iter()
        .enumerate()
        {
            let half = Vector3::new(half_width, height / 2.0, 4.0);
            let texture = house(50 + number as u32, 0.3 + 0.08 * number as f64);
            hard = hard.with(Part::Textured, body(Shape::Cuboid { half }, texture, x, height / 2.0, z));
        }
        let tree = Texture::new(71, 0.3, 0.5).with_octaves(0.6, 6);
        hard = hard.with(Part::Textured, body(Shape::Sphere { radius: 2.2 }, tree.clone(), -4.2, 4.4, 20.0));
        let trunk = Shape::Cylinder { radius: 0.2, half_height: 1.4 };
        hard = hard.with(Part::Textured, body(trunk, tree, -4.2, 1.4, 20.0));
        for (number, (x, z, radius)) in
            [(-2.6, 7.0, 0.04), (2.9, 9.0, 0.05), (3.1, 16.0, 0.08), (-0.6, 13.0, 0.04)]
                .into_iter()
                .enumerate()
        {
            let post = Shape::Cylinder { radius, half_height: 2.4 };
            let texture = Texture::new(80 + number as u32, 0.35, 0.25).with_octaves(0.4, 6);
            hard = hard.with(Part::Pole, body(post, texture, x, 2.4, z));
        }
        let car = Shape::Cuboid { half: Vector3::new(0.9, 0.7, 2.0) };
        let paint = Texture::new(91, 0.2, 0.04).with_octaves(0.5, 5);
        hard.with_glossy(body(car, paint, 1.2, 0.7, 9.5))
    }

    /// A room with a white wall: a lamp without texture, a box, a ball, a glossy box and two thin poles
    /// before it. 450 x 375 px, 64 disparities; `noise_grey` as of [`Scene::with_noise`].
    pub fn white_room(noise_grey: f64, seed: u64) -> Self {
        const EYE_M: f64 = 0.5;
        let rig = RectifiedRig::new(450.0, 0.16, 224.5, 187.0).expect("the numbers are in range");
        let scene = Scene::new(rig, 450, 375, 64)
            .with_light(Point3::new(-1.0, -1.6, 0.2), 0.5)
            .with_noise(noise_grey, seed);
        let body = |shape: Shape, texture: Texture, x: f64, above_floor: f64, z: f64| {
            Object::new(shape, texture, Point3::new(x, EYE_M - above_floor, z))
        };
        let pole = Shape::Cylinder { radius: 0.009, half_height: 0.7 };
        let pole_texture = |seed: u32| Texture::new(seed, 0.4, 0.3).with_octaves(0.05, 4);
        Self::new("white room", scene)
            .with(
                Part::Wall,
                Object::plane(
                    Point3::new(0.0, 0.0, 3.2),
                    Vector3::new(-0.08, 0.0, 1.0),
                    Texture::new(5, 0.9, 0.004).with_octaves(0.5, 6),
                ),
            )
            .with(
                Part::Textured,
                Object::plane(
                    Point3::new(0.0, EYE_M, 0.0),
                    Vector3::y(),
                    Texture::new(11, 0.5, 0.16).with_octaves(0.04, 4),
                ),
            )
            .with(
                Part::Textured,
                body(
                    Shape::Cuboid { half: Vector3::new(0.22, 0.26, 0.2) },
                    Texture::new(31, 0.5, 0.2).with_octaves(0.05, 4),
                    -0.42,
                    0.26,
                    2.1,
                ),
            )
            .with(
                Part::Wall,
                body(
                    Shape::Cylinder { radius: 0.17, half_height: 0.2 },
                    Texture::new(33, 0.75, 0.01).with_octaves(0.2, 4),
                    -0.36,
                    0.72,
                    2.15,
                ),
            )
            .with(
                Part::Textured,
                body(
                    Shape::Sphere { radius: 0.15 },
                    Texture::new(43, 0.6, 0.2).with_octaves(0.03, 4),
                    0.12,
                    0.15,
                    1.7,
                ),
            )
            .with_glossy(body(
                Shape::Cuboid { half: Vector3::new(0.16, 0.3, 0.15) },
                Texture::new(47, 0.35, 0.03).with_octaves(0.1, 4),
                0.62,
                0.3,
                2.3,
            ))
            .with(Part::Pole, body(pole.clone(), pole_texture(53), 0.2, 0.7, 2.4))
            .with(Part::Pole, body(pole, pole_texture(59), 0.36, 0.7, 2.0))
    }

    /// Two chessboards before a wall with texture: one that faces the cameras, with a period of 14 px, and
    /// one that is slanted, with one of about 23 px. 450 x 375 px, 64 disparities; `noise_grey` as of
    /// [`Scene::with_noise`].
    pub fn boards(noise_grey: f64, seed: u64) -> Self {
        let rig = RectifiedRig::new(450.0, 0.16, 224.5, 187.0).expect("the numbers are in range");
        let scene = Scene::new(rig, 450, 375, 64)
            .with_light(Point3::new(-1.0, -1.6, 0.2), 0.5)
            .with_noise(noise_grey, seed);
        let wall = Texture::new(7, 0.5, 0.2).with_octaves(0.1, 5);
        let board = |squares_m: f64, x: f64, z: f64| {
            let texture = Texture::new(0, 0.5, 0.6).with_squares(squares_m);
            let half = Vector3::new(0.3, 0.6, 0.01);
            Object::new(Shape::Cuboid { half }, texture, Point3::new(x, 0.0, z))
        };
        let slant = Rotation3::from_axis_angle(&Vector3::y_axis(), 0.35);
        Self::new("boards", scene)
            .with(Part::Textured, Object::plane(Point3::new(0.0, 0.0, 3.2), Vector3::z(), wall))
            .with(Part::Board, board(0.0373, -0.36, 2.4))
            .with(Part::Board, board(0.058, 0.42, 2.2).turned(slant))
    }
}

/// What a matcher says of a part of a scene, as shares of the part's pixels.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Shares {
    /// Pixels that have an answer.
    pub answered: f64,
    /// Answers nearer than the truth, by over 2 px.
    pub false_near: f64,
    /// Answers farther than the truth, by over 2 px.
    pub false_far: f64,
}

impl Shares {
    /// What the disparities `found`, one a pixel, say of all pixels of a `part` that both cameras see; `None`
    /// where there is no such pixel.
    pub fn of(hard: &HardScene, truth: &Truth, found: &[Disparity], part: Part) -> Option<Self> {
        let seen =
            (0..truth.disparity.len()).filter(|&i| !truth.occluded[i] && hard.part(truth.objects[i]) == part);
        let errors: Vec<_> =
            seen.map(|i| found[i].to_f32().map(|answer| answer - truth.disparity[i])).collect();
        let share = |counts: fn(f32) -> bool| {
            errors.iter().flatten().filter(|&&error| counts(error)).count() as f64 / errors.len() as f64
        };
        (!errors.is_empty()).then(|| Self {
            answered: share(|_| true),
            false_near: share(|error| error > 2.0),
            false_far: share(|error| error < -2.0),
        })
    }
}
