//! A road with traffic: what is hard on an odometry.

use super::{MovingScene, Object, Random, Scene, Shape, Texture};
use nalgebra::{Point3, Rotation3, Vector3};
use stereopsis::geometry::camera::{Pose, RectifiedRig};

/// A place along the road, and which way it goes there.
#[derive(Clone, Copy)]
struct Place {
    at: Point3<f64>,
    heading: f64,
}

impl Place {
    /// The pose of what stands so far right of the road's middle and so far above the camera's height, with
    /// its Z along the road.
    fn beside(&self, right_m: f64, down_m: f64) -> Pose<f64> {
        let turn = Rotation3::from_axis_angle(&Vector3::y_axis(), self.heading);
        let place = self.at + turn * Vector3::new(right_m, down_m, 0.0);
        Pose::new(*turn.matrix(), place.coords).expect("a rotation")
    }
}

/// Frames of a straight piece and of a bend, and the bends' turn per frame, degrees.
const STRAIGHT: f64 = 18.0;
const BEND: f64 = 20.0;
const BEND_DEG: [f64; 3] = [2.5, -3.0, 2.0];
/// The road is known every so many metres.
const GRAIN_M: f64 = 0.05;
/// Metres that are built beyond the last frame, and before the first.
const BEYOND_M: f64 = 60.0;

/// Places along the road, every [`GRAIN_M`] from [`BEYOND_M`] before the start.
fn road(frames: usize, step_m: f64) -> Vec<Place> {
    let length = frames as f64 * step_m + 2.0 * BEYOND_M;
    let mut place = Place { at: Point3::new(0.0, 0.0, -BEYOND_M), heading: 0.0 };
    let mut places = Vec::new();
    for i in 0..(length / GRAIN_M) as usize {
        places.push(place);
        let frame = (i as f64 * GRAIN_M - BEYOND_M) / step_m;
        let piece = (frame / (STRAIGHT + BEND)).floor();
        let bends = frame > 0.0 && frame - piece * (STRAIGHT + BEND) > STRAIGHT;
        if bends {
            let turn = BEND_DEG[piece as usize % BEND_DEG.len()].to_radians();
            place.heading += turn * GRAIN_M / step_m;
        }
        place.at += Vector3::new(place.heading.sin(), 0.0, place.heading.cos()) * GRAIN_M;
    }
    places
}

impl MovingScene {
    /// A road that is driven along in steps of `step_m`, straight and in bends of 2 to 3 degrees a frame:
    /// houses and posts beside a surface with little to see, cars ahead and oncoming, lorries that
    /// overtake and that cross, up to a third of the picture. `width` columns, three tenths of them as
    /// rows, the field of view and the baseline (0.54 m) of a car's.
    pub fn road(width: u16, frames: usize, step_m: f64, seed: u64) -> Self {
        let height = width * 3 / 10;
        let (cx, cy) = (f32::from(width) / 2.0 - 0.5, f32::from(height) / 2.0 - 0.5);
        let rig = RectifiedRig::new(0.58 * f32::from(width), 0.54, cx, cy).expect("numbers of a rig");
        let mut random = Random::new(seed);
        let places = road(frames, step_m);
        let at = |along_m: f64| {
            let index = ((along_m + BEYOND_M) / GRAIN_M).round().clamp(0.0, (places.len() - 1) as f64);
            places[index as usize]
        };
        let texture = |seed: u32, brightness: f64| Texture::new(seed, brightness, 0.3).with_octaves(1.5, 8);
        let body = |half: Vector3<f64>, seed: u32, brightness: f64, pose: &Pose<f64>| {
            let position = Point3::from(*pose.translation());
            let turn = Rotation3::from_matrix_unchecked(*pose.rotation());
            Object::new(Shape::Cuboid { half }, texture(seed, brightness), position).turned(turn)
        };
        let surface = Texture::new(1, 0.35, 0.06).with_octaves(2.0, 8);
        let mut scene = Scene::new(rig, width, height, 128).with(Object::plane(
            Point3::new(0.0, 1.65, 0.0),
            Vector3::y(),
            surface,
        ));
        let way = frames as f64 * step_m;
        let rows = ((way + BEYOND_M) / 9.0) as u32;
        for i in 0..rows {
            for side in [-1.0, 1.0] {
                let number = 10 + 4 * i + u32::from(side > 0.0);
                let along = f64::from(i) * 9.0 + 3.0 * random.unit();
                let half = Vector3::new(2.0 + random.unit(), 2.0 + 3.0 * random.unit(), 3.5 + random.unit());
                let pose = at(along).beside(side * (8.0 + 4.0 * random.unit() + half.x), 1.65 - half.y);
                scene = scene.with(body(half, number, 0.3 + 0.4 * random.unit(), &pose));
                let half = Vector3::new(0.12, 1.2 + random.unit(), 0.12);
                let pose =
                    at(along + 9.0 * random.unit()).beside(side * (4.6 + random.unit()), 1.65 - half.y);
                scene = scene.with(body(half, number + 2, 0.2 + 0.4 * random.unit(), &pose));
            }
        }
        let path: Vec<_> = (0..frames)
            .map(|i| {
                let here = at(i as f64 * step_m).beside(0.0, 0.03 * (i as f64 * 0.9).sin());
                let nod = Rotation3::from_euler_angles(
                    0.006 * (i as f64 * 1.1).sin(),
                    0.0,
                    0.004 * (i as f64 * 0.7).sin(),
                );
                here.then(&Pose::new(*nod.matrix(), Vector3::zeros()).expect("a rotation"))
            })
            .collect();
        let car = |seed: u32| {
            let half = Vector3::new(0.9, 0.75, 2.1);
            body(half, seed, 0.5, &Pose::identity())
        };
        let lorry = |seed: u32| body(Vector3::new(1.25, 1.5, 4.5), seed, 0.6, &Pose::identity());
        let along = |f: &dyn Fn(f64) -> Pose<f64>| (0..frames).map(|i| f(i as f64)).collect::<Vec<_>>();
        let mut moving = Self::new(scene, path);
        // One ahead, nearer and farther; oncoming ones; one that overtakes for as long as it is alongside;
        // one that crosses.
        moving = moving.with_mover(
            car(7001),
            along(&|i| at(i * step_m + 13.0 + 3.0 * (i / 15.0).sin()).beside(0.3, 0.9)),
        );
        for n in 0..(way / 45.0) as u32 + 1 {
            let start = 60.0 + 45.0 * 2.0 * f64::from(n);
            moving = moving.with_mover(car(7100 + n), along(&|i| at(start - i * step_m).beside(-3.2, 0.9)));
        }
        for n in 0..(frames / 80) as u32 + 1 {
            let from = 25.0 + 80.0 * f64::from(n);
            moving = moving.with_mover(
                lorry(7200 + n),
                along(&|i| at(i * step_m + 0.4 * (i - from)).beside(-3.1, 0.15)),
            );
            let crossing = 55.0 + 80.0 * f64::from(n);
            let place = at((crossing + 4.0) * step_m + 20.0);
            moving = moving.with_mover(
                lorry(7300 + n),
                along(&|i| {
                    let across = Rotation3::from_axis_angle(&Vector3::y_axis(), core::f64::consts::FRAC_PI_2);
                    let across = Pose::new(*across.matrix(), Vector3::zeros()).expect("a rotation");
                    place.beside(1.6 * (i - crossing - 4.0), 0.15).then(&across)
                }),
            );
        }
        moving
    }
}
