//! How much is read of an input, at most: one place for the bounds that name an endless or a huge input
//! instead of waiting for it.
//!
//! | input | bound |
//! | --- | --- |
//! | images | [`IMAGE_SIDE`] columns and rows, [`IMAGE_BYTES`], regular files only |
//! | truths, results and masks beside them | the same, also through a pipe: float maps of 10^8 pixels |
//! | calibrations | [`CALIBRATION_BYTES`], elements nested [`DEPTH`] deep |
//! | tables: matches, positions, poses | [`TABLE_BYTES`]; [`MATCHES`] matches |
//! | problems of bundle adjustment | [`PROBLEM_BYTES`] |
//! | the live page's module | [`MODULE_BYTES`] |
//! | anything that comes through a pipe | [`PIPE_BYTES`] too |

pub use stereopsis_rig::limits::{CALIBRATION_BYTES, DEPTH};

use image::{DynamicImage, ImageReader, ImageResult, Limits};
use std::fs::{self, File};
use std::io::{self, Cursor, Read};
use std::path::Path;

/// The most columns and the most rows of an image.
pub const IMAGE_SIDE: u16 = 4096;
/// The longest image file: four samples of 48 bits for each pixel of the largest image.
pub const IMAGE_BYTES: u64 = 24 * (IMAGE_SIDE as u64).pow(2);
/// The most that a decoder of images may allocate: the largest image, RGBA with 16 bits, twice.
pub const DECODER_BYTES: u64 = 16 * (IMAGE_SIDE as u64).pow(2);
/// The longest table.
pub const TABLE_BYTES: u64 = 64 << 20;
/// The most matches of two images.
pub const MATCHES: usize = 100_000;
/// The longest problem of bundle adjustment: twice the largest of "Bundle Adjustment in the Large".
pub const PROBLEM_BYTES: u64 = 2 << 30;
/// The longest module of WebAssembly.
pub const MODULE_BYTES: u64 = 64 << 20;
/// The most that comes through a pipe, whose end is not known before.
pub const PIPE_BYTES: u64 = 64 << 20;

/// Opens an input that may have `most` bytes: of a file that is longer nothing is read, and what comes
/// through a pipe is an error after [`PIPE_BYTES`].
pub fn open(path: &Path, most: u64) -> io::Result<impl Read> {
    let found = fs::metadata(path)?;
    if found.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    if found.is_file() && found.len() > most {
        return Err(too_long(most));
    }
    // A file may grow while it is read.
    let most = if found.is_file() { most } else { most.min(PIPE_BYTES) };
    Ok(Bounded { from: File::open(path)?, left: most, most })
}

/// All bytes of an input that may have `most`.
pub fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open(path, most)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// A picture of these bytes, told by its content, of at most [`IMAGE_SIDE`] columns and rows: the header says
/// how large it is, before anything is decoded.
pub fn picture(bytes: &[u8]) -> ImageResult<DynamicImage> {
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format()?;
    let mut limits = Limits::no_limits();
    (limits.max_image_width, limits.max_image_height) = (Some(IMAGE_SIDE.into()), Some(IMAGE_SIDE.into()));
    limits.max_alloc = Some(DECODER_BYTES);
    reader.limits(limits);
    reader.decode()
}

fn too_long(most: u64) -> io::Error {
    let text = if most >= 1 << 20 { format!("{} MiB", most >> 20) } else { format!("{most} bytes") };
    io::Error::new(io::ErrorKind::FileTooLarge, format!("it is longer than {text}, the most that is read"))
}

/// A file of which so many bytes may come.
struct Bounded {
    from: File,
    left: u64,
    most: u64,
}

impl Read for Bounded {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let count = self.from.read(to)?;
        self.left = self.left.checked_sub(count as u64).ok_or_else(|| too_long(self.most))?;
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::error::{ImageError, LimitErrorKind};
    use std::io::Write;

    #[test]
    fn a_byte_too_many_is_named() {
        let mut file = tempfile::NamedTempFile::new().expect("a temporary file");
        file.write_all(&[7; 1000]).expect("a file");
        assert_eq!(read(file.path(), 1000).expect("not too long"), [7; 1000]);
        let error = read(file.path(), 999).expect_err("too long");
        assert_eq!(error.to_string(), "it is longer than 999 bytes, the most that is read");
        let error = read(Path::new("/"), 9).expect_err("a folder");
        assert_eq!(error.kind(), io::ErrorKind::IsADirectory);
    }

    #[test]
    fn a_picture_larger_than_any_is_refused_by_its_header() {
        let is_too_large = |side: u32| {
            let error = picture(format!("P5\n{side} 1\n255\n").as_bytes()).expect_err("no pixel");
            matches!(error, ImageError::Limits(error) if error.kind() == LimitErrorKind::DimensionError)
        };
        assert!(is_too_large(4097));
        assert!(!is_too_large(4096));
    }
}
