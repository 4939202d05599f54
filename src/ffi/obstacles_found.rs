//! What a frame shows in C: ground, stixels, sectors, a laser scan, cells.
#![allow(unsafe_code)]

use super::Status;
use super::obstacles::{ObstaclesHandle, view_at};
use super::obstacles_types::{CGround, CScan, CSector, CStixel};
use super::state::{any_shared, checked};
use super::status::either;
use crate::obstacles::ObstaclesView;
use core::slice::from_raw_parts_mut;

/// Writes `count` findings of the last frame, each from its number.
///
/// # Safety
///
/// `handle` is as [`obstacles_deinit`](super::obstacles_deinit) asks; `written` is null or points to `count`
/// findings' bytes.
unsafe fn write_each<T>(
    handle: *mut ObstaclesHandle,
    written: *mut T,
    count: usize,
    found: impl Fn(&ObstaclesView<'_>, usize) -> T,
) -> Status {
    let write = || {
        checked(written)?;
        if count > usize::from(u16::MAX) {
            return Err(Status::TooMany);
        }
        // SAFETY: the caller's promise.
        let view = unsafe { view_at(handle, written.cast_const().cast(), count * size_of::<T>()) }?;
        for index in 0..count {
            // SAFETY: the caller's promise; the findings are apart from the finder.
            unsafe { written.add(index).write(found(&view, index)) };
        }
        Ok(Status::Ok)
    };
    either(write())
}

/// Writes the ground, as `stereopsis_obstacles_ground`.
///
/// # Safety
///
/// `handle` is as [`obstacles_deinit`](super::obstacles_deinit) asks; `ground` is null or points to a
/// ground's bytes.
pub unsafe fn obstacles_ground(handle: *mut ObstaclesHandle, ground: *mut CGround) -> Status {
    // SAFETY: the caller's promise.
    unsafe { write_each(handle, ground, 1, |view, _| view.plane().into()) }
}

/// Writes stixels from the left, as `stereopsis_obstacles_stixels`.
///
/// # Safety
///
/// `handle` is as [`obstacles_deinit`](super::obstacles_deinit) asks; `stixels` is null or points to `count`
/// stixels' bytes.
pub unsafe fn obstacles_stixels(handle: *mut ObstaclesHandle, stixels: *mut CStixel, count: usize) -> Status {
    // SAFETY: the caller's promise.
    unsafe { write_each(handle, stixels, count, |view, column| view.stixel(column).into()) }
}

/// Writes sectors from the left, as `stereopsis_obstacles_sectors`.
///
/// # Safety
///
/// `handle` is as [`obstacles_deinit`](super::obstacles_deinit) asks; `sectors` is null or points to `count`
/// sectors' bytes.
pub unsafe fn obstacles_sectors(handle: *mut ObstaclesHandle, sectors: *mut CSector, count: usize) -> Status {
    // SAFETY: the caller's promise.
    unsafe { write_each(handle, sectors, count, |view, index| view.sector(index).into()) }
}

/// Writes the disparities of a row of cells, as `stereopsis_obstacles_cells`.
///
/// # Safety
///
/// `handle` is as [`obstacles_deinit`](super::obstacles_deinit) asks; `disparities` is null or points to
/// `count` words.
pub unsafe fn obstacles_cells(
    handle: *mut ObstaclesHandle,
    row: u16,
    disparities: *mut u16,
    count: usize,
) -> Status {
    let row = usize::from(row);
    // SAFETY: the caller's promise.
    unsafe { write_each(handle, disparities, count, |view, column| view.cell(column, row).raw()) }
}

/// Writes the sectors as a laser scan, as `stereopsis_obstacles_scan`.
///
/// # Safety
///
/// `handle` is as [`obstacles_deinit`](super::obstacles_deinit) asks; `ranges` is null or points to `count`
/// floats, `scan` to a scan's bytes.
pub unsafe fn obstacles_scan(
    handle: *mut ObstaclesHandle,
    ranges: *mut f32,
    count: usize,
    scan: *mut CScan,
) -> Status {
    let write = || {
        checked(ranges)?;
        checked(scan)?;
        if count > usize::from(u16::MAX) {
            return Err(Status::TooMany);
        }
        let (floats, angles) = (ranges.cast_const().cast(), scan.cast_const().cast());
        let (bytes, of_scan) = (count * size_of::<f32>(), size_of::<CScan>());
        // SAFETY: the caller's promise; the first view is dropped before the second is made.
        let view = unsafe {
            view_at(handle, floats, bytes)?;
            view_at(handle, angles, of_scan)?
        };
        if any_shared(&[(floats, bytes), (angles, of_scan)], &[]) {
            return Err(Status::Overlap);
        }
        // SAFETY: the caller's promise; zeros are floats, and they are apart from the finder and the scan.
        unsafe {
            ranges.write_bytes(0, count);
            scan.write(view.laser_scan(from_raw_parts_mut(ranges, count)).into());
        }
        Ok(Status::Ok)
    };
    either(write())
}
