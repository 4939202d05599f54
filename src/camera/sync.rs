//! What both ends of a [`queue`](super::queue) share, from one place: the test of its orderings compiles the
//! queue with cells and atomics that watch who sees what.

pub(super) use core::cell::UnsafeCell;
pub(super) use core::sync::atomic::{AtomicUsize, Ordering};
