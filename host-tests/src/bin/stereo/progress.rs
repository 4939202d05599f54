//! How far the work is, for somebody who waits at a terminal.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::Duration;
use stereopsis::matching::Config;

/// Disparity evaluations that take about a second on a slow core.
const LONG: u64 = 200_000_000;

/// A bar over the rows of a frame, or over frames, on standard error. It is hidden when the work is short or
/// standard error is no terminal, and gone when dropped.
pub struct Progress(ProgressBar);

impl Progress {
    pub fn over(config: &Config) -> Self {
        let work = u64::from(config.width) * u64::from(config.height) * u64::from(config.disparities);
        // Draws nothing where standard error is no terminal.
        let target = if work < LONG { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        Self::new(config.height.into(), target, "matching {bar:40} {pos}/{len} rows, {eta} left")
    }

    /// Over the frames of a sequence.
    pub fn over_frames(frames: usize) -> Self {
        Self::new(
            frames as u64,
            ProgressDrawTarget::stderr(),
            "following {bar:40} {pos}/{len} frames, {eta} left",
        )
    }

    /// Over the frames of a recording, which does not say how many it has.
    pub fn over_played() -> Self {
        Self::new(0, ProgressDrawTarget::stderr(), "playing {spinner} {pos} frames in {elapsed}")
    }

    fn new(length: u64, target: ProgressDrawTarget, template: &str) -> Self {
        let bar = ProgressBar::with_draw_target(Some(length), target);
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.enable_steady_tick(Duration::from_millis(200));
        Self(bar)
    }

    pub fn one_more(&self) {
        self.0.inc(1);
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
