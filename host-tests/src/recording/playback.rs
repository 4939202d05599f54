//! A recording as a stereo source.

use super::{Entry, Header, LINE_FAULTS, RecordingError};
use std::fmt;
use std::iter::Peekable;
use std::time::{Duration, Instant};
use stereopsis::camera::{
    CameraError, ErrorType, FrameStart, LineFault, LineFormat, LineStart, PixelFormat, StereoSource,
};

/// An error that was recorded.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum RecordedFault {
    /// A line was lost.
    Line(LineFault),
    /// The hardware failed; what it said is not recorded.
    Hardware,
    /// Nothing came in time.
    TimedOut,
    /// The frame broke off.
    LostSync,
}

impl fmt::Display for RecordedFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(fault) => write!(f, "{fault}"),
            Self::Hardware => f.write_str("the camera's hardware failed"),
            Self::TimedOut => f.write_str("the camera gave nothing in time"),
            Self::LostSync => f.write_str("the sensor's frame broke off"),
        }
    }
}

impl RecordedFault {
    /// What is recorded of an error.
    pub(super) fn of<E>(error: &CameraError<E>) -> Self {
        match error {
            CameraError::LineLost(fault) => Self::Line(*fault),
            CameraError::TimedOut => Self::TimedOut,
            CameraError::LostSync => Self::LostSync,
            _ => Self::Hardware,
        }
    }

    pub(super) fn code(self) -> u8 {
        match self {
            Self::Line(fault) => LINE_FAULTS.iter().find(|(_, f)| *f == fault).map_or(1, |(code, _)| *code),
            Self::Hardware => 5,
            Self::TimedOut => 6,
            Self::LostSync => 7,
        }
    }

    pub(super) fn from_code(code: u8) -> Option<Self> {
        match code {
            5 => Some(Self::Hardware),
            6 => Some(Self::TimedOut),
            7 => Some(Self::LostSync),
            _ => LINE_FAULTS.iter().find(|(c, _)| *c == code).map(|(_, fault)| Self::Line(*fault)),
        }
    }

    /// The error again.
    fn error(self) -> CameraError<Self> {
        match self {
            Self::Line(fault) => CameraError::LineLost(fault),
            Self::Hardware => CameraError::Hardware(self),
            Self::TimedOut => CameraError::TimedOut,
            Self::LostSync => CameraError::LostSync,
        }
    }
}

/// The longest pause of a recording that is waited for.
const LONGEST_WAIT: Duration = Duration::from_secs(10);

/// Plays records as the source did that they are of.
pub struct Playback<I: Iterator<Item = Result<Entry, RecordingError>>> {
    entries: Peekable<I>,
    header: Header,
    /// Waits until the time of each record, as it was recorded.
    is_timed: bool,
    /// When the first record was played, and its time stamp.
    began: Option<(Instant, u64)>,
    in_frame: bool,
    /// Frames played, the stamp of the last one, and the first that has one of before.
    frames: u32,
    last_us: u64,
    went_back: Option<u32>,
    was_cut: bool,
    failed: Option<RecordingError>,
}

impl<I: Iterator<Item = Result<Entry, RecordingError>>> Playback<I> {
    /// Plays the records of such a recording, at the speed at which it was recorded or as fast as they are
    /// taken.
    pub fn new(entries: I, header: Header, is_timed: bool) -> Self {
        Self {
            entries: entries.peekable(),
            header,
            is_timed,
            began: None,
            in_frame: false,
            frames: 0,
            last_us: 0,
            went_back: None,
            was_cut: false,
            failed: None,
        }
    }

    /// Goes to the next frame, or error in its place; false when all are played.
    pub fn has_frame(&mut self) -> bool {
        self.in_frame = false;
        loop {
            match self.entries.peek() {
                Some(Ok(Entry::Frame(_) | Entry::NoFrame(_))) => return true,
                Some(Ok(entry)) => {
                    self.was_cut |= *entry == Entry::Cut;
                    self.entries.next();
                }
                Some(Err(_)) | None => {
                    self.take_error();
                    return false;
                }
            }
        }
    }

    /// Whether the recording ended within a record.
    pub fn was_cut(&self) -> bool {
        self.was_cut
    }

    /// The first frame, from 1, whose time stamp is of before that of the frame before.
    pub fn went_back(&self) -> Option<u32> {
        self.went_back
    }

    /// The error of the recording itself at which it ended.
    pub fn failed(&mut self) -> Option<RecordingError> {
        self.failed.take()
    }

    fn take_error(&mut self) {
        if let Some(Err(e)) = self.entries.next_if(Result::is_err) {
            self.failed = Some(e);
        }
    }

    /// Waits until it is time for what has this stamp; a source without a clock does not wait. Where the
    /// stamps jump, back or by more than [`LONGEST_WAIT`], time begins anew.
    fn wait(&mut self, timestamp_us: u64) {
        if !self.is_timed || timestamp_us == 0 {
            return;
        }
        let (began, first_us) = *self.began.get_or_insert((Instant::now(), timestamp_us));
        let due = timestamp_us.checked_sub(first_us).map(Duration::from_micros);
        match due.map(|due| due.saturating_sub(began.elapsed())) {
            Some(wait) if wait <= LONGEST_WAIT => std::thread::sleep(wait),
            _ => self.began = Some((Instant::now(), timestamp_us)),
        }
    }
}

impl<I: Iterator<Item = Result<Entry, RecordingError>>> ErrorType for Playback<I> {
    type Error = RecordedFault;
}

impl<I: Iterator<Item = Result<Entry, RecordingError>>> StereoSource for Playback<I> {
    fn format(&self) -> LineFormat {
        LineFormat { width: self.header.width, height: self.header.height, pixel: PixelFormat::Grey8 }
    }

    fn max_row_skew_us(&self) -> u32 {
        self.header.max_row_skew_us
    }

    /// After the last frame nothing comes any more: [`CameraError::TimedOut`].
    fn start_frame(&mut self) -> Result<FrameStart, CameraError<RecordedFault>> {
        if !self.has_frame() {
            return Err(CameraError::TimedOut);
        }
        match self.entries.next() {
            Some(Ok(Entry::Frame(start))) => {
                self.wait(start.timestamp_us);
                self.in_frame = true;
                self.frames += 1;
                if start.timestamp_us != 0 {
                    if start.timestamp_us < self.last_us {
                        self.went_back.get_or_insert(self.frames);
                    }
                    self.last_us = start.timestamp_us;
                }
                Ok(start)
            }
            Some(Ok(Entry::NoFrame(fault))) => Err(fault.error()),
            _ => Err(CameraError::TimedOut),
        }
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<RecordedFault>> {
        let needed = usize::from(self.header.width);
        let (Some(to_left), Some(to_right)) = (left.get_mut(..needed), right.get_mut(..needed)) else {
            return Err(CameraError::BufferTooShort { needed });
        };
        match self.entries.next_if(|entry| self.in_frame && entry.as_ref().is_ok_and(Entry::is_of_frame)) {
            Some(Ok(Entry::Line { start, left, right })) => {
                self.wait(start.timestamp_us);
                to_left.copy_from_slice(&left);
                to_right.copy_from_slice(&right);
                Ok(start)
            }
            Some(Ok(Entry::NoLine(fault))) => Err(fault.error()),
            _ => Err(CameraError::NoLineLeft),
        }
    }
}
