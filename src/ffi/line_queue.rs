//! Line hand-off from an interrupt in C: a ring of slots in the caller's memory, filled and read in place.
//!
//! Both sides share the state, each field of which is an atomic or is set once. A slot is of the interrupt or
//! of the program that takes its lines, as [`Positions`] says.
#![allow(unsafe_code)]

use super::Status;
use super::state::{Content, State, checked, kind};
use super::status::either;
use crate::camera::Positions;
use core::ffi::c_void;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};

/// Queue of lines in the caller's memory, from an interrupt to the program that takes them.
pub struct LineQueueHandle {
    _opaque: [u8; 0],
}

/// Line that waits in a queue.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct CLine {
    /// The line's bytes, in the queue's memory: they hold until `stereopsis_line_queue_done`.
    pub bytes: *const u8,
    /// Time of the line, as the interrupt gave it, microseconds.
    pub timestamp_us: u64,
    /// Number of the frame that the line belongs to.
    pub frame: u32,
    /// Number of lines that had found no slot when this one was finished.
    pub overruns: u32,
    /// Row in the frame: it jumps where lines were lost.
    pub row: u16,
}

/// Ring of slots: behind it come as many [`CLine`]s, then the lines' bytes.
#[repr(align(8))]
pub(super) struct LineQueue {
    positions: Positions,
    slots: usize,
    line_bytes: usize,
    overruns: AtomicU32,
    /// Whether the interrupt fills the next free slot.
    is_begun: AtomicBool,
    /// Whether the program reads the line that has waited longest.
    is_taken: AtomicBool,
}

impl Content for LineQueue {
    type Handle = LineQueueHandle;
    const NEW: Self = Self::with(0, 0);
    const KIND: usize = kind("line queue", &[]);
    const MOST_BYTES: usize = FIXED_BYTES;
}

/// Bytes of a queue beside its slots, on any target.
const FIXED_BYTES: usize = 48;
/// Bytes of a slot beside its line.
const SLOT_BYTES: usize = 32;
/// Longest line, bytes.
const MOST_LINE_BYTES: usize = 65535;
const _: () = assert!(size_of::<CLine>() <= SLOT_BYTES && align_of::<CLine>() <= 8);

/// Returns the bytes of memory that are enough for a queue on any target, as the macro
/// `STEREOPSIS_LINE_QUEUE_BYTES` does.
pub const fn line_queue_bytes(line_bytes: usize, slots: usize) -> usize {
    FIXED_BYTES + slots * slot_bytes(line_bytes)
}

const fn slot_bytes(line_bytes: usize) -> usize {
    SLOT_BYTES + line_bytes.next_multiple_of(8)
}

impl LineQueue {
    const fn with(slots: usize, line_bytes: usize) -> Self {
        Self {
            positions: Positions::new(),
            slots,
            line_bytes,
            overruns: AtomicU32::new(0),
            is_begun: AtomicBool::new(false),
            is_taken: AtomicBool::new(false),
        }
    }

    /// Returns the description and the bytes of a slot of the queue at a handle.
    ///
    /// # Safety
    ///
    /// The handle is that of this queue, and the place one of its slots.
    unsafe fn slot(&self, handle: *mut LineQueueHandle, place: usize) -> (*mut CLine, *mut u8) {
        // SAFETY: the memory holds the slots behind the state, as `init` has counted them.
        unsafe {
            let lines = handle.cast::<State<Self>>().add(1).cast::<CLine>();
            let bytes = lines.add(self.slots).cast::<u8>();
            (lines.add(place), bytes.add(place * self.line_bytes.next_multiple_of(8)))
        }
    }

    /// Returns whether `count` values at `data` share bytes with a queue's memory.
    fn overlaps<T>(&self, handle: *mut LineQueueHandle, data: *const T) -> bool {
        let bytes = size_of::<State<Self>>() + self.slots * slot_bytes(self.line_bytes);
        super::state::share_bytes(handle.cast(), bytes, data.cast(), size_of::<T>())
    }
}

/// Returns the queue of a handle, whose memory is apart from the value at `argument`.
///
/// # Safety
///
/// `handle` is null or from [`line_queue_init`].
unsafe fn open<'a, T>(handle: *mut LineQueueHandle, argument: *const T) -> Result<&'a LineQueue, Status> {
    checked(argument)?;
    // SAFETY: the caller's promise; a queue may be shared.
    let queue = &unsafe { State::<LineQueue>::shared(handle) }?.content;
    if queue.overlaps(handle, argument) { Err(Status::Overlap) } else { Ok(queue) }
}

/// Creates a queue, as `stereopsis_line_queue_init`.
///
/// # Safety
///
/// `memory` is null or points to `length` bytes that nothing else uses until the queue is given up; `handle`
/// is null or points to a pointer.
pub unsafe fn line_queue_init(
    memory: *mut c_void,
    length: usize,
    line_bytes: usize,
    handle: *mut *mut LineQueueHandle,
) -> Status {
    let content = if (1..=MOST_LINE_BYTES).contains(&line_bytes) {
        let each = slot_bytes(line_bytes);
        let room = length.saturating_sub(size_of::<State<LineQueue>>());
        // One slot stays free, so that two hold one line. The division is by 40 at least.
        match room.checked_div(each).unwrap_or(0) {
            0 | 1 => Err(Status::MemoryTooShort),
            slots => Ok((LineQueue::with(slots, line_bytes), slots * each)),
        }
    } else {
        Err(Status::LineBytes)
    };
    // SAFETY: the caller's promise.
    unsafe { State::<LineQueue>::init_with_tail(memory, length, content, handle) }
}

/// Gives the memory up.
///
/// # Safety
///
/// `handle` is null or from [`line_queue_init`], and no other call uses it at the same time.
pub unsafe fn line_queue_deinit(handle: *mut LineQueueHandle) -> Status {
    // SAFETY: the caller's promise.
    unsafe { State::<LineQueue>::deinit(handle) }
}

/// Gives the slot for the line that comes now, as `stereopsis_line_queue_begin`.
///
/// # Safety
///
/// `handle` is null or from [`line_queue_init`], and one call of the interrupt's side uses it at a time;
/// `bytes` is null or points to a pointer.
pub unsafe fn line_queue_begin(handle: *mut LineQueueHandle, bytes: *mut *mut u8) -> Status {
    let begin = || {
        // SAFETY: the caller's promise.
        let queue = unsafe { open(handle, bytes) }?;
        let place = queue.positions.free(queue.slots);
        queue.is_begun.store(place.is_some(), Ordering::Relaxed);
        let Some(place) = place else {
            let overruns = queue.overruns.load(Ordering::Relaxed);
            queue.overruns.store(overruns.saturating_add(1), Ordering::Relaxed);
            return Ok(Status::NoSlot);
        };
        // SAFETY: the place is a slot, and `bytes` is aligned and apart from the memory.
        unsafe { bytes.write(queue.slot(handle, place).1) };
        Ok(Status::Ok)
    };
    either(begin())
}

/// Hands a line over, as `stereopsis_line_queue_finish`.
///
/// # Safety
///
/// `handle` is as [`line_queue_begin`] asks.
pub unsafe fn line_queue_finish(
    handle: *mut LineQueueHandle,
    frame: u32,
    row: u16,
    timestamp_us: u64,
) -> Status {
    let finish = || {
        // SAFETY: the caller's promise; a queue may be shared.
        let queue = &unsafe { State::<LineQueue>::shared(handle) }?.content;
        if !queue.is_begun.load(Ordering::Relaxed) {
            return Err(Status::LineNotBegun);
        }
        queue.is_begun.store(false, Ordering::Relaxed);
        // A slot that was begun stays free until it is handed over.
        let place = queue.positions.free(queue.slots).ok_or(Status::LineNotBegun)?;
        let overruns = queue.overruns.load(Ordering::Relaxed);
        // SAFETY: the place is a slot, and of this side until it is handed over.
        unsafe {
            let (line, bytes) = queue.slot(handle, place);
            line.write(CLine { bytes, timestamp_us, frame, overruns, row });
        }
        queue.positions.fill(place, queue.slots);
        Ok(Status::Ok)
    };
    either(finish())
}

/// Gives the line that has waited longest, as `stereopsis_line_queue_next`.
///
/// # Safety
///
/// `handle` is null or from [`line_queue_init`], and one call of the taking side uses it at a time; `line` is
/// null or points to a line's bytes.
pub unsafe fn line_queue_next(handle: *mut LineQueueHandle, line: *mut CLine) -> Status {
    let next = || {
        // SAFETY: the caller's promise.
        let queue = unsafe { open(handle, line) }?;
        let Some(place) = queue.positions.waiting() else { return Ok(Status::NoLineYet) };
        queue.is_taken.store(true, Ordering::Relaxed);
        // SAFETY: the place is a slot of this side, and `line` is aligned and apart from the memory.
        unsafe { line.write(queue.slot(handle, place).0.read()) };
        Ok(Status::Ok)
    };
    either(next())
}

/// Frees the slot of a line that was read, as `stereopsis_line_queue_done`.
///
/// # Safety
///
/// `handle` is as [`line_queue_next`] asks.
pub unsafe fn line_queue_done(handle: *mut LineQueueHandle) -> Status {
    let done = || {
        // SAFETY: the caller's promise; a queue may be shared.
        let queue = &unsafe { State::<LineQueue>::shared(handle) }?.content;
        let place = queue.positions.waiting().filter(|_| queue.is_taken.load(Ordering::Relaxed));
        let place = place.ok_or(Status::LineNotTaken)?;
        queue.is_taken.store(false, Ordering::Relaxed);
        queue.positions.clear(place, queue.slots);
        Ok(Status::Ok)
    };
    either(done())
}

/// Writes how many lines found no slot, as `stereopsis_line_queue_overruns`.
///
/// # Safety
///
/// `handle` is null or from [`line_queue_init`]; `overruns` is null or points to a number.
pub unsafe fn line_queue_overruns(handle: *mut LineQueueHandle, overruns: *mut u32) -> Status {
    let read = || {
        // SAFETY: the caller's promise.
        let queue = unsafe { open(handle, overruns) }?;
        // SAFETY: the caller's promise; it is aligned and apart from the memory.
        unsafe { overruns.write(queue.overruns.load(Ordering::Relaxed)) };
        Ok(Status::Ok)
    };
    either(read())
}
