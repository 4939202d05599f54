//! Fault counters, one for each kind of fault.

/// Saturating counts of frames, rows, lines and faults since the start. Every fault is counted once.
///
/// A replaced line counts as `lines_dropped`, `lines_torn`, `lines_late`, `lines_stale`, `lines_failed`,
/// `lines_timed_out` or `lines_short`, and so does the line that ended a frame because too many were lost.
/// Lines that were due after that are not counted.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct FaultCounters {
    /// Frames that began.
    pub frames: u32,
    /// Frames of which every line came and every row was given.
    pub frames_whole: u32,
    /// Frames of which every row was given, some of them flagged.
    pub frames_damaged: u32,
    /// Frames that ended early, by an error or by the next frame.
    pub frames_broken: u32,
    /// Frames that the camera could not begin.
    pub frames_failed: u32,
    /// Frames that were skipped, by gaps in the sequence numbers.
    pub frames_skipped: u32,
    /// Frames refused as a repetition of the previous one.
    pub frames_stale: u32,
    /// Restarts of the sensor, by sequence numbers that went back.
    pub restarts: u32,
    /// Rows that were given.
    pub rows: u32,
    /// Rows with [`PixelFlags::DAMAGED`](crate::units::PixelFlags::DAMAGED).
    pub rows_damaged: u32,
    /// Lines that came.
    pub lines: u32,
    /// Lines that row numbers skipped, or that the source reported as dropped.
    pub lines_dropped: u32,
    /// Lines that came again, which are ignored.
    pub lines_repeated: u32,
    /// Lines that the source reported as torn.
    pub lines_torn: u32,
    /// Lines that the source reported as late.
    pub lines_late: u32,
    /// Lines with a time stamp before the frame's or the line above's, or that the source reported as stale.
    pub lines_stale: u32,
    /// Lines that the hardware failed to deliver.
    pub lines_failed: u32,
    /// Lines that timed out.
    pub lines_timed_out: u32,
    /// Lines that were missing at the end of short frames.
    pub lines_short: u32,
    /// Frames that ended because the sensor lost sync, or its rows ran backwards.
    pub syncs_lost: u32,
}

impl FaultCounters {
    /// All counts zero.
    pub(super) const NONE: Self = Self {
        frames: 0,
        frames_whole: 0,
        frames_damaged: 0,
        frames_broken: 0,
        frames_failed: 0,
        frames_skipped: 0,
        frames_stale: 0,
        restarts: 0,
        rows: 0,
        rows_damaged: 0,
        lines: 0,
        lines_dropped: 0,
        lines_repeated: 0,
        lines_torn: 0,
        lines_late: 0,
        lines_stale: 0,
        lines_failed: 0,
        lines_timed_out: 0,
        lines_short: 0,
        syncs_lost: 0,
    };
}

/// Adds to a counter, saturating.
pub(super) fn count(counter: &mut u32, more: usize) {
    *counter = counter.saturating_add(u32::try_from(more).unwrap_or(u32::MAX));
}
