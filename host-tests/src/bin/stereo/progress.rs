//! How far the matching is, for somebody who waits at a terminal.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::Duration;
use stereopsis::matching::Config;

/// Disparity evaluations that take about a second on a slow core.
const LONG: u64 = 200_000_000;

/// A bar over the rows of a frame, on standard error. It is hidden when the work is short or standard error is no
/// terminal, and gone when dropped.
pub struct Progress(ProgressBar);

impl Progress {
    pub fn over(config: &Config) -> Self {
        let work = u64::from(config.width) * u64::from(config.height) * u64::from(config.disparities);
        // Draws nothing where standard error is no terminal.
        let target = if work < LONG { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bar = ProgressBar::with_draw_target(Some(u64::from(config.height)), target);
        if let Ok(style) = ProgressStyle::with_template("matching {bar:40} {pos}/{len} rows, {eta} left") {
            bar.set_style(style);
        }
        bar.enable_steady_tick(Duration::from_millis(200));
        Self(bar)
    }

    pub fn rows(&self, done: u16) {
        self.0.set_position(u64::from(done));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
