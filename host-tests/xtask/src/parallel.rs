//! Several programs at a time.

use crate::steps::Outcome;
use std::collections::VecDeque;
use std::sync::{Mutex, PoisonError};
use std::thread;

/// Programs that are worked on at a time: while one is built another one runs.
const WORKERS: usize = 2;

/// The work on all jobs by several threads; what came of them in their order, or the first failure.
pub fn work<J: Send, R: Send>(jobs: Vec<J>, work: impl Fn(J) -> Outcome<R> + Sync) -> Outcome<Vec<R>> {
    let queue: Mutex<VecDeque<_>> = Mutex::new(jobs.into_iter().enumerate().collect());
    let done = Mutex::new(Vec::new());
    let next = || queue.lock().unwrap_or_else(PoisonError::into_inner).pop_front();
    let worker = || {
        while let Some((at, job)) = next() {
            let result = work(job);
            if result.is_err() {
                queue.lock().unwrap_or_else(PoisonError::into_inner).clear();
            }
            done.lock().unwrap_or_else(PoisonError::into_inner).push((at, result));
        }
    };
    thread::scope(|scope| (0..WORKERS).for_each(|_| drop(scope.spawn(worker))));
    let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    done.sort_by_key(|(at, _)| *at);
    done.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::steps::Failure;

    #[test]
    fn jobs_keep_their_order_and_failures_come_through() {
        assert_eq!(work((0..9).collect(), |n| Ok(n * n)).expect("squares"), [0, 1, 4, 9, 16, 25, 36, 49, 64]);
        let failed = work((0..9).collect(), |n| if n == 4 { Err(Failure::new("four")) } else { Ok(n) });
        assert_eq!(failed.expect_err("a failure").to_string(), "four");
    }
}
