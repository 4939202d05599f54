//! A frame in bands of rows, one thread each: what a chip with two cores does with two pipelines.
//!
//! With the block methods every row is bit-equal to that of one pipeline over the whole frame, because each
//! band sees more lines than it gives rows:
//!
//! * below, as many as a row waits for: [`MethodName::latency_lines`](super::MethodName::latency_lines);
//! * above, as many again, for windows and for the uncertainty, which looks back at finished rows; one for
//!   the median, which looks at the row above; and one for each answer that the speckle filter asks for,
//!   since a surface that goes on through so many rows has them.
//!
//! Along paths ([`MethodName::is_exact_in_bands`](super::MethodName::is_exact_in_bands) says no) a band's
//! first rows lack what a path from above has gathered farther up: `tests/matching/threads.rs` measures how
//! many answers that changes.
//!
//! The lines that are worked on twice are the price: 34 above and 10 below with `block` and the default
//! checks.

use super::method::with_method;
use super::{Host, MemoryPair, Outcome, RunError, RunOptions, frame};
use crate::map::DisparityMap;
use std::ops::Range;
use std::sync::Barrier;
use std::thread::{Builder, scope};
use std::time::Instant;
use stereopsis::matching::{Config, ConfigError, Kernel, Method, Row};

/// A thread's stack: it holds a pipeline.
const STACK: usize = 16 << 20;

/// Rows that a thread gives, and the lines that it sees for them.
#[derive(Clone, PartialEq, Eq, Debug)]
struct Band {
    rows: Range<usize>,
    lines: Range<usize>,
}

/// The bands of a frame, as even as whole rows can be.
fn bands(options: RunOptions, config: &Config) -> Vec<Band> {
    let height = usize::from(config.height);
    let count = usize::from(options.threads).clamp(1, height);
    let below = options.method.latency_lines();
    let above = below + usize::from(config.checks.median) + usize::from(config.checks.speckle_pixels);
    let band = |band: usize| {
        let rows = band * height / count..(band + 1) * height / count;
        let lines = rows.start.saturating_sub(above)..height.min(rows.end + below);
        Band { rows, lines }
    };
    (0..count).map(band).collect()
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
            let lines = pair.rows(band.lines.clone());
            (band, lines)
        };
        Self { options, config: *config, parts: bands(options, config).into_iter().map(part).collect() }
    }

    /// One frame into a map. The time is that of the band that took longest.
    pub(super) fn run(&mut self) -> Result<Outcome, ConfigError> {
        let width = usize::from(self.config.width);
        let results = self.in_threads(|band, frame| {
            let mut map = DisparityMap::new(width, band.rows.len());
            let first = band.rows.start - band.lines.start;
            let (kernel, time_ms) = frame(&mut |row| match usize::from(row.index()).checked_sub(first) {
                Some(y) if y < band.rows.len() => map.put(y, row),
                _ => {}
            })?;
            Ok(Outcome { map, kernel, time_ms })
        });
        let mut results = results.into_iter();
        let mut whole = results.next().expect("a frame has a row")?;
        for result in results {
            let band: Outcome = result?;
            whole.map.append(band.map);
            whole.time_ms = whole.time_ms.max(band.time_ms);
        }
        Ok(whole)
    }

    /// The times of `frames` frames in milliseconds, after one that is left out, and the kernel that they ran
    /// on. The threads stay, and begin each frame together.
    pub(super) fn time(&mut self, frames: usize) -> Result<(Vec<f64>, Kernel), ConfigError> {
        // What cannot be done shows here.
        let kernel = self.run()?.kernel;
        let together = Barrier::new(self.parts.len() + 1);
        let times_ms = scope(|scope| {
            scope.spawn(|| {
                self.in_threads(|_, frame| {
                    for _ in 0..=frames {
                        together.wait();
                        frame(&mut |row| _ = std::hint::black_box(row.disparities())).expect("it did before");
                        together.wait();
                    }
                })
            });
            let time = |_| {
                // Before they are let go: behind it some may be done already.
                let start = Instant::now();
                together.wait();
                together.wait();
                start.elapsed().as_secs_f64() * 1e3
            };
            (0..=frames).map(time).skip(1).collect()
        });
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
    let config = Config { height: band.lines.len() as u16, ..*config };
    let mut pipeline = Host::<S>::new();
    work(band, &mut |keep| match frame(options, &mut pipeline, &config, pair, keep) {
        Ok(done) => Ok(done),
        Err(RunError::Config(e)) => Err(e),
        Err(RunError::Pipeline(e)) => panic!("a source that cannot fail: {e}"),
    })
}

#[cfg(test)]
mod tests {
    use super::super::MethodName;
    use super::*;
    use stereopsis::matching::Block;

    #[test]
    fn bands_cover_the_frame() {
        let options = RunOptions { threads: 3, ..MethodName::Block.into() };
        let ranges = |height| {
            bands(options, &Config::for_method::<Block>(64, height, 16))
                .into_iter()
                .map(|b| (b.rows, b.lines))
        };
        assert!(ranges(100).eq([(0..33, 0..43), (33..66, 0..76), (66..100, 32..100)]));
        assert!(ranges(2).eq([(0..1, 0..2), (1..2, 0..2)]));
    }
}
