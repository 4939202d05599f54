//! What a folder that is finished says of its pair: it is not matched again while that is the same.

use crate::failure::Failure;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use stereopsis_host::output::Staging;

/// The file's name.
pub const FINISHED: &str = "finished.json";

/// What results depend on.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Mark {
    version: String,
    /// A hash of the images and of what they share.
    content: String,
    settings: String,
}

/// What stands in the file.
#[derive(Serialize, Deserialize)]
struct Finished {
    #[serde(flatten)]
    mark: Mark,
    /// The results, with their lengths in bytes.
    files: BTreeMap<String, u64>,
}

impl Mark {
    /// Of the bytes of all files that are read, and of the settings.
    pub fn new<'a>(content: impl Iterator<Item = &'a u8>, settings: &str) -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            content: format!("{:016x}", fnv(content)),
            settings: settings.to_owned(),
        }
    }

    /// Whether a folder is finished with this, and has its files as they were written.
    pub fn is_in(&self, folder: &Path) -> bool {
        let found = fs::read(folder.join(FINISHED)).ok();
        let found = found.and_then(|text| serde_json::from_slice::<Finished>(&text).ok());
        found.is_some_and(|Finished { mark, files }| {
            let is_whole = |(name, &length): (&String, &u64)| {
                fs::metadata(folder.join(name)).is_ok_and(|file| file.is_file() && file.len() == length)
            };
            mark == *self && files.iter().all(is_whole)
        })
    }

    /// Writes it beside the results that are written.
    pub fn write(&self, staging: &mut Staging) -> Result<(), Failure> {
        let finished = Finished { mark: self.clone(), files: staging.lengths()? };
        let text = serde_json::to_string_pretty(&finished)? + "\n";
        Ok(staging.write(FINISHED, |out| out.write_all(text.as_bytes()))?)
    }
}

/// Fowler, Noll and Vo's hash, 1a, of 64 bits: the same in every version.
fn fnv<'a>(bytes: impl Iterator<Item = &'a u8>) -> u64 {
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of the authors' page.
    #[test]
    fn hashes_are_the_published_ones() {
        assert_eq!(fnv(b"".iter()), 0xcbf2_9ce4_8422_2325);
        assert_eq!(fnv(b"a".iter()), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(fnv(b"foobar".iter()), 0x8594_4171_f739_67e8);
    }
}
