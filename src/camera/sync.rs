//! What both ends of a [`queue`](super::queue) share, from one place: in the crate's own tests it is cells
//! and atomics that watch who sees what, in a run of theirs, and are the processor's outside of one.

#[cfg(not(test))]
pub(super) use core::{cell::UnsafeCell, sync::atomic::AtomicUsize};

pub(super) use core::sync::atomic::Ordering;

#[cfg(test)]
pub(super) use watched::{AtomicUsize, UnsafeCell};

/// Atomics and cells that watch two threads: a load may give any value that the memory model of C11 lets it
/// see, and a cell that both use without one before the other is a race.
///
/// Each atomic is a list of the values that were stored, each with what its thread knew if it was released. A
/// thread sees no value older than one it knows of. A run takes one way through all choices of who is next
/// and what is seen; [`Runs`] takes all ways.
#[cfg(test)]
mod watched {
    extern crate std;

    use super::Ordering;
    use std::cell::RefCell;
    use std::collections::HashMap;
    use std::prelude::v1::*;
    use std::sync::{Arc, Condvar, Mutex, MutexGuard};

    /// For each thread, how many of its steps are known.
    type Clock = [u32; 2];

    /// A value that was stored.
    struct Stored {
        value: usize,
        by: usize,
        at: u32,
        /// What its thread knew, for those who acquire it.
        released: Option<Clock>,
    }

    /// Stands for the orderings of a thread's loads, or of its stores, which are taken for relaxed.
    pub type Weakened = Option<(usize, Kind)>;

    #[derive(Clone, Copy, PartialEq, Eq, Debug)]
    pub enum Kind {
        Load,
        Store,
    }

    #[derive(Default)]
    struct State {
        /// The choices of this run: which was taken, of how many.
        choices: Vec<(usize, usize)>,
        made: usize,
        turn: usize,
        is_done: [bool; 2],
        clocks: [Clock; 2],
        stored: HashMap<usize, Vec<Stored>>,
        seen: [HashMap<usize, usize>; 2],
        used: HashMap<usize, Clock>,
        race: Option<String>,
        weakened: Weakened,
    }

    impl State {
        fn choose(&mut self, of: usize) -> usize {
            if self.made == self.choices.len() {
                self.choices.push((0, of));
            }
            self.made += 1;
            self.choices[self.made - 1].0
        }
    }

    /// What a run of two threads shares.
    #[derive(Default)]
    struct World {
        state: Mutex<State>,
        turns: Condvar,
    }

    std::thread_local! {
        static ME: RefCell<Option<(Arc<World>, usize)>> = const { RefCell::new(None) };
    }

    fn here() -> Option<(Arc<World>, usize)> {
        ME.with_borrow(Clone::clone)
    }

    impl World {
        /// Lets either thread go on, and comes back when it is this one's turn.
        fn next(&self, me: usize) -> MutexGuard<'_, State> {
            let mut state = self.wait(me);
            let other = 1 - me;
            if !state.is_done[other] && state.choose(2) == 1 {
                state.turn = other;
                self.turns.notify_all();
                drop(state);
                state = self.wait(me);
            }
            state
        }

        fn wait(&self, me: usize) -> MutexGuard<'_, State> {
            let state = self.state.lock().expect("no thread panics with it");
            self.turns.wait_while(state, |state| state.turn != me).expect("no thread panics with it")
        }
    }

    /// Runs a thread's part in the world.
    fn part(world: &Arc<World>, me: usize, work: impl FnOnce()) {
        ME.set(Some((Arc::clone(world), me)));
        drop(world.wait(me));
        work();
        ME.set(None);
        let mut state = world.wait(me);
        (state.is_done[me], state.turn) = (true, 1 - me);
        world.turns.notify_all();
    }

    /// All ways of a program of two threads.
    pub struct Runs {
        choices: Option<Vec<(usize, usize)>>,
        weakened: Weakened,
    }

    impl Runs {
        pub fn new(weakened: Weakened) -> Self {
            Self { choices: Some(Vec::new()), weakened }
        }

        /// Runs one way; false where all were taken. A race is an error.
        pub fn run(
            &mut self,
            first: impl FnOnce() + Send,
            second: impl FnOnce() + Send,
        ) -> Result<bool, String> {
            let Some(choices) = self.choices.take() else { return Ok(false) };
            let state = State { choices, weakened: self.weakened, ..State::default() };
            let world = Arc::new(World { state: Mutex::new(state), turns: Condvar::new() });
            std::thread::scope(|scope| {
                scope.spawn(|| part(&world, 0, first));
                part(&world, 1, second);
            });
            let mut state = world.state.lock().expect("both threads ended");
            if let Some(race) = state.race.take() {
                return Err(race);
            }
            let mut choices = std::mem::take(&mut state.choices);
            // The last choice that has another way.
            while choices.pop_if(|(taken, of)| *taken + 1 == *of).is_some() {}
            if let Some((taken, _)) = choices.last_mut() {
                *taken += 1;
                self.choices = Some(choices);
            }
            Ok(true)
        }
    }

    /// An atomic; outside of a run it is one of the processor's.
    #[derive(Debug)]
    pub struct AtomicUsize(std::sync::atomic::AtomicUsize);

    impl AtomicUsize {
        pub const fn new(value: usize) -> Self {
            Self(std::sync::atomic::AtomicUsize::new(value))
        }

        fn key(&self) -> usize {
            std::ptr::from_ref(self).addr()
        }

        pub fn load(&self, order: Ordering) -> usize {
            let Some((world, me)) = here() else { return self.0.load(order) };
            // Who loads what he alone stores sees it whoever is next.
            let is_own = order == Ordering::Relaxed;
            let mut state = if is_own { world.wait(me) } else { world.next(me) };
            let state = &mut *state;
            let first = self.0.load(Ordering::Relaxed);
            let known = state.clocks[me];
            let all = state
                .stored
                .entry(self.key())
                .or_insert_with(|| std::vec![Stored { value: first, by: 0, at: 0, released: None }]);
            let newest = all.len() - 1;
            let oldest = all.iter().rposition(|stored| stored.at <= known[stored.by]).unwrap_or(0);
            let oldest = oldest.max(state.seen[me].get(&self.key()).copied().unwrap_or(0));
            let Stored { value, released, .. } = all[oldest];
            let (mut value, mut released, mut place) = (value, released, oldest);
            if newest > oldest {
                place = newest - state.choose(newest - oldest + 1);
                let all = &state.stored[&self.key()];
                (value, released) = (all[place].value, all[place].released);
            }
            state.seen[me].insert(self.key(), place);
            let is_weak = state.weakened == Some((me, Kind::Load));
            if let Some(released) = released.filter(|_| order == Ordering::Acquire && !is_weak) {
                let clock = &mut state.clocks[me];
                clock.iter_mut().zip(released).for_each(|(known, at)| *known = (*known).max(at));
            }
            value
        }

        pub fn store(&self, value: usize, order: Ordering) {
            let Some((world, me)) = here() else { return self.0.store(value, order) };
            let mut state = world.next(me);
            let state = &mut *state;
            state.clocks[me][me] += 1;
            let clock = state.clocks[me];
            let is_weak = state.weakened == Some((me, Kind::Store));
            let released = (order == Ordering::Release && !is_weak).then_some(clock);
            let first = self.0.load(Ordering::Relaxed);
            let all = state
                .stored
                .entry(self.key())
                .or_insert_with(|| std::vec![Stored { value: first, by: 0, at: 0, released: None }]);
            all.push(Stored { value, by: me, at: clock[me], released });
            state.seen[me].insert(self.key(), all.len() - 1);
            // For who looks at it when the run is over.
            self.0.store(value, Ordering::Relaxed);
        }
    }

    /// A cell: who gets at it uses it.
    pub struct UnsafeCell<T>(std::cell::UnsafeCell<T>);

    impl<T> UnsafeCell<T> {
        pub const fn new(value: T) -> Self {
            Self(std::cell::UnsafeCell::new(value))
        }

        pub fn get(&self) -> *mut T {
            if let Some((world, me)) = here() {
                let mut state = world.wait(me);
                let state = &mut *state;
                state.clocks[me][me] += 1;
                let (clock, used) = (state.clocks[me], state.used.entry(self.0.get().addr()).or_default());
                if used[1 - me] > clock[1 - me] {
                    state.race = Some(std::format!(
                        "thread {me} uses a cell beside step {} of the other",
                        used[1 - me]
                    ));
                }
                used[me] = clock[me];
            }
            self.0.get()
        }
    }
}

/// The orderings of the queue, through every way of short runs.
#[cfg(test)]
mod tests {
    extern crate std;

    use super::super::queue::Queue;
    use super::watched::{Kind, Runs, Weakened};
    use std::{string::String, vec::Vec};

    /// The threads of [`Runs::run`].
    const SENDER: usize = 0;
    const RECEIVER: usize = 1;

    /// Sends and receives a few times each, in every way; how many ways there are.
    fn ways<const N: usize>([sends, receives]: [u32; 2], weakened: Weakened) -> Result<u32, String> {
        let mut runs = Runs::new(weakened);
        for number in 0.. {
            let mut queue = Queue::<u32, N>::new();
            let (mut sender, mut receiver) = queue.split();
            let (mut sent, mut received) = (Vec::new(), Vec::new());
            let is_run = runs.run(
                || sent.extend((0..sends).filter(|&item| sender.send(item).is_ok())),
                || received.extend((0..receives).filter_map(|_| receiver.receive())),
            )?;
            if !is_run {
                return Ok(number);
            }
            while let Some(item) = receiver.receive() {
                received.push(item);
            }
            assert_eq!(received, sent, "each item once and in order");
        }
        unreachable!("runs end")
    }

    #[test]
    fn every_way_of_two_threads_is_without_a_race() {
        for (ways, least) in [(ways::<2>([3, 3], None), 500), (ways::<3>([3, 3], None), 500)] {
            let ways = ways.expect("no race");
            assert!(ways >= least, "{ways} ways");
        }
    }

    /// What the test sees: without any one of its four orderings the queue has a race.
    #[test]
    fn no_ordering_can_be_left_out() {
        for thread in [SENDER, RECEIVER] {
            for kind in [Kind::Load, Kind::Store] {
                let race = ways::<2>([3, 3], Some((thread, kind))).expect_err("a race");
                assert!(race.contains("uses a cell beside"), "{thread} {kind:?}: {race}");
            }
        }
    }
}
