//! Lock-free queue between one producer and one consumer, Lamport's ring: loads and stores of two indices
//! and no compare-and-swap, so that it runs on every core that has interrupts.
//!
//! Leslie Lamport, "Specifying Concurrent Program Modules", ACM TOPLAS 5 (2), 1983.
#![allow(unsafe_code)]

use core::cell::UnsafeCell;
use core::fmt;
use core::sync::atomic::{AtomicUsize, Ordering};

/// Ring of `N` places, which takes `N - 1` items: with one place free, equal indices mean an empty ring.
pub(super) struct Queue<T, const N: usize> {
    /// The place that is read next: the receiver alone moves it.
    read: AtomicUsize,
    /// The place that is written next: the sender alone moves it.
    written: AtomicUsize,
    places: [Place<T>; N],
}

/// A place of the ring. At any time one end alone may look at it: the receiver from `read` to before
/// `written`, the sender at all others.
struct Place<T>(UnsafeCell<Option<T>>);

// SAFETY: both ends share the places of a ring, and the indices give each place to one of them at a time. An
// item is moved from the sender's thread to the receiver's, which `Send` allows.
unsafe impl<T: Send> Sync for Place<T> {}

impl<T, const N: usize> Queue<T, N> {
    /// Creates an empty ring.
    pub const fn new() -> Self {
        const { assert!(N > 1, "a queue of N places takes N - 1 items") };
        let places = [const { Place(UnsafeCell::new(None)) }; N];
        Self { read: AtomicUsize::new(0), written: AtomicUsize::new(0), places }
    }

    /// Drops what is in the ring.
    pub fn clear(&mut self) {
        let (_, mut receiver) = self.split();
        for _ in 0..N {
            drop(receiver.receive());
        }
    }

    /// Splits the ring into its two ends.
    pub fn split(&mut self) -> (Sender<'_, T>, Receiver<'_, T>) {
        let ends = || Ends { read: &self.read, written: &self.written, places: &self.places };
        (Sender(ends()), Receiver(ends()))
    }
}

impl<T, const N: usize> fmt::Debug for Queue<T, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut fields = f.debug_struct("Queue");
        fields.field("read", &self.read).field("written", &self.written).finish_non_exhaustive()
    }
}

/// What both ends of a ring see of it.
struct Ends<'a, T> {
    read: &'a AtomicUsize,
    written: &'a AtomicUsize,
    places: &'a [Place<T>],
}

impl<T> Ends<'_, T> {
    /// The place behind another, the first one behind the last.
    fn behind(&self, place: usize) -> usize {
        if place + 1 < self.places.len() { place + 1 } else { 0 }
    }
}

/// The end that puts items into a ring.
pub(super) struct Sender<'a, T>(Ends<'a, T>);

impl<T> Sender<'_, T> {
    /// Puts an item into the ring; gives it back where the ring is full.
    pub fn send(&mut self, item: T) -> Result<(), T> {
        let here = self.0.written.load(Ordering::Relaxed);
        let next = self.0.behind(here);
        // Acquire: the receiver has taken the item out of the place before it gives the place up.
        if next == self.0.read.load(Ordering::Acquire) {
            return Err(item);
        }
        let Some(place) = self.0.places.get(here) else { return Err(item) };
        // SAFETY: the place is not between `read` and `written`, so it is this end's; `&mut self` is the only
        // sender.
        unsafe { *place.0.get() = Some(item) };
        // Release: the item is in its place before the receiver learns of it.
        self.0.written.store(next, Ordering::Release);
        Ok(())
    }
}

/// The end that takes items out of a ring.
pub(super) struct Receiver<'a, T>(Ends<'a, T>);

impl<T> Receiver<'_, T> {
    /// Takes the oldest item.
    pub fn receive(&mut self) -> Option<T> {
        let here = self.0.read.load(Ordering::Relaxed);
        // Acquire: what the sender has put into the place is seen.
        if here == self.0.written.load(Ordering::Acquire) {
            return None;
        }
        let place = self.0.places.get(here)?;
        // SAFETY: the place is between `read` and `written`, so it is this end's; `&mut self` is the only
        // receiver.
        let item = unsafe { (*place.0.get()).take() };
        // Release: the item is out of its place before the sender learns that it is free.
        self.0.read.store(self.0.behind(here), Ordering::Release);
        item
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_come_in_order_round_and_round() {
        let mut queue = Queue::<u32, 3>::new();
        let (mut sender, mut receiver) = queue.split();
        for item in 0..20 {
            assert_eq!((sender.send(item), sender.send(item + 100)), (Ok(()), Ok(())));
            assert_eq!(sender.send(7), Err(7), "two items fill three places");
            assert_eq!((receiver.receive(), receiver.receive()), (Some(item), Some(item + 100)));
            assert_eq!(receiver.receive(), None);
        }
    }

    #[test]
    fn clearing_drops_the_items() {
        let (first, second) = (core::cell::Cell::new(0), core::cell::Cell::new(0));
        struct Counted<'a>(&'a core::cell::Cell<u32>);
        impl Drop for Counted<'_> {
            fn drop(&mut self) {
                self.0.set(self.0.get() + 1);
            }
        }
        let mut queue = Queue::<_, 4>::new();
        assert!(queue.split().0.send(Counted(&first)).is_ok());
        queue.clear();
        assert_eq!(first.get(), 1);
        assert!(queue.split().0.send(Counted(&second)).is_ok());
        drop(queue);
        assert_eq!(second.get(), 1);
    }
}
