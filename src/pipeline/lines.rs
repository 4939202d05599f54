//! Fault detection by line: each line of a camera is classified before it goes in.

use super::counters::{FaultCounters, count};
use super::{Pipeline, PipelineError};
use crate::camera::{CameraError, FrameStart, LineFault, LineStart, StereoSource};
use crate::matching::Method;

/// State of a frame's lines, and the fault counters.
pub(super) struct LineGuard {
    pub(super) counters: FaultCounters,
    /// Largest number of lost lines per frame; unlimited if `None`.
    pub(super) most_lost: Option<u16>,
    /// Number of replaced lines of this frame.
    pub(super) lost: u16,
    /// Row number of the last line of this frame that was replaced.
    pub(super) last_lost: usize,
    /// Whether each of the last 64 lines was replaced, the newest in bit 0.
    replaced: u64,
    /// Newest time stamp of this frame, microseconds.
    newest_us: u64,
    /// One more than the last row that the camera reported.
    reported: usize,
    /// Row of the newest line while the lines skipped above it are replaced.
    held: Option<usize>,
    /// Whether that line is lost as they are, for its old time stamp: the line above replaces them all. Not a
    /// part of `held`, whose `None` has to be of zero bytes.
    is_held_stale: bool,
    /// Whether the camera reported that no line is left.
    is_short: bool,
}

/// Counter of a lost line, and the error if it is one too many.
type Lost<E> = (fn(&mut FaultCounters) -> &mut u32, PipelineError<E>);

impl LineGuard {
    pub(super) const fn new() -> Self {
        Self {
            counters: FaultCounters::NONE,
            most_lost: None,
            lost: 0,
            last_lost: 0,
            replaced: 0,
            newest_us: 0,
            reported: 0,
            held: None,
            is_held_stale: false,
            is_short: false,
        }
    }

    /// Begins a frame.
    pub(super) fn begin(&mut self, start: &FrameStart) {
        (self.lost, self.last_lost, self.replaced) = (0, 0, 0);
        (self.newest_us, self.reported, self.held, self.is_short) = (start.timestamp_us, 0, None, false);
    }

    /// Counts line `due` of a frame, which the caller pushed or reported as lost.
    pub(super) fn pushed(&mut self, lost: Option<LineFault>, due: usize) {
        if let Some(fault) = lost {
            count(counter_of(fault)(&mut self.counters), 1);
        }
        self.note(lost.is_none(), due);
    }

    /// Returns whether the line `back` lines above the newest was replaced.
    pub(super) fn was_replaced(&self, back: usize) -> bool {
        back < 64 && self.replaced >> back & 1 != 0
    }

    /// Reads the lines that the next row needs.
    pub(super) fn take<S: Method, C: StereoSource, const W: usize, const D: usize>(
        &mut self,
        pipeline: &mut Pipeline<S, W, D>,
        camera: &mut C,
    ) -> Result<(), PipelineError<C::Error>> {
        for due in pipeline.left.count()..pipeline.lines_needed() {
            self.take_one(pipeline, camera, due)?;
        }
        Ok(())
    }

    fn take_one<S: Method, C: StereoSource, const W: usize, const D: usize>(
        &mut self,
        pipeline: &mut Pipeline<S, W, D>,
        camera: &mut C,
        due: usize,
    ) -> Result<(), PipelineError<C::Error>> {
        let height = usize::from(pipeline.config().height);
        if let Some(row) = self.held {
            pipeline.left.repeat();
            pipeline.right.repeat();
            if row == due {
                self.held = None;
            }
            return self.accept(pipeline, row == due && !self.is_held_stale, due);
        }
        // A camera may give a line again and again: a frame's worth of that is enough.
        for _ in 0..=height {
            if self.is_short {
                return self.replace(pipeline, due, (|c| &mut c.lines_short, CameraError::NoLineLeft.into()));
            }
            let lost: Lost<C::Error> = match camera
                .next_lines(pipeline.left.next_line(), pipeline.right.next_line())
            {
                Ok(line) => match self.classify(line, due, height)? {
                    LineKind::Due => return self.accept(pipeline, true, due),
                    LineKind::Repeated => continue,
                    LineKind::Below(row) => {
                        (self.held, self.is_held_stale) = (Some(row), false);
                        return self.accept(pipeline, false, due);
                    }
                    LineKind::StaleBelow(row) => {
                        (self.held, self.is_held_stale) = (Some(row), true);
                        pipeline.left.repeat();
                        pipeline.right.repeat();
                        return self.accept(pipeline, false, due);
                    }
                    LineKind::Stale => (|c| &mut c.lines_stale, PipelineError::StaleLine { row: line.row }),
                },
                Err(CameraError::LineLost(fault)) => (counter_of(fault), CameraError::LineLost(fault).into()),
                Err(CameraError::TimedOut) => (|c| &mut c.lines_timed_out, CameraError::TimedOut.into()),
                Err(CameraError::WouldBlock) => return Err(CameraError::WouldBlock.into()),
                Err(CameraError::NoLineLeft) => {
                    self.is_short = true;
                    continue;
                }
                Err(CameraError::LostSync) => {
                    count(&mut self.counters.syncs_lost, 1);
                    return Err(CameraError::LostSync.into());
                }
                Err(e) => (|c| &mut c.lines_failed, e.into()),
            };
            return self.replace(pipeline, due, lost);
        }
        count(&mut self.counters.syncs_lost, 1);
        Err(CameraError::LostSync.into())
    }

    /// Classifies a line by its row number and time stamp.
    fn classify<E>(
        &mut self,
        line: LineStart,
        due: usize,
        height: usize,
    ) -> Result<LineKind, PipelineError<E>> {
        let row = usize::from(line.row);
        if row + 1 == self.reported {
            count(&mut self.counters.lines_repeated, 1);
            return Ok(LineKind::Repeated);
        }
        let order = PipelineError::RowOrder { expected: due as u16, given: line.row };
        if row < self.reported || row >= height {
            count(&mut self.counters.syncs_lost, 1);
            return Err(order);
        }
        self.reported = row + 1;
        // A late line whose place is taken.
        if row < due {
            return Ok(LineKind::Repeated);
        }
        let is_stale = line.timestamp_us != 0 && line.timestamp_us < self.newest_us;
        let passed = row - due;
        if passed == 0 {
            self.newest_us = self.newest_us.max(line.timestamp_us);
            return Ok(if is_stale { LineKind::Stale } else { LineKind::Due });
        }
        // Skipped rows are lost, even if this line is stale.
        count(&mut self.counters.lines_dropped, passed);
        count(&mut self.counters.lines_stale, is_stale.into());
        self.allow(passed + usize::from(is_stale), order)?;
        self.newest_us = self.newest_us.max(line.timestamp_us);
        Ok(if is_stale { LineKind::StaleBelow(row) } else { LineKind::Below(row) })
    }

    /// Replaces the due line by the one above, if so many lines may be lost.
    fn replace<E, S: Method, const W: usize, const D: usize>(
        &mut self,
        pipeline: &mut Pipeline<S, W, D>,
        due: usize,
        (counter, error): Lost<E>,
    ) -> Result<(), PipelineError<E>> {
        count(counter(&mut self.counters), 1);
        self.allow(1, error)?;
        pipeline.left.repeat();
        pipeline.right.repeat();
        self.accept(pipeline, false, due)
    }

    /// Checks that so many more lines may be lost.
    fn allow<E>(&self, more: usize, otherwise: PipelineError<E>) -> Result<(), PipelineError<E>> {
        let lost = usize::from(self.lost) + more;
        if self.most_lost.is_some_and(|most| lost > usize::from(most)) { Err(otherwise) } else { Ok(()) }
    }

    /// Accepts the lines in the windows as row `due`, its own or replacements.
    fn accept<E, S: Method, const W: usize, const D: usize>(
        &mut self,
        pipeline: &mut Pipeline<S, W, D>,
        is_own: bool,
        due: usize,
    ) -> Result<(), PipelineError<E>> {
        pipeline.left.accept();
        pipeline.right.accept();
        self.note(is_own, due);
        Ok(())
    }

    /// Records whether the newest line is its row's own.
    fn note(&mut self, is_own: bool, due: usize) {
        self.replaced = self.replaced << 1 | u64::from(!is_own);
        if is_own {
            count(&mut self.counters.lines, 1);
        } else {
            (self.lost, self.last_lost) = (self.lost.saturating_add(1), due);
        }
    }
}

/// Counter of a reported fault.
fn counter_of(fault: LineFault) -> fn(&mut FaultCounters) -> &mut u32 {
    match fault {
        LineFault::Dropped => |c| &mut c.lines_dropped,
        LineFault::Torn => |c| &mut c.lines_torn,
        LineFault::Late => |c| &mut c.lines_late,
        LineFault::Stale => |c| &mut c.lines_stale,
    }
}

/// Relation of a line to the due one.
enum LineKind {
    /// The line is the due one.
    Due,
    /// The line came before, or its place is taken.
    Repeated,
    /// The line is of this row below the due one.
    Below(usize),
    /// The line is of this row below the due one, with an old time stamp.
    StaleBelow(usize),
    /// The line has an old time stamp.
    Stale,
}
