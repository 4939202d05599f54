//! Lost lines and fault counters in C.

use super::Status;
use crate::camera::LineFault;
use crate::pipeline::FaultCounters;

/// Fault: the line did not arrive, or found no free buffer.
pub const STEREOPSIS_LOST_DROPPED: i32 = 0;
/// Fault: the line was overwritten while it was read, or has too few or too many pixels.
pub const STEREOPSIS_LOST_TORN: i32 = 1;
/// Fault: the line arrived too late to be used.
pub const STEREOPSIS_LOST_LATE: i32 = 2;
/// Fault: the buffer still holds an earlier line.
pub const STEREOPSIS_LOST_STALE: i32 = 3;

/// Returns the fault of a `STEREOPSIS_LOST_` number.
pub(super) fn fault(number: i32) -> Result<LineFault, Status> {
    match number {
        STEREOPSIS_LOST_DROPPED => Ok(LineFault::Dropped),
        STEREOPSIS_LOST_TORN => Ok(LineFault::Torn),
        STEREOPSIS_LOST_LATE => Ok(LineFault::Late),
        STEREOPSIS_LOST_STALE => Ok(LineFault::Stale),
        _ => Err(Status::Fault),
    }
}

/// Saturating counts since `stereopsis_start`.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[repr(C)]
pub struct CCounters {
    /// Frames that began.
    pub frames: u32,
    /// Frames of which every line came and every row was given.
    pub frames_whole: u32,
    /// Frames of which every row was given, some of them flagged.
    pub frames_damaged: u32,
    /// Frames that ended early.
    pub frames_broken: u32,
    /// Rows that were given.
    pub rows: u32,
    /// Rows with `STEREOPSIS_FLAG_DAMAGED`.
    pub rows_damaged: u32,
    /// Lines that came.
    pub lines: u32,
    /// Lines reported as `STEREOPSIS_LOST_DROPPED`.
    pub lines_dropped: u32,
    /// Lines reported as `STEREOPSIS_LOST_TORN`.
    pub lines_torn: u32,
    /// Lines reported as `STEREOPSIS_LOST_LATE`.
    pub lines_late: u32,
    /// Lines reported as `STEREOPSIS_LOST_STALE`.
    pub lines_stale: u32,
}

impl From<&FaultCounters> for CCounters {
    fn from(counters: &FaultCounters) -> Self {
        Self {
            frames: counters.frames,
            frames_whole: counters.frames_whole,
            frames_damaged: counters.frames_damaged,
            frames_broken: counters.frames_broken,
            rows: counters.rows,
            rows_damaged: counters.rows_damaged,
            lines: counters.lines,
            lines_dropped: counters.lines_dropped,
            lines_torn: counters.lines_torn,
            lines_late: counters.lines_late,
            lines_stale: counters.lines_stale,
        }
    }
}
