//! Ray-traced scenes for a rectified rig, with their true depth: what a camera would see, and what a matcher
//! should say.
//!
//! In: bodies with textures in the left camera's frame, a rig. Out: two 8-bit pictures with sensor noise, and
//! per pixel of the left one the true depth, the true disparity and whether the right camera sees the point
//! at all.
//!
//! * [`Shape`], [`Object`], [`Texture`]: what a scene is made of.
//! * [`Scene`]: the scene; [`Scene::demo`], [`Scene::small`], [`Scene::slanted_plane`] are ready-made.
//! * [`HardScene`], [`Shares`]: scenes with a sky, a white wall, a glossy box and thin poles, and what a
//!   matcher says of them.
//! * [`MovingScene`]: a scene that the rig moves through.
//! * [`RobotScene`]: what a small robot drives towards, on a ground of known pose.
//! * [`Truth`]: the true values, by ray casting at the pixel centres.
//! * [`SceneCamera`]: pictures as a stereo source.
//! * [`pattern`]: pictures that are hard on a matcher and show nothing.
//! * [`Random`]: seeded random numbers.

pub mod pattern;

mod camera;
mod hard;
mod moving;
pub mod random;
mod ready;
mod render;
mod road;
mod robot;
mod shape;
mod simple;
mod texture;

pub use camera::SceneCamera;
pub use hard::{HardScene, Part, Shares};
pub use moving::MovingScene;
pub use random::Random;
pub use robot::RobotScene;
pub use shape::{Object, Shape};
pub use texture::{Points, SAMPLES, Texture};

use image::GrayImage;
use nalgebra::{Point3, Rotation3};
use render::Eye;
use stereopsis::geometry::camera::{Pose, RectifiedRig};

/// Bodies before a rectified rig, with a lamp.
///
/// Surfaces are Lambertian, but for those that are [`glossy`](Object::glossy): they look equally bright to
/// both cameras, up to the noise of the sensors.
#[derive(Clone, Debug)]
pub struct Scene {
    pub(crate) rig: RectifiedRig,
    pub(crate) width: u16,
    pub(crate) height: u16,
    pub(crate) disparities: u16,
    pub(crate) objects: Vec<Object>,
    pub(crate) lamp: Point3<f64>,
    pub(crate) ambient: f64,
    pub(crate) noise_grey: f64,
    pub(crate) seed: u64,
}

/// The true values at the centres of the left camera's pixels, row by row.
#[derive(Clone, PartialEq, Debug)]
pub struct Truth {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Disparity u - u' of the point that the pixel shows, px; `-doffs` where it shows nothing.
    pub disparity: Vec<f32>,
    /// Depth Z, metres; infinite where the pixel shows nothing.
    pub depth_m: Vec<f32>,
    /// Whether the right camera does not see the point: outside of its picture, or hidden by something
    /// nearer.
    pub occluded: Vec<bool>,
    /// Number of the object that the pixel shows, in the order in which the scene was given them; `None`
    /// where it shows nothing.
    pub objects: Vec<Option<usize>>,
}

impl Scene {
    /// A scene without bodies: `width` x `height` px, searched over `disparities` whole disparities. The lamp
    /// is 2 m above and 1 m left of the left camera, three tenths of the light come from everywhere, and
    /// the sensors have a noise of 1 grey level.
    pub fn new(rig: RectifiedRig, width: u16, height: u16, disparities: u16) -> Self {
        Self {
            rig,
            width,
            height,
            disparities,
            objects: Vec::new(),
            lamp: Point3::new(-1.0, -2.0, 0.0),
            ambient: 0.3,
            noise_grey: 1.0,
            seed: 1,
        }
    }

    /// The scene with one body more.
    pub fn with(mut self, object: Object) -> Self {
        self.objects.push(object);
        self
    }

    /// The scene with the lamp at a point of the left camera's frame, and with this share (0 to 1) of light
    /// from everywhere.
    pub fn with_light(self, lamp: Point3<f64>, ambient: f64) -> Self {
        Self { lamp, ambient, ..self }
    }

    /// The scene seen by sensors with Gaussian noise of this deviation, grey levels.
    pub fn with_noise(self, noise_grey: f64, seed: u64) -> Self {
        Self { noise_grey, seed, ..self }
    }

    /// The rig that looks at the scene.
    pub fn rig(&self) -> RectifiedRig {
        self.rig
    }

    /// Pixels in a row.
    pub fn width(&self) -> u16 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u16 {
        self.height
    }

    /// How many whole disparities from 0 hold the scene.
    pub fn disparities(&self) -> u16 {
        self.disparities
    }

    /// What the two cameras see, left and right: 4 x 4 samples a pixel, sensor noise, 8 bit.
    pub fn render(&self) -> (GrayImage, GrayImage) {
        let noise = |camera: u64| Random::new(self.seed.wrapping_mul(2).wrapping_add(camera)).bits();
        (
            render::picture(self, &Eye::left(self), noise(0)),
            render::picture(self, &Eye::right(self), noise(1)),
        )
    }

    /// The scene in the frame of a camera that stands elsewhere: its left picture is what that camera sees,
    /// from a pose that need not be rectified beside this one's. `pose` carries a point of that camera
    /// into this one's left camera, metres.
    pub fn seen_from(&self, pose: &Pose<f64>) -> Self {
        let mut scene = self.clone();
        let back = Rotation3::from_matrix_unchecked(pose.rotation().transpose());
        scene.lamp = pose.inverse_transform(&self.lamp);
        for object in &mut scene.objects {
            object.position = pose.inverse_transform(&object.position);
            object.rotation = back * object.rotation;
        }
        scene
    }

    /// The true values.
    pub fn truth(&self) -> Truth {
        render::truth(self)
    }

    /// A camera that sees the scene: every frame is the same picture.
    pub fn camera(&self) -> SceneCamera {
        let (left, right) = self.render();
        SceneCamera::new(left, right)
    }
}
