//! Frames of a finder of obstacles in C, row by row.
#![allow(unsafe_code)]

use super::obstacles::{Finder, ObstaclesHandle, view_at};
use super::obstacles_types::blind_number;
use super::pair_monitor::{PairMonitorHandle, monitor_at};
use super::state::checked;
use super::status::either;
use super::{CRow, Status};
use crate::units::{Disparity, PixelFlags};
use core::ptr::null;
use core::slice::from_raw_parts;

/// Begins a frame, as `stereopsis_obstacles_begin_frame`.
///
/// # Safety
///
/// `handle` is as [`obstacles_deinit`](super::obstacles_deinit) asks.
pub unsafe fn obstacles_begin_frame(handle: *mut ObstaclesHandle) -> Status {
    let begin = || {
        // SAFETY: the caller's promise.
        let finder = unsafe { Finder::open(handle, null(), 0) }?;
        // SAFETY: the caller's promise.
        unsafe { finder.view(handle) }.begin();
        (finder.next, finder.is_begun) = (0, true);
        Ok(Status::Ok)
    };
    either(begin())
}

/// Sets the pose of the camera, as `stereopsis_obstacles_set_pose`.
///
/// # Safety
///
/// `handle` is as [`obstacles_deinit`](super::obstacles_deinit) asks.
pub unsafe fn obstacles_set_pose(
    handle: *mut ObstaclesHandle,
    pitch_mrad: i16,
    roll_mrad: i16,
    height_mm: u16,
) -> Status {
    let set = || {
        // SAFETY: the caller's promise.
        unsafe { view_at(handle, null(), 0) }?.set_pose(pitch_mrad, roll_mrad, height_mm)?;
        Ok(Status::Ok)
    };
    either(set())
}

/// Takes what a monitor says of the cameras, as `stereopsis_obstacles_cameras`.
///
/// # Safety
///
/// Both handles are null or from their `init`, and no other call uses them at the same time.
pub unsafe fn obstacles_cameras(handle: *mut ObstaclesHandle, monitor: *mut PairMonitorHandle) -> Status {
    let take = || {
        // SAFETY: the caller's promise; two handles that are alive have memory of their own.
        let (finder, monitor) = unsafe { (Finder::open(handle, null(), 0)?, monitor_at(monitor)?) };
        if !finder.is_begun {
            return Err(Status::NotBegun);
        }
        // SAFETY: the caller's promise.
        unsafe { finder.view(handle) }.cameras(monitor);
        Ok(Status::Ok)
    };
    either(take())
}

/// Takes a row, as `stereopsis_obstacles_push`.
///
/// # Safety
///
/// `handle` is as [`obstacles_deinit`](super::obstacles_deinit) asks; `row` is null or points to a row whose
/// arrays are null or have its width.
pub unsafe fn obstacles_push(handle: *mut ObstaclesHandle, row: *const CRow) -> Status {
    let push = || {
        checked(row)?;
        // SAFETY: the caller's promise, it is aligned, and every bit pattern is a row.
        let CRow { index, width, disparities, flags, confidences } = unsafe { row.read() };
        checked(disparities)?;
        checked(flags)?;
        let length = usize::from(width);
        // SAFETY: the caller's promise.
        let finder = unsafe { Finder::open(handle, disparities.cast(), 2 * length) }?;
        if finder.overlaps(handle, flags.cast(), length)
            || finder.overlaps(handle, confidences.cast(), length)
        {
            return Err(Status::Overlap);
        }
        if !finder.is_begun {
            return Err(Status::NotBegun);
        }
        if index >= finder.height || index < finder.next {
            return Err(Status::Row);
        }
        if length < finder.width {
            return Err(Status::LineLength);
        }
        // SAFETY: the caller's promise; the arrays are apart from the finder, and may have any bits.
        let (disparities, flags, confidences) = unsafe {
            (
                from_raw_parts(disparities.cast::<Disparity>(), length),
                from_raw_parts(flags.cast::<PixelFlags>(), length),
                if confidences.is_null() { &[] } else { from_raw_parts(confidences, length) },
            )
        };
        // SAFETY: the caller's promise.
        unsafe { finder.view(handle) }.push(index.into(), disparities, flags, confidences);
        finder.next = index + 1;
        Ok(Status::Ok)
    };
    either(push())
}

/// Ends a frame and writes why it is blind, as `stereopsis_obstacles_finish`.
///
/// # Safety
///
/// `handle` is as [`obstacles_deinit`](super::obstacles_deinit) asks; `blind` is null or points to a byte.
pub unsafe fn obstacles_finish(handle: *mut ObstaclesHandle, blind: *mut u8) -> Status {
    let finish = || {
        checked(blind)?;
        // SAFETY: the caller's promise.
        let finder = unsafe { Finder::open(handle, blind.cast_const().cast(), 1) }?;
        if !finder.is_begun {
            return Err(Status::NotBegun);
        }
        finder.is_begun = false;
        // SAFETY: the caller's promise; the byte is apart from the finder.
        unsafe { blind.write(blind_number(finder.view(handle).finish().err())) };
        Ok(Status::Ok)
    };
    either(finish())
}
