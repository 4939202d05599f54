//! Health of two cameras in C: a monitor in the caller's memory.
#![allow(unsafe_code)]

use super::Status;
use super::state::{Content, State, any_shared, checked, kind};
use super::status::either;
use crate::imaging::{CameraHealth, PairMonitor};
use core::ffi::c_void;
use core::slice::from_raw_parts;

/// Camera: no fault shows.
pub const STEREOPSIS_CAMERA_GOOD: u8 = 0;
/// Camera: at least 99 % of the pixels are black: dark, covered or dead.
pub const STEREOPSIS_CAMERA_BLACK: u8 = 1;
/// Camera: at least half of the pixels are saturated.
pub const STEREOPSIS_CAMERA_SATURATED: u8 = 2;
/// Camera: all pixels are in one of the 16 bins of 16 levels, as from a stuck port.
pub const STEREOPSIS_CAMERA_FLAT: u8 = 3;
/// Camera: at least half of the lines equal the one above bit for bit: a hanging line or a test pattern.
pub const STEREOPSIS_CAMERA_REPEATING: u8 = 4;

/// Bytes that are enough for a monitor of two cameras, on any target.
pub const STEREOPSIS_PAIR_MONITOR_BYTES: usize = 240;

/// Monitor of two cameras in the caller's memory.
pub struct PairMonitorHandle {
    _opaque: [u8; 0],
}

impl Content for PairMonitor {
    type Handle = PairMonitorHandle;
    const NEW: Self = Self::new(0);
    const KIND: usize = kind("pair monitor", &[]);
    const MOST_BYTES: usize = STEREOPSIS_PAIR_MONITOR_BYTES;
}

/// Returns the monitor at a handle.
///
/// # Safety
///
/// `handle` is as [`pair_monitor_deinit`] asks, and nothing else uses its memory for `'a`.
pub(super) unsafe fn monitor_at<'a>(handle: *mut PairMonitorHandle) -> Result<&'a mut PairMonitor, Status> {
    // SAFETY: the caller's promise.
    Ok(&mut unsafe { State::<PairMonitor>::open(handle) }?.content)
}

/// Creates a monitor, as `stereopsis_pair_monitor_init`.
///
/// # Safety
///
/// `memory` is null or points to `length` bytes that nothing else uses until the monitor is given up;
/// `handle` is null or points to a pointer.
pub unsafe fn pair_monitor_init(
    memory: *mut c_void,
    length: usize,
    most_disparity: u16,
    handle: *mut *mut PairMonitorHandle,
) -> Status {
    let content = Ok((PairMonitor::new(most_disparity), 0));
    // SAFETY: the caller's promise.
    unsafe { State::<PairMonitor>::init_with_tail(memory, length, content, handle) }
}

/// Gives the memory up.
///
/// # Safety
///
/// `handle` is null or from [`pair_monitor_init`], and no other call uses it at the same time.
pub unsafe fn pair_monitor_deinit(handle: *mut PairMonitorHandle) -> Status {
    // SAFETY: the caller's promise.
    unsafe { State::<PairMonitor>::deinit(handle) }
}

/// Begins a frame, as `stereopsis_pair_monitor_begin_frame`.
///
/// # Safety
///
/// `handle` is as [`pair_monitor_deinit`] asks.
pub unsafe fn pair_monitor_begin_frame(handle: *mut PairMonitorHandle) -> Status {
    // SAFETY: the caller's promise.
    either(unsafe { monitor_at(handle) }.map(|monitor| {
        monitor.begin();
        Status::Ok
    }))
}

/// Takes the next line of both cameras, as `stereopsis_pair_monitor_push`.
///
/// # Safety
///
/// `handle` is as [`pair_monitor_deinit`] asks; `left` and `right` are null or point to `length` bytes.
pub unsafe fn pair_monitor_push(
    handle: *mut PairMonitorHandle,
    [left, right]: [*const u8; 2],
    length: usize,
) -> Status {
    let push = || {
        checked(left)?;
        checked(right)?;
        if length > usize::from(u16::MAX) {
            return Err(Status::TooMany);
        }
        // SAFETY: the caller's promise.
        let state = unsafe { State::<PairMonitor>::open(handle) }?;
        if state.overlaps(left, length) || state.overlaps(right, length) {
            return Err(Status::Overlap);
        }
        // SAFETY: the caller's promise, and both lines are apart from the monitor.
        let (left, right) = unsafe { (from_raw_parts(left, length), from_raw_parts(right, length)) };
        state.content.lines(left, right);
        Ok(Status::Ok)
    };
    either(push())
}

/// Number of a camera's condition.
fn health_number(health: CameraHealth) -> u8 {
    match health {
        CameraHealth::Good => STEREOPSIS_CAMERA_GOOD,
        CameraHealth::Black => STEREOPSIS_CAMERA_BLACK,
        CameraHealth::Saturated => STEREOPSIS_CAMERA_SATURATED,
        CameraHealth::Flat => STEREOPSIS_CAMERA_FLAT,
        CameraHealth::Repeating => STEREOPSIS_CAMERA_REPEATING,
    }
}

/// Writes the condition of both cameras, as `stereopsis_pair_monitor_health`.
///
/// # Safety
///
/// `handle` is as [`pair_monitor_deinit`] asks; `left`, `right` and `swapped` are null or point to a byte
/// each.
pub unsafe fn pair_monitor_health(
    handle: *mut PairMonitorHandle,
    [left, right]: [*mut u8; 2],
    swapped: *mut u8,
) -> Status {
    let write = || {
        let written = [left, right, swapped];
        for byte in written {
            checked(byte)?;
        }
        // SAFETY: the caller's promise.
        let state = unsafe { State::<PairMonitor>::open(handle) }?;
        if written.iter().any(|&byte| state.overlaps(byte, 1))
            || any_shared(&written.map(|byte| (byte.cast_const().cast(), 1)), &[])
        {
            return Err(Status::Overlap);
        }
        let found = state.content.health().map(health_number);
        // SAFETY: the caller's promise; the bytes are apart.
        unsafe {
            left.write(found[0]);
            right.write(found[1]);
            swapped.write(state.content.are_swapped().into());
        }
        Ok(Status::Ok)
    };
    either(write())
}
