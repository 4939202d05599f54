//! State in the caller's memory, with a mark that detects memory which holds none.
#![allow(unsafe_code)]

use super::Status;
use super::status::either;
use crate::matching::{self, Capacity, Method, Supported};
use crate::pipeline::Guarded;
use core::ffi::c_void;

/// Alignment that is enough for every matcher's memory, that of `uint64_t`.
pub const STEREOPSIS_ALIGN: usize = 8;

/// Matcher in the caller's memory.
pub struct Handle {
    _opaque: [u8; 0],
}

/// What a caller's memory may hold: a matcher, or a rectifier.
pub(super) trait Content {
    /// What C holds of it.
    type Handle;
    /// The content before its start, all bytes of which are zero.
    const NEW: Self;
    /// Number of its kind and capacity, part of the mark.
    const KIND: usize;
    /// Bytes of memory that are said to be enough on any target.
    const MOST_BYTES: usize;
}

impl<S: Method, const W: usize, const D: usize> Content for Guarded<S, W, D>
where
    Capacity<D>: Supported,
{
    type Handle = Handle;
    const NEW: Self = Self::new();
    const KIND: usize = kind(S::NAME, &[W, D]);
    const MOST_BYTES: usize = memory_bytes::<S>(W, D);
}

/// Contents of the memory.
#[repr(C)]
pub(super) struct State<C> {
    /// [`MARK`] combined with the kind and the state's own address, which memory that was moved, was not
    /// initialised, or holds something else does not have.
    mark: usize,
    pub(super) content: C,
}

/// Bits that memory is unlikely to hold by chance.
const MARK: usize = 0x57E2_E0D5;

/// Largest number of bytes of counters and padding beside the arrays of matcher and lines.
const FIXED_BYTES: usize = 416;

/// Returns the bytes of memory that are enough for a matcher on any target, as the macros of `stereopsis.h`
/// do.
///
/// `disparities` is a multiple of 16, and `width` at least as large.
pub const fn memory_bytes<S: Method>(width: usize, disparities: usize) -> usize {
    // Five lines of two cameras.
    matching::array_bytes::<S>(width, disparities) + 2 * 5 * width + FIXED_BYTES
}

/// Hash (FNV-1a) of a name and sizes, so that handles of different libraries in one program differ.
pub(super) const fn kind(name: &str, sizes: &[usize]) -> usize {
    const PRIME: usize = 0x0100_0193;
    let (mut hash, mut i) = (0x811C_9DC5, 0);
    while i < name.len() {
        hash = (hash ^ name.as_bytes()[i] as usize).wrapping_mul(PRIME);
        i += 1;
    }
    i = 0;
    while i < sizes.len() {
        hash = (hash ^ sizes[i]).wrapping_mul(PRIME);
        i += 1;
    }
    hash
}

impl<C: Content> State<C> {
    const CHECKED: () = {
        assert!(align_of::<Self>() <= STEREOPSIS_ALIGN, "STEREOPSIS_ALIGN must be enough");
        assert!(size_of::<Self>() <= C::MOST_BYTES, "the stated bytes must cover the state");
    };

    fn mark_of(state: *const Self) -> usize {
        MARK ^ C::KIND ^ state.addr()
    }

    /// Creates the content in the caller's memory; memory that `may_hold_one` already is read and refused.
    ///
    /// # Safety
    ///
    /// `memory` is null or points to `length` bytes that nothing else uses until the memory is given up; it
    /// was written before if it `may_hold_one`, or is memory that the compiler knows nothing of.
    pub(super) unsafe fn init(
        memory: *mut c_void,
        length: usize,
        may_hold_one: bool,
    ) -> Result<*mut C::Handle, Status> {
        const { Self::CHECKED };
        let state = memory.cast::<Self>();
        checked(state)?;
        if length < size_of::<Self>() {
            return Err(Status::MemoryTooShort);
        }
        if may_hold_one {
            // SAFETY: the state is aligned and inside of the caller's bytes. What it holds was written by C,
            // or by nobody: a volatile read takes it as the machine has it, and every bit pattern is an
            // integer.
            let mark = unsafe { (&raw const (*state).mark).read_volatile() };
            if mark == Self::mark_of(state) {
                return Err(Status::AlreadyInitialised);
            }
        }
        // SAFETY: as before; nothing refers to these bytes yet. The constant is all zero: the bytes are set
        // in place and no copy stands on the stack.
        unsafe {
            (&raw mut (*state).content).write(const { C::NEW });
            (&raw mut (*state).mark).write_volatile(Self::mark_of(state));
        }
        Ok(state.cast())
    }

    /// Creates the content, and writes the handle, null on an error unless `handle` itself is invalid.
    ///
    /// # Safety
    ///
    /// As [`Self::init`] asks; `handle` is null or points to a pointer.
    pub(super) unsafe fn init_handle(
        memory: *mut c_void,
        length: usize,
        may_hold_one: bool,
        handle: *mut *mut C::Handle,
    ) -> Status {
        if let Err(status) = checked(handle) {
            return status;
        }
        // Nothing is written before the handle is known to be apart from the memory.
        if !memory.is_null() && share_bytes(memory, length, handle.cast(), size_of::<*mut C::Handle>()) {
            return Status::Overlap;
        }
        // SAFETY: the caller's promise.
        let made = unsafe { Self::init(memory, length, may_hold_one) };
        // SAFETY: the caller's promise, and it is aligned.
        unsafe { handle.write(made.unwrap_or(core::ptr::null_mut())) };
        made.map_or_else(|status| status, |_| Status::Ok)
    }

    /// Creates a content that has as many bytes of the caller's memory behind it as it says, all of them 0,
    /// and writes the handle, null on an error unless `handle` itself is invalid. The memory is not read.
    ///
    /// # Safety
    ///
    /// As [`Self::init_handle`] asks.
    pub(super) unsafe fn init_with_tail(
        memory: *mut c_void,
        length: usize,
        content: Result<(C, usize), Status>,
        handle: *mut *mut C::Handle,
    ) -> Status {
        // Whatever is wrong beside, the handle's place is apart from the memory: null is written there.
        if !memory.is_null() && share_bytes(memory, length, handle.cast(), size_of::<*mut C::Handle>()) {
            return checked(handle).map_or_else(|status| status, |()| Status::Overlap);
        }
        let (content, tail) = match content {
            Ok((_, tail)) if tail > length.saturating_sub(size_of::<Self>()) => {
                (Err(Status::MemoryTooShort), 0)
            }
            Ok((content, tail)) => (Ok(content), tail),
            Err(status) => (Err(status), 0),
        };
        let stated = if content.is_ok() { length } else { 0 };
        // SAFETY: the caller's promise; a content that is refused has no memory, which is refused as well.
        let made = unsafe { Self::init_handle(memory, stated, false, handle) };
        match (made, content) {
            (Status::Ok, Ok(content)) => {
                let state = memory.cast::<Self>();
                // SAFETY: the state was just made there, and the tail behind it is inside of the memory.
                unsafe {
                    (&raw mut (*state).content).write(content);
                    state.add(1).cast::<u8>().write_bytes(0, tail);
                }
                Status::Ok
            }
            (Status::MemoryTooShort, Err(status)) | (status, _) => status,
        }
    }

    /// Returns the state behind a handle that several calls may use at the same time.
    ///
    /// # Safety
    ///
    /// `handle` is null or points to as many bytes as a state has, and for `'a` nothing changes them but what
    /// a shared content allows.
    pub(super) unsafe fn shared<'a>(handle: *mut C::Handle) -> Result<&'a Self, Status> {
        let state = handle.cast::<Self>();
        checked(state)?;
        // SAFETY: the state is aligned and its bytes are there; every bit pattern is an integer.
        let mark = unsafe { (&raw const (*state).mark).read_volatile() };
        if mark != Self::mark_of(state) {
            return Err(Status::NotInitialised);
        }
        // SAFETY: the mark says that `init` has made a state at this very address.
        Ok(unsafe { &*state })
    }

    /// Returns the state behind a handle.
    ///
    /// # Safety
    ///
    /// `handle` is null or points to as many bytes as a state has, and for `'a` nothing else uses them.
    pub(super) unsafe fn open<'a>(handle: *mut C::Handle) -> Result<&'a mut Self, Status> {
        // SAFETY: the caller's promise; the reference is not kept.
        let _ = unsafe { Self::shared(handle) }?;
        // SAFETY: the mark says that `init` has made a state at this very address, and nothing else uses it.
        Ok(unsafe { &mut *handle.cast::<Self>() })
    }

    /// Gives the memory behind a handle up.
    ///
    /// # Safety
    ///
    /// As [`Self::open`] asks.
    pub(super) unsafe fn deinit(handle: *mut C::Handle) -> Status {
        // SAFETY: the caller's promise.
        either(unsafe { Self::open(handle) }.map(|state| {
            // SAFETY: a reference is aligned and its bytes are there. The write is volatile as the reads are:
            // nothing here looks at the mark again, and it has to go all the same.
            unsafe { (&raw mut state.mark).write_volatile(0) };
            Status::Ok
        }))
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

/// Checks that a pointer is not null and is aligned.
pub(super) fn checked<T>(pointer: *const T) -> Result<(), Status> {
    if pointer.is_null() {
        Err(Status::Null)
    } else if pointer.is_aligned() {
        Ok(())
    } else {
        Err(Status::Misaligned)
    }
}

/// Returns whether two runs of bytes overlap.
pub(super) fn share_bytes(a: *const c_void, a_length: usize, b: *const c_void, b_length: usize) -> bool {
    let (a, b) = (a.addr(), b.addr());
    a < b.saturating_add(b_length) && b < a.saturating_add(a_length)
}

/// Returns whether a run of bytes that is written overlaps another one, or one that is read.
pub(super) fn any_shared(written: &[(*const c_void, usize)], read: &[(*const c_void, usize)]) -> bool {
    written.iter().enumerate().any(|(i, &(one, length))| {
        let others = written.iter().skip(i + 1).chain(read);
        others.into_iter().any(|&(other, bytes)| share_bytes(one, length, other, bytes))
    })
}
