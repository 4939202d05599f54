//! A camera over semihosting: two pictures on the host, `left.pgm` and `right.pgm`, read a line at a time.

use super::pgm::{self, HeaderError};
use crate::host::HostFile;
use core::ffi::CStr;
use stereopsis::camera::{
    CameraError, ErrorType, FrameStart, LineFormat, LineStart, PixelFormat, StereoSource,
};

/// The left picture.
const LEFT: &CStr = c"left.pgm";
/// The right picture.
const RIGHT: &CStr = c"right.pgm";

/// Which of the two files.
#[derive(Clone, Copy, PartialEq, Eq, Debug, defmt::Format)]
pub enum Side {
    /// `left.pgm`.
    Left,
    /// `right.pgm`.
    Right,
}

/// What is wrong with a file.
#[derive(Clone, Copy, PartialEq, Eq, Debug, defmt::Format)]
#[non_exhaustive]
pub enum Fault {
    /// It is not there, and the other one is.
    Missing,
    /// The host does not let it be opened.
    Open,
    /// The host does not let it be read.
    Read,
    /// It ends before its last line.
    Ends,
    /// Its header is not that of an 8-bit grey picture.
    Header(HeaderError),
    /// It is not of the left one's size.
    Size {
        /// Pixels in a line.
        width: u16,
        /// Lines.
        height: u16,
    },
}

impl From<HeaderError> for Fault {
    fn from(error: HeaderError) -> Self {
        Self::Header(error)
    }
}

/// Why a file gave no line.
#[derive(Clone, Copy, PartialEq, Eq, Debug, defmt::Format)]
pub struct FileError {
    /// Which file.
    pub side: Side,
    /// What is wrong with it.
    pub fault: Fault,
}

/// The two pictures as cameras.
pub struct FileCamera {
    left: HostFile,
    right: HostFile,
    format: LineFormat,
    frames: u32,
    row: u16,
}

impl FileCamera {
    /// Opens both files and reads their headers; `None` when neither is there.
    ///
    /// # Errors
    /// When one of the files is missing, cannot be read, or is not what the other one is.
    pub fn open() -> Result<Option<Self>, FileError> {
        let (left, right) = match (open(Side::Left)?, open(Side::Right)?) {
            (Some(left), Some(right)) => (left, right),
            (None, None) => return Ok(None),
            (None, Some(_)) => return Err(FileError { side: Side::Left, fault: Fault::Missing }),
            (Some(_), None) => return Err(FileError { side: Side::Right, fault: Fault::Missing }),
        };
        let of = |side| move |fault| FileError { side, fault };
        let (width, height) = size(&left).map_err(of(Side::Left))?;
        let found = size(&right).map_err(of(Side::Right))?;
        if found != (width, height) {
            return Err(of(Side::Right)(Fault::Size { width: found.0, height: found.1 }));
        }
        let format = LineFormat { width, height, pixel: PixelFormat::Grey8 };
        Ok(Some(Self { left, right, format, frames: 0, row: height }))
    }
}

/// A file, if it is there.
fn open(side: Side) -> Result<Option<HostFile>, FileError> {
    let name = match side {
        Side::Left => LEFT,
        Side::Right => RIGHT,
    };
    HostFile::open(name).map_err(|_| FileError { side, fault: Fault::Open })
}

/// Width and height; the file is left at its first pixel.
fn size(file: &HostFile) -> Result<(u16, u16), Fault> {
    pgm::header(|| {
        let mut byte = [0];
        match file.read(&mut byte) {
            Ok(0) => Ok(None),
            Ok(_) => Ok(Some(byte[0])),
            Err(_) => Err(Fault::Read),
        }
    })
}

/// Fills a line.
fn read(file: &HostFile, line: &mut [u8]) -> Result<(), Fault> {
    match file.read(line) {
        Ok(count) if count == line.len() => Ok(()),
        Ok(_) => Err(Fault::Ends),
        Err(_) => Err(Fault::Read),
    }
}

impl ErrorType for FileCamera {
    type Error = FileError;
}

impl StereoSource for FileCamera {
    fn format(&self) -> LineFormat {
        self.format
    }

    fn max_row_skew_us(&self) -> u32 {
        0
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<FileError>> {
        // The files stand at their first pixel: they hold one frame, and after it there is no line left.
        self.row = if self.frames == 0 { 0 } else { self.format.height };
        self.frames = self.frames.wrapping_add(1);
        Ok(FrameStart { sequence: self.frames, ..FrameStart::default() })
    }

    fn next_lines(&mut self, left: &mut [u8], right: &mut [u8]) -> Result<LineStart, CameraError<FileError>> {
        let row = self.row;
        if row >= self.format.height {
            return Err(CameraError::NoLineLeft);
        }
        let needed = usize::from(self.format.width);
        let (Some(left), Some(right)) = (left.get_mut(..needed), right.get_mut(..needed)) else {
            return Err(CameraError::BufferTooShort { needed });
        };
        let of = |side| move |fault| CameraError::Hardware(FileError { side, fault });
        read(&self.left, left).map_err(of(Side::Left))?;
        read(&self.right, right).map_err(of(Side::Right))?;
        self.row = row + 1;
        Ok(LineStart { row, timestamp_us: 0 })
    }
}
