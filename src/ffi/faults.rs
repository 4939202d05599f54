//! Lines that were lost, and what is counted of them, as C has it.

use crate::pipeline::FaultCounters;

/// The line did not come, or no buffer was free for it.
pub const STEREOPSIS_LOST_DROPPED: i32 = 0;
/// The line was overwritten while it was read, or has fewer or more pixels than a line.
pub const STEREOPSIS_LOST_TORN: i32 = 1;
/// The line came after the time at which it was of use.
pub const STEREOPSIS_LOST_LATE: i32 = 2;
/// The buffer holds a line of before: nobody has filled it since.
pub const STEREOPSIS_LOST_STALE: i32 = 3;

/// Counts since `stereopsis_start`, each of which stays at its largest value when it is reached.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[repr(C)]
pub struct CCounters {
    /// Frames begun.
    pub frames: u32,
    /// Frames of which every line came, and every row went out.
    pub frames_whole: u32,
    /// Frames of which every row went out, some of them flagged.
    pub frames_damaged: u32,
    /// Frames that were given up after they had begun.
    pub frames_broken: u32,
    /// Rows that went out.
    pub rows: u32,
    /// Rows of these with `STEREOPSIS_FLAG_DAMAGED`.
    pub rows_damaged: u32,
    /// Lines that came.
    pub lines: u32,
    /// Lines told as `STEREOPSIS_LOST_DROPPED`.
    pub lines_dropped: u32,
    /// Lines told as `STEREOPSIS_LOST_TORN`.
    pub lines_torn: u32,
    /// Lines told as `STEREOPSIS_LOST_LATE`.
    pub lines_late: u32,
    /// Lines told as `STEREOPSIS_LOST_STALE`.
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
