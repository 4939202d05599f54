//! Pictures and true values by ray casting.

use super::random::Random;
use super::shape::{Object, Shape};
use super::texture::{Points, SAMPLES};
use super::{Scene, Truth};
use image::GrayImage;
use nalgebra::{Matrix3, Point2, Point3, Vector3};

/// Samples along each side of a pixel.
const SIDE: usize = 4;
/// A surface does not hide itself, nor the edge of a picture: what is hidden lies behind by more than this
/// share of the ray, or this part of a pixel outside.
const SLACK: f64 = 1e-6;
/// How sharp highlights are: the exponent of Blinn's model (1977).
const SHARPNESS: i32 = 30;

/// One camera's pin-hole.
#[derive(Clone, Copy)]
pub(super) struct Eye {
    position: Point3<f64>,
    focal_px: f64,
    centre: Point2<f64>,
}

/// Where a ray meets the scene: the object's number and the ray's parameter, which is the depth Z on a ray of
/// the eye.
struct Meeting {
    object: usize,
    t: f64,
}

/// Rays from one point, put into every object's coordinates.
struct Rays<'a> {
    objects: &'a [Object],
    from: Point3<f64>,
    local: Vec<(Matrix3<f64>, Point3<f64>)>,
    balls: Vec<Option<Ball>>,
}

/// A ball that holds a body, as a ray's origin sees it.
struct Ball {
    to_middle: Vector3<f64>,
    /// The square of the length of a tangent; negative within the ball.
    tangent_squared: f64,
}

impl Eye {
    pub(super) fn left(scene: &Scene) -> Self {
        let (cx, cy) = scene.rig.principal_point();
        let centre = Point2::new(f64::from(cx), f64::from(cy));
        Self { position: Point3::origin(), focal_px: f64::from(scene.rig.focal_px()), centre }
    }

    pub(super) fn right(scene: &Scene) -> Self {
        let mut eye = Self::left(scene);
        eye.position.x = f64::from(scene.rig.baseline_m());
        eye.centre.x += f64::from(scene.rig.disparity_offset_px());
        eye
    }

    /// The direction that column `u` and row `v` look into, with a Z of 1: a ray's parameter is the depth.
    fn direction(&self, u: f64, v: f64) -> Vector3<f64> {
        Vector3::new((u - self.centre.x) / self.focal_px, (v - self.centre.y) / self.focal_px, 1.0)
    }
}

impl<'a> Rays<'a> {
    fn new(objects: &'a [Object], from: Point3<f64>) -> Self {
        let local = objects.iter().map(|o| (o.rotation.matrix().transpose(), o.to_local(&from))).collect();
        let ball = |object: &Object| {
            let to_middle = object.position - from;
            let tangent_squared = to_middle.norm_squared() - object.reach_squared()?;
            Some(Ball { to_middle, tangent_squared })
        };
        Self { objects, from, local, balls: objects.iter().map(ball).collect() }
    }

    /// Where the ray along `along` meets the object of this number.
    fn meet(&self, number: usize, along: &Vector3<f64>) -> Option<f64> {
        let (turn, from) = &self.local[number];
        self.objects[number].shape.meet(from, &(turn * along), 0.0)
    }

    /// The first of these objects along `along`.
    fn first(&self, numbers: impl IntoIterator<Item = usize>, along: &Vector3<f64>) -> Option<Meeting> {
        let mut nearest: Option<Meeting> = None;
        for object in numbers {
            if let Some(t) = self.meet(object, along)
                && nearest.as_ref().is_none_or(|m| t < m.t)
            {
                nearest = Some(Meeting { object, t });
            }
        }
        nearest
    }

    /// Whether anything stands before `point`.
    fn hidden(&self, point: &Point3<f64>) -> bool {
        let along = point - self.from;
        (0..self.objects.len()).any(|i| self.meet(i, &along).is_some_and(|t| t < 1.0 - SLACK))
    }

    /// Whether a body that has an end stands before `point`.
    fn shaded(&self, point: &Point3<f64>) -> bool {
        let along = point - self.from;
        let length_squared = along.norm_squared();
        self.balls.iter().enumerate().any(|(i, ball)| {
            // Most rays pass the ball around a body by, which is quickly seen.
            ball.as_ref().is_some_and(|Ball { to_middle, tangent_squared }| {
                let along_middle = along.dot(to_middle);
                let passes = tangent_squared * length_squared > along_middle * along_middle;
                !passes && self.meet(i, &along).is_some_and(|t| t < 1.0 - SLACK)
            })
        })
    }
}

/// The samples of one pixel that show one object.
struct Patch {
    object: usize,
    depth: f64,
    /// In the object's coordinates; what is not of the patch is left where it is.
    points: Points,
    /// The light that falls on each point and goes towards the eye if it is white; 0 for what is not of the
    /// patch.
    light: [f32; SAMPLES],
    /// The light that is mirrored towards the eye, summed over the samples.
    highlight: f64,
}

impl Patch {
    fn new(object: usize, depth: f64) -> Self {
        Self { object, depth, points: [[0.0; SAMPLES]; 3], light: [0.0; SAMPLES], highlight: 0.0 }
    }

    /// Adds the point where the eye's ray along `along` meets the object.
    fn add(
        &mut self,
        scene: &Scene,
        eye: &Rays<'_>,
        lamp: &Rays<'_>,
        sample: usize,
        along: &Vector3<f64>,
        t: f64,
    ) {
        let shape = &scene.objects[self.object].shape;
        let (turn, from) = &eye.local[self.object];
        let mut local = from + turn * along * t;
        if matches!(shape, Shape::Plane | Shape::Rectangle { .. }) {
            local.z = 0.0;
        }
        let mut normal = turn.tr_mul(&shape.normal(&local));
        if normal.dot(along) > 0.0 {
            normal = -normal;
        }
        let point = eye.from + along * t;
        let to_lamp = scene.lamp - point;
        let facing = normal.dot(&to_lamp) / to_lamp.norm();
        let lit = facing > 0.0 && !lamp.shaded(&point);
        let light = scene.ambient + if lit { (1.0 - scene.ambient) * facing } else { 0.0 };
        self.light[sample] = light as f32;
        let gloss = scene.objects[self.object].gloss;
        if gloss > 0.0 && lit {
            let half_way = (to_lamp.normalize() - along.normalize()).normalize();
            self.highlight += gloss * normal.dot(&half_way).max(0.0).powi(SHARPNESS);
        }
        for axis in 0..3 {
            self.points[axis][sample] = local[axis] as f32;
        }
    }

    /// The light that comes back, summed over the samples.
    fn brightness(&self, scene: &Scene, eye: &Eye) -> f64 {
        let albedos = scene.objects[self.object].texture.albedos(&self.points, self.depth / eye.focal_px);
        albedos.iter().zip(&self.light).map(|(a, l)| f64::from(a * l)).sum::<f64>() + self.highlight
    }
}

/// What one camera sees, 8-bit grey.
pub(super) fn picture(scene: &Scene, eye: &Eye, noise_seed: u64) -> GrayImage {
    let bounds: Vec<_> =
        scene.objects.iter().map(|o| o.picture_bounds(&eye.position, eye.focal_px, eye.centre)).collect();
    let (rays, lamp) = (Rays::new(&scene.objects, eye.position), Rays::new(&scene.objects, scene.lamp));
    let mut noise = Random::new(noise_seed);
    let (mut in_reach, mut patches) = (Vec::new(), Vec::new());
    GrayImage::from_fn(u32::from(scene.width), u32::from(scene.height), |x, y| {
        let (x, y) = (f64::from(x), f64::from(y));
        // Only objects whose bounds touch the pixel can be seen in it.
        in_reach.clear();
        in_reach.extend((0..scene.objects.len()).filter(|&i| {
            let [least, greatest] = bounds[i];
            least.x - 0.5 <= x && x <= greatest.x + 0.5 && least.y - 0.5 <= y && y <= greatest.y + 0.5
        }));
        patches.clear();
        let mut sum = 0.0;
        for sample in 0..SAMPLES {
            let inside = |i: usize| (i as f64 + 0.5) / SIDE as f64 - 0.5;
            let along = eye.direction(x + inside(sample % SIDE), y + inside(sample / SIDE));
            let Some(Meeting { object, t }) = rays.first(in_reach.iter().copied(), &along) else {
                sum += scene.ambient;
                continue;
            };
            let place = patches.iter().position(|p: &Patch| p.object == object).unwrap_or_else(|| {
                patches.push(Patch::new(object, t));
                patches.len() - 1
            });
            patches[place].add(scene, &rays, &lamp, sample, &along, t);
        }
        sum += patches.iter().map(|p| p.brightness(scene, eye)).sum::<f64>();
        let grey = 255.0 * sum / SAMPLES as f64 + scene.noise_grey * noise.gauss();
        image::Luma([(grey + 0.5).clamp(0.0, 255.0) as u8])
    })
}

/// Depth, disparity and occlusion at the left camera's pixel centres.
pub(super) fn truth(scene: &Scene) -> Truth {
    let (left_eye, right_eye) = (Eye::left(scene), Eye::right(scene));
    let [left, right] = [left_eye, right_eye].map(|eye| Rays::new(&scene.objects, eye.position));
    let everything = 0..scene.objects.len();
    let (width, height) = (usize::from(scene.width), usize::from(scene.height));
    let fb = f64::from(scene.rig.focal_px()) * f64::from(scene.rig.baseline_m());
    let mut truth = Truth {
        width,
        height,
        disparity: Vec::new(),
        depth_m: Vec::new(),
        occluded: Vec::new(),
        objects: Vec::new(),
    };
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y as f64, x as f64))) {
        let along = left_eye.direction(x, y);
        let meeting = left.first(everything.clone(), &along);
        let depth = meeting.as_ref().map_or(f64::INFINITY, |m| m.t);
        truth.objects.push(meeting.map(|m| m.object));
        let disparity = fb / depth - f64::from(scene.rig.disparity_offset_px());
        let column = x - disparity;
        let outside = column < -SLACK || column > (width - 1) as f64 + SLACK;
        let hidden = || {
            if depth.is_finite() {
                right.hidden(&(left.from + along * depth))
            } else {
                // What is infinitely far lies in one direction from both eyes.
                right.first(everything.clone(), &along).is_some()
            }
        };
        truth.occluded.push(outside || hidden());
        truth.disparity.push(disparity as f32);
        truth.depth_m.push(depth as f32);
    }
    truth
}
