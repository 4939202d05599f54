//! What the functions of `stereopsis.h` do, for one method and one capacity.
#![allow(unsafe_code)]

use super::state::{State, share_bytes};
use super::{
    CConfig, CCounters, CRow, Handle, STEREOPSIS_LOST_DROPPED, STEREOPSIS_LOST_LATE, STEREOPSIS_LOST_STALE,
    STEREOPSIS_LOST_TORN, Status,
};
use crate::camera::LineFault;
use crate::matching::{self, MatchError, Method};
use crate::pipeline::Pipeline;
use core::ffi::c_void;
use core::marker::PhantomData;

/// The functions for method `S`, lines up to `W` pixels and `D` disparities.
///
/// [`instantiate_c_api`](crate::instantiate_c_api) gives them their names in C and says what each of them
/// does and needs.
pub struct Instance<S: Method, const W: usize, const D: usize>(PhantomData<S>);

/// Both ways out of a call are a status.
pub(super) fn either(result: Result<Status, Status>) -> Status {
    result.unwrap_or_else(|status| status)
}

/// The result of a call that gives a row: the row is always written, empty where there is none.
///
/// # Safety
///
/// `to` points to a row's bytes.
unsafe fn give(to: *mut CRow, row: Option<matching::Row<'_>>, without: Status) -> Status {
    let status = if row.is_some() { Status::Ok } else { without };
    // SAFETY: the caller's promise; no alignment is asked for.
    unsafe { to.write_unaligned(row.map_or(CRow::NONE, CRow::from)) };
    status
}

impl<S: Method, const W: usize, const D: usize> Instance<S, W, D> {
    /// Bytes that a matcher takes.
    pub const fn size() -> usize {
        size_of::<State<S, W, D>>()
    }

    /// What their address is a multiple of.
    pub const fn align() -> usize {
        align_of::<State<S, W, D>>()
    }

    /// The longest line, pixels.
    pub const fn max_width() -> usize {
        W
    }

    /// The most disparities.
    pub const fn max_disparities() -> usize {
        D
    }

    /// How many lines after its own a row comes out.
    pub const fn latency() -> usize {
        Pipeline::<S, W, D>::LATENCY
    }

    /// Makes a matcher in the caller's memory.
    ///
    /// # Safety
    ///
    /// `memory` is null or points to `length` bytes that nothing else uses until the matcher is given up;
    /// `handle` is null or points to a pointer.
    pub unsafe fn init(memory: *mut c_void, length: usize, handle: *mut *mut Handle) -> Status {
        if handle.is_null() {
            return Status::Null;
        }
        // Nothing is written before the pointer to write to is known to be beside the memory.
        if !memory.is_null() && share_bytes(memory, length, handle.cast(), size_of::<*mut Handle>()) {
            return Status::Overlap;
        }
        // SAFETY: the caller's promise.
        let made = unsafe { State::<S, W, D>::init(memory, length) };
        // SAFETY: the caller's promise; no alignment is asked for.
        unsafe { handle.write_unaligned(made.unwrap_or(core::ptr::null_mut())) };
        made.map_or_else(|status| status, |_| Status::Ok)
    }

    /// Gives the memory up.
    ///
    /// # Safety
    ///
    /// `handle` is null or from [`Self::init`], and no other call uses it at the same time.
    pub unsafe fn deinit(handle: *mut Handle) -> Status {
        // SAFETY: the caller's promise.
        either(unsafe { State::<S, W, D>::open(handle) }.map(|state| {
            state.deinit();
            Status::Ok
        }))
    }

    /// Checks a configuration and gets ready for the first frame; `keeps_counters` where it is for the next
    /// one.
    ///
    /// # Safety
    ///
    /// As [`Self::deinit`]; `config` is null or points to a configuration.
    pub unsafe fn start(handle: *mut Handle, config: *const CConfig, keeps_counters: bool) -> Status {
        if config.is_null() {
            return Status::Null;
        }
        // SAFETY: the caller's promise; no alignment is asked for, and every bit pattern is a configuration.
        let (state, config) = unsafe { (State::<S, W, D>::open(handle), config.read_unaligned()) };
        let start = || {
            let (pipeline, config) = (&mut state?.pipeline, config.checked()?);
            if keeps_counters {
                pipeline.restart(&config)?
            } else {
                pipeline.start(&config)?
            }
            Ok(Status::Ok)
        };
        either(start())
    }

    /// Begins a frame.
    ///
    /// # Safety
    ///
    /// As [`Self::deinit`].
    pub unsafe fn begin_frame(handle: *mut Handle) -> Status {
        // SAFETY: the caller's promise.
        let state = unsafe { State::<S, W, D>::open(handle) };
        either(state.and_then(|state| Ok(state.pipeline.begin().map(|()| Status::Ok)?)))
    }

    /// Takes a line of both cameras.
    ///
    /// # Safety
    ///
    /// As [`Self::deinit`]; `left` and `right` are null or point to `length` bytes, `row` is null or points
    /// to a row's bytes.
    pub unsafe fn push(
        handle: *mut Handle,
        left: *const u8,
        right: *const u8,
        length: usize,
        row: *mut CRow,
    ) -> Status {
        if left.is_null() || right.is_null() || row.is_null() {
            return Status::Null;
        }
        // SAFETY: the caller's promise.
        let state = match unsafe { State::<S, W, D>::open(handle) } {
            Ok(state) => state,
            Err(status) => return status,
        };
        let width = usize::from(state.pipeline.config().width);
        if width == 0 {
            return MatchError::NotStarted.into();
        }
        // A slice is made of what has the right length only: any other might be longer than a slice can be.
        if length != width {
            return Status::LineLength;
        }
        if state.overlaps(left, length) || state.overlaps(right, length) || state.overlaps(row, 1) {
            return Status::Overlap;
        }
        // SAFETY: the caller's promise, and neither stands in the state.
        let (left, right) = unsafe {
            (core::slice::from_raw_parts(left, length), core::slice::from_raw_parts(right, length))
        };
        match state.pipeline.push(left, right) {
            // SAFETY: the caller's promise, and the row stands beside the state.
            Ok(found) => unsafe { give(row, found, Status::NoRowYet) },
            Err(e) => e.into(),
        }
    }

    /// Takes the line above once more, for one that was lost.
    ///
    /// # Safety
    ///
    /// As [`Self::deinit`]; `row` is null or points to a row's bytes.
    pub unsafe fn push_lost(handle: *mut Handle, fault: i32, row: *mut CRow) -> Status {
        if row.is_null() {
            return Status::Null;
        }
        // SAFETY: the caller's promise.
        let state = match unsafe { State::<S, W, D>::open(handle) } {
            Ok(state) if state.overlaps(row, 1) => return Status::Overlap,
            Ok(state) => state,
            Err(status) => return status,
        };
        let fault = match fault {
            STEREOPSIS_LOST_DROPPED => LineFault::Dropped,
            STEREOPSIS_LOST_TORN => LineFault::Torn,
            STEREOPSIS_LOST_LATE => LineFault::Late,
            STEREOPSIS_LOST_STALE => LineFault::Stale,
            _ => return Status::Fault,
        };
        match state.pipeline.push_lost(fault) {
            // SAFETY: the caller's promise, and the row stands beside the state.
            Ok(found) => unsafe { give(row, found, Status::NoRowYet) },
            Err(e) => e.into(),
        }
    }

    /// Takes answers of the last row away where a camera did not see.
    ///
    /// # Safety
    ///
    /// As [`Self::deinit`]; `left` and `right` are null or point to `length` bytes.
    pub unsafe fn mask(handle: *mut Handle, left: *const u8, right: *const u8, length: usize) -> Status {
        // SAFETY: the caller's promise.
        let state = match unsafe { State::<S, W, D>::open(handle) } {
            Ok(state) => state,
            Err(status) => return status,
        };
        let Some(row) = state.pipeline.row() else { return Status::NoRowYet };
        if length != row.disparities().len() {
            return Status::LineLength;
        }
        if state.overlaps(left, length) || state.overlaps(right, length) {
            return Status::Overlap;
        }
        state.pipeline.mask(|_, masks| {
            for (mask, given) in masks.into_iter().zip([left, right]) {
                if given.is_null() {
                    mask.fill(1);
                } else {
                    // SAFETY: the caller's promise, and the array does not stand in the state.
                    let given = unsafe { core::slice::from_raw_parts(given, length) };
                    mask.iter_mut().zip(given).for_each(|(mask, given)| *mask = *given);
                }
            }
            true
        });
        Status::Ok
    }

    /// What went wrong since the start.
    ///
    /// # Safety
    ///
    /// As [`Self::deinit`]; `counters` is null or points to counters' bytes.
    pub unsafe fn counters(handle: *mut Handle, counters: *mut CCounters) -> Status {
        if counters.is_null() {
            return Status::Null;
        }
        // SAFETY: the caller's promise.
        let state = match unsafe { State::<S, W, D>::open(handle) } {
            Ok(state) if state.overlaps(counters, 1) => return Status::Overlap,
            Ok(state) => state,
            Err(status) => return status,
        };
        // SAFETY: the caller's promise; no alignment is asked for.
        unsafe { counters.write_unaligned(state.pipeline.counters().into()) };
        Status::Ok
    }

    /// Goes on below the last line.
    ///
    /// # Safety
    ///
    /// As [`Self::deinit`]; `row` is null or points to a row's bytes.
    pub unsafe fn flush(handle: *mut Handle, row: *mut CRow) -> Status {
        if row.is_null() {
            return Status::Null;
        }
        // SAFETY: the caller's promise.
        let state = match unsafe { State::<S, W, D>::open(handle) } {
            Ok(state) if state.overlaps(row, 1) => return Status::Overlap,
            Ok(state) => state,
            Err(status) => return status,
        };
        match state.pipeline.flush() {
            // SAFETY: the caller's promise, and the row stands beside the state.
            Ok(found) => unsafe { give(row, found, Status::FrameDone) },
            Err(e) => e.into(),
        }
    }

    /// The deviations of the row that came out last.
    ///
    /// # Safety
    ///
    /// As [`Self::deinit`]; `sigma_px` is null or points to `count` floats.
    pub unsafe fn sigma_px(handle: *mut Handle, sigma_px: *mut f32, count: usize) -> Status {
        if sigma_px.is_null() {
            return Status::Null;
        }
        if !sigma_px.is_aligned() {
            return Status::Misaligned;
        }
        // SAFETY: the caller's promise.
        let state = match unsafe { State::<S, W, D>::open(handle) } {
            Ok(state) if state.overlaps(sigma_px, count) => return Status::Overlap,
            Ok(state) => state,
            Err(status) => return status,
        };
        let Some(row) = state.pipeline.row() else { return Status::NoRowYet };
        if count != row.disparities().len() {
            return Status::LineLength;
        }
        for x in 0..count {
            // SAFETY: the caller's promise, and none of the floats stands in the state.
            unsafe { sigma_px.add(x).write(row.sigma_px(x).unwrap_or(f32::INFINITY)) };
        }
        Status::Ok
    }
}
