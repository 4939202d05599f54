//! A frame in bands of rows, one thread each: what a chip with two cores does with two pipelines.
//!
//! The core splits the frame ([`Band::split`]): bands take the lines above and below that their rows need,
//! and have as equally many lines as can be. Along paths
//! ([`MethodName::is_exact_in_bands`](super::MethodName::is_exact_in_bands) says no) a band's first rows lack
//! what a path from above has gathered farther up: `tests/matching/threads.rs` measures how many answers that
//! changes.

use super::{Host, MemoryPair, Outcome, RunOptions, frame};
use crate::map::DisparityMap;
use std::hint::{black_box, spin_loop};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::{Builder, scope, yield_now};
use std::time::{Duration, Instant};
use stereopsis::matching::{Config, ConfigError, Kernel, Method, Row};
use stereopsis::pipeline::Band;
use stereopsis_rig::with_method;

/// A thread's stack: it holds a pipeline.
const STACK: usize = 16 << 20;

/// The bands of a frame.
fn bands(options: RunOptions, config: &Config) -> Vec<Band> {
    with_method!(options.method, S => Band::split::<S>(config, options.threads).collect())
}

/// A pair of pictures in bands.
pub(super) struct Bands {
    options: RunOptions,
    config: Config,
    parts: Vec<(Band, MemoryPair)>,
}

impl Bands {
    pub(super) fn new(options: RunOptions, config: &Config, pair: &MemoryPair) -> Self {
        let part = |band: Band| {
            let lines = band.lines();
            let lines = pair.rows(lines.start.into()..lines.end.into());
            (band, lines)
        };
        Self { options, config: *config, parts: bands(options, config).into_iter().map(part).collect() }
    }

    /// One frame into a map. The time is that of the band that took longest.
    pub(super) fn run(&mut self) -> Result<Outcome, ConfigError> {
        let width = usize::from(self.config.width);
        let results = self.in_threads(|band, kernel, frame| {
            let mut map = DisparityMap::new(width, band.rows().len());
            let first = band.rows().start;
            let (mut kept, start) = (Duration::ZERO, Instant::now());
            frame(&mut |row| {
                let start = Instant::now();
                if let Some(y) = band.row(row.index()) {
                    map.put(usize::from(y - first), row);
                }
                kept += start.elapsed();
            });
            let time_ms = start.elapsed().saturating_sub(kept).as_secs_f64() * 1e3;
            Outcome { map, kernel, time_ms, threads: 1 }
        })?;
        let mut results = results.into_iter();
        let mut whole = results.next().expect("a frame has a row");
        for band in results {
            whole.map.append(band.map);
            whole.threads += 1;
            whole.time_ms = whole.time_ms.max(band.time_ms);
        }
        Ok(whole)
    }

    /// The times of `frames` frames in milliseconds, after one that is left out, and the kernel that they ran
    /// on. The threads stay, and begin a frame together, as soon as the last one is done with the one before.
    pub(super) fn time(&mut self, frames: usize) -> Result<(Vec<f64>, Kernel), ConfigError> {
        let together = Meeting::new(self.parts.len());
        let times = self.in_threads(|_, kernel, frame| {
            together.wait();
            let mut start = Instant::now();
            let time = |_| {
                frame(&mut |row| _ = black_box(row.disparities()));
                together.wait();
                let end = Instant::now();
                end.duration_since(std::mem::replace(&mut start, end)).as_secs_f64() * 1e3
            };
            ((0..=frames).map(time).skip(1).collect(), kernel)
        })?;
        // They meet after each frame: the times of one are those of all.
        Ok(times.into_iter().next().expect("a frame has a row"))
    }

    /// Does something with every band, in a thread each that has a pipeline, once all of these are started.
    fn in_threads<T: Send>(
        &mut self,
        work: impl Fn(&Band, Kernel, &mut Frame<'_>) -> T + Sync,
    ) -> Result<Vec<T>, ConfigError> {
        let (options, config, work) = (self.options, &self.config, &work);
        scope(|scope| {
            let threads = self.parts.iter_mut().map(|(band, pair)| {
                let in_thread = move || {
                    with_method!(options.method, S => with_pipeline::<S,
                        T>(options, config, band, pair, work))
                };
                Builder::new().stack_size(STACK).spawn_scoped(scope, in_thread).expect("a thread")
            });
            let threads: Vec<_> = threads.collect();
            threads.into_iter().map(|thread| thread.join().expect("a thread without a panic")).collect()
        })
    }
}

/// Where threads wait for one another. They spin: being woken takes a twentieth of a small frame.
struct Meeting {
    threads: usize,
    there: AtomicUsize,
    times: AtomicUsize,
}

impl Meeting {
    /// Rounds of spinning before other threads are let in, of which there may be more than cores.
    const SPINS: usize = 1 << 12;

    fn new(threads: usize) -> Self {
        Self { threads, there: AtomicUsize::new(0), times: AtomicUsize::new(0) }
    }

    /// Returns when all threads are there.
    fn wait(&self) {
        let times = self.times.load(Ordering::Acquire);
        if self.there.fetch_add(1, Ordering::AcqRel) + 1 == self.threads {
            self.there.store(0, Ordering::Release);
            self.times.store(times.wrapping_add(1), Ordering::Release);
            return;
        }
        let mut spins = 0;
        while self.times.load(Ordering::Acquire) == times {
            spins += 1;
            if spins < Self::SPINS {
                spin_loop();
            } else {
                yield_now();
            }
        }
    }
}

/// Matches a frame and hands its rows on.
type Frame<'a> = dyn FnMut(&mut dyn FnMut(Row<'_>)) + 'a;

fn with_pipeline<S: Method, T>(
    options: RunOptions,
    config: &Config,
    band: &Band,
    pair: &mut MemoryPair,
    work: &impl Fn(&Band, Kernel, &mut Frame<'_>) -> T,
) -> Result<T, ConfigError> {
    let mut pipeline = Host::<S>::new();
    options.start(&mut pipeline, &band.config(config))?;
    // What comes out below the band's rows is another one's.
    let rows = band.rows().end - band.lines().start;
    let kernel = pipeline.kernel();
    Ok(work(band, kernel, &mut |keep| {
        frame(&mut pipeline, pair, rows, keep).expect("a source that cannot fail")
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_meet_after_each_round() {
        const THREADS: usize = 5;
        let (meeting, done) = (Meeting::new(THREADS), AtomicUsize::new(0));
        scope(|scope| {
            for _ in 0..THREADS {
                scope.spawn(|| {
                    for round in 1..=200 {
                        done.fetch_add(1, Ordering::AcqRel);
                        meeting.wait();
                        assert_eq!(done.load(Ordering::Acquire), round * THREADS);
                        meeting.wait();
                    }
                });
            }
        });
    }
}
