//! A scene that a rig moves through: poses that are known, and frames as they come, with noise and the blur
//! of the motion.

use super::{Object, Random, Scene, Shape, Texture};
use image::GrayImage;
use nalgebra::{Point3, Rotation3, Vector3};
use stereopsis::geometry::camera::{Pose, RectifiedRig};

/// A scene, and where the rig's left camera stands in each frame.
#[derive(Clone, Debug)]
pub struct MovingScene {
    scene: Scene,
    path: Vec<Pose<f64>>,
    noise_grey: f64,
    /// The share of the time from frame to frame that the shutter is open.
    shutter: f64,
    /// Bodies with the poses that carry them into the scene, frame by frame.
    movers: Vec<(Object, Vec<Pose<f64>>)>,
    /// By how much pictures are brighter, frame by frame in turn; by nothing when there is none.
    gains: Vec<f64>,
}

/// Moments that make up a blurred frame.
const MOMENTS: usize = 4;

impl MovingScene {
    /// The scene seen from these poses, which carry a point of the left camera into the scene's frame:
    /// without noise, in no time.
    pub fn new(scene: Scene, path: Vec<Pose<f64>>) -> Self {
        Self {
            scene: scene.with_light(Point3::new(0.0, -50.0, 0.0), 1.0),
            path,
            noise_grey: 0.0,
            shutter: 0.0,
            movers: Vec::new(),
            gains: Vec::new(),
        }
    }

    /// The same with Gaussian sensor noise of a deviation in grey levels.
    pub fn with_noise(self, noise_grey: f64) -> Self {
        Self { noise_grey, ..self }
    }

    /// The same with a shutter that is open for a share of the time between frames, 0 to 1: motion blurs.
    pub fn with_shutter(self, shutter: f64) -> Self {
        Self { shutter, ..self }
    }

    /// The same with a body, given in its own frame, that moves: each frame's pose carries it into the scene.
    pub fn with_mover(mut self, body: Object, path: Vec<Pose<f64>>) -> Self {
        self.movers.push((body, path));
        self
    }

    /// The same with pictures of a changing exposure: times these, one frame after the other, and again from
    /// the first.
    pub fn with_gains(self, gains: Vec<f64>) -> Self {
        Self { gains, ..self }
    }

    /// A street of so many metres with walls and boxes on both sides, driven through in steps of `step_m`,
    /// swerving and nodding: `width` x `height` px, a field of view of about 80 degrees, a baseline of
    /// 0.4 m.
    pub fn street(width: u16, height: u16, frames: usize, step_m: f64, seed: u64) -> Self {
        let focal = 0.6 * f32::from(width);
        let (cx, cy) = (f32::from(width) / 2.0 - 0.5, f32::from(height) / 2.0 - 0.5);
        let rig = RectifiedRig::new(focal, 0.4, cx, cy).expect("numbers of a rig");
        let mut random = Random::new(seed);
        let texture = |seed: u32, brightness: f64| Texture::new(seed, brightness, 0.45).with_octaves(0.8, 7);
        let mut scene = Scene::new(rig, width, height, 64)
            .with(Object::plane(Point3::new(0.0, 1.5, 0.0), Vector3::y(), texture(1, 0.45)))
            .with(Object::plane(Point3::new(-9.0, 0.0, 0.0), Vector3::x(), texture(2, 0.5)))
            .with(Object::plane(Point3::new(9.0, 0.0, 0.0), Vector3::x(), texture(3, 0.6)));
        let way = frames as f64 * step_m;
        let boxes = (way / 6.0) as u32 + 8;
        for i in 0..boxes {
            let half =
                Vector3::new(0.6 + random.unit(), 0.8 + 1.2 * random.unit(), 0.6 + 1.4 * random.unit());
            let side = if i % 2 == 0 { 1.0 } else { -1.0 };
            let z = 4.0 + (way + 40.0) * (f64::from(i) + random.unit()) / f64::from(boxes);
            let place = Point3::new(side * (4.0 + 3.0 * random.unit()), 1.5 - half.y, z);
            let brightness = 0.35 + 0.4 * random.unit();
            let turn = Rotation3::from_axis_angle(&Vector3::y_axis(), random.unit());
            let body = Object::new(Shape::Cuboid { half }, texture(10 + i, brightness), place);
            scene = scene.with(body.turned(turn));
        }
        let at = |i: usize| {
            let along = i as f64 * step_m;
            let yaw = 0.08 * (along / 9.0).sin();
            let nod = 0.01 * (along / 2.3).sin();
            let roll = 0.01 * (along / 3.1).cos() - 0.01;
            let turn = Rotation3::from_euler_angles(nod, yaw, roll);
            // The way goes where the camera looks: x' = tan(yaw).
            let place =
                Vector3::new(0.08 * 9.0 * (1.0 - (along / 9.0).cos()), 0.03 * (along / 1.7).sin(), along);
            Pose::new(*turn.matrix(), place).expect("a rotation")
        };
        Self::new(scene, (0..frames).map(at).collect())
    }

    /// The rig.
    pub fn rig(&self) -> RectifiedRig {
        self.scene.rig
    }

    /// The scene, in its own frame.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// How many frames there are.
    pub fn len(&self) -> usize {
        self.path.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.path.is_empty()
    }

    /// The true poses beside the first one.
    pub fn truth(&self) -> Vec<Pose<f64>> {
        let Some(first) = self.path.first() else { return Vec::new() };
        let back = first.inverse();
        self.path.iter().map(|pose| back.then(pose)).collect()
    }

    /// What the two cameras see in a frame, counted from 0: the mean over the time that the shutter is open,
    /// with the frame's pose in its middle.
    ///
    /// # Panics
    ///
    /// When there is no such frame.
    pub fn frame(&self, index: usize) -> (GrayImage, GrayImage) {
        let moments = if self.shutter > 0.0 { MOMENTS } else { 1 };
        let seed = |moment: usize| (index * MOMENTS + moment) as u64 + 1;
        let noise = self.noise_grey * (moments as f64).sqrt();
        let pictures: Vec<_> = (0..moments)
            .map(|moment| {
                let time = ((moment as f64 + 0.5) / moments as f64 - 0.5) * self.shutter;
                let scene = self.movers.iter().fold(self.scene.clone(), |scene, (body, path)| {
                    scene.with(body.clone().carried(&pose_at(path, index, time)))
                });
                scene.seen_from(&pose_at(&self.path, index, time)).with_noise(noise, seed(moment)).render()
            })
            .collect();
        let gain = if self.gains.is_empty() { 1.0 } else { self.gains[index % self.gains.len()] };
        let side = |pick: fn(&(GrayImage, GrayImage)) -> &GrayImage| {
            let first = pick(&pictures[0]);
            GrayImage::from_fn(first.width(), first.height(), |x, y| {
                let sum: u32 = pictures.iter().map(|pair| u32::from(pick(pair).get_pixel(x, y).0[0])).sum();
                let mean = (sum + moments as u32 / 2) / moments as u32;
                image::Luma([(f64::from(mean) * gain).round().min(255.0) as u8])
            })
        };
        (side(|pair| &pair.0), side(|pair| &pair.1))
    }
}

/// The pose a part of the time before or after a frame.
fn pose_at(path: &[Pose<f64>], index: usize, time: f64) -> Pose<f64> {
    let here = path[index];
    let at = |index: Option<usize>| index.and_then(|index| path.get(index));
    let (before, after) = (at(index.checked_sub(1)), at(index.checked_add(1)));
    // Before the first frame, and after the last, the motion is that beside it.
    let (other, share) = match (before, after) {
        (Some(before), _) if time < 0.0 => (before, -time),
        (_, Some(after)) => (after, time),
        (Some(before), None) => (before, -time),
        (None, None) => (&here, 0.0),
    };
    crate::interpolate::between(&here, other, share)
}
