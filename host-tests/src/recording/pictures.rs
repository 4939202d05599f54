//! Images as a stereo source at a frame rate.

use crate::focus::stack;
use crate::limits::IMAGE_SIDE;
use crate::mock::{MockCamera, MockError, significant_bits};
use crate::partners::{alone, partners_of};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use stereopsis::camera::{
    CameraError, CameraPair, ErrorType, FrameStart, LineFormat, LineSource, LineStart, StereoSource,
};
use stereopsis::imaging::GreyLines;

/// Bytes of the longest raw line: RGB with 16 bits.
const RAW: usize = IMAGE_SIDE as usize * 6;
type Pair = CameraPair<GreyLines<MockCamera, RAW>, GreyLines<MockCamera, RAW>>;

/// Why images are no frames.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PicturesError {
    /// An image cannot be played.
    #[error("{0}")]
    Image(#[from] MockError),
    /// A folder cannot be read.
    #[error("{}: cannot be read ({source}); give an image or a folder of images", path.display())]
    Read {
        /// The folder.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// An image of one side has no partner.
    #[error("{}: has no partner in {}; every left image needs a right one", path.display(), other.display())]
    Partner {
        /// The image.
        path: PathBuf,
        /// Where its partner should be.
        other: PathBuf,
    },
    /// The two sides are not the same number of images.
    #[error("{} has {lefts} images and {} has {rights}; give one for each side of every \
        frame", left.display(), right.display())]
    Counts {
        /// The left side.
        left: PathBuf,
        /// Its images.
        lefts: usize,
        /// The right side.
        right: PathBuf,
        /// Its images.
        rights: usize,
    },
    /// A folder has no image.
    #[error("{}: has no PNG, JPEG, PGM/PPM, TIFF, BMP or WebP image", path.display())]
    Empty {
        /// The folder.
        path: PathBuf,
    },
    /// A frame has another size than the first one.
    #[error("{}: is of another size than the first image; all frames must have one size", path.display())]
    Size {
        /// The image.
        path: PathBuf,
    },
}

/// Pairs of images as a stereo source: frames of a simulated clock, over and over.
pub struct Pictures {
    pairs: Vec<(PathBuf, PathBuf)>,
    format: LineFormat,
    /// Significant bits of all images with 16 bits a sample.
    bits: Option<u8>,
    frame_us: f64,
    frames: u32,
    current: Option<Pair>,
    failed: Option<PicturesError>,
}

impl Pictures {
    /// Two images, or two folders whose images belong together by their names, at a frame rate.
    pub fn open(left: &Path, right: &Path, frames_per_second: f64) -> Result<Self, PicturesError> {
        Self::of([(left, images(left)?), (right, images(right)?)], frames_per_second)
    }

    /// The images of the left and of the right side, and what each side is called, at a frame rate.
    pub fn of(
        [(left, lefts), (right, rights)]: [(&Path, Vec<PathBuf>); 2],
        frames_per_second: f64,
    ) -> Result<Self, PicturesError> {
        if let Some((path, is_left)) = alone(&lefts, &rights) {
            let (path, other) = (path.into(), if is_left { right } else { left }.into());
            return Err(PicturesError::Partner { path, other });
        }
        if lefts.len() != rights.len() {
            let (lefts, rights) = (lefts.len(), rights.len());
            return Err(PicturesError::Counts { left: left.into(), lefts, right: right.into(), rights });
        }
        let rights = partners_of(&lefts, rights);
        let bits = significant_bits(lefts.iter().chain(&rights));
        let pairs: Vec<_> = lefts.into_iter().zip(rights).collect();
        let (first, _) = MockCamera::open_pair(&pairs[0].0, &pairs[0].1)?;
        let format = LineFormat { pixel: stereopsis::camera::PixelFormat::Grey8, ..first.format() };
        let frame_us = 1e6 / frames_per_second;
        Ok(Self { pairs, format, bits, frame_us, frames: 0, current: None, failed: None })
    }

    /// How many frames there are before they begin again.
    pub fn frames(&self) -> usize {
        self.pairs.len()
    }

    /// What was wrong with an image, if one could not be played.
    pub fn failed(&mut self) -> Option<PicturesError> {
        self.failed.take()
    }

    fn frame_start_us(&self) -> u64 {
        // The first frame is not at 0, which means that there is no clock.
        (self.frame_us * f64::from(self.frames)) as u64
    }

    fn pair(&self) -> Result<Pair, PicturesError> {
        let (left, right) = &self.pairs[(self.frames as usize - 1) % self.pairs.len()];
        let other_size = || PicturesError::Size { path: left.clone() };
        let (l, r) = MockCamera::open_pair(left, right)?;
        if (l.format().width, l.format().height) != (self.format.width, self.format.height) {
            return Err(other_size());
        }
        let lines =
            |camera: MockCamera| GreyLines::new(camera.with_bits(self.bits)).map_err(|_| other_size());
        CameraPair::new(lines(l)?, lines(r)?, 0).map_err(|_| other_size())
    }
}

/// The images of a folder in the order of their names, numbers by their value, or the one image.
fn images(path: &Path) -> Result<Vec<PathBuf>, PicturesError> {
    let failed = |source| PicturesError::Read { path: path.into(), source };
    if !fs::metadata(path).map_err(failed)?.is_dir() {
        return Ok(vec![path.into()]);
    }
    let images = stack::images(path).map_err(failed)?;
    if images.is_empty() { Err(PicturesError::Empty { path: path.into() }) } else { Ok(images) }
}

impl ErrorType for Pictures {
    type Error = &'static str;
}

impl StereoSource for Pictures {
    fn format(&self) -> LineFormat {
        self.format
    }

    fn max_row_skew_us(&self) -> u32 {
        0
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Self::Error>> {
        self.frames = self.frames.wrapping_add(1);
        let start = || {
            let mut pair = self.pair()?;
            // A file does not fail once it is open.
            let _ = pair.start_frame();
            Ok(pair)
        };
        match start() {
            Ok(pair) => self.current = Some(pair),
            Err(e) => {
                self.failed = Some(e);
                return Err(CameraError::Hardware("an image cannot be played"));
            }
        }
        let exposure_us = (self.frame_us / 2.0) as u32;
        Ok(FrameStart { sequence: self.frames, timestamp_us: self.frame_start_us(), exposure_us })
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Self::Error>> {
        let frame_us = self.frame_start_us();
        let pair = self.current.as_mut().ok_or(CameraError::NoLineLeft)?;
        let line =
            pair.next_lines(left, right).map_err(|e| e.map_hardware(|_| "an image cannot be played"))?;
        let after_us = self.frame_us * f64::from(line.row) / f64::from(self.format.height);
        Ok(LineStart { timestamp_us: frame_us + after_us as u64, ..line })
    }
}
