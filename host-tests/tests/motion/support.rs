//! Scenes and runs that several tests share.

use image::GrayImage;
use nalgebra::{Rotation3, Vector3};
use std::convert::Infallible;
use stereopsis::geometry::camera::{Camera, Pose, RectifiedRig};
use stereopsis_host::odometry::run::{Rig, RunConfig, run};
use stereopsis_host::odometry::trajectory::Trajectory;
use stereopsis_host::scene::{MovingScene, Scene};

/// A small picture: what is rendered counts.
pub const WIDTH: u16 = 240;

pub fn rig() -> RectifiedRig {
    room().rig()
}

pub fn camera(rig: &RectifiedRig) -> Camera<f64> {
    let (cx, cy) = rig.principal_point();
    Camera::new(rig.focal_px().into(), rig.focal_px().into(), cx.into(), cy.into()).expect("a camera")
}

pub fn room() -> Scene {
    Scene::boxes(WIDTH)
}

/// A wall without an end at a distance, and nothing else.
pub fn wall(distance_m: f64, slant: f64) -> Scene {
    Scene::wall(WIDTH, distance_m, Vector3::new(slant, 0.3 * slant, 1.0))
}

/// A pose of a turn (radians about X, Y, Z) and a place.
pub fn pose(turn: [f64; 3], place: [f64; 3]) -> Pose<f64> {
    Pose::new(*Rotation3::new(Vector3::from(turn)).matrix(), Vector3::from(place)).expect("a rotation")
}

/// What the cameras see on the way, with noise.
pub fn frames(scene: Scene, path: Vec<Pose<f64>>) -> Vec<(GrayImage, GrayImage)> {
    let moving = MovingScene::new(scene, path).with_noise(1.5);
    (0..moving.len()).map(|i| moving.frame(i)).collect()
}

pub fn stereo(rig: RectifiedRig, frames: &[(GrayImage, GrayImage)]) -> Trajectory {
    let frames = frames.iter().map(|(left, right)| Ok::<_, Infallible>((left.clone(), Some(right.clone()))));
    run(&Rig::Stereo(rig), frames, RunConfig::default(), |_| ()).expect("a trajectory")
}

pub fn mono(rig: RectifiedRig, frames: &[(GrayImage, GrayImage)]) -> Trajectory {
    let frames = frames.iter().map(|(left, _)| Ok::<_, Infallible>((left.clone(), None)));
    run(&Rig::Mono(camera(&rig)), frames, RunConfig::default(), |_| ()).expect("a trajectory")
}

/// The angle between two poses' turns, degrees.
pub fn turned_deg(a: &Pose<f64>, b: &Pose<f64>) -> f64 {
    a.inverse().then(b).angle_rad().to_degrees()
}
