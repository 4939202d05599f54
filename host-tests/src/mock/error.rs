//! Why an image file is no camera.

use crate::limits::IMAGE_SIDE;
use std::io;
use std::path::PathBuf;

/// Why an image file cannot be played: one line that names the file and what would be right.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MockError {
    /// The operating system refused to open or read the file.
    #[error("{}: cannot be read ({source}); give {WANTED}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// The path leads to a folder or a device.
    #[error("{}: is not a file; give {WANTED}", path.display())]
    NotAFile {
        /// The path.
        path: PathBuf,
    },
    /// The file has no byte.
    #[error("{}: the file is empty; give {WANTED}", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// The file is longer than any image of the largest size can be.
    #[error("{}: the file has more than {most} bytes; give {WANTED} of at most {MOST} x {MOST} \
        pixels", path.display())]
    FileTooLong {
        /// The file.
        path: PathBuf,
        /// The longest file that is read, bytes.
        most: u64,
    },
    /// The first bytes are those of no format that is read.
    #[error("{}: is no image that can be read; give {WANTED}", path.display())]
    NotAnImage {
        /// The file.
        path: PathBuf,
    },
    /// The file ends before the picture does.
    #[error("{}: the {format} file is truncated: it ends before the picture does; give the whole \
        file", path.display())]
    Truncated {
        /// The file.
        path: PathBuf,
        /// The name of its format.
        format: &'static str,
    },
    /// The file's content contradicts its format.
    #[error("{}: the {format} file is corrupt ({reason}); give one that decodes", path.display())]
    Corrupt {
        /// The file.
        path: PathBuf,
        /// The name of its format.
        format: &'static str,
        /// What the decoder says.
        reason: String,
    },
    /// The samples are neither 8 nor 16 bits, or the colour model is not read.
    #[error("{}: has samples of a kind that is not read ({found}); give 8 or 16 bits, grey or \
        RGB", path.display())]
    Samples {
        /// The file.
        path: PathBuf,
        /// What the file holds.
        found: String,
    },
    /// More columns or rows than a camera may have.
    #[error("{}: is {width} x {height}; the limit is {MOST} x {MOST} pixels", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// No column or no row.
    #[error("{}: is {width} x {height}; at least 1 x 1 pixel is needed", path.display())]
    ZeroSize {
        /// The file.
        path: PathBuf,
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// The two images of a pair differ in size.
    #[error(
        "{} is {} x {} and {} is {} x {}; the two images must have one size",
        left.display(), left_size.0, left_size.1, right.display(), right_size.0, right_size.1
    )]
    Sizes {
        /// The left image's file.
        left: PathBuf,
        /// Its columns and rows.
        left_size: (u16, u16),
        /// The right image's file.
        right: PathBuf,
        /// Its columns and rows.
        right_size: (u16, u16),
    },
}

const MOST: u16 = IMAGE_SIDE;
const WANTED: &str = "a PNG, JPEG, PGM/PPM, TIFF, BMP or WebP image";
