//! Points of the world seen by two cameras of known geometry, with noise and wrong matches: a scene without
//! pixels.
//!
//! In: a seed, or a pose and what makes points. Out: [`Views`], exact; [`noisy`] adds noise to it and
//! [`mixed`] wrong matches.

use crate::scene::Random;
use nalgebra::{Matrix3, Point2, Point3, Rotation3, Vector3};
use stereopsis::geometry::{
    camera::{Camera, Pose},
    two_view::{Correspondence, Fundamental},
};

/// Two cameras of 640 x 480 pixels, and what both see.
#[derive(Clone, Debug)]
pub struct Views {
    /// Both cameras.
    pub camera: Camera<f64>,
    /// The second camera beside the first: `P = R P' + t`, metres.
    pub pose: Pose<f64>,
    /// In camera 1, metres.
    pub points: Vec<Point3<f64>>,
    /// Where both cameras see them, px.
    pub seen: Vec<Correspondence<f64>>,
}

impl Views {
    /// `count` points that `next` makes of random numbers, in camera 1, as far as both images of 640 x 480
    /// show them.
    ///
    /// # Panics
    ///
    /// When the images show fewer than `count` of a hundred times as many points.
    pub fn of(
        random: &mut Random,
        count: usize,
        pose: Pose<f64>,
        next: impl Fn(&mut Random) -> Point3<f64>,
    ) -> Self {
        let camera = Camera::new(600.0, 600.0, 320.0, 240.0).expect("a camera");
        let mut views = Self { camera, pose, points: Vec::new(), seen: Vec::new() };
        for _ in 0..100 * count {
            if views.seen.len() == count {
                return views;
            }
            let point = next(random);
            let (Ok(p), Ok(q)) = (camera.project(&point), camera.project(&pose.inverse_transform(&point)))
            else {
                continue;
            };
            let inside = |p: &Point2<f64>| (0.0..640.0).contains(&p.x) && (0.0..480.0).contains(&p.y);
            if inside(&p) && inside(&q) {
                views.points.push(point);
                views.seen.push(Correspondence { first: p, second: q });
            }
        }
        panic!("the cameras see only {} points of {count}", views.seen.len());
    }

    /// A box of points 4 to 10 m away, by cameras half a metre apart and up to 6 degrees askew.
    pub fn scene(seed: u64, count: usize) -> Self {
        let mut random = Random::new(seed);
        let pose = nearby(&mut random);
        Self::of(&mut random, count, pose, anywhere)
    }

    /// The true fundamental matrix.
    pub fn fundamental(&self) -> Fundamental<f64> {
        Fundamental::from_cameras(&self.pose, &self.camera, &self.camera).expect("a baseline")
    }
}

/// A camera half a metre to the right, and a little of everything else.
pub fn nearby(random: &mut Random) -> Pose<f64> {
    let mut number = |size: f64| size * (2.0 * random.unit() - 1.0);
    let rotation = Rotation3::new(Vector3::new(number(0.1), number(0.1), number(0.1)));
    let translation = Vector3::new(0.5 + number(0.1), number(0.1), number(0.2));
    Pose::new(*rotation.matrix(), translation).expect("a rotation")
}

/// A point 4 to 10 m ahead.
pub fn anywhere(random: &mut Random) -> Point3<f64> {
    let mut number = |size: f64| size * (2.0 * random.unit() - 1.0);
    Point3::new(number(3.0), number(2.0), 7.0 + number(3.0))
}

/// The same with normally distributed noise of `sigma` px on every coordinate.
pub fn noisy(seen: &[Correspondence<f64>], sigma: f64, seed: u64) -> Vec<Correspondence<f64>> {
    let mut random = Random::new(seed ^ 0x5eed);
    let mut off = |p: Point2<f64>| Point2::new(p.x + sigma * random.gauss(), p.y + sigma * random.gauss());
    seen.iter().map(|s| Correspondence { first: off(s.first), second: off(s.second) }).collect()
}

/// The same in f32.
pub fn narrow(seen: &[Correspondence<f64>]) -> Vec<Correspondence<f32>> {
    seen.iter()
        .map(|s| Correspondence { first: s.first.map(|x| x as f32), second: s.second.map(|x| x as f32) })
        .collect()
}

/// An f32 estimate, to be judged in f64.
pub fn wide(f: &Fundamental<f32>) -> Fundamental<f64> {
    let matrix: Matrix3<f64> = f.matrix().map(f64::from);
    Fundamental::from_matrix(&matrix).expect("rank 2")
}

/// Root mean square of Sampson's distance, px.
pub fn rms_sampson(f: &Fundamental<f64>, seen: &[Correspondence<f64>]) -> f64 {
    (seen.iter().map(|s| f.sampson_squared_px2(s)).sum::<f64>() / seen.len() as f64).sqrt()
}

/// What a matcher would find: the correspondences with noise of `sigma` px, and among them wrong ones,
/// anywhere in images of 640 x 480 pixels, which are `share` (0 to 1, without 1) of all. With each, whether
/// it is right.
pub fn mixed(
    seen: &[Correspondence<f64>],
    sigma: f64,
    share: f64,
    seed: u64,
) -> Vec<(Correspondence<f64>, bool)> {
    let mut random = Random::new(seed ^ 0xbad);
    let mut all: Vec<_> = noisy(seen, sigma, seed).into_iter().map(|s| (s, true)).collect();
    let wrong = (share / (1.0 - share) * all.len() as f64).round() as usize;
    for _ in 0..wrong {
        let mut place = || Point2::new(640.0 * random.unit(), 480.0 * random.unit());
        let one = Correspondence { first: place(), second: place() };
        let at = random.below(all.len() + 1);
        all.insert(at, (one, false));
    }
    all
}

/// By how many degrees an estimated pose is off the true one: its rotation, and the direction of its
/// translation.
pub fn off_degrees(found: &Pose<f64>, truth: &Pose<f64>) -> (f64, f64) {
    let angle = |cosine: f64| cosine.clamp(-1.0, 1.0).acos().to_degrees();
    let turned = found.rotation().tr_mul(truth.rotation()).trace();
    let (a, b) = (found.translation(), truth.translation());
    (angle((turned - 1.0) / 2.0), angle(a.dot(b) / (a.norm() * b.norm())))
}
