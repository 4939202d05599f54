//! The geometry with any numbers: an `Ok` is finite and keeps what its type promises.

use crate::case::number;
use arbitrary::{Result, Unstructured};
use nalgebra::{Matrix3, Point2, Point3, Vector3};
use stereopsis::geometry::Real;
use stereopsis::geometry::absolute::p3p;
use stereopsis::geometry::camera::{Camera, Distortion, Pose, RectifiedRig};
use stereopsis::geometry::two_view::{
    Correspondence, Essential, Fundamental, Homography, TwoViews, eight_point,
};

/// Whatever goes in, what comes out as `Ok` is finite, and rotations are rotations.
pub fn is_finite(u: &mut Unstructured<'_>) -> Result<()> {
    match u.arbitrary()? {
        false => of::<f32>(u),
        true => of::<f64>(u),
    }
}

fn of<T: Real>(u: &mut Unstructured<'_>) -> Result<()> {
    match u.int_in_range(0..=4)? {
        0 => cameras::<T>(u),
        1 => two_views::<T>(u),
        2 => matrices::<T>(u),
        3 => three_points::<T>(u),
        _ => depths(u),
    }
}

fn one<T: Real>(u: &mut Unstructured<'_>) -> Result<T> {
    Ok(T::of(number(u)?))
}

fn pixel<T: Real>(u: &mut Unstructured<'_>) -> Result<Point2<T>> {
    Ok(Point2::new(one(u)?, one(u)?))
}

fn vector<T: Real>(u: &mut Unstructured<'_>) -> Result<Vector3<T>> {
    Ok(Vector3::new(one(u)?, one(u)?, one(u)?))
}

fn matrix<T: Real>(u: &mut Unstructured<'_>) -> Result<Matrix3<T>> {
    let mut matrix = Matrix3::zeros();
    for value in matrix.iter_mut() {
        *value = one(u)?;
    }
    Ok(matrix)
}

fn camera<T: Real>(u: &mut Unstructured<'_>) -> Result<Option<Camera<T>>> {
    let Ok(camera) = Camera::new(one(u)?, one(u)?, one(u)?, one(u)?) else { return Ok(None) };
    if u.arbitrary()? {
        return Ok(Some(camera));
    }
    let lens = [one(u)?, one(u)?, one(u)?, one(u)?, one(u)?];
    Ok(camera.with_distortion(Distortion::from_opencv(lens)).ok())
}

/// A pose: of any matrix, or a turn about an axis.
fn pose<T: Real>(u: &mut Unstructured<'_>) -> Result<Option<Pose<T>>> {
    if u.arbitrary()? {
        return Ok(Pose::new(matrix(u)?, vector(u)?).ok());
    }
    let angle = f64::from(u.arbitrary::<i16>()?) / 10_000.0;
    let (sin, cos) = angle.sin_cos();
    let turn = Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0).map(T::of);
    Ok(Pose::new(turn, vector(u)?).ok())
}

#[track_caller]
fn finite<T: Real>(values: &[T]) {
    assert!(values.iter().all(|v| v.is_finite()), "{values:?}");
}

#[track_caller]
fn rigid<T: Real>(pose: &Pose<T>) {
    let turn = pose.rotation();
    let off = (turn.transpose() * turn - Matrix3::identity()).norm();
    assert!(off < T::of(1e-2), "{turn:?}");
    finite(pose.translation().as_slice());
}

fn cameras<T: Real>(u: &mut Unstructured<'_>) -> Result<()> {
    let Some(camera) = camera::<T>(u)? else { return Ok(()) };
    finite(camera.inverse_matrix().as_slice());
    if let Ok(seen) = camera.project(&Point3::from(vector::<T>(u)?)) {
        finite(seen.coords.as_slice());
    }
    let place = pixel(u)?;
    if let Ok(ray) = camera.unproject(&place) {
        finite(ray.as_slice());
    }
    if let Ok(place) = camera.undistort(&place) {
        finite(place.coords.as_slice());
    }
    Ok(())
}

fn two_views<T: Real>(u: &mut Unstructured<'_>) -> Result<()> {
    let (Some(first), Some(second), Some(pose)) = (camera::<T>(u)?, camera::<T>(u)?, pose::<T>(u)?) else {
        return Ok(());
    };
    rigid(&pose);
    rigid(&pose.inverse());
    let Ok(views) = TwoViews::new(first, second, pose) else { return Ok(()) };
    let seen = Correspondence { first: pixel(u)?, second: pixel(u)? };
    for found in [views.midpoint(&seen), views.linear(&seen), views.optimal(&seen)].into_iter().flatten() {
        finite(found.point.coords.as_slice());
        finite(&[found.residual_px, found.angle_rad]);
        assert!(found.point.z > T::ZERO, "{found:?}");
    }
    Ok(())
}

fn matrices<T: Real>(u: &mut Unstructured<'_>) -> Result<()> {
    let matrix = matrix::<T>(u)?;
    let mut seen = Vec::new();
    for _ in 0..u.int_in_range(0..=9)? {
        seen.push(Correspondence { first: pixel::<T>(u)?, second: pixel(u)? });
    }
    for found in [Fundamental::from_matrix(&matrix).ok(), eight_point(&seen).ok()].into_iter().flatten() {
        finite(found.matrix().as_slice());
        finite(found.epipole_in_first().homogeneous().as_slice());
    }
    if let Ok(found) = Essential::nearest(&matrix) {
        found.poses().iter().for_each(|pose| finite(pose.rotation().as_slice()));
    }
    for found in [Homography::from_matrix(&matrix), Homography::from_correspondences(&seen)] {
        let Ok(found) = found else { continue };
        finite(found.matrix().as_slice());
        finite(found.inverse().matrix().as_slice());
    }
    Ok(())
}

fn three_points<T: Real>(u: &mut Unstructured<'_>) -> Result<()> {
    let rays: [Vector3<T>; 3] = [vector(u)?, vector(u)?, vector(u)?];
    let points = [vector(u)?, vector(u)?, vector(u)?].map(Point3::from);
    if let Ok(found) = p3p(&rays, &points) {
        found.as_slice().iter().for_each(rigid);
    }
    Ok(())
}

fn depths(u: &mut Unstructured<'_>) -> Result<()> {
    let rig = RectifiedRig::with_offset(one(u)?, one(u)?, one(u)?, one(u)?, one(u)?);
    let Ok(rig) = rig else { return Ok(()) };
    let (x, y, disparity) = (one(u)?, one(u)?, one(u)?);
    if let Some(depth) = rig.depth_m(disparity) {
        assert!(depth.is_finite() && depth >= 0.0, "{rig:?} {disparity} {depth}");
    }
    if let Some(point) = rig.reproject(x, y, disparity) {
        finite(point.coords.as_slice());
    }
    Ok(())
}
