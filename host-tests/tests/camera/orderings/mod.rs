//! The orderings of the line queue: its very code, with atomics and cells that watch what two threads may
//! see of each other, through every way of short runs.

#[allow(dead_code, reason = "what a ring offers beside its two ends")]
#[path = "../../../../src/camera/queue.rs"]
mod queue;
mod sync;

use queue::Queue;
use sync::{Kind, Runs, Weakened};

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
