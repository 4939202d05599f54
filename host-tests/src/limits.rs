//! How much is read of an input, at most: one place for the bounds that name an endless or a huge input
//! instead of waiting for it.
//!
//! | input | bound |
//! | --- | --- |
//! | images | [`IMAGE_SIDE`] columns and rows, [`IMAGE_BYTES`], regular files only |
//! | calibrations | [`CALIBRATION_BYTES`], elements nested [`DEPTH`] deep |
//! | tables: matches, positions, poses | [`TABLE_BYTES`]; [`MATCHES`] matches |
//! | problems of bundle adjustment | [`PROBLEM_BYTES`] |
//! | anything that comes through a pipe | [`PIPE_BYTES`] too |

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// The most columns and the most rows of an image.
pub const IMAGE_SIDE: u16 = 4096;
/// The longest image file: four samples of 48 bits for each pixel of the largest image.
pub const IMAGE_BYTES: u64 = 24 * (IMAGE_SIDE as u64).pow(2);
/// The longest calibration file.
pub const CALIBRATION_BYTES: u64 = 1 << 20;
/// How deep a calibration file's elements may be nested.
pub const DEPTH: usize = 64;
/// The longest table.
pub const TABLE_BYTES: u64 = 64 << 20;
/// The most matches of two images.
pub const MATCHES: usize = 100_000;
/// The longest problem of bundle adjustment: twice the largest of "Bundle Adjustment in the Large".
pub const PROBLEM_BYTES: u64 = 2 << 30;
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
}
