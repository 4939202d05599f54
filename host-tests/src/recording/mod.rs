//! Lines of two cameras as they came, with their time stamps and faults, in a file: to bring a failure in the
//! field to the desk.
//!
//! * [`record()`]: a stereo source into a file. [`Recording`]: such a file. [`Playback`]: it as a stereo
//!   source again.
//! * [`Ahead`]: its records with both cameras of one exposure, each frame measured before it is played.
//! * [`first_pairs()`]: the pictures of its first frames, before it is played.
//! * [`Pictures`]: images, or folders of them, as a stereo source at a frame rate.
//!
//! A recording begins with a line of text, `stereopsis recording 1`, and a line of JSON: `width`, `height`,
//! `max_row_skew_us`. Records follow, all numbers with the low byte first:
//!
//! | record | bytes |
//! | --- | --- |
//! | frame | `F`, sequence (4), time stamp in us (8), exposure in us (4) |
//! | line | `L`, row (2), time stamp in us (8), the left line, the right line: a byte a pixel |
//! | fault | `E`, or `S` at the start of a frame; number of the fault (1) |
//!
//! Faults are 1 dropped, 2 torn, 3 late, 4 stale, 5 hardware, 6 timed out, 7 sync lost.
//!
//! A file that ends within a record is played up to there: what wrote it may have failed as well.

mod ahead;
mod first;
mod pictures;
mod playback;

pub use ahead::{Ahead, Seen};
pub use first::{FromStart, first_pairs};
pub use pictures::{Pictures, PicturesError};
pub use playback::{Playback, RecordedFault};

use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use stereopsis::camera::{CameraError, FrameStart, LineFault, LineStart, StereoSource};

const TITLE: &str = "stereopsis recording 1";
/// The longest line of JSON.
const MOST_HEADER: u64 = 1000;
const MOST_PIXELS: u16 = crate::limits::IMAGE_SIDE;

/// What is known about a recording before its records.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct Header {
    /// Pixels in a line.
    pub width: u16,
    /// Lines in a frame.
    pub height: u16,
    /// The bound on the row skew, microseconds.
    pub max_row_skew_us: u32,
}

/// Why a recording cannot be played.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// The file cannot be read.
    #[error("{}: cannot be read ({source}); give a recording by `stereo record`, or a folder with left and \
        right", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// It does not begin as a recording.
    #[error("{}: is no recording; give one by `stereo record`, or a folder with left and \
        right", path.display())]
    NotARecording {
        /// The file.
        path: PathBuf,
    },
    /// Its frames have no size that can be played.
    #[error("{}: frames of {width} x {height}; 1 x 1 to {MOST_PIXELS} x {MOST_PIXELS} can be \
        played", path.display())]
    Size {
        /// The file.
        path: PathBuf,
        /// Pixels in a line.
        width: u16,
        /// Lines in a frame.
        height: u16,
    },
    /// There is a record of no known kind.
    #[error("{}: is corrupt at byte {at}: no record begins with {kind:#04x}", path.display())]
    Corrupt {
        /// The file.
        path: PathBuf,
        /// Where.
        at: u64,
        /// What stands there.
        kind: u8,
    },
}

/// One record.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Entry {
    /// A frame began.
    Frame(FrameStart),
    /// A row came.
    Line {
        /// Its number and time.
        start: LineStart,
        /// The left camera's line.
        left: Vec<u8>,
        /// The right camera's line.
        right: Vec<u8>,
    },
    /// No frame began.
    NoFrame(RecordedFault),
    /// No row came.
    NoLine(RecordedFault),
    /// The file ends within a record.
    Cut,
}

impl Entry {
    /// Whether it is of a frame that began: a row that came, or did not.
    fn is_of_frame(&self) -> bool {
        matches!(self, Self::Line { .. } | Self::NoLine(_))
    }
}

/// A recording that is read record by record.
pub struct Recording {
    path: PathBuf,
    header: Header,
    from: Box<dyn BufRead + Send>,
    at: u64,
    is_over: bool,
}

impl Recording {
    /// Opens a file.
    pub fn open(path: &Path) -> Result<Self, RecordingError> {
        let failed = |source| RecordingError::Read { path: path.into(), source };
        Self::read(path, Box::new(BufReader::new(File::open(path).map_err(failed)?)))
    }

    /// Reads from anywhere; `path` is what errors name.
    pub fn read(path: &Path, mut from: Box<dyn BufRead + Send>) -> Result<Self, RecordingError> {
        let mut line = |most| -> Result<String, RecordingError> {
            let (mut text, not) = (Vec::new(), || RecordingError::NotARecording { path: path.into() });
            let failed = |source| RecordingError::Read { path: path.into(), source };
            (&mut from).take(most).read_until(b'\n', &mut text).map_err(failed)?;
            if text.pop() != Some(b'\n') {
                return Err(not());
            }
            String::from_utf8(text).map_err(|_| not())
        };
        let (title, json) = (line(TITLE.len() as u64 + 1)?, line(MOST_HEADER)?);
        let header = serde_json::from_str::<Header>(&json).ok().filter(|_| title == TITLE);
        let header = header.ok_or_else(|| RecordingError::NotARecording { path: path.into() })?;
        let Header { width, height, .. } = header;
        if !(1..=MOST_PIXELS).contains(&width) || !(1..=MOST_PIXELS).contains(&height) {
            return Err(RecordingError::Size { path: path.into(), width, height });
        }
        let at = (title.len() + json.len() + 2) as u64;
        Ok(Self { path: path.into(), header, from, at, is_over: false })
    }

    /// What is known about all of it.
    pub fn header(&self) -> Header {
        self.header
    }

    /// The next record, with where it is for errors.
    fn entry(&mut self) -> Result<Option<Entry>, RecordingError> {
        let mut kind = [0];
        if self.is_over || !self.fill(&mut kind)? {
            return Ok(None);
        }
        let at = self.at - 1;
        let corrupt = |kind| RecordingError::Corrupt { path: self.path.clone(), at, kind };
        let length = match kind[0] {
            b'F' => 16,
            b'L' => 10,
            b'E' | b'S' => 1,
            kind => return Err(corrupt(kind)),
        };
        let mut fixed = vec![0; length];
        let (mut left, mut right) = (vec![0; self.header.width.into()], vec![0; self.header.width.into()]);
        let has_lines = kind[0] == b'L';
        if !self.fill(&mut fixed)? || has_lines && (!self.fill(&mut left)? || !self.fill(&mut right)?) {
            self.is_over = true;
            return Ok(Some(Entry::Cut));
        }
        let number = |from: usize, length: usize| {
            fixed[from..from + length].iter().rev().fold(0, |number, &byte| number << 8 | u64::from(byte))
        };
        let corrupt = || RecordingError::Corrupt { path: self.path.clone(), at: at + 1, kind: fixed[0] };
        Ok(Some(match kind[0] {
            b'F' => Entry::Frame(FrameStart {
                sequence: number(0, 4) as u32,
                timestamp_us: number(4, 8),
                exposure_us: number(12, 4) as u32,
            }),
            b'L' => {
                let start = LineStart { row: number(0, 2) as u16, timestamp_us: number(2, 8) };
                Entry::Line { start, left, right }
            }
            b'S' => Entry::NoFrame(RecordedFault::from_code(fixed[0]).ok_or_else(corrupt)?),
            _ => Entry::NoLine(RecordedFault::from_code(fixed[0]).ok_or_else(corrupt)?),
        }))
    }

    /// Fills `bytes`; false where the file ends before.
    fn fill(&mut self, bytes: &mut [u8]) -> Result<bool, RecordingError> {
        match self.from.read_exact(bytes) {
            Ok(()) => {
                self.at += bytes.len() as u64;
                Ok(true)
            }
            Err(e) if e.kind() == io::ErrorKind::UnexpectedEof => Ok(false),
            Err(source) => Err(RecordingError::Read { path: self.path.clone(), source }),
        }
    }
}

impl Iterator for Recording {
    type Item = Result<Entry, RecordingError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.entry().transpose()
    }
}

/// What was recorded.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug, Serialize)]
pub struct Recorded {
    /// Frames that began.
    pub frames: u32,
    /// Rows that came.
    pub lines: u32,
    /// Errors.
    pub faults: u32,
}

/// How many records of rows a frame has at most: a source may repeat lines and fail, but not without an end.
fn most_rows(height: u16) -> u32 {
    4 * u32::from(height)
}

/// Writes the next `frames` frames of a source, errors as well.
pub fn record<S: StereoSource>(source: &mut S, frames: u32, out: &mut dyn Write) -> io::Result<Recorded> {
    let format = source.format();
    let header =
        Header { width: format.width, height: format.height, max_row_skew_us: source.max_row_skew_us() };
    writeln!(out, "{TITLE}\n{}", serde_json::to_string(&header).map_err(io::Error::other)?)?;
    let (mut left, mut right) = (vec![0; format.width.into()], vec![0; format.width.into()]);
    let mut report = Recorded::default();
    for _ in 0..frames {
        match source.start_frame() {
            Ok(start) => {
                report.frames += 1;
                out.write_all(b"F")?;
                out.write_all(&start.sequence.to_le_bytes())?;
                out.write_all(&start.timestamp_us.to_le_bytes())?;
                out.write_all(&start.exposure_us.to_le_bytes())?;
            }
            Err(e) => {
                report.faults += 1;
                out.write_all(&[b'S', RecordedFault::of(&e).code()])?;
                continue;
            }
        }
        for _ in 0..most_rows(format.height) {
            match source.next_lines(&mut left, &mut right) {
                Ok(start) => {
                    report.lines += 1;
                    out.write_all(b"L")?;
                    out.write_all(&start.row.to_le_bytes())?;
                    out.write_all(&start.timestamp_us.to_le_bytes())?;
                    out.write_all(&left)?;
                    out.write_all(&right)?;
                }
                // That no line is left is said by the frame that follows.
                Err(CameraError::NoLineLeft) => break,
                Err(e) => {
                    report.faults += 1;
                    out.write_all(&[b'E', RecordedFault::of(&e).code()])?;
                    if e.map_hardware(|_| ()) == CameraError::LostSync {
                        break;
                    }
                }
            }
        }
    }
    out.flush()?;
    Ok(report)
}

/// The faults of lines with their codes.
const LINE_FAULTS: [(u8, LineFault); 4] =
    [(1, LineFault::Dropped), (2, LineFault::Torn), (3, LineFault::Late), (4, LineFault::Stale)];
