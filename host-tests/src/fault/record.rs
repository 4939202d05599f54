//! The faults by name, and what was done to a frame.

/// What can go wrong, and what can be known of it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Fault {
    /// A line does not come, and the source says so.
    LineDropped,
    /// A line does not come; the next one's number tells.
    LinePassedOver,
    /// A line comes once more, with its own number.
    LineRepeated,
    /// A line is torn, and the source says so.
    LineTorn,
    /// A line comes too late, and the source says so.
    LineLate,
    /// A line of the frame before stands in the buffer; its time stamp tells.
    LineStale,
    /// The bus fails, and the line is gone.
    Bus,
    /// The bus fails before the line was taken: the next call gives it.
    BusBefore,
    /// A line is waited for in vain.
    TimesOut,
    /// The frame ends here.
    FrameShort,
    /// The sensor begins another frame here, and the source says so.
    SyncLost,
    /// The sensor begins another frame here; the rows' numbers tell.
    RowsRestart,
    /// The camera dies: every line of the frame from here on is waited for in vain.
    Dead,
    /// The frame before comes once more; its number tells.
    FrameStale,
    /// A frame is left out; the next one's number tells.
    FrameSkipped,
    /// The frame is waited for in vain.
    FrameTimesOut,
    /// The bus fails where a frame is to begin.
    FrameFails,
}

impl Fault {
    /// All of them.
    pub const ALL: [Self; 17] = [
        Self::LineDropped,
        Self::LinePassedOver,
        Self::LineRepeated,
        Self::LineTorn,
        Self::LineLate,
        Self::LineStale,
        Self::Bus,
        Self::BusBefore,
        Self::TimesOut,
        Self::FrameShort,
        Self::SyncLost,
        Self::RowsRestart,
        Self::Dead,
        Self::FrameStale,
        Self::FrameSkipped,
        Self::FrameTimesOut,
        Self::FrameFails,
    ];

    /// Whether it is a frame that has the fault, and not a line.
    pub const fn is_of_frames(self) -> bool {
        matches!(self, Self::FrameStale | Self::FrameSkipped | Self::FrameTimesOut | Self::FrameFails)
    }

    /// Its name, for messages.
    pub const fn name(self) -> &'static str {
        match self {
            Self::LineDropped => "a dropped line",
            Self::LinePassedOver => "a line passed over",
            Self::LineRepeated => "a repeated line",
            Self::LineTorn => "a torn line",
            Self::LineLate => "a late line",
            Self::LineStale => "a stale line",
            Self::Bus => "a bus error",
            Self::BusBefore => "a bus error before the line",
            Self::TimesOut => "a time-out",
            Self::FrameShort => "a short frame",
            Self::SyncLost => "lost sync",
            Self::RowsRestart => "rows that begin anew",
            Self::Dead => "a dead camera",
            Self::FrameStale => "a stale frame",
            Self::FrameSkipped => "a skipped frame",
            Self::FrameTimesOut => "a time-out at the frame",
            Self::FrameFails => "a bus error at the frame",
        }
    }
}

/// What was done to a frame.
#[derive(Clone, PartialEq, Eq, Default, Debug)]
pub struct Record {
    /// The fault of the frame itself.
    pub frame: Option<Fault>,
    /// The rows whose lines are lost, in order, and by what.
    pub lost: Vec<(u16, Fault)>,
    /// Lines that came once more.
    pub repeated: u32,
    /// Frames that were left out before this one.
    pub skipped: u32,
    /// The row at which the frame ended with an error, and by what.
    pub ended: Option<(u16, Fault)>,
}

impl Record {
    pub(super) fn lose(&mut self, row: u16, fault: Fault) {
        self.lost.push((row, fault));
    }

    /// How many lines were lost by a fault.
    pub fn count(&self, fault: Fault) -> u32 {
        self.lost.iter().filter(|(_, f)| *f == fault).count() as u32
    }
}
