//! What a program without sizes to choose leaves: a file that has to be the host's, and `summary.json`.

use crate::steps::{Failure, Outcome};
use serde::Serialize;
use std::path::Path;
use stereopsis_host::output::{OutputError, Staging};

/// Whether the board found what the host found; else where their files differ.
pub fn same(file: &str, board: &[u8], host: &[u8]) -> Result<(), String> {
    if board.len() != host.len() {
        return Err(format!("{file} has {} bytes, the host's {}", board.len(), host.len()));
    }
    match board.iter().zip(host).position(|(a, b)| a != b) {
        Some(at) => Err(format!("byte {at} of {file} is not the host's")),
        None => Ok(()),
    }
}

/// Writes `summary.json` into a folder.
pub fn write(summary: &impl Serialize, out: &Path) -> Outcome {
    let write = || -> Result<(), OutputError> {
        let mut staging = Staging::new(out)?;
        staging.write("summary.json", |file| {
            serde_json::to_writer_pretty(&mut *file, summary)?;
            file.write_all(b"\n")
        })?;
        staging.commit(&[])
    };
    write().map_err(|e| Failure::new(format!("--out: {e}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_bit_makes_a_difference() {
        assert_eq!(same("a.bin", &[1, 2, 3], &[1, 2, 3]), Ok(()));
        assert_eq!(same("a.bin", &[1, 2, 3], &[1, 2, 7]).unwrap_err(), "byte 2 of a.bin is not the host's");
        assert_eq!(same("a.bin", &[1, 2], &[1, 2, 3]).unwrap_err(), "a.bin has 2 bytes, the host's 3");
    }
}
