//! The bytes of calibration files. What comes through a pipe is read once and kept: a format is told by
//! content, for which some files are looked at more than once. A page's files are held from the start: it has
//! no others.

use super::Fault;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The longest calibration file that is read.
pub(super) const MOST_BYTES: usize = crate::limits::CALIBRATION_BYTES as usize;

/// What came through pipes, and what a page holds.
static HELD: Mutex<Vec<(PathBuf, Vec<u8>)>> = Mutex::new(Vec::new());

/// Holds the bytes of a file under its name, which is looked for here before it is on a disk.
pub fn hold(path: &Path, bytes: &[u8]) {
    let mut held = HELD.lock().unwrap_or_else(PoisonError::into_inner);
    held.retain(|(known, _)| known != path);
    held.push((path.into(), bytes.get(..MOST_BYTES + 1).unwrap_or(bytes).to_vec()));
}

/// Forgets all files that are held.
pub fn release() {
    HELD.lock().unwrap_or_else(PoisonError::into_inner).clear();
}

/// The bytes of a file that is held.
fn held(path: &Path) -> Option<Vec<u8>> {
    let held = HELD.lock().unwrap_or_else(PoisonError::into_inner);
    held.iter().find(|(known, _)| known == path).map(|(_, bytes)| bytes.clone())
}

/// The bytes of a calibration file, or of a pipe, which is read once for all who ask; of one that is too
/// long, one more than [`CALIBRATION_BYTES`](crate::limits::CALIBRATION_BYTES).
pub fn bytes(path: &Path) -> Result<Vec<u8>, Fault> {
    if let Some(bytes) = held(path) {
        return Ok(bytes);
    }
    let found = fs::metadata(path).map_err(Fault::Read)?;
    if found.is_dir() {
        return Err(Fault::NotText);
    }
    let bytes = read(path).map_err(Fault::Read)?;
    if !found.is_file() {
        hold(path, &bytes);
    }
    Ok(bytes)
}

fn read(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(MOST_BYTES as u64 + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}
