//! The matcher's state in the caller's memory, with a mark that detects memory which holds none.
#![allow(unsafe_code)]

use super::Status;
use crate::matching::{self, Capacity, Method, Supported};
use crate::pipeline::Guarded;
use core::ffi::c_void;

/// Alignment that is enough for every matcher's memory, that of `uint64_t`.
pub const STEREOPSIS_ALIGN: usize = 8;

/// Matcher in the caller's memory.
pub struct Handle {
    _opaque: [u8; 0],
}

/// Contents of the memory.
#[repr(C)]
pub(super) struct State<S: Method, const W: usize, const D: usize> {
    /// [`MARK`] combined with the state's own address, which moved or uninitialised memory does not have.
    mark: usize,
    pub(super) pipeline: Guarded<S, W, D>,
}

/// Bits that memory is unlikely to hold by chance.
const MARK: usize = 0x57E2_E0D5;

/// Largest number of bytes of counters and padding beside matcher and lines.
const FIXED_BYTES: usize = 352;

/// Returns the bytes of memory that are enough for a matcher on any target, as the macros of `stereopsis.h`
/// do.
///
/// `disparities` is a multiple of 16, and `width` at least as large.
pub const fn memory_bytes<S: Method>(width: usize, disparities: usize) -> usize {
    // Five lines of two cameras.
    matching::state_bytes::<S>(width, disparities) + 2 * 5 * width + FIXED_BYTES
}

impl<S: Method, const W: usize, const D: usize> State<S, W, D>
where
    Capacity<D>: Supported,
{
    const CHECKED: () = {
        assert!(align_of::<Self>() <= STEREOPSIS_ALIGN, "STEREOPSIS_ALIGN must be enough");
        assert!(size_of::<Self>() <= memory_bytes::<S>(W, D), "memory_bytes must cover the state");
    };

    fn mark_of(state: *const Self) -> usize {
        MARK ^ state.addr()
    }

    /// Creates a matcher in the caller's memory, which holds none yet.
    ///
    /// # Safety
    ///
    /// `memory` is null or points to `length` bytes that nothing else uses until the matcher is given up.
    pub(super) unsafe fn init(memory: *mut c_void, length: usize) -> Result<*mut Handle, Status> {
        const { Self::CHECKED };
        let state = memory.cast::<Self>();
        if state.is_null() {
            return Err(Status::Null);
        }
        if !state.is_aligned() {
            return Err(Status::Misaligned);
        }
        if length < size_of::<Self>() {
            return Err(Status::MemoryTooShort);
        }
        // SAFETY: the state is aligned and inside of the caller's bytes. What it holds was written by C, or
        // by nobody: a volatile read takes it as the machine has it, and every bit pattern is an
        // integer.
        let mark = unsafe { (&raw const (*state).mark).read_volatile() };
        if mark == Self::mark_of(state) {
            return Err(Status::AlreadyInitialised);
        }
        // SAFETY: as before; nothing refers to these bytes yet. The constant is all zero: the bytes are set
        // in place and no copy stands on the stack.
        unsafe {
            (&raw mut (*state).pipeline).write(const { Guarded::new() });
            (&raw mut (*state).mark).write_volatile(Self::mark_of(state));
        }
        Ok(state.cast())
    }

    /// Returns the matcher behind a handle.
    ///
    /// # Safety
    ///
    /// `handle` is null or points to as many bytes as a state has, and for `'a` nothing else uses them.
    pub(super) unsafe fn open<'a>(handle: *mut Handle) -> Result<&'a mut Self, Status> {
        let state = handle.cast::<Self>();
        if state.is_null() {
            return Err(Status::Null);
        }
        if !state.is_aligned() {
            return Err(Status::Misaligned);
        }
        // SAFETY: the state is aligned and its bytes are there; every bit pattern is an integer.
        let mark = unsafe { (&raw const (*state).mark).read_volatile() };
        if mark != Self::mark_of(state) {
            return Err(Status::NotInitialised);
        }
        // SAFETY: the mark says that `init` has made a state at this very address, and nothing else uses it.
        Ok(unsafe { &mut *state })
    }

    /// Gives the memory up.
    pub(super) fn deinit(&mut self) {
        // SAFETY: a reference is aligned and its bytes are there. The write is volatile as the reads are:
        // nothing here looks at the mark again, and it has to go all the same.
        unsafe { (&raw mut self.mark).write_volatile(0) };
    }

    /// Returns whether `count` values at `data` share bytes with the state.
    pub(super) fn overlaps<T>(&self, data: *const T, count: usize) -> bool {
        share_bytes(
            (&raw const *self).cast(),
            size_of::<Self>(),
            data.cast(),
            count.saturating_mul(size_of::<T>()),
        )
    }
}

/// Returns whether two runs of bytes overlap.
pub(super) fn share_bytes(a: *const c_void, a_length: usize, b: *const c_void, b_length: usize) -> bool {
    let (a, b) = (a.addr(), b.addr());
    a < b.saturating_add(b_length) && b < a.saturating_add(a_length)
}
