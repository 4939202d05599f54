//! Rectification of raw lines in C, in memory of the caller.
#![allow(unsafe_code)]

use super::record::rig_of;
use super::rectifying::{CELL, Rectifying};
use super::state::{State, checked, share_bytes};
use super::status::either;
use super::{CRig, RectifierHandle, STEREOPSIS_ALPHA_NATURAL, STEREOPSIS_RECORD_BYTES, Status};
use crate::geometry::camera::ImageSize;
use crate::geometry::rectify::{Axis, Crop, Rectification};
use crate::imaging::{RemapError, RemapPairError, RemapTable};
use core::ffi::c_void;

/// The functions for lines up to `W` pixels, bands of `N` lines and tables of `SLOTS` entries.
///
/// [`instantiate_c_api`](crate::instantiate_c_api) gives them their names in C and their full descriptions.
pub struct Rectifier<const W: usize, const N: usize, const SLOTS: usize>;

impl<const W: usize, const N: usize, const SLOTS: usize> Rectifier<W, N, SLOTS> {
    /// Returns the bytes that a rectifier takes.
    pub const fn size() -> usize {
        size_of::<State<Rectifying<W, N, SLOTS>>>()
    }

    /// Returns the raw lines of each camera that are held, one of which is a copy.
    pub const fn lines() -> usize {
        N
    }

    /// Creates a rectifier in the caller's memory, which is not read.
    ///
    /// # Safety
    ///
    /// `memory` is null or points to `length` bytes that nothing else uses until the rectifier is given up;
    /// `handle` is null or points to a pointer.
    pub unsafe fn init(memory: *mut c_void, length: usize, handle: *mut *mut RectifierHandle) -> Status {
        // SAFETY: the caller's promise.
        unsafe { State::<Rectifying<W, N, SLOTS>>::init_handle(memory, length, false, handle) }
    }

    /// Gives the memory up.
    ///
    /// # Safety
    ///
    /// `handle` is null or from [`Self::init`], and no other call uses it at the same time.
    pub unsafe fn deinit(handle: *mut RectifierHandle) -> Status {
        // SAFETY: the caller's promise.
        unsafe { State::<Rectifying<W, N, SLOTS>>::deinit(handle) }
    }

    /// Returns the started content of a rectifier, apart from the `count` values at each of `arguments`.
    ///
    /// # Safety
    ///
    /// `handle` is as [`Self::deinit`] asks.
    unsafe fn open<'a, T, const K: usize>(
        handle: *mut RectifierHandle,
        arguments: [*const T; K],
        count: usize,
    ) -> Result<&'a mut Rectifying<W, N, SLOTS>, Status> {
        for argument in arguments {
            checked(argument)?;
        }
        // SAFETY: the caller's promise.
        let state = unsafe { State::<Rectifying<W, N, SLOTS>>::open(handle) }?;
        if !state.content.is_started {
            return Err(Status::NotStarted);
        }
        if arguments.iter().any(|&argument| state.overlaps(argument, count)) {
            return Err(Status::Overlap);
        }
        Ok(&mut state.content)
    }

    /// Reads a record and tabulates its rectification.
    ///
    /// # Safety
    ///
    /// `handle` is as [`Self::deinit`] asks; `record` is null or points to `length` bytes, `rig` is null or
    /// points to a rig's bytes, `lines` is null or points to a number.
    pub unsafe fn start(
        handle: *mut RectifierHandle,
        record: *const u8,
        length: usize,
        [width, height]: [u16; 2],
        alpha: f32,
        rig: *mut CRig,
        lines: *mut usize,
    ) -> Status {
        let start = || {
            checked(rig)?;
            if !lines.is_aligned() {
                return Err(Status::Misaligned);
            }
            // SAFETY: the caller's promise.
            let state = unsafe { State::<Rectifying<W, N, SLOTS>>::open(handle) }?;
            let read = length.min(STEREOPSIS_RECORD_BYTES);
            let is_shared = !lines.is_null()
                && share_bytes(rig.cast(), size_of::<CRig>(), lines.cast(), size_of::<usize>());
            if state.overlaps(record, read) || state.overlaps(rig, 1) || state.overlaps(lines, 1) || is_shared
            {
                return Err(Status::Overlap);
            }
            // SAFETY: the caller's promise.
            let cameras = unsafe { rig_of(record, length) }?;
            let [left, right] = cameras.sizes();
            if left != right {
                return Err(Status::RawSizes);
            }
            let crop = if alpha == STEREOPSIS_ALPHA_NATURAL { Crop::Natural } else { Crop::Alpha(alpha) };
            let rectified = Rectification::new(&cameras, crop, ImageSize { width, height })?;
            if rectified.axis() != Axis::Horizontal {
                return Err(Status::RectifyVertical);
            }
            let rectified_rig = rectified.rig()?;
            if [left.width, width].iter().any(|&width| usize::from(width) > W)
                || RemapTable::<0>::slots(rectified.size(), CELL) > SLOTS
            {
                return Err(Status::RectifySize);
            }
            let content = &mut state.content;
            (content.is_started, content.is_begun) = (false, false);
            let set = content.pair.set(&rectified);
            let in_step = if set.is_ok() { content.pair.lines_in_step() } else { Ok(0) };
            let needed = match (set, in_step) {
                (Err(RemapError::Lines { needed }), _) | (_, Err(RemapPairError::Lines { needed })) => needed,
                (_, Ok(needed)) => needed,
                (_, Err(RemapPairError::Sizes)) => 0,
            };
            if !lines.is_null() {
                // SAFETY: the caller's promise; it is aligned and apart from the state.
                unsafe { lines.write(needed) };
            }
            set?;
            in_step.map_err(|error| match error {
                RemapPairError::Sizes => Status::RawSizes,
                RemapPairError::Lines { .. } => Status::RectifyLines,
            })?;
            content.is_started = true;
            // SAFETY: as for the lines.
            unsafe { rig.write(rectified_rig.into()) };
            Ok(Status::Ok)
        };
        either(start())
    }

    /// Begins a frame.
    ///
    /// # Safety
    ///
    /// `handle` is as [`Self::deinit`] asks.
    pub unsafe fn begin_frame(handle: *mut RectifierHandle) -> Status {
        // SAFETY: the caller's promise.
        either(unsafe { Self::open::<u8, 0>(handle, [], 0) }.map(|content| {
            content.pair.begin();
            content.is_begun = true;
            Status::Ok
        }))
    }

    /// Takes a raw line of both cameras.
    ///
    /// # Safety
    ///
    /// `handle` is as [`Self::deinit`] asks; `left` and `right` are null or point to `length` bytes.
    pub unsafe fn push(
        handle: *mut RectifierHandle,
        left: *const u8,
        right: *const u8,
        length: usize,
    ) -> Status {
        let push = || {
            // SAFETY: the caller's promise.
            let content = unsafe { Self::open(handle, [left, right], length) }?;
            let width = content.begun()?.remaps()[0].table().raw_size().width;
            if length != usize::from(width) {
                return Err(Status::LineLength);
            }
            content.take(|pair| {
                for (to, from) in pair.next_lines().into_iter().zip([left, right]) {
                    // SAFETY: the caller's promise, and the line is apart from the state.
                    let from = unsafe { core::slice::from_raw_parts(from, length) };
                    to.iter_mut().zip(from).for_each(|(to, from)| *to = *from);
                }
                pair.accept();
            })
        };
        either(push())
    }

    /// Takes the raw lines above again, in place of lost ones.
    ///
    /// # Safety
    ///
    /// `handle` is as [`Self::deinit`] asks.
    pub unsafe fn push_lost(handle: *mut RectifierHandle) -> Status {
        // SAFETY: the caller's promise.
        either(unsafe { Self::open::<u8, 0>(handle, [], 0) }.and_then(|content| {
            content.take(|pair| {
                pair.repeat_lines();
                pair.accept_replaced();
            })
        }))
    }

    /// Writes the next rectified lines.
    ///
    /// # Safety
    ///
    /// `handle` is as [`Self::deinit`] asks; `left` and `right` are null or point to `length` bytes each,
    /// that do not overlap.
    pub unsafe fn line(handle: *mut RectifierHandle, left: *mut u8, right: *mut u8, length: usize) -> Status {
        let line = || {
            // SAFETY: the caller's promise.
            let content = unsafe { Self::open(handle, [left.cast_const(), right], length) }?;
            let pair = content.begun()?;
            let size = pair.remaps()[0].table().size();
            // SAFETY: the caller's promise, and both are apart from the state.
            let [left, right] = unsafe { two_lines([left, right], length, size.width) }?;
            if pair.next_row() >= size.height {
                return Ok(Status::FrameDone);
            }
            if pair.wants_lines() {
                return Ok(Status::NoRowYet);
            }
            if pair.is_damaged() {
                pair.skip();
                return Ok(Status::Lost);
            }
            pair.row(left, right)?;
            Ok(Status::Ok)
        };
        either(line())
    }

    /// Writes the masks of a rectified row.
    ///
    /// # Safety
    ///
    /// As [`Self::line`] asks.
    pub unsafe fn mask(
        handle: *mut RectifierHandle,
        row: u16,
        left: *mut u8,
        right: *mut u8,
        length: usize,
    ) -> Status {
        let mask = || {
            // SAFETY: the caller's promise.
            let content = unsafe { Self::open(handle, [left.cast_const(), right], length) }?;
            let size = content.pair.remaps()[0].table().size();
            // SAFETY: the caller's promise, and both are apart from the state.
            let masks = unsafe { two_lines([left, right], length, size.width) }?;
            if row >= size.height {
                return Err(Status::Row);
            }
            content.pair.mask(row, masks);
            Ok(Status::Ok)
        };
        either(mask())
    }
}

/// Returns two lines of `length` bytes, which has to be `width`, and which have to be apart.
///
/// # Safety
///
/// Both point to `length` bytes that nothing else uses for `'a`, unless they overlap.
unsafe fn two_lines<'a>(lines: [*mut u8; 2], length: usize, width: u16) -> Result<[&'a mut [u8]; 2], Status> {
    if length != usize::from(width) {
        return Err(Status::LineLength);
    }
    let [left, right] = lines;
    if share_bytes(left.cast(), length, right.cast(), length) {
        return Err(Status::Overlap);
    }
    // SAFETY: the caller's promise, and they do not overlap.
    Ok(lines.map(|line| unsafe { core::slice::from_raw_parts_mut(line, length) }))
}
