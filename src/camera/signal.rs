//! Signal from an interrupt to a task that waits for lines: a waker goes one way, its call the other.

use super::queue::{Queue, Receiver, Sender};
use core::future::{Future, poll_fn};
use core::sync::atomic::{Ordering, fence};
use core::task::{Poll, Waker};

/// Memory for the waker of one task that one interrupt wakes.
///
/// The interrupt calls [`LineNotifier::notify`] after a line was handed on. The task, of any executor, awaits
/// [`LineListener::until`]. There is no lock and no compare-and-swap.
///
/// ```
/// use std::task::{Context, Poll, Waker};
/// use stereopsis::camera::LineSignal;
/// let mut signal = LineSignal::new();
/// let (mut notifier, mut listener) = signal.split();
/// let mut lines = 0;
/// let mut attempt = || { lines += 1; if lines > 2 { Poll::Ready(lines) } else { Poll::Pending } };
/// let mut third = std::pin::pin!(listener.until(&mut attempt));
/// let mut context = Context::from_waker(Waker::noop()); // The executor's.
/// assert!(third.as_mut().poll(&mut context).is_pending());
/// notifier.notify(); // In the interrupt: the executor polls again.
/// assert_eq!(third.as_mut().poll(&mut context), Poll::Ready(3));
/// ```
#[derive(Debug)]
pub struct LineSignal {
    wakers: Queue<Waker, PLACES>,
}

/// Places of a ring that takes one waker.
const PLACES: usize = 2;

impl LineSignal {
    /// Creates a signal that nobody waits for.
    pub const fn new() -> Self {
        Self { wakers: Queue::new() }
    }

    /// Splits the signal into the interrupt's and the task's end.
    pub fn split(&mut self) -> (LineNotifier<'_>, LineListener<'_>) {
        self.wakers.clear();
        let (sender, receiver) = self.wakers.split();
        (LineNotifier { wakers: receiver }, LineListener { wakers: sender, last: None })
    }
}

impl Default for LineSignal {
    fn default() -> Self {
        Self::new()
    }
}

/// The interrupt's end of a [`LineSignal`].
pub struct LineNotifier<'a> {
    wakers: Receiver<'a, Waker>,
}

impl LineNotifier<'_> {
    /// Wakes the task that waits, if one does: to be called after every line, and after whatever else the
    /// task's attempt looks at.
    pub fn notify(&mut self) {
        // The line is stored before the waker is looked for; `LineListener::until` does it the other way
        // round. One of both sees the other's store.
        fence(Ordering::SeqCst);
        if let Some(waker) = self.wakers.receive() {
            waker.wake();
        }
    }
}

/// The task's end of a [`LineSignal`].
pub struct LineListener<'a> {
    wakers: Sender<'a, Waker>,
    /// The waker that was stored last.
    last: Option<Waker>,
}

impl LineListener<'_> {
    /// Repeats `attempt` until it is ready: at once, and after every [`LineNotifier::notify`] while it is
    /// not.
    ///
    /// It may be dropped at any time, by a time-out for one; what `attempt` has done by then is done. It does
    /// not give way to other tasks while `attempt` is ready each time: await the executor's own yield for
    /// that.
    pub fn until<T>(&mut self, mut attempt: impl FnMut() -> Poll<T>) -> impl Future<Output = T> {
        poll_fn(move |context| {
            let first = attempt();
            if first.is_ready() {
                return first;
            }
            self.store(context.waker());
            fence(Ordering::SeqCst);
            // What came before the waker was stored woke nobody.
            attempt()
        })
    }

    /// Stores the waker that the next notification calls.
    fn store(&mut self, waker: &Waker) {
        if self.wakers.send(waker.clone()).is_ok() {
            self.last = Some(waker.clone());
        } else if !self.last.as_ref().is_some_and(|last| last.will_wake(waker)) {
            // Another task's is in the place until the next notification. Until then this one asks again.
            waker.wake_by_ref();
        }
    }
}
