//! Decisions and free space over frames in C: a rule and sectors in the caller's memory.
#![allow(unsafe_code)]

use super::Status;
use super::drive_types::{CDriveConfig, CVerdict};
use super::obstacles::{ObstaclesHandle, view_at};
use super::obstacles_types::CSector;
use super::state::{Content, State, checked, kind};
use super::status::either;
use crate::obstacles::{DriveConfig, DriveRule, FreeSpace, Hysteresis};
use core::ffi::c_void;
use core::ptr::null;

/// Bytes that are enough for a drive rule, on any target.
pub const STEREOPSIS_DRIVE_BYTES: usize = 40;
/// Bytes that are enough for the free space over frames, on any target.
pub const STEREOPSIS_FREE_SPACE_BYTES: usize = 1536;

/// Drive rule in the caller's memory.
pub struct DriveHandle {
    _opaque: [u8; 0],
}

/// Free space over frames in the caller's memory.
pub struct FreeSpaceHandle {
    _opaque: [u8; 0],
}

/// A rule, which may have been started.
pub(super) struct Drive {
    rule: DriveRule,
    is_started: bool,
}

/// A vehicle before its start.
const NOTHING: DriveConfig = DriveConfig {
    corridor_mm: 0,
    margin_mm: 0,
    reaction_ms: 0,
    brake_mm_s2: 0,
    slow_ms: 0,
    hysteresis: NO_FRAMES,
};
const NO_FRAMES: Hysteresis = Hysteresis { confirm: 0, release: 0 };

impl Content for Drive {
    type Handle = DriveHandle;
    const NEW: Self = Self { rule: DriveRule::new(NOTHING), is_started: false };
    const KIND: usize = kind("drive", &[]);
    const MOST_BYTES: usize = STEREOPSIS_DRIVE_BYTES;
}

impl Content for FreeSpace {
    type Handle = FreeSpaceHandle;
    const NEW: Self = Self::new(NO_FRAMES);
    const KIND: usize = kind("free space", &[]);
    const MOST_BYTES: usize = STEREOPSIS_FREE_SPACE_BYTES;
}

/// Creates a rule, as `stereopsis_drive_init`.
///
/// # Safety
///
/// `memory` is null or points to `length` bytes that nothing else uses until the rule is given up; `handle`
/// is null or points to a pointer.
pub unsafe fn drive_init(memory: *mut c_void, length: usize, handle: *mut *mut DriveHandle) -> Status {
    // SAFETY: the caller's promise.
    unsafe { State::<Drive>::init_with_tail(memory, length, Ok((Drive::NEW, 0)), handle) }
}

/// Gives the memory up.
///
/// # Safety
///
/// `handle` is null or from [`drive_init`], and no other call uses it at the same time.
pub unsafe fn drive_deinit(handle: *mut DriveHandle) -> Status {
    // SAFETY: the caller's promise.
    unsafe { State::<Drive>::deinit(handle) }
}

/// Sets how the vehicle drives, and forgets what was held, as `stereopsis_drive_start`.
///
/// # Safety
///
/// `handle` is as [`drive_deinit`] asks; `config` is null or points to a configuration.
pub unsafe fn drive_start(handle: *mut DriveHandle, config: *const CDriveConfig) -> Status {
    let start = || {
        checked(config)?;
        // SAFETY: the caller's promise, it is aligned, and every bit pattern is a configuration.
        let (drive, config) = unsafe { (&mut State::<Drive>::open(handle)?.content, config.read()) };
        *drive = Drive { rule: DriveRule::new(config.into()), is_started: true };
        Ok(Status::Ok)
    };
    either(start())
}

/// Writes the way that the vehicle needs to stand, as `stereopsis_drive_stopping_mm`.
///
/// # Safety
///
/// `handle` is as [`drive_deinit`] asks; `stopping_mm` is null or points to a word.
pub unsafe fn drive_stopping_mm(handle: *mut DriveHandle, speed_mm_s: u16, stopping_mm: *mut u16) -> Status {
    let write = || {
        checked(stopping_mm)?;
        // SAFETY: the caller's promise.
        let state = unsafe { State::<Drive>::open(handle) }?;
        if state.overlaps(stopping_mm, 1) {
            return Err(Status::Overlap);
        }
        if !state.content.is_started {
            return Err(Status::NotStarted);
        }
        // SAFETY: the caller's promise; it is aligned and apart from the rule.
        unsafe { stopping_mm.write(state.content.rule.stopping_mm(speed_mm_s)) };
        Ok(Status::Ok)
    };
    either(write())
}

/// Decides on a finished frame, as `stereopsis_drive_decide`.
///
/// # Safety
///
/// `handle` is as [`drive_deinit`] asks, `obstacles` is null or from `stereopsis_obstacles_init`, and no
/// other call uses them at the same time; `verdict` is null or points to a verdict's bytes.
pub unsafe fn drive_decide(
    handle: *mut DriveHandle,
    obstacles: *mut ObstaclesHandle,
    speed_mm_s: u16,
    verdict: *mut CVerdict,
) -> Status {
    let decide = || {
        checked(verdict)?;
        // SAFETY: the caller's promise.
        let state = unsafe { State::<Drive>::open(handle) }?;
        if state.overlaps(verdict, 1) {
            return Err(Status::Overlap);
        }
        // SAFETY: the caller's promise; two handles that are alive have memory of their own.
        let frame = unsafe { view_at(obstacles, verdict.cast_const().cast(), size_of::<CVerdict>()) }?;
        if !state.content.is_started {
            return Err(Status::NotStarted);
        }
        let decided = state.content.rule.decide(&frame, speed_mm_s);
        // SAFETY: the caller's promise; it is aligned and apart from both.
        unsafe { verdict.write(decided.into()) };
        Ok(Status::Ok)
    };
    either(decide())
}

/// Creates a free space, as `stereopsis_free_space_init`.
///
/// # Safety
///
/// `memory` is null or points to `length` bytes that nothing else uses until the free space is given up;
/// `handle` is null or points to a pointer.
pub unsafe fn free_space_init(
    memory: *mut c_void,
    length: usize,
    [confirm, release]: [u8; 2],
    handle: *mut *mut FreeSpaceHandle,
) -> Status {
    let content = Ok((FreeSpace::new(Hysteresis { confirm, release }), 0));
    // SAFETY: the caller's promise.
    unsafe { State::<FreeSpace>::init_with_tail(memory, length, content, handle) }
}

/// Gives the memory up.
///
/// # Safety
///
/// `handle` is null or from [`free_space_init`], and no other call uses it at the same time.
pub unsafe fn free_space_deinit(handle: *mut FreeSpaceHandle) -> Status {
    // SAFETY: the caller's promise.
    unsafe { State::<FreeSpace>::deinit(handle) }
}

/// Takes a finished frame, as `stereopsis_free_space_update`.
///
/// # Safety
///
/// `handle` is as [`free_space_deinit`] asks, `obstacles` is null or from `stereopsis_obstacles_init`, and no
/// other call uses them at the same time.
pub unsafe fn free_space_update(handle: *mut FreeSpaceHandle, obstacles: *mut ObstaclesHandle) -> Status {
    let update = || {
        // SAFETY: the caller's promise; two handles that are alive have memory of their own.
        let (state, frame) = unsafe { (State::<FreeSpace>::open(handle)?, view_at(obstacles, null(), 0)?) };
        state.content.update(&frame);
        Ok(Status::Ok)
    };
    either(update())
}

/// Writes sectors from the left, as `stereopsis_free_space_sectors`.
///
/// # Safety
///
/// `handle` is as [`free_space_deinit`] asks; `sectors` is null or points to `count` sectors' bytes.
pub unsafe fn free_space_sectors(
    handle: *mut FreeSpaceHandle,
    sectors: *mut CSector,
    count: usize,
) -> Status {
    let write = || {
        checked(sectors)?;
        if count > usize::from(u16::MAX) {
            return Err(Status::TooMany);
        }
        // SAFETY: the caller's promise.
        let state = unsafe { State::<FreeSpace>::open(handle) }?;
        if state.overlaps(sectors, count) {
            return Err(Status::Overlap);
        }
        for index in 0..count {
            // SAFETY: the caller's promise; the sectors are apart from the free space.
            unsafe { sectors.add(index).write(state.content.sector(index).into()) };
        }
        Ok(Status::Ok)
    };
    either(write())
}
