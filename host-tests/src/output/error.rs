//! Why results were not written.

use std::io;
use std::path::PathBuf;

/// Why results could not be written: one line that names the place and what would be right.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutputError {
    /// The target exists and is no folder.
    #[error("{}: is not a folder; name a folder for the results", path.display())]
    NotAFolder {
        /// The target.
        path: PathBuf,
    },
    /// What stands in the place of a result is a folder's link, a pipe, a device or a socket.
    #[error("{}: is no regular file; name one, or a new one, for the result", path.display())]
    NotAFile {
        /// The place.
        path: PathBuf,
    },
    /// The result would take the place of what is read.
    #[error("{}: is an input of this run; name another place for the result", path.display())]
    Input {
        /// The place.
        path: PathBuf,
    },
    /// The target cannot be made or written to.
    #[error("{}: cannot be written to ({source}); name a folder that can", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What the operating system says.
        source: io::Error,
    },
    /// A result could not be written; none was kept.
    #[error("{}: cannot be written ({source}); nothing was kept, make room or name another \
        folder", path.display())]
    File {
        /// The file that was asked for.
        path: PathBuf,
        /// What the operating system or the encoder says.
        source: io::Error,
    },
}
