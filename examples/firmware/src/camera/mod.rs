//! Where lines come from: a scene that is computed, or two files on the host.
//!
//! * [`scene`]: the built-in scene. [`pgm`]: the header of a picture. [`files`]: two pictures, read line by
//!   line. [`memory`]: a picture in memory. [`recorded`]: a recording, with its faults.
//! * [`Camera`]: one of the two, as a program takes it. [`timed`]: any camera, its own time measured.

pub mod files;
pub mod memory;
pub mod recorded;
pub use firmware_scenes::{pgm, scene};
pub mod timed;

use core::convert::Infallible;
use files::{FileCamera, FileError};
use scene::{Scene, SceneCamera};
use stereopsis::camera::{CameraError, ErrorType, FrameStart, LineFormat, LineStart, StereoSource};

/// The two files when they are there, else the built-in scene.
pub enum Camera {
    /// `left.pgm` and `right.pgm` in the emulator's working directory.
    Files(FileCamera),
    /// The built-in scene.
    Scene(SceneCamera),
}

impl Camera {
    /// Opens the files; a scene of that size when neither of them is there.
    ///
    /// # Errors
    /// When one of the files is missing, cannot be read, or is not what the other one is.
    pub fn open(scene: Scene) -> Result<Self, FileError> {
        Ok(match FileCamera::open()? {
            Some(files) => Self::Files(files),
            None => Self::Scene(SceneCamera::new(scene)),
        })
    }
}

impl ErrorType for Camera {
    type Error = FileError;
}

impl StereoSource for Camera {
    fn format(&self) -> LineFormat {
        match self {
            Self::Files(camera) => camera.format(),
            Self::Scene(camera) => camera.format(),
        }
    }

    fn max_row_skew_us(&self) -> u32 {
        0
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<FileError>> {
        match self {
            Self::Files(camera) => camera.start_frame(),
            Self::Scene(camera) => camera.start_frame().map_err(without_hardware),
        }
    }

    fn next_lines(&mut self, left: &mut [u8], right: &mut [u8]) -> Result<LineStart, CameraError<FileError>> {
        match self {
            Self::Files(camera) => camera.next_lines(left, right),
            Self::Scene(camera) => camera.next_lines(left, right).map_err(without_hardware),
        }
    }
}

/// An error of a camera whose hardware cannot fail.
fn without_hardware(error: CameraError<Infallible>) -> CameraError<FileError> {
    error.map_hardware(|never| match never {})
}
