//! What the program says when it cannot do what is asked: one line.

use std::fmt;

/// One line that names the file or the option, and what would be right.
#[derive(Debug)]
pub struct Failure {
    line: String,
    is_usage: bool,
}

impl Failure {
    /// From a finished line.
    pub fn new(line: impl Into<String>) -> Self {
        Self { line: line.into(), is_usage: false }
    }

    /// Of a wrong command line, from a finished line.
    pub fn usage(line: impl Into<String>) -> Self {
        Self { line: line.into(), is_usage: true }
    }

    /// The same of a part of the work, which is named first.
    pub fn of(self, part: &str) -> Self {
        Self { line: format!("{part}: {}", self.line), ..self }
    }

    /// Whether the command line is wrong.
    pub fn is_usage(&self) -> bool {
        self.is_usage
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.line)
    }
}

/// The library's errors name their file or folder themselves.
impl<E: std::error::Error> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::new(error.to_string())
    }
}
