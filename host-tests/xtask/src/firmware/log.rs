//! The firmware's log, decoded: what the encoded file means stands in the linked one.

use crate::steps::{Failure, Outcome};
use defmt_decoder::{DecodeError, Table};
use std::fs;
use std::path::Path;

/// The file that the firmware writes.
const NAME: &str = "log.defmt";

/// The log's lines, each with its level, of a linked file that an error names so.
pub fn read(elf: &Path, name: &str, folder: &Path) -> Outcome<Vec<String>> {
    let failed = |what: String| Failure::new(format!("the log of {name}: {what}"));
    let elf = fs::read(elf).map_err(|e| failed(e.to_string()))?;
    let table = Table::parse(&elf).map_err(|e| failed(format!("{e:#}")))?;
    let table = table.ok_or_else(|| failed("the program has no section .defmt".into()))?;
    let bytes = fs::read(folder.join(NAME)).map_err(|e| failed(format!("{NAME}: {e}")))?;
    let mut decoder = table.new_stream_decoder();
    decoder.received(&bytes);
    let mut lines = Vec::new();
    loop {
        match decoder.decode() {
            Ok(frame) => {
                let level = frame.level().map_or("print", |level| level.as_str()).to_uppercase();
                lines.push(format!("{level:5} {}", frame.display_message()));
            }
            Err(DecodeError::UnexpectedEof) => return Ok(lines),
            Err(DecodeError::Malformed) => return Err(failed("a message cannot be decoded".into())),
        }
    }
}
