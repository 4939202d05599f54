//! The frames of a focus stack: the images of a folder, in the order of their names.

use crate::limits::IMAGE_SIDE;
use crate::mock::{MockCamera, MockError, significant_bits};
use alphanumeric_sort::sort_path_slice;
use image::{GrayImage, RgbImage};
use std::convert::Infallible;
use std::io;
use std::path::{Path, PathBuf};
use stereopsis::camera::{CameraError, LineSource};
use stereopsis::imaging::GreyLines;

/// Bytes of the longest raw line: RGB with 16 bits.
const RAW: usize = IMAGE_SIDE as usize * 6;
/// Endings of files that are frames.
const ENDINGS: [&str; 10] = ["png", "jpg", "jpeg", "pgm", "ppm", "pnm", "tif", "tiff", "bmp", "webp"];

/// A frame in grey, as the core sees it, and in colour.
#[derive(Clone, Debug)]
pub struct Frame {
    /// What the core is given.
    pub grey: GrayImage,
    /// For display.
    pub colours: RgbImage,
}

/// The files of a stack.
#[derive(Clone, Debug)]
pub struct Stack {
    files: Vec<PathBuf>,
    size: (u32, u32),
    /// Significant bits of all frames with 16 bits a sample.
    bits: Option<u8>,
}

/// Why a folder is no focus stack.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StackError {
    /// The folder cannot be read.
    #[error("{}: cannot be read ({source}); give a folder of images", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// Too few images for a peak.
    #[error("{}: has {found} images; a focus stack has {FEWEST} to {MOST}", path.display())]
    Count {
        /// The folder.
        path: PathBuf,
        /// How many images there are.
        found: usize,
    },
    /// An image cannot be read.
    #[error(transparent)]
    Image(#[from] MockError),
    /// An image differs in size.
    #[error("{}: is {} x {} and {} is {} x {}; all frames must have one \
        size", path.display(), size.0, size.1, first.display(), first_size.0, first_size.1)]
    Size {
        /// The image.
        path: PathBuf,
        /// Its columns and rows.
        size: (u32, u32),
        /// The first one.
        first: PathBuf,
        /// Its columns and rows.
        first_size: (u32, u32),
    },
    /// A camera on a file failed.
    #[error("{}: {source}", path.display())]
    Camera {
        /// The image.
        path: PathBuf,
        /// Why.
        source: CameraError<Infallible>,
    },
}

const FEWEST: usize = 3;
const MOST: usize = u16::MAX as usize;

impl Stack {
    /// The images of a folder in the order of their names, byte by byte. Hidden files, and files whose ending
    /// is not that of an image, are passed over. Of frames with 16 bits a sample one number of bits is
    /// significant, so that equal brightness stays equal: all of them are read for it.
    pub fn open(folder: &Path) -> Result<Self, StackError> {
        let files = images(folder).map_err(|source| StackError::Folder { path: folder.into(), source })?;
        if !(FEWEST..=MOST).contains(&files.len()) {
            return Err(StackError::Count { path: folder.into(), found: files.len() });
        }
        let size = read(&files[0], None)?.grey.dimensions();
        let bits = significant_bits(&files);
        Ok(Self { files, size, bits })
    }

    /// How many frames there are, 3 at least.
    pub fn len(&self) -> usize {
        self.files.len()
    }

    /// Whether there is none, which is never so.
    pub fn is_empty(&self) -> bool {
        self.files.is_empty()
    }

    /// Columns and rows of all frames.
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// The file of a frame.
    pub fn file(&self, index: usize) -> &Path {
        &self.files[index]
    }

    /// Reads a frame, counted from 0.
    ///
    /// # Panics
    ///
    /// When there is no such frame.
    pub fn frame(&self, index: usize) -> Result<Frame, StackError> {
        let path = &self.files[index];
        let frame = read(path, self.bits)?;
        let size = frame.grey.dimensions();
        if size != self.size {
            let first = self.files[0].clone();
            return Err(StackError::Size { path: path.clone(), size, first, first_size: self.size });
        }
        Ok(frame)
    }
}

/// The images of a folder in the order of their names, numbers by their value: `f2` comes before `f10`.
pub fn images(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        let ending = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        let is_hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
        if !is_hidden && ENDINGS.contains(&ending.as_str()) && !path.is_dir() {
            files.push(path);
        }
    }
    sort_path_slice(&mut files);
    Ok(files)
}

/// An image in grey, as the core sees it, and in colour; `bits` are the significant ones of 16-bit samples
/// where others have more than its own.
pub fn read(path: &Path, bits: Option<u8>) -> Result<Frame, StackError> {
    let failed = |source| StackError::Camera { path: path.into(), source };
    let camera = MockCamera::open(path)?.with_bits(bits);
    let colours = camera.picture();
    let mut lines = GreyLines::<_, RAW>::new(camera).map_err(failed)?;
    let format = lines.format();
    let mut grey = GrayImage::new(format.width.into(), format.height.into());
    lines.start_frame().map_err(failed)?;
    for line in grey.chunks_exact_mut(format.width.into()) {
        lines.next_line(line).map_err(failed)?;
    }
    Ok(Frame { grey, colours })
}
