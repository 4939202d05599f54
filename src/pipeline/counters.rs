//! What went wrong, by name.

/// Faults since the start, each counted once, by what showed it. Every count stays at its largest value when
/// it is reached.
///
/// A line that another one stood in for is one of `lines_dropped`, `lines_torn`, `lines_late`, `lines_stale`,
/// `lines_failed`, `lines_timed_out` or `lines_short`, and so is the line that ended a frame because too many
/// were lost. Of the lines that are due after that nothing is known: they count nowhere.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct FaultCounters {
    /// Frames begun.
    pub frames: u32,
    /// Frames of which every line came, and every row went out.
    pub frames_whole: u32,
    /// Frames of which every row went out, some of them flagged.
    pub frames_damaged: u32,
    /// Frames that ended with an error after they had begun.
    pub frames_broken: u32,
    /// Frames that the camera could not begin.
    pub frames_failed: u32,
    /// Frames that the sensor counted and nobody saw: gaps of the sequence numbers.
    pub frames_skipped: u32,
    /// Frames refused because they were the one before once more.
    pub frames_stale: u32,
    /// Sequence numbers that went back: the sensor began to count anew.
    pub restarts: u32,
    /// Rows that went out.
    pub rows: u32,
    /// Rows of these with [`PixelFlags::DAMAGED`](crate::units::PixelFlags::DAMAGED).
    pub rows_damaged: u32,
    /// Lines that came.
    pub lines: u32,
    /// Lines that row numbers passed over, or that the source said were dropped.
    pub lines_dropped: u32,
    /// Lines that came once more, which are left out.
    pub lines_repeated: u32,
    /// Lines that the source said were torn.
    pub lines_torn: u32,
    /// Lines that the source said came too late.
    pub lines_late: u32,
    /// Lines with a time stamp of before the frame or of before the line above, or that the source said were
    /// old.
    pub lines_stale: u32,
    /// Lines that the hardware failed to give.
    pub lines_failed: u32,
    /// Lines that were waited for in vain.
    pub lines_timed_out: u32,
    /// Lines that a frame was short of.
    pub lines_short: u32,
    /// Frames that broke off because the sensor lost sync, or its rows ran backwards.
    pub syncs_lost: u32,
}

impl FaultCounters {
    /// All zero, in a `const`.
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

/// One more, or several.
pub(super) fn count(counter: &mut u32, more: usize) {
    *counter = counter.saturating_add(u32::try_from(more).unwrap_or(u32::MAX));
}
