//! Depths in metres and points of a row in C.
#![allow(unsafe_code)]

use super::rig::scale_of;
use super::state::{checked, share_bytes};
use super::status::either;
use super::{CRig, Status};
use crate::units::{Disparity, Metres};

/// Point in the left camera's frame: X to the right, Y down, Z forward.
#[derive(Clone, Copy, PartialEq, Debug)]
#[repr(C)]
pub struct CPoint {
    /// X, m.
    pub x_m: f32,
    /// Y, m.
    pub y_m: f32,
    /// Z, m; 0, as X and Y are, where there is no point.
    pub z_m: f32,
}

/// Returns whether `count` values at `a` share bytes with `count` values at `b`.
pub(super) fn overlap<A, B>(a: *const A, b: *const B, count: usize) -> bool {
    let bytes = |size: usize| count.saturating_mul(size);
    share_bytes(a.cast(), bytes(size_of::<A>()), b.cast(), bytes(size_of::<B>()))
}

/// Computes the points of a row, as `stereopsis_points`.
///
/// # Safety
///
/// `rig` is null or points to a rig; `disparities` and `points` are null or point to `count` elements each.
pub unsafe fn points(
    rig: *const CRig,
    row: u16,
    disparities: *const u16,
    points: *mut CPoint,
    count: usize,
) -> Status {
    let convert = || {
        // SAFETY: the caller's promise.
        let scale = unsafe { scale_of(rig) }?;
        checked(disparities)?;
        checked(points)?;
        let count = u16::try_from(count).map_err(|_| Status::TooMany)?;
        if overlap(disparities, points, count.into()) {
            return Err(Status::Overlap);
        }
        for column in 0..count {
            // SAFETY: the caller's promise.
            let disparity = Disparity::from_raw(unsafe { disparities.add(column.into()).read() });
            let [x_m, y_m, z_m] = scale.point(column, row, disparity).map_or([0.0; 3], |p| [p.x, p.y, p.z]);
            // SAFETY: the caller's promise.
            unsafe { points.add(column.into()).write(CPoint { x_m, y_m, z_m }) };
        }
        Ok(Status::Ok)
    };
    either(convert())
}

/// Computes depths and their standard deviations, as `stereopsis_metres`.
///
/// # Safety
///
/// `rig` is null or points to a rig; the arrays are null or point to `count` elements each.
pub unsafe fn metres(
    rig: *const CRig,
    disparities: *const u16,
    sigma_px: *const f32,
    depth_m: *mut f32,
    sigma_m: *mut f32,
    count: usize,
) -> Status {
    let convert = || {
        // SAFETY: the caller's promise.
        let scale = unsafe { scale_of(rig) }?;
        checked(disparities)?;
        checked(depth_m)?;
        let has_sigma = !sigma_px.is_null() || !sigma_m.is_null();
        if has_sigma {
            checked(sigma_px)?;
            checked(sigma_m)?;
        }
        if count > isize::MAX as usize / size_of::<f32>() {
            return Err(Status::TooMany);
        }
        let is_shared = overlap(depth_m, disparities, count)
            || has_sigma
                && (overlap(depth_m, sigma_px, count)
                    || overlap(depth_m, sigma_m, count)
                    || overlap(sigma_m, disparities, count)
                    || sigma_px != sigma_m.cast_const() && overlap(sigma_m, sigma_px, count));
        if is_shared {
            return Err(Status::Overlap);
        }
        for i in 0..count {
            // SAFETY: the caller's promise. No slices are made: both deviations may be one array.
            unsafe {
                let disparity = Disparity::from_raw(disparities.add(i).read());
                depth_m.add(i).write(scale.metres(disparity).map_or(0.0, |Metres(z)| z));
                if has_sigma {
                    let sigma = scale.sigma(disparity, sigma_px.add(i).read());
                    sigma_m.add(i).write(sigma.map_or(f32::INFINITY, |Metres(sigma)| sigma));
                }
            }
        }
        Ok(Status::Ok)
    };
    either(convert())
}
