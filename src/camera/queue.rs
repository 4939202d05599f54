//! Lock-free queue between one producer and one consumer, Lamport's ring: loads and stores of two indices
//! and no compare-and-swap, so that it runs on every core that has interrupts.
//!
//! Leslie Lamport, "Specifying Concurrent Program Modules", ACM TOPLAS 5 (2), 1983.
#![allow(unsafe_code)]

use super::sync::{AtomicUsize, Ordering, UnsafeCell};
use core::fmt;

/// Places of a ring that are written and read next, for whoever keeps items in them: of `places` places one
/// stays free, so that equal positions mean an empty ring. All zeros: empty.
///
/// One side alone calls [`Self::free`] and [`Self::fill`], the other one alone [`Self::waiting`] and
/// [`Self::clear`].
pub(crate) struct Positions {
    /// The place that is read next: the receiver alone moves it.
    read: AtomicUsize,
    /// The place that is written next: the sender alone moves it.
    written: AtomicUsize,
}

impl Positions {
    /// Creates the positions of an empty ring.
    pub const fn new() -> Self {
        Self { read: AtomicUsize::new(0), written: AtomicUsize::new(0) }
    }

    /// Returns the place that the sender may write, unless the ring is full.
    pub fn free(&self, places: usize) -> Option<usize> {
        let here = self.written.load(Ordering::Relaxed);
        // Acquire: the receiver has taken the item out of the place before it gives the place up.
        (behind(here, places) != self.read.load(Ordering::Acquire)).then_some(here)
    }

    /// Hands the place of [`Self::free`], which was written, to the receiver.
    pub fn fill(&self, place: usize, places: usize) {
        // Release: the item is in its place before the receiver learns of it.
        self.written.store(behind(place, places), Ordering::Release);
    }

    /// Returns the place that the receiver may read, unless the ring is empty.
    pub fn waiting(&self) -> Option<usize> {
        let here = self.read.load(Ordering::Relaxed);
        // Acquire: what the sender has put into the place is seen.
        (here != self.written.load(Ordering::Acquire)).then_some(here)
    }

    /// Gives the place of [`Self::waiting`], which was read, back to the sender.
    pub fn clear(&self, place: usize, places: usize) {
        // Release: the item is out of its place before the sender learns that it is free.
        self.read.store(behind(place, places), Ordering::Release);
    }
}

/// Returns the place behind another, the first one behind the last.
fn behind(place: usize, places: usize) -> usize {
    if place + 1 < places { place + 1 } else { 0 }
}

/// Ring of `N` places, which takes `N - 1` items.
pub(super) struct Queue<T, const N: usize> {
    positions: Positions,
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
        Self { positions: Positions::new(), places }
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
        let ends = || Ends { positions: &self.positions, places: &self.places };
        (Sender(ends()), Receiver(ends()))
    }
}

impl<T, const N: usize> fmt::Debug for Queue<T, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Positions { read, written } = &self.positions;
        f.debug_struct("Queue").field("read", read).field("written", written).finish_non_exhaustive()
    }
}

/// What both ends of a ring see of it.
struct Ends<'a, T> {
    positions: &'a Positions,
    places: &'a [Place<T>],
}

/// The end that puts items into a ring.
pub(super) struct Sender<'a, T>(Ends<'a, T>);

impl<T> Sender<'_, T> {
    /// Puts an item into the ring; gives it back where the ring is full.
    pub fn send(&mut self, item: T) -> Result<(), T> {
        let Ends { positions, places } = &self.0;
        let Some(here) = positions.free(places.len()) else { return Err(item) };
        let Some(place) = places.get(here) else { return Err(item) };
        // SAFETY: the place is not between `read` and `written`, so it is this end's; `&mut self` is the only
        // sender.
        unsafe { *place.0.get() = Some(item) };
        positions.fill(here, places.len());
        Ok(())
    }
}

/// The end that takes items out of a ring.
pub(super) struct Receiver<'a, T>(Ends<'a, T>);

impl<T> Receiver<'_, T> {
    /// Takes the oldest item.
    pub fn receive(&mut self) -> Option<T> {
        let Ends { positions, places } = &self.0;
        let here = positions.waiting()?;
        let place = places.get(here)?;
        // SAFETY: the place is between `read` and `written`, so it is this end's; `&mut self` is the only
        // receiver.
        let item = unsafe { (*place.0.get()).take() };
        positions.clear(here, places.len());
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

    /// Under Miri this also sees what the processor of the test does not do: late and reordered stores.
    #[test]
    fn two_threads_hand_boxes_over() {
        extern crate std;
        use std::{boxed::Box, thread};
        const ITEMS: u32 = if cfg!(miri) { 60 } else { 5000 };
        let mut queue = Queue::<Box<u32>, 3>::new();
        let (mut sender, mut receiver) = queue.split();
        thread::scope(|scope| {
            scope.spawn(|| {
                for item in 0..ITEMS {
                    let mut item = Box::new(item);
                    while let Err(back) = sender.send(item) {
                        item = back;
                        thread::yield_now();
                    }
                }
            });
            for expected in 0..ITEMS {
                let item = loop {
                    match receiver.receive() {
                        Some(item) => break item,
                        None => thread::yield_now(),
                    }
                };
                assert_eq!(*item, expected);
            }
        });
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
