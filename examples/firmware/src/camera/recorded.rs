//! A recording of `stereo record` as a camera, over semihosting: lines with their time stamps and faults, as
//! they came.
//!
//! The form is that of the module `recording` of the harness. Sizes are the program's: the two lines of text
//! at the head are passed over.

use crate::host::HostFile;
use core::ffi::CStr;
use stereopsis::camera::{
    CameraError, ErrorType, FrameStart, LineFault, LineFormat, LineStart, PixelFormat, StereoSource,
};

/// What a recording says besides lines.
#[derive(Clone, Copy, PartialEq, Eq, Debug, defmt::Format)]
pub struct HardwareFailed;

/// The file is no recording, or is not there.
#[derive(Clone, Copy, PartialEq, Eq, Debug, defmt::Format)]
pub struct NoRecording;

/// A recording that is played.
pub struct Recorded {
    file: HostFile,
    format: LineFormat,
    /// The kind of the record that comes next; none at the end.
    next: Option<u8>,
    in_frame: bool,
}

impl Recorded {
    /// Opens the file, whose lines are `width` pixels long.
    ///
    /// # Errors
    /// When it is not there, or ends before its first record.
    pub fn open(name: &CStr, width: u16, height: u16) -> Result<Self, NoRecording> {
        let file = HostFile::open(name).ok().flatten().ok_or(NoRecording)?;
        let format = LineFormat { width, height, pixel: PixelFormat::Grey8 };
        let mut recorded = Self { file, format, next: None, in_frame: false };
        for _ in 0..2 {
            while recorded.bytes::<1>().ok_or(NoRecording)? != *b"\n" {}
        }
        recorded.advance();
        Ok(recorded)
    }

    /// Goes to the next frame, or the error in its place; false when all are played.
    pub fn has_frame(&mut self) -> bool {
        self.in_frame = false;
        loop {
            match self.next {
                Some(b'F' | b'S') => return true,
                Some(b'L') => {
                    let _ = self.bytes::<10>();
                    let both = 2 * self.format.width;
                    for _ in 0..both / 64 {
                        let _ = self.bytes::<64>();
                    }
                    for _ in 0..both % 64 {
                        let _ = self.bytes::<1>();
                    }
                }
                Some(b'E') => {
                    let _ = self.bytes::<1>();
                }
                _ => return false,
            }
            self.advance();
        }
    }

    /// So many bytes, where there are as many.
    fn bytes<const N: usize>(&self) -> Option<[u8; N]> {
        let mut bytes = [0; N];
        self.file.read(&mut bytes).ok().filter(|&count| count == N).map(|_| bytes)
    }

    fn advance(&mut self) {
        self.next = self.bytes::<1>().and_then(|kind| kind.first().copied());
    }

    /// The error whose code comes next.
    fn error(&mut self) -> CameraError<HardwareFailed> {
        let code = self.bytes::<1>().and_then(|code| code.first().copied());
        self.advance();
        match code {
            Some(1) => CameraError::LineLost(LineFault::Dropped),
            Some(2) => CameraError::LineLost(LineFault::Torn),
            Some(3) => CameraError::LineLost(LineFault::Late),
            Some(4) => CameraError::LineLost(LineFault::Stale),
            Some(6) => CameraError::TimedOut,
            Some(7) => CameraError::LostSync,
            _ => CameraError::Hardware(HardwareFailed),
        }
    }
}

/// A number with its low byte first.
fn number(bytes: &[u8]) -> u64 {
    bytes.iter().rev().fold(0, |number, &byte| number << 8 | u64::from(byte))
}

impl ErrorType for Recorded {
    type Error = HardwareFailed;
}

impl StereoSource for Recorded {
    fn format(&self) -> LineFormat {
        self.format
    }

    fn max_row_skew_us(&self) -> u32 {
        0
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<HardwareFailed>> {
        if !self.has_frame() {
            return Err(CameraError::TimedOut);
        }
        if self.next == Some(b'S') {
            return Err(self.error());
        }
        let fixed = self.bytes::<16>().ok_or(CameraError::TimedOut)?;
        self.advance();
        self.in_frame = true;
        let of = |from: usize, to: usize| number(fixed.get(from..to).unwrap_or_default());
        Ok(FrameStart { sequence: of(0, 4) as u32, timestamp_us: of(4, 12), exposure_us: of(12, 16) as u32 })
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<HardwareFailed>> {
        let needed = usize::from(self.format.width);
        let (Some(left), Some(right)) = (left.get_mut(..needed), right.get_mut(..needed)) else {
            return Err(CameraError::BufferTooShort { needed });
        };
        match self.next.filter(|_| self.in_frame) {
            Some(b'L') => {
                let fixed = self.bytes::<10>().ok_or(CameraError::TimedOut)?;
                let is_whole = [left, right].map(|line| self.file.read(line) == Ok(needed)) == [true; 2];
                self.advance();
                if !is_whole {
                    return Err(CameraError::TimedOut);
                }
                let of = |from: usize, to: usize| number(fixed.get(from..to).unwrap_or_default());
                Ok(LineStart { row: of(0, 2) as u16, timestamp_us: of(2, 10) })
            }
            Some(b'E') => Err(self.error()),
            _ => Err(CameraError::NoLineLeft),
        }
    }
}
