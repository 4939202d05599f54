//! The signal between an interrupt and a task: no wake is lost, in any order, and none is made up.

use std::cell::Cell;
use std::pin::pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering};
use std::task::{Context, Poll, Wake, Waker};
use stereopsis::camera::{LineListener, LineSignal};

#[derive(Default)]
struct Counted(AtomicUsize);

impl Wake for Counted {
    fn wake(self: Arc<Self>) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }
}

impl Counted {
    fn task() -> (Arc<Self>, Waker) {
        let counted = Arc::new(Self::default());
        (counted.clone(), Waker::from(counted))
    }

    fn count(&self) -> usize {
        self.0.load(Ordering::Relaxed)
    }
}

/// Polls a task that waits for ever, once.
fn wait(listener: &mut LineListener<'_>, waker: &Waker) {
    let waits = listener.until(|| Poll::<()>::Pending);
    assert!(pin!(waits).poll(&mut Context::from_waker(waker)).is_pending());
}

#[test]
fn a_notification_wakes_who_waits_once() {
    let mut signal = LineSignal::new();
    let (mut notifier, mut listener) = signal.split();
    let (task, waker) = Counted::task();
    notifier.notify();
    assert_eq!(task.count(), 0, "nobody waits yet");
    for round in 1..=5 {
        // However often it is polled meanwhile.
        for _ in 0..round {
            wait(&mut listener, &waker);
        }
        assert_eq!(task.count(), round - 1, "nothing has come");
        notifier.notify();
        assert_eq!(task.count(), round);
        notifier.notify();
        assert_eq!(task.count(), round, "nobody waits any more");
    }
}

#[test]
fn another_task_asks_again_until_the_place_of_its_waker_is_free() {
    let mut signal = LineSignal::new();
    let (mut notifier, mut listener) = signal.split();
    let [(first, first_waker), (second, second_waker)] = [Counted::task(), Counted::task()];
    wait(&mut listener, &first_waker);
    wait(&mut listener, &second_waker);
    assert_eq!((first.count(), second.count()), (0, 1), "it wakes itself");
    notifier.notify();
    assert_eq!((first.count(), second.count()), (1, 1));
    wait(&mut listener, &second_waker);
    notifier.notify();
    assert_eq!((first.count(), second.count()), (1, 2));
    // Split anew, the signal knows of nobody.
    wait(&mut listener, &first_waker);
    let (mut notifier, _listener) = signal.split();
    notifier.notify();
    assert_eq!(first.count(), 1);
}

/// What comes between the first look and the waker's storing is found by the second look.
#[test]
fn a_line_between_the_look_and_the_waker_is_found() {
    let mut signal = LineSignal::new();
    let (mut notifier, mut listener) = signal.split();
    let lines = Cell::new(0);
    let attempt = || {
        let seen = lines.replace(1);
        if seen == 0 {
            notifier.notify();
            return Poll::Pending;
        }
        Poll::Ready(seen)
    };
    let (task, waker) = Counted::task();
    assert_eq!(pin!(listener.until(attempt)).poll(&mut Context::from_waker(&waker)), Poll::Ready(1));
    assert_eq!(task.count(), 0);
}

/// Two threads as fast as they go: a wake that was lost would let both wait for ever, which the bound on the
/// waiting tells.
#[test]
fn no_wake_is_lost_between_two_threads() {
    const LINES: u32 = 20_000;
    let mut signal = LineSignal::new();
    let (mut notifier, mut listener) = signal.split();
    let (sent, taken) = (AtomicU32::new(0), AtomicU32::new(0));
    struct Unpark(std::thread::Thread, AtomicUsize);
    impl Wake for Unpark {
        fn wake(self: Arc<Self>) {
            self.1.fetch_add(1, Ordering::SeqCst);
            self.0.unpark();
        }
    }
    std::thread::scope(|scope| {
        let (sent, taken) = (&sent, &taken);
        scope.spawn(move || {
            for line in 1..=LINES {
                // The next line comes when this one was taken, so that only its own wake can help.
                sent.store(line, Ordering::Relaxed);
                notifier.notify();
                while taken.load(Ordering::Relaxed) < line {
                    std::hint::spin_loop();
                    std::thread::yield_now();
                }
            }
        });
        let unpark = Arc::new(Unpark(std::thread::current(), AtomicUsize::new(0)));
        let waker = Waker::from(unpark.clone());
        for line in 1..=LINES {
            let mut come = pin!(listener.until(|| {
                if sent.load(Ordering::Relaxed) >= line { Poll::Ready(()) } else { Poll::Pending }
            }));
            loop {
                let wakes = unpark.1.load(Ordering::SeqCst);
                if come.as_mut().poll(&mut Context::from_waker(&waker)).is_ready() {
                    break;
                }
                let mut waited = 0;
                while unpark.1.load(Ordering::SeqCst) == wakes {
                    std::thread::park_timeout(std::time::Duration::from_millis(10));
                    waited += 1;
                    if waited >= 2000 {
                        // Lets the other thread end, too.
                        taken.store(LINES, Ordering::Relaxed);
                        panic!("the wake of line {line} was lost");
                    }
                }
            }
            taken.store(line, Ordering::Relaxed);
        }
    });
}
