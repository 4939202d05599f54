//! The bytes of calibration files. What comes through a pipe is read once and kept: a format is told by
//! content, for which some files are looked at more than once.

use super::Fault;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The longest calibration file that is read.
pub(super) const MOST_BYTES: usize = crate::limits::CALIBRATION_BYTES as usize;

/// What came through pipes.
static PIPES: Mutex<Vec<(PathBuf, Vec<u8>)>> = Mutex::new(Vec::new());

/// The bytes of a file or of a pipe; of one that is too long, one more than [`MOST_BYTES`].
pub(super) fn bytes(path: &Path) -> Result<Vec<u8>, Fault> {
    let found = fs::metadata(path).map_err(Fault::Read)?;
    if found.is_dir() {
        return Err(Fault::NotText);
    }
    if found.is_file() {
        return read(path).map_err(Fault::Read);
    }
    let mut pipes = PIPES.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, bytes)) = pipes.iter().find(|(known, _)| known == path) {
        return Ok(bytes.clone());
    }
    let bytes = read(path).map_err(Fault::Read)?;
    pipes.push((path.into(), bytes.clone()));
    Ok(bytes)
}

fn read(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(MOST_BYTES as u64 + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}
