//! Scenes and runs that several tests share.

use image::GrayImage;
use nalgebra::{Point3, Rotation3, Vector3};
use std::convert::Infallible;
use stereopsis::geometry::{Camera, Pose, RectifiedRig};
use stereopsis_host::odometry::run::{Rig, Trajectory, VIEWS, run};
use stereopsis_host::scene::{MovingScene, Object, Scene, Shape, Texture};

/// A small picture: what is rendered counts.
pub const SIZE: (u16, u16) = (240, 160);

pub fn rig() -> RectifiedRig {
    RectifiedRig::new(180.0, 0.12, 119.5, 79.5).expect("a rig")
}

pub fn camera(rig: &RectifiedRig) -> Camera<f64> {
    let (cx, cy) = rig.principal_point();
    Camera::new(rig.focal_px().into(), rig.focal_px().into(), cx.into(), cy.into()).expect("a camera")
}

fn texture(seed: u32, coarsest_m: f64) -> Texture {
    Texture::new(seed, 0.5, 0.45).with_octaves(coarsest_m, 7)
}

/// A room: a wall ahead, a floor, boxes.
pub fn room() -> Scene {
    let scene = Scene::new(rig(), SIZE.0, SIZE.1, 64)
        .with(Object::plane(Point3::new(0.0, 0.0, 6.0), Vector3::new(0.2, 0.0, 1.0), texture(1, 1.0)))
        .with(Object::plane(Point3::new(0.0, 1.0, 0.0), Vector3::y(), texture(2, 0.6)));
    (0..6).fold(scene, |scene, i| {
        let place = Point3::new(f64::from(i) * 0.9 - 2.2, 0.5 - 0.4 * f64::from(i % 3), 2.4 + 0.5 * f64::from(i % 4));
        let half = Vector3::new(0.3, 0.35, 0.3);
        let turn = Rotation3::from_axis_angle(&Vector3::y_axis(), f64::from(i));
        scene.with(Object::new(Shape::Cuboid { half }, texture(5 + i, 0.4), place).turned(turn))
    })
}

/// A wall without an end at a distance, and nothing else.
pub fn wall(distance_m: f64, slant: f64) -> Scene {
    let at = Point3::new(0.0, 0.0, distance_m);
    let wall = Object::plane(at, Vector3::new(slant, 0.3 * slant, 1.0), texture(1, distance_m * 0.2));
    Scene::new(rig(), SIZE.0, SIZE.1, 64).with(wall)
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
    run(&Rig::Stereo(rig), frames, VIEWS, |_| ()).expect("a trajectory")
}

pub fn mono(rig: RectifiedRig, frames: &[(GrayImage, GrayImage)]) -> Trajectory {
    let frames = frames.iter().map(|(left, _)| Ok::<_, Infallible>((left.clone(), None)));
    run(&Rig::Mono(camera(&rig)), frames, VIEWS, |_| ()).expect("a trajectory")
}

/// The angle between two poses' turns, degrees.
pub fn turned_deg(a: &Pose<f64>, b: &Pose<f64>) -> f64 {
    a.inverse().then(b).angle_rad().to_degrees()
}
