//! A pipeline that tolerates camera faults.

use super::counters::{FaultCounters, count};
use super::error::CameraResult;
use super::lines::LineGuard;
use super::reach::reach_down;
use super::{Pipeline, PipelineError, PushError};
use crate::camera::{FrameStart, LineFault, StereoSource};
use crate::matching::{
    Capacity, Config, ConfigError, Kernel, KernelError, MatchError, Method, Row, Supported,
};

/// A [`Pipeline`] that replaces lost lines, flags the rows that depend on them, and counts every fault by
/// name.
///
/// A [`Pipeline`] ends the frame at the first error. This one replaces a lost line by the line above, as
/// often per frame as [`Self::set_most_lost`] allows:
///
/// * rows whose matching window contains the lost line have no answers, and [`PixelFlags::DAMAGED`] on every
///   pixel;
/// * rows that the lost line can affect through checks or along paths keep their answers and have the flag;
/// * every other row is bit-equal to that without the fault.
///
/// With [`Fast`](crate::matching::Fast) and [`Block`](crate::matching::Block) a lost line affects
/// [`Pipeline::LATENCY`] rows up and [`Self::reach_down`] rows down; along paths, and where open places are
/// looked for, it affects the rest of the frame.
///
/// A frame ends early after more lost lines than allowed, lost sync, or rows that run backwards. The next
/// frame is as good as the first.
///
/// ```text
/// line              reported row  treatment                         counter
/// expected          due           taken                             lines
/// reported lost     -             replaced by the line above        lines_dropped, lines_torn, lines_late,
///                                                                   lines_failed, lines_timed_out
/// skipped           > due         this line replaces those above    lines_dropped
/// repeated          due - 1       ignored                           lines_repeated
/// of another frame  < due - 1     ends the frame                    syncs_lost
/// old time stamp    due           replaced by the line above        lines_stale
/// old time stamp    > due         lost with those skipped           lines_stale, lines_dropped
/// none left         -             replaced by the line above        lines_short
/// ```
///
/// Pushed lines ([`Self::push`]) are taken as they are, and lost ones are reported by [`Self::push_lost`].
///
/// A time stamp of 0 means none. A frame repeats the previous one when both have one sequence number that is
/// not 0, or one number and one time stamp that is not 0.
///
/// [`PixelFlags::DAMAGED`]: crate::units::PixelFlags::DAMAGED
pub struct Guarded<S: Method, const W: usize, const D: usize> {
    pipeline: Pipeline<S, W, D>,
    lines: LineGuard,
    before: Option<FrameStart>,
    is_running: bool,
}

impl<S: Method, const W: usize, const D: usize> Guarded<S, W, D> {
    /// Creates a pipeline that awaits [`Self::start`]. All its bytes are zero, so that a static takes no
    /// flash.
    pub const fn new() -> Self
    where
        Capacity<D>: Supported,
    {
        Self { pipeline: Pipeline::new(), lines: LineGuard::new(), before: None, is_running: false }
    }

    /// Checks the configuration, prepares for the first frame, and clears the counters.
    pub fn start(&mut self, config: &Config) -> Result<(), ConfigError> {
        self.pipeline.start(config)?;
        (self.lines.counters, self.before, self.is_running) = (FaultCounters::NONE, None, false);
        Ok(())
    }

    /// Changes the configuration from the next frame on, for instance for the [noise](Config::noise) measured
    /// in the last frame. Counters continue, and a frame under way ends. A refused configuration changes
    /// nothing.
    pub fn restart(&mut self, config: &Config) -> Result<(), ConfigError> {
        self.pipeline.start(config)?;
        self.give_up();
        Ok(())
    }

    /// Sets how many lines of a frame may be lost before it ends with an error; by default all of them. With
    /// a dead camera every lost line may cost the source's time-out.
    pub fn set_most_lost(&mut self, lines: u16) {
        self.lines.most_lost = Some(lines);
    }

    /// Chooses the kernel from the next frame on; every kernel gives the same bits.
    pub fn set_kernel(&mut self, kernel: Kernel) -> Result<(), KernelError> {
        self.pipeline.set_kernel(kernel)
    }

    /// Returns the fault counters.
    pub fn counters(&self) -> &FaultCounters {
        &self.lines.counters
    }

    /// Returns the number of replaced lines of this frame.
    pub fn lost_lines(&self) -> u16 {
        self.lines.lost
    }

    /// Returns the configuration.
    pub fn config(&self) -> &Config {
        self.pipeline.config()
    }

    /// Returns how many rows below a lost line are flagged; `usize::MAX` for the rest of the frame.
    pub fn reach_down(&self) -> usize {
        Pipeline::<S, W, D>::LATENCY.saturating_add(reach_down::<S>(&self.config().checks))
    }

    /// Waits for the camera's next frame, and drops the one before.
    pub fn begin_frame<C: StereoSource>(&mut self, camera: &mut C) -> CameraResult<FrameStart, C> {
        self.give_up();
        let start = match self.pipeline.begin_frame(camera) {
            Ok(start) => start,
            Err(e) => {
                if let PipelineError::Camera(_) = e
                    && !e.is_pause()
                {
                    count(&mut self.lines.counters.frames_failed, 1);
                }
                return Err(e);
            }
        };
        if let Some(before) = self.before.replace(start) {
            let is_same = start.sequence == before.sequence;
            if is_same
                && (start.sequence != 0
                    || start.timestamp_us != 0 && start.timestamp_us == before.timestamp_us)
            {
                count(&mut self.lines.counters.frames_stale, 1);
                self.pipeline.stop();
                return Err(PipelineError::StaleFrame { sequence: start.sequence });
            }
            match start.sequence.wrapping_sub(before.sequence) as i32 {
                0 => {}
                1.. => {
                    let gap = start.sequence.wrapping_sub(before.sequence) - 1;
                    count(&mut self.lines.counters.frames_skipped, gap as usize);
                }
                _ => count(&mut self.lines.counters.restarts, 1),
            }
        }
        count(&mut self.lines.counters.frames, 1);
        self.lines.begin(&start);
        self.is_running = true;
        Ok(start)
    }

    /// Returns the next row; `None` after the frame's last row. An error ends the frame.
    pub fn next_row<C: StereoSource>(&mut self, camera: &mut C) -> CameraResult<Option<Row<'_>>, C> {
        let Self { pipeline, lines, .. } = self;
        match pipeline.advance(|pipeline| lines.take(pipeline, camera)) {
            Err(e) => {
                if !e.is_pause() {
                    self.give_up();
                }
                Err(e)
            }
            Ok(false) => {
                self.end();
                Ok(None)
            }
            Ok(true) => {
                self.pipeline.matcher.mask(|row, masks| camera.mask(row, masks));
                self.mark();
                Ok(self.pipeline.row())
            }
        }
    }

    /// Begins a frame whose lines are pushed, and drops the one before.
    pub fn begin(&mut self) -> Result<(), MatchError> {
        // It drops the frame before; a pipeline that was not started has none.
        self.pipeline.begin()?;
        self.count_broken();
        count(&mut self.lines.counters.frames, 1);
        self.lines.begin(&FrameStart::default());
        self.is_running = true;
        Ok(())
    }

    /// Pushes a line as [`Pipeline::push`] does, and flags the row if it depends on a lost line.
    pub fn push(&mut self, left: &[u8], right: &[u8]) -> Result<Option<Row<'_>>, PushError> {
        let due = self.pipeline.left.count();
        let is_out = self.pipeline.push(left, right)?.is_some();
        Ok(self.pushed(None, due, is_out))
    }

    /// Pushes the line above in place of a lost one, which is counted by its fault. The caller decides how
    /// many lost lines of a frame to accept.
    pub fn push_lost(&mut self, fault: LineFault) -> Result<Option<Row<'_>>, PushError> {
        let due = self.pipeline.left.count();
        let is_out = self.pipeline.push_repeated()?.is_some();
        Ok(self.pushed(Some(fault), due, is_out))
    }

    fn pushed(&mut self, lost: Option<LineFault>, due: usize, is_out: bool) -> Option<Row<'_>> {
        self.lines.pushed(lost, due);
        if is_out {
            self.mark();
        }
        self.pipeline.row()
    }

    /// Returns the next row as [`Pipeline::flush`] does, and flags it if it depends on a lost line.
    pub fn flush(&mut self) -> Result<Option<Row<'_>>, PushError> {
        if self.pipeline.flush()?.is_some() {
            self.mark();
            return Ok(self.pipeline.row());
        }
        self.end();
        Ok(None)
    }

    /// Returns the last row, until the next line goes in; `None` before a frame's first row.
    pub fn row(&self) -> Option<Row<'_>> {
        self.pipeline.row()
    }

    /// Removes answers of [`Self::row`] at pixels that a camera did not see, as [`Pipeline::mask`] does.
    pub fn mask(&mut self, valid: impl FnOnce(u16, [&mut [u8]; 2]) -> bool) {
        self.pipeline.mask(valid);
    }

    /// Counts a complete frame.
    fn end(&mut self) {
        if core::mem::take(&mut self.is_running) {
            let LineGuard { lost, counters, .. } = &mut self.lines;
            count(if *lost == 0 { &mut counters.frames_whole } else { &mut counters.frames_damaged }, 1);
        }
    }

    /// Counts the row that came out, and flags it if it depends on a lost line.
    fn mark(&mut self) {
        count(&mut self.lines.counters.rows, 1);
        let Some(row) = self.pipeline.row().map(|row| usize::from(row.index())) else { return };
        if self.lines.lost == 0 || row > self.lines.last_lost.saturating_add(self.reach_down()) {
            return;
        }
        let reach = S::RADIUS_Y + Pipeline::<S, W, D>::CENSUS_REACH;
        let newest = self.pipeline.left.count().saturating_sub(1);
        let mut seen = row.saturating_sub(reach)..=newest.min(row + reach);
        let has_lost = seen.any(|line| self.lines.was_replaced(newest - line));
        self.pipeline.matcher.mark_damaged(!has_lost);
        count(&mut self.lines.counters.rows_damaged, 1);
    }

    /// Ends an incomplete frame.
    fn give_up(&mut self) {
        self.count_broken();
        self.pipeline.stop();
    }

    fn count_broken(&mut self) {
        if core::mem::take(&mut self.is_running) {
            count(&mut self.lines.counters.frames_broken, 1);
        }
    }
}

impl<S: Method, const W: usize, const D: usize> Default for Guarded<S, W, D>
where
    Capacity<D>: Supported,
{
    fn default() -> Self {
        Self::new()
    }
}
