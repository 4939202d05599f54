//! Lines from a camera that fails, each judged before it goes in.

use super::counters::{FaultCounters, count};
use super::{Pipeline, PipelineError};
use crate::camera::{CameraError, FrameStart, LineFault, LineStart, StereoSource};
use crate::matching::Method;

/// What is known about the lines of a frame, and the faults so far.
pub(super) struct LineGuard {
    pub(super) counters: FaultCounters,
    /// Lines of a frame that may be lost; any number where that is not said.
    pub(super) most_lost: Option<u16>,
    /// Lines of this frame that another one stood in for.
    pub(super) lost: u16,
    /// The lowest of them.
    pub(super) last_lost: usize,
    /// Of the last 64 lines, the newest in bit 0: whether another one stood in.
    stood_in: u64,
    /// The newest time stamp of this frame, microseconds.
    newest_us: u64,
    /// Rows up to the last one that the camera told.
    told: usize,
    /// The newest line is this row's, and stands in for those above it.
    held: Option<usize>,
    /// The camera said that no line is left.
    is_short: bool,
}

/// What is to be done about a line that did not come.
type Lost<E> = (fn(&mut FaultCounters) -> &mut u32, PipelineError<E>);

impl LineGuard {
    pub(super) const fn new() -> Self {
        Self {
            counters: FaultCounters::NONE,
            most_lost: None,
            lost: 0,
            last_lost: 0,
            stood_in: 0,
            newest_us: 0,
            told: 0,
            held: None,
            is_short: false,
        }
    }

    /// Forgets the frame before.
    pub(super) fn begin(&mut self, start: &FrameStart) {
        (self.lost, self.last_lost, self.stood_in) = (0, 0, 0);
        (self.newest_us, self.told, self.held, self.is_short) = (start.timestamp_us, 0, None, false);
    }

    /// Counts a line that the caller brought, or lost for a reason, as number `due` of its frame.
    pub(super) fn pushed(&mut self, lost: Option<LineFault>, due: usize) {
        if let Some(fault) = lost {
            count(counter_of(fault)(&mut self.counters), 1);
        }
        self.note(lost.is_none(), due);
    }

    /// Whether another line stood in for the one `back` lines above the newest.
    pub(super) fn stood_in(&self, back: usize) -> bool {
        back < 64 && self.stood_in >> back & 1 != 0
    }

    /// Takes the lines that the next row needs.
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
            return self.accept(pipeline, row == due, due);
        }
        // A camera may give a line again and again: a frame's worth of that is enough.
        for _ in 0..=height {
            if self.is_short {
                return self.stand_in(
                    pipeline,
                    due,
                    (|c| &mut c.lines_short, CameraError::NoLineLeft.into()),
                );
            }
            let lost: Lost<C::Error> = match camera
                .next_lines(pipeline.left.next_line(), pipeline.right.next_line())
            {
                Ok(line) => match self.judge(line, due, height)? {
                    Judged::Due => return self.accept(pipeline, true, due),
                    Judged::Again => continue,
                    Judged::Below(row) => {
                        self.held = Some(row);
                        return self.accept(pipeline, false, due);
                    }
                    Judged::Old => (|c| &mut c.lines_stale, PipelineError::StaleLine { row: line.row }),
                },
                Err(CameraError::LineLost(fault)) => (counter_of(fault), CameraError::LineLost(fault).into()),
                Err(CameraError::TimedOut) => (|c| &mut c.lines_timed_out, CameraError::TimedOut.into()),
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
            return self.stand_in(pipeline, due, lost);
        }
        count(&mut self.counters.syncs_lost, 1);
        Err(CameraError::LostSync.into())
    }

    /// What a line that came is to the one that is due.
    fn judge<E>(&mut self, line: LineStart, due: usize, height: usize) -> Result<Judged, PipelineError<E>> {
        let row = usize::from(line.row);
        if row + 1 == self.told {
            count(&mut self.counters.lines_repeated, 1);
            return Ok(Judged::Again);
        }
        let order = PipelineError::RowOrder { expected: due as u16, given: line.row };
        if row < self.told || row >= height {
            count(&mut self.counters.syncs_lost, 1);
            return Err(order);
        }
        self.told = row + 1;
        // It came after all, and another one stands in its place.
        if row < due {
            return Ok(Judged::Again);
        }
        // Rows passed over are lost, whatever the line below them is worth.
        let passed = row - due;
        if passed > 0 {
            count(&mut self.counters.lines_dropped, passed);
            self.allow(passed, order)?;
        }
        if line.timestamp_us != 0 && line.timestamp_us < self.newest_us {
            if passed > 0 {
                // The line that would stand in is none itself.
                self.told = row;
                count(&mut self.counters.lines_stale, 1);
                return Err(PipelineError::StaleLine { row: line.row });
            }
            return Ok(Judged::Old);
        }
        self.newest_us = self.newest_us.max(line.timestamp_us);
        Ok(if passed > 0 { Judged::Below(row) } else { Judged::Due })
    }

    /// Puts the line above in the place of the one that is due, if so many may be lost.
    fn stand_in<E, S: Method, const W: usize, const D: usize>(
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

    /// Whether so many more lines may be lost.
    fn allow<E>(&self, more: usize, otherwise: PipelineError<E>) -> Result<(), PipelineError<E>> {
        let lost = usize::from(self.lost) + more;
        if self.most_lost.is_some_and(|most| lost > usize::from(most)) { Err(otherwise) } else { Ok(()) }
    }

    /// The lines that stand where the next ones go are those of `due`, or stand in for them.
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

    /// Remembers whether the newest line is its row's own.
    fn note(&mut self, is_own: bool, due: usize) {
        self.stood_in = self.stood_in << 1 | u64::from(!is_own);
        if is_own {
            count(&mut self.counters.lines, 1);
        } else {
            (self.lost, self.last_lost) = (self.lost.saturating_add(1), due);
        }
    }
}

/// Where a line is counted that its source knows to be lost.
fn counter_of(fault: LineFault) -> fn(&mut FaultCounters) -> &mut u32 {
    match fault {
        LineFault::Dropped => |c| &mut c.lines_dropped,
        LineFault::Torn => |c| &mut c.lines_torn,
        LineFault::Late => |c| &mut c.lines_late,
        LineFault::Stale => |c| &mut c.lines_stale,
    }
}

/// What a line is to the one that is due.
enum Judged {
    /// It is the one.
    Due,
    /// It came before, or its place is taken.
    Again,
    /// It is of this row, below.
    Below(usize),
    /// It was left from before.
    Old,
}
