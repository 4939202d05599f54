//! What is wrong with a problem's file.

use std::path::PathBuf;

/// Why a file holds no problem: one line that names the file, the place, and what would be right.
#[derive(Debug, thiserror::Error)]
#[error("{}: {fault}", path.display())]
pub struct BalError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong in it.
    pub fault: BalFault,
}

/// What is wrong in a problem's file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BalFault {
    /// The operating system refused to open or read the file.
    #[error("cannot be read ({0}); give a text file in BAL's format")]
    Read(std::io::Error),
    /// The file is compressed.
    #[error("is compressed; unpack it with {0} first")]
    Compressed(&'static str),
    /// The file is no text.
    #[error("is no text; give a text file in BAL's format")]
    Binary,
    /// Nothing is in it.
    #[error("the file is empty; BAL's format begins with the numbers of cameras, points and observations")]
    Empty,
    /// The file ends too early.
    #[error(
        "ends where {what} is due; {cameras} cameras, {points} points and {observations} observations need \
         {needed} numbers, and it has {found}"
    )]
    TooFew {
        /// What is missing.
        what: String,
        /// As the first line says.
        cameras: usize,
        /// As the first line says.
        points: usize,
        /// As the first line says.
        observations: usize,
        /// Numbers that the file needs.
        needed: usize,
        /// Numbers that it has.
        found: usize,
    },
    /// The file goes on after the last point.
    #[error(
        "line {line}: '{found}' stands behind the last point; the first line says {cameras} cameras, \
         {points} points and {observations} observations"
    )]
    TooMany {
        /// The line, from 1.
        line: usize,
        /// What stands there.
        found: String,
        /// As the first line says.
        cameras: usize,
        /// As the first line says.
        points: usize,
        /// As the first line says.
        observations: usize,
    },
    /// A count is none.
    #[error("line {line}: '{found}' is not {what}; a whole number from {least} to {most} is needed")]
    Whole {
        /// The line, from 1.
        line: usize,
        /// What it should be.
        what: String,
        /// What stands there.
        found: String,
        /// The least that can be.
        least: usize,
        /// The most that can be.
        most: usize,
    },
    /// What should be a number is none, or is not finite.
    #[error("line {line}: {what}: '{found}' is not a finite number")]
    NotANumber {
        /// The line, from 1.
        line: usize,
        /// What it should be.
        what: String,
        /// What stands there.
        found: String,
    },
    /// A point lies in the plane of a camera's centre.
    #[error(
        "observation {0}: the point lies in the plane of the camera's centre or is too far off; move the \
         camera or the point"
    )]
    NotSeen(usize),
    /// The problem is too large for this machine.
    #[error("needs {0} bytes of memory, more than there are; leave cameras out")]
    TooLarge(usize),
    /// What the adjustment says otherwise.
    #[error("{0}")]
    Other(stereopsis::motion::bundle::BundleError),
}
