//! What the program says when it cannot do what is asked: one line.

use std::fmt;

/// One line that names the file or the option, and what would be right.
#[derive(Debug)]
pub struct Failure(String);

impl Failure {
    /// From a finished line.
    pub fn new(line: impl Into<String>) -> Self {
        Self(line.into())
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// The library's errors name their file or folder themselves.
impl<E: std::error::Error> From<E> for Failure {
    fn from(error: E) -> Self {
        Self(error.to_string())
    }
}
