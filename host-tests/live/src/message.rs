//! What was wrong, in one line.

use std::fmt::Display;

/// A line of text: all zero while there is none.
#[derive(Debug, Default)]
pub struct Message(Option<Box<str>>);

impl Message {
    /// No line.
    pub const fn new() -> Self {
        Self(None)
    }

    /// All is well.
    pub fn clear(&mut self) {
        self.0 = None;
    }

    /// Says what is wrong.
    pub fn set(&mut self, error: &dyn Display) {
        self.0 = Some(error.to_string().into_boxed_str());
    }

    /// The line; empty where all is well.
    pub fn as_str(&self) -> &str {
        self.0.as_deref().unwrap_or("")
    }
}
