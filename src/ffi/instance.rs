//! Implementation of the functions of `stereopsis.h`, for one method and one capacity.
#![allow(unsafe_code)]

use super::faults::fault;
use super::state::{State, checked};
use super::status::either;
use super::{CConfig, CCounters, CRow, Handle, Status};
use crate::matching::{self, Capacity, MatchError, Method, Supported};
use crate::pipeline::{Guarded, Pipeline};
use core::ffi::c_void;
use core::marker::PhantomData;

/// The functions for method `S`, lines up to `W` pixels and `D` disparities.
///
/// [`instantiate_c_api`](crate::instantiate_c_api) gives them their names in C and their full descriptions.
pub struct Instance<S: Method, const W: usize, const D: usize>(PhantomData<S>);

/// Writes the row of a call that gives one, empty where there is none.
///
/// # Safety
///
/// `to` points to a row's bytes and is aligned.
pub(super) unsafe fn give(to: *mut CRow, row: Option<matching::Row<'_>>, without: Status) -> Status {
    let status = if row.is_some() { Status::Ok } else { without };
    // SAFETY: the caller's promise.
    unsafe { to.write(row.map_or(CRow::NONE, CRow::from)) };
    status
}

/// Writes the standard deviations of a row, px.
///
/// # Safety
///
/// `to` points to `count` floats apart from the row, and is aligned.
pub(super) unsafe fn write_sigma_px(
    row: &matching::Row<'_>,
    to: *mut f32,
    count: usize,
) -> Result<Status, Status> {
    if count != row.disparities().len() {
        return Err(Status::LineLength);
    }
    for x in 0..count {
        // SAFETY: the caller's promise.
        unsafe { to.add(x).write(row.sigma_px(x).unwrap_or(f32::INFINITY)) };
    }
    Ok(Status::Ok)
}

impl<S: Method, const W: usize, const D: usize> Instance<S, W, D>
where
    Capacity<D>: Supported,
{
    /// Returns the bytes that a matcher takes.
    pub const fn size() -> usize {
        size_of::<State<Guarded<S, W, D>>>()
    }

    /// Returns the alignment of a matcher's memory, bytes.
    pub const fn align() -> usize {
        align_of::<State<Guarded<S, W, D>>>()
    }

    /// Returns the longest line, pixels.
    pub const fn max_width() -> usize {
        W
    }

    /// Returns the largest number of disparities.
    pub const fn max_disparities() -> usize {
        D
    }

    /// Returns the delay of a row, lines.
    pub const fn latency() -> usize {
        Pipeline::<S, W, D>::LATENCY
    }

    /// Returns the matcher behind a handle, apart from the `count` values at `argument`, which is neither
    /// null nor misaligned.
    ///
    /// # Safety
    ///
    /// `handle` is as [`Self::deinit`] asks.
    unsafe fn open_apart<'a, T>(
        handle: *mut Handle,
        argument: *const T,
        count: usize,
    ) -> Result<&'a mut State<Guarded<S, W, D>>, Status> {
        checked(argument)?;
        // SAFETY: the caller's promise.
        let state = unsafe { State::<Guarded<S, W, D>>::open(handle) }?;
        if state.overlaps(argument, count) { Err(Status::Overlap) } else { Ok(state) }
    }

    /// Creates a matcher in the caller's memory, which is read first unless it is `fresh`.
    ///
    /// # Safety
    ///
    /// `memory` is null or points to `length` bytes that nothing else uses until the matcher is given up;
    /// `handle` is null or points to a pointer.
    pub unsafe fn init(memory: *mut c_void, length: usize, fresh: bool, handle: *mut *mut Handle) -> Status {
        // SAFETY: the caller's promise.
        unsafe { State::<Guarded<S, W, D>>::init_handle(memory, length, !fresh, handle) }
    }

    /// Gives the memory up.
    ///
    /// # Safety
    ///
    /// `handle` is null or from [`Self::init`], and no other call uses it at the same time.
    pub unsafe fn deinit(handle: *mut Handle) -> Status {
        // SAFETY: the caller's promise.
        unsafe { State::<Guarded<S, W, D>>::deinit(handle) }
    }

    /// Checks a configuration and prepares for the next frame; counters go on if it `keeps_counters`.
    ///
    /// # Safety
    ///
    /// `handle` is as [`Self::deinit`] asks; `config` is null or points to a configuration.
    pub unsafe fn start(handle: *mut Handle, config: *const CConfig, keeps_counters: bool) -> Status {
        if let Err(status) = checked(config) {
            return status;
        }
        // SAFETY: the caller's promise, it is aligned, and every bit pattern is a configuration.
        let (state, config) = unsafe { (State::<Guarded<S, W, D>>::open(handle), config.read()) };
        let start = || {
            let (pipeline, config) = (&mut state?.content, config.checked()?);
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
    /// `handle` is as [`Self::deinit`] asks.
    pub unsafe fn begin_frame(handle: *mut Handle) -> Status {
        // SAFETY: the caller's promise.
        let state = unsafe { State::<Guarded<S, W, D>>::open(handle) };
        either(state.and_then(|state| Ok(state.content.begin().map(|()| Status::Ok)?)))
    }

    /// Takes a line of both cameras.
    ///
    /// # Safety
    ///
    /// `handle` is as [`Self::deinit`] asks; `left` and `right` are null or point to `length` bytes, `row` is
    /// null or points to a row's bytes.
    pub unsafe fn push(
        handle: *mut Handle,
        left: *const u8,
        right: *const u8,
        length: usize,
        row: *mut CRow,
    ) -> Status {
        if left.is_null() || right.is_null() {
            return Status::Null;
        }
        let push = || {
            checked(row)?;
            // SAFETY: the caller's promise.
            let state = unsafe { State::<Guarded<S, W, D>>::open(handle) }?;
            let width = usize::from(state.content.config().width);
            if width == 0 {
                return Err(MatchError::NotStarted.into());
            }
            // Only the right length makes a slice: any other might be longer than a slice can be.
            if length != width {
                return Err(Status::LineLength);
            }
            if state.overlaps(left, length) || state.overlaps(right, length) || state.overlaps(row, 1) {
                return Err(Status::Overlap);
            }
            // SAFETY: the caller's promise, and neither is in the state.
            let [left, right] =
                unsafe { [left, right].map(|line| core::slice::from_raw_parts(line, length)) };
            let found = state.content.push(left, right)?;
            // SAFETY: the caller's promise, and the row is apart from the state.
            Ok(unsafe { give(row, found, Status::NoRowYet) })
        };
        either(push())
    }

    /// Takes the line above again, in place of a lost one.
    ///
    /// # Safety
    ///
    /// `handle` is as [`Self::deinit`] asks; `row` is null or points to a row's bytes.
    pub unsafe fn push_lost(handle: *mut Handle, number: i32, row: *mut CRow) -> Status {
        let push = || {
            // SAFETY: the caller's promise.
            let state = unsafe { Self::open_apart(handle, row, 1) }?;
            let found = state.content.push_lost(fault(number)?)?;
            // SAFETY: the caller's promise, and the row is apart from the state.
            Ok(unsafe { give(row, found, Status::NoRowYet) })
        };
        either(push())
    }

    /// Removes answers of the last row at pixels that a camera did not see.
    ///
    /// # Safety
    ///
    /// `handle` is as [`Self::deinit`] asks; `left` and `right` are null or point to `length` bytes.
    pub unsafe fn mask(handle: *mut Handle, left: *const u8, right: *const u8, length: usize) -> Status {
        let mask = || {
            // SAFETY: the caller's promise.
            let state = unsafe { State::<Guarded<S, W, D>>::open(handle) }?;
            if state.content.config().width == 0 {
                return Err(Status::NotStarted);
            }
            let row = state.content.row().ok_or(Status::NoRowYet)?;
            if length != row.disparities().len() {
                return Err(Status::LineLength);
            }
            if state.overlaps(left, length) || state.overlaps(right, length) {
                return Err(Status::Overlap);
            }
            state.content.mask(|_, masks| {
                for (mask, given) in masks.into_iter().zip([left, right]) {
                    if given.is_null() {
                        mask.fill(1);
                    } else {
                        // SAFETY: the caller's promise, and the array is apart from the state.
                        let given = unsafe { core::slice::from_raw_parts(given, length) };
                        mask.iter_mut().zip(given).for_each(|(mask, given)| *mask = *given);
                    }
                }
                true
            });
            Ok(Status::Ok)
        };
        either(mask())
    }

    /// Writes the counts since the start.
    ///
    /// # Safety
    ///
    /// `handle` is as [`Self::deinit`] asks; `counters` is null or points to counters' bytes.
    pub unsafe fn counters(handle: *mut Handle, counters: *mut CCounters) -> Status {
        // SAFETY: the caller's promise.
        either(unsafe { Self::open_apart(handle, counters, 1) }.map(|state| {
            // SAFETY: the caller's promise, and it is aligned.
            unsafe { counters.write(state.content.counters().into()) };
            Status::Ok
        }))
    }

    /// Gives the next row after the last line.
    ///
    /// # Safety
    ///
    /// `handle` is as [`Self::deinit`] asks; `row` is null or points to a row's bytes.
    pub unsafe fn flush(handle: *mut Handle, row: *mut CRow) -> Status {
        let flush = || {
            // SAFETY: the caller's promise.
            let state = unsafe { Self::open_apart(handle, row, 1) }?;
            let found = state.content.flush()?;
            // SAFETY: the caller's promise, and the row is apart from the state.
            Ok(unsafe { give(row, found, Status::FrameDone) })
        };
        either(flush())
    }

    /// Writes the standard deviations of the last row, px.
    ///
    /// # Safety
    ///
    /// `handle` is as [`Self::deinit`] asks; `sigma_px` is null or points to `count` floats.
    pub unsafe fn sigma_px(handle: *mut Handle, sigma_px: *mut f32, count: usize) -> Status {
        let write = || {
            // SAFETY: the caller's promise.
            let state = unsafe { Self::open_apart(handle, sigma_px, count) }?;
            if state.content.config().width == 0 {
                return Err(Status::NotStarted);
            }
            let row = state.content.row().ok_or(Status::NoRowYet)?;
            // SAFETY: the caller's promise, and the floats are apart from the state.
            unsafe { write_sigma_px(&row, sigma_px, count) }
        };
        either(write())
    }
}
