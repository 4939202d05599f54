//! Odometry with any configuration, rig and pictures.

use crate::case::{self, number};
use arbitrary::{Result, Unstructured};
use nalgebra::Matrix3;
use stereopsis::features::{Feature, FeatureConfig, FeatureDetector};
use stereopsis::geometry::camera::{Camera, Pose, RectifiedRig};
use stereopsis::imaging::Picture;
use stereopsis::motion::odometry::{Frame, MonocularOdometry, OdometryConfig, StereoOdometry};

const WIDTH: u32 = 96;
const HEIGHT: u32 = 64;
const POINTS: usize = 32;

/// Every step is a rigid motion.
pub fn survives(u: &mut Unstructured<'_>) -> Result<()> {
    let sane = OdometryConfig::new(WIDTH as u16);
    let mut any =
        |value: f32| -> Result<f32> { if u.ratio(1, 3)? { Ok(number(u)? as f32) } else { Ok(value) } };
    let config = OdometryConfig {
        far_px: any(sane.far_px)?,
        near_px: any(sane.near_px)?,
        sigma_px: any(sane.sigma_px)?,
        spacing_px: any(sane.spacing_px)?,
        most_disparity_px: if u.arbitrary()? { sane.most_disparity_px } else { u.arbitrary()? },
        // As many as there may be: their number is what bounds the time.
        most_samples: u.int_in_range(0..=400)?,
        seed: u.arbitrary()?,
        corrects_rig: u.arbitrary()?,
    };
    let focal = if u.ratio(1, 4)? { number(u)? as f32 } else { 80.0 };
    let baseline = if u.ratio(1, 4)? { number(u)? as f32 } else { 0.1 };
    if u.arbitrary()? {
        let Ok(rig) = RectifiedRig::with_offset(focal, baseline, 48.0, 32.0, 48.0) else { return Ok(()) };
        let mut odometry = Box::<StereoOdometry<f32, POINTS>>::default();
        if odometry.start(&rig, config).is_err() {
            return Ok(());
        }
        drive(u, |frame| odometry.step(frame).ok().map(|step| step.motion))
    } else {
        let Ok(camera) = Camera::new(focal, focal, 48.0, 32.0) else { return Ok(()) };
        let mut odometry = Box::<MonocularOdometry<f32, POINTS>>::default();
        odometry.start(camera, config);
        drive(u, |frame| odometry.step(frame).ok().map(|step| step.in_first_baselines().motion))
    }
}

fn drive(u: &mut Unstructured<'_>, mut step: impl FnMut(&Frame<'_>) -> Option<Pose<f32>>) -> Result<()> {
    let still = case::pair(u, WIDTH, HEIGHT)?;
    for _ in 0..u.int_in_range(1..=4)? {
        let (left, right) = if u.arbitrary()? { still.clone() } else { case::pair(u, WIDTH, HEIGHT)? };
        let mut detector = Box::new(FeatureDetector::<{ WIDTH as usize }, 64>::new());
        let mut features = Box::new(heapless::Vec::<Feature, 256>::new());
        let config = FeatureConfig::new(WIDTH as u16, HEIGHT as u16);
        detector.start(&config).expect("there is room");
        for line in left.chunks_exact(WIDTH as usize) {
            detector.push(line, features.as_mut_view()).expect("a line that is due");
        }
        let view = |image| Picture::new(image, WIDTH as u16, HEIGHT as u16).expect("as many pixels");
        let right = if u.ratio(1, 6)? { None } else { Some(view(right.as_raw())) };
        let Some(pose) = step(&Frame { left: view(left.as_raw()), right, features: &features }) else {
            continue;
        };
        let turn = pose.rotation();
        let off = (turn.transpose() * turn - Matrix3::identity()).norm();
        assert!(off < 1e-2 && pose.translation().iter().all(|v| v.is_finite()), "{pose:?}");
    }
    Ok(())
}
