//! The pipeline before cameras that fail.

use super::counters::{FaultCounters, count};
use super::lines::LineGuard;
use super::{Pipeline, PipelineError, PushError};
use crate::camera::{ErrorType, FrameStart, LineFault, StereoSource};
use crate::matching::{Config, ConfigError, Kernel, KernelError, MatchError, Method, Row};

/// A [`Pipeline`] that goes on when lines get lost, flags what they touch and counts every fault by name.
///
/// A [`Pipeline`] ends the frame with the first error. This one takes the line above in a lost line's place,
/// in a frame as often as [`Self::set_most_lost`] allows, and says so in the rows:
///
/// * rows whose matching window saw the lost line have no answers, and [`PixelFlags::DAMAGED`] on every
///   pixel;
/// * rows farther away that it can have touched, by the checks or along paths, keep their answers and have
///   the flag;
/// * every other row is, to the bit, what it would be without the fault.
///
/// With [`Fast`](crate::matching::Fast) and [`Block`](crate::matching::Block) a lost line reaches
/// [`Pipeline::LATENCY`] rows up, and [`Self::reach_down`] rows down; along paths it reaches to the end of
/// the frame.
///
/// What ends a frame, as a [`Pipeline`]'s does: more lost lines than allowed, sync lost, rows that run
/// backwards. The next frame is as good as the first.
///
/// ```text
/// line              row told      what becomes of it
/// as due            due           taken
/// lost, told        -             the line above stands in            lines_dropped, _torn, _late, _failed, _timed_out
/// passed over       > due         it stands in for those above it     lines_dropped
/// once more         due - 1       left out, the next one is taken     lines_repeated
/// of another frame  < due - 1     ends the frame                      syncs_lost
/// old time stamp    due           the line above stands in            lines_stale
/// none left         -             the line above stands in            lines_short
/// ```
///
/// Lines that the caller brings ([`Self::push`]) are taken as they are, and one that did not come is told
/// ([`Self::push_lost`]).
///
/// Time stamps are looked at where the source has them: 0 is none. A frame is the one before once more when
/// its sequence number, not 0, is that of the one before, or when its number and its stamp, not 0, are.
///
/// [`PixelFlags::DAMAGED`]: crate::units::PixelFlags::DAMAGED
pub struct Guarded<S: Method, const W: usize, const D: usize> {
    pipeline: Pipeline<S, W, D>,
    lines: LineGuard,
    before: Option<FrameStart>,
    is_running: bool,
}

type Guard<T, C> = Result<T, PipelineError<<C as ErrorType>::Error>>;

impl<S: Method, const W: usize, const D: usize> Guarded<S, W, D> {
    /// A pipeline that waits for [`Self::start`]. Every byte of it is zero: a static of it takes RAM and no
    /// flash.
    pub const fn new() -> Self {
        Self { pipeline: Pipeline::new(), lines: LineGuard::new(), before: None, is_running: false }
    }

    /// Checks the configuration and gets ready for the first frame. Counters go to zero.
    pub fn start(&mut self, config: &Config) -> Result<(), ConfigError> {
        self.pipeline.start(config)?;
        (self.lines.counters, self.before, self.is_running) = (FaultCounters::NONE, None, false);
        Ok(())
    }

    /// Another configuration from the next frame on: counters go on, and a frame under way is over. So a
    /// frame can be matched for the [noise](Config::noise) that was measured in the one before. What is
    /// refused changes nothing.
    pub fn restart(&mut self, config: &Config) -> Result<(), ConfigError> {
        self.pipeline.start(config)?;
        self.give_up();
        Ok(())
    }

    /// How many lines of a frame may be lost before it ends with an error; all of them where nothing is set.
    /// With a camera that is dead each of them may cost the time that the source waits: a few are enough
    /// where that matters.
    pub fn set_most_lost(&mut self, lines: u16) {
        self.lines.most_lost = Some(lines);
    }

    /// Chooses the kernel from the next frame on; every kernel gives the same bits.
    pub fn set_kernel(&mut self, kernel: Kernel) -> Result<(), KernelError> {
        self.pipeline.set_kernel(kernel)
    }

    /// What went wrong so far.
    pub fn counters(&self) -> &FaultCounters {
        &self.lines.counters
    }

    /// Lines of this frame that another one stood in for.
    pub fn lost_lines(&self) -> u16 {
        self.lines.lost
    }

    /// What the pipeline was started for.
    pub fn config(&self) -> &Config {
        self.pipeline.config()
    }

    /// How many rows down from a lost line the flag stands; along paths it stands to the end of the frame.
    pub fn reach_down(&self) -> usize {
        // Answers that are smoothed down the columns rest on the row above as it came out, and so does a
        // path.
        if S::VERTICAL_FILTER {
            return usize::MAX;
        }
        let checks = &self.config().checks;
        Pipeline::<S, W, D>::LATENCY + usize::from(checks.median) + usize::from(checks.speckle_pixels)
    }

    /// Waits for the camera's next frame and forgets the one before.
    pub fn begin_frame<C: StereoSource>(&mut self, camera: &mut C) -> Guard<FrameStart, C> {
        self.give_up();
        let start = match self.pipeline.begin_frame(camera) {
            Ok(start) => start,
            Err(e) => {
                if let PipelineError::Camera(_) = e {
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
                    let skipped = &mut self.lines.counters.frames_skipped;
                    *skipped = skipped.saturating_add(gap);
                }
                _ => count(&mut self.lines.counters.restarts, 1),
            }
        }
        count(&mut self.lines.counters.frames, 1);
        self.lines.begin(&start);
        self.is_running = true;
        Ok(start)
    }

    /// The next row of disparities; `None` when all rows of the frame are out. After an error the frame is
    /// over.
    pub fn next_row<C: StereoSource>(&mut self, camera: &mut C) -> Guard<Option<Row<'_>>, C> {
        let Self { pipeline, lines, .. } = self;
        match pipeline.advance(|pipeline| lines.take(pipeline, camera)) {
            Err(e) => {
                self.give_up();
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

    /// Begins a frame whose lines the caller brings, and forgets the one before.
    pub fn begin(&mut self) -> Result<(), MatchError> {
        self.give_up();
        self.pipeline.begin()?;
        count(&mut self.lines.counters.frames, 1);
        self.lines.begin(&FrameStart::default());
        self.is_running = true;
        Ok(())
    }

    /// As [`Pipeline::push`], with the row flagged where it rests on a line that was lost.
    pub fn push(&mut self, left: &[u8], right: &[u8]) -> Result<Option<Row<'_>>, PushError> {
        let due = self.pipeline.left.count();
        let is_out = self.pipeline.push(left, right)?.is_some();
        Ok(self.pushed(None, due, is_out))
    }

    /// In place of [`Self::push`], of a line that did not come: the line above stands in. It counts by its
    /// fault. The caller says how many lines of a frame it bears.
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

    /// As [`Pipeline::flush`], with the row flagged.
    pub fn flush(&mut self) -> Result<Option<Row<'_>>, PushError> {
        if self.pipeline.flush()?.is_some() {
            self.mark();
            return Ok(self.pipeline.row());
        }
        self.end();
        Ok(None)
    }

    /// The row that came out last, until the next line goes in; `None` before the first of a frame.
    pub fn row(&self) -> Option<Row<'_>> {
        self.pipeline.row()
    }

    /// Takes the answers of [`Self::row`] away where a camera did not see: [`Pipeline::mask`].
    pub fn mask(&mut self, valid: impl FnOnce(u16, [&mut [u8]; 2]) -> bool) {
        self.pipeline.mask(valid);
    }

    /// Counts a frame of which all rows are out.
    fn end(&mut self) {
        if core::mem::take(&mut self.is_running) {
            let LineGuard { lost, counters, .. } = &mut self.lines;
            count(if *lost == 0 { &mut counters.frames_whole } else { &mut counters.frames_damaged }, 1);
        }
    }

    /// Counts the row that came out, and flags it where it rests on a lost line.
    fn mark(&mut self) {
        count(&mut self.lines.counters.rows, 1);
        let Some(row) = self.pipeline.row().map(|row| usize::from(row.index())) else { return };
        if self.lines.lost == 0 || row > self.lines.last_lost.saturating_add(self.reach_down()) {
            return;
        }
        let reach = S::RADIUS_Y + Pipeline::<S, W, D>::CENSUS_REACH;
        let newest = self.pipeline.left.count().saturating_sub(1);
        let mut seen = row.saturating_sub(reach)..=newest.min(row + reach);
        let has_lost = seen.any(|line| self.lines.stood_in(newest - line));
        self.pipeline.matcher.mark_damaged(!has_lost);
        count(&mut self.lines.counters.rows_damaged, 1);
    }

    /// Ends a frame whose rows are not all out.
    fn give_up(&mut self) {
        if core::mem::take(&mut self.is_running) {
            count(&mut self.lines.counters.frames_broken, 1);
        }
        self.pipeline.stop();
    }
}

impl<S: Method, const W: usize, const D: usize> Default for Guarded<S, W, D> {
    fn default() -> Self {
        Self::new()
    }
}
