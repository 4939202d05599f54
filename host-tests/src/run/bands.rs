//! A frame in bands of rows, one thread each: what a chip with two cores does with two pipelines.
//!
//! The core splits the frame ([`Band::split`]): bands take the lines above and below that their rows need,
//! and have as equally many lines as can be. Along paths
//! ([`MethodName::is_exact_in_bands`](super::MethodName::is_exact_in_bands) says no) a band's first rows lack
//! what a path from above has gathered farther up: `tests/matching/threads.rs` measures how many answers that
//! changes.

use super::{Host, MemoryPair, Outcome, RunError, RunOptions, frame};
use crate::map::DisparityMap;
use std::sync::Barrier;
use std::thread::{Builder, scope};
use std::time::Instant;
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
        let results = self.in_threads(|band, frame| {
            let mut map = DisparityMap::new(width, band.rows().len());
            let first = band.rows().start;
            let (kernel, time_ms) = frame(&mut |row| {
                if let Some(y) = band.row(row.index()) {
                    map.put(usize::from(y - first), row);
                }
            })?;
            Ok(Outcome { map, kernel, time_ms, threads: 1 })
        });
        let mut results = results.into_iter();
        let mut whole = results.next().expect("a frame has a row")?;
        for result in results {
            let band: Outcome = result?;
            whole.map.append(band.map);
            whole.threads += 1;
            whole.time_ms = whole.time_ms.max(band.time_ms);
        }
        Ok(whole)
    }

    /// The times of `frames` frames in milliseconds, after one that is left out, and the kernel that they ran
    /// on. The threads stay, and begin a frame together, as soon as the last one is done with the one before.
    pub(super) fn time(&mut self, frames: usize) -> Result<(Vec<f64>, Kernel), ConfigError> {
        // What cannot be done shows here.
        let kernel = self.run()?.kernel;
        let together = Barrier::new(self.parts.len());
        let times_ms = self.in_threads(|_, frame| {
            together.wait();
            let mut start = Instant::now();
            let time = |_| {
                frame(&mut |row| _ = std::hint::black_box(row.disparities())).expect("it did before");
                together.wait();
                let end = Instant::now();
                end.duration_since(std::mem::replace(&mut start, end)).as_secs_f64() * 1e3
            };
            (0..=frames).map(time).skip(1).collect()
        });
        // They meet after each frame: the times of one are those of all.
        let times_ms = times_ms.into_iter().next().expect("a frame has a row");
        Ok((times_ms, kernel))
    }

    /// Does something with every band, in a thread each that has a pipeline.
    fn in_threads<T: Send>(&mut self, work: impl Fn(&Band, &mut Frame<'_>) -> T + Sync) -> Vec<T> {
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

/// Matches a frame and hands its rows on: the kernel, and the time in milliseconds.
type Frame<'a> = dyn FnMut(&mut dyn FnMut(Row<'_>)) -> Result<(Kernel, f64), ConfigError> + 'a;

fn with_pipeline<S: Method, T>(
    options: RunOptions,
    config: &Config,
    band: &Band,
    pair: &mut MemoryPair,
    work: &impl Fn(&Band, &mut Frame<'_>) -> T,
) -> T {
    let config = band.config(config);
    let mut pipeline = Host::<S>::new();
    work(band, &mut |keep| match frame(options, &mut pipeline, &config, pair, keep) {
        Ok(done) => Ok(done),
        Err(RunError::Config(e)) => Err(e),
        Err(RunError::Pipeline(e)) => panic!("a source that cannot fail: {e}"),
    })
}
