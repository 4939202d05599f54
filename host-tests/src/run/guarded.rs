//! Frames of a source that may fail, through the core's guarded pipeline.

use super::{MOST_DISPARITIES, MOST_WIDTH, MethodName};
use crate::map::DisparityMap;
use std::fmt::Display;
use stereopsis::camera::{FrameStart, StereoSource};
use stereopsis::matching::{Config, ConfigError, Method};
use stereopsis::pipeline::{FaultCounters, Guarded};
use stereopsis_rig::with_method;

/// A thread's stack: it holds a pipeline.
const STACK: usize = 64 << 20;

/// What came of a frame.
#[derive(Clone, Debug)]
pub struct GuardedFrame {
    /// How it began, if it did.
    pub start: Option<FrameStart>,
    /// Its rows; those that did not come have no answer and no flag.
    pub map: DisparityMap,
    /// Rows that came.
    pub rows: u16,
    /// Rows of these that rest on a lost line.
    pub damaged_rows: u16,
    /// Lines that another one stood in for.
    pub lost_lines: u16,
    /// Why it ended before its last row.
    pub error: Option<String>,
}

/// Takes frames of `source` as long as `next` has a configuration for each, and gives them to `keep`. The
/// first one is begun with `config`.
pub fn run_guarded<C: StereoSource<Error: Display> + Send>(
    method: MethodName,
    config: &Config,
    most_lost: Option<u16>,
    source: &mut C,
    next: impl FnMut(&mut C) -> Option<Config> + Send,
    keep: impl FnMut(GuardedFrame) + Send,
) -> Result<FaultCounters, ConfigError> {
    std::thread::scope(|scope| {
        let work = move || with_method!(method, S => frames::<S, C>(config, most_lost, source, next, keep));
        let thread =
            std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, work).expect("a thread");
        thread.join().expect("a thread without a panic")
    })
}

fn frames<S: Method, C: StereoSource<Error: Display>>(
    config: &Config,
    most_lost: Option<u16>,
    source: &mut C,
    mut next: impl FnMut(&mut C) -> Option<Config>,
    mut keep: impl FnMut(GuardedFrame),
) -> Result<FaultCounters, ConfigError> {
    let mut guarded = Guarded::<S, MOST_WIDTH, MOST_DISPARITIES>::new();
    guarded.start(config)?;
    if let Some(lines) = most_lost {
        guarded.set_most_lost(lines);
    }
    while let Some(config) = next(source) {
        if config != *guarded.config() {
            guarded.restart(&config)?;
        }
        let before = guarded.counters().rows_damaged;
        let map = DisparityMap::new(config.width.into(), config.height.into());
        let mut frame =
            GuardedFrame { start: None, map, rows: 0, damaged_rows: 0, lost_lines: 0, error: None };
        match guarded.begin_frame(source) {
            Err(e) => frame.error = Some(e.to_string()),
            Ok(start) => {
                frame.start = Some(start);
                frame.error = loop {
                    match guarded.next_row(source) {
                        Ok(Some(row)) => frame.map.put(usize::from(row.index()), row),
                        Ok(None) => break None,
                        Err(e) => break Some(e.to_string()),
                    }
                    frame.rows += 1;
                };
                frame.lost_lines = guarded.lost_lines();
            }
        }
        frame.damaged_rows = (guarded.counters().rows_damaged - before) as u16;
        keep(frame);
    }
    Ok(*guarded.counters())
}
