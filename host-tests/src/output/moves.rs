//! Files on their way to their places, all or none.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Renames that are taken back when dropped, unless they are kept.
#[derive(Default)]
pub(super) struct Moves {
    done: Vec<(PathBuf, PathBuf)>,
}

impl Moves {
    /// Renames a file.
    pub fn rename(&mut self, from: &Path, to: &Path) -> io::Result<()> {
        fs::rename(from, to)?;
        self.done.push((from.into(), to.into()));
        Ok(())
    }

    /// Leaves the files where they are now.
    pub fn keep(mut self) {
        self.done.clear();
    }
}

impl Drop for Moves {
    fn drop(&mut self) {
        for (from, to) in self.done.drain(..).rev() {
            // Nothing more can be done about a failure while a failure is being handled.
            let _ = fs::rename(to, from);
        }
    }
}
