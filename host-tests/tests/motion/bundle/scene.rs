//! A scene that is known: views on an arc before a cloud of points.

use nalgebra::{Matrix3, Point2, Point3, Rotation3, Vector3};
use proptest::prelude::*;
use stereopsis::geometry::{
    Real,
    camera::{Camera, Distortion, Pose},
};
use stereopsis::motion::bundle::{CameraView, Observation, RadialView, RigView, View, Window};
use stereopsis_host::scene::Random;

/// Views, points and what is seen of them, in any numbers.
#[derive(Clone, Debug)]
pub struct Scene<V, T: Real> {
    pub views: Vec<V>,
    pub points: Vec<Point3<T>>,
    pub observations: Vec<Observation<T>>,
}

pub fn camera<T: Real>() -> Camera<T> {
    let distortion = Distortion::from_opencv([-0.2, 0.05, 1e-3, -5e-4, 0.01].map(T::of));
    let camera = Camera::new(T::of(500.0), T::of(510.0), T::of(320.0), T::of(240.0));
    camera.and_then(|c| c.with_skew(T::of(0.5))?.with_distortion(distortion)).expect("a camera")
}

pub fn pose<T: Real>(turn: [f64; 3], centre: [f64; 3]) -> Pose<T> {
    let rotation = Rotation3::new(Vector3::from(turn)).into_inner();
    let rotation = Matrix3::from_iterator(rotation.iter().map(|&x| T::of(x)));
    Pose::new(rotation, Vector3::from(centre.map(T::of))).expect("a pose")
}

/// The pose of view n: on an arc of 0.3 a view, turned towards the scene, a little up and down.
pub fn on_arc<T: Real>(n: usize) -> Pose<T> {
    let n = n as f64;
    pose(
        [0.02 * (n * 1.7).sin(), -0.06 * n, 0.03 * (n * 0.9).cos()],
        [0.3 * n, 0.05 * (n * 2.1).sin(), 0.04 * n],
    )
}

pub fn calibrated<T: Real>(n: usize) -> CameraView<T> {
    CameraView { camera: camera(), pose: on_arc(n) }
}

pub fn rig<T: Real>(n: usize) -> RigView<T> {
    let second = pose([0.01, -0.02, 0.005], [0.12, 0.001, -0.002]);
    RigView { cameras: [camera(), camera()], second, pose: on_arc(n) }
}

pub fn radial<T: Real>(n: usize) -> RadialView<T> {
    RadialView { pose: on_arc(n), focal_px: T::of(480.0 + 10.0 * n as f64), k1: T::of(-0.1), k2: T::of(0.02) }
}

/// `points` points 3 to 7 ahead, seen by all views and both eyes, or by those that `sees` says, with noise.
pub fn scene<V: View<T, N>, T: Real, const N: usize>(
    views: Vec<V>,
    points: usize,
    eyes: u16,
    noise_px: f64,
    sees: impl Fn(usize, usize) -> bool,
) -> Scene<V, T> {
    let mut random = Random::new(11);
    let (mut places, mut observations) = (Vec::new(), Vec::new());
    for point in 0..points {
        let [x, y, z] = [(); 3].map(|()| random.unit());
        let place = Point3::from([3.0 * x - 1.0, 2.4 * y - 1.2, 3.0 + 4.0 * z].map(T::of));
        places.push(place);
        for (n, view) in views.iter().enumerate().filter(|(n, _)| sees(*n, point)) {
            for eye in 0..eyes {
                let seen = view.project(eye, &place).expect("before the camera");
                let off = [random.gauss(), random.gauss()].map(|x| T::of(noise_px * x));
                let pixel = Point2::new(seen.x + off[0], seen.y + off[1]);
                observations.push(Observation { point: point as u32, view: n as u16, eye, pixel });
            }
        }
    }
    Scene { views, points: places, observations }
}

/// A window of up to eight views, filled from a scene.
pub type Wide<V, T, const N: usize> = Window<V, T, N, 8, 128, 1024>;

/// All of a scene in a window.
pub fn filled<V: View<T, N>, T: Real, const N: usize>(scene: &Scene<V, T>) -> Box<Wide<V, T, N>> {
    let mut window = Box::new(Window::new());
    for view in &scene.views {
        window.add_view(*view).expect("room");
    }
    for (n, point) in scene.points.iter().enumerate() {
        window.add_point(*point).expect("room");
        for observation in scene.observations.iter().filter(|observation| observation.point as usize == n) {
            window.add_observation(observation.view, observation.eye, observation.pixel).expect("room");
        }
    }
    window
}

impl<V, T: Real> Scene<V, T> {
    /// Views from `first` on, and all points, moved by so much at random.
    pub fn disturbed<const N: usize>(&self, first: usize, turn: f64, shift: f64) -> Self
    where
        V: View<T, N>,
    {
        let mut random = Random::new(5);
        let mut off = |size: f64| T::of(size * (2.0 * random.unit() - 1.0));
        let mut moved = self.clone();
        for view in moved.views.iter_mut().skip(first) {
            let mut step = [T::ZERO; N];
            for (k, x) in step.iter_mut().enumerate().take(6) {
                *x = off(if k < 3 { turn } else { shift });
            }
            *view = view.moved(&step);
        }
        for point in &mut moved.points {
            *point += Vector3::new(off(shift), off(shift), off(shift));
        }
        moved
    }
}

prop_compose! {
    /// A step of a view's pose, and a point.
    pub fn placed()(turn in prop::array::uniform3(-1.0..1.0_f64),
        centre in prop::array::uniform3(-1.0..1.0_f64),
        observation in prop::array::uniform2(-0.6..0.6_f64), depth in 0.5..20.0_f64) -> (Pose<f64>,
            Point3<f64>) {
        let pose = pose(turn, centre);
        (pose, pose.transform(&Point3::new(observation[0] * depth, observation[1] * depth, depth)))
    }
}
