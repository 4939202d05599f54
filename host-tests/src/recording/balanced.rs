//! Records with the right camera's lines as the left one would have exposed them.

use super::{Entry, Header, RecordingError, most_rows};
use crate::run::{MemoryPair, measure_balance};
use std::collections::VecDeque;
use std::iter::Peekable;
use std::sync::atomic::{AtomicU32, Ordering};
use stereopsis::imaging::Balance;

/// Any records with every frame [balanced](Balance) by its own lines, those that came. (A device has not seen them when the first
/// row goes out: there a [`BalancedPair`](stereopsis::imaging::BalancedPair) goes by the frame before.)
pub struct Balanced<'a, I: Iterator<Item = Result<Entry, RecordingError>>> {
    entries: Peekable<I>,
    width: u16,
    /// How many records a frame is read ahead.
    most_ahead: usize,
    ahead: VecDeque<Entry>,
    /// A frame began of which nothing was read yet.
    is_new: bool,
    balance: Balance,
    /// Frames whose exposures differ.
    frames: &'a AtomicU32,
}

impl<'a, I: Iterator<Item = Result<Entry, RecordingError>>> Balanced<'a, I> {
    /// Of records of such lines; `frames` counts those that are changed, from the first of their lines that is asked for.
    pub fn new(entries: I, header: Header, frames: &'a AtomicU32) -> Self {
        // As many as a frame has that is recorded: a file may be any.
        let (width, most_ahead) = (header.width, most_rows(header.height) as usize);
        let entries = entries.peekable();
        Self { entries, width, most_ahead, ahead: VecDeque::new(), is_new: false, balance: Balance::NONE, frames }
    }

    /// Reads the frame ahead, and what it asks for.
    fn read_ahead(&mut self) {
        let (mut left_lines, mut right_lines) = (Vec::new(), Vec::new());
        while self.ahead.len() < self.most_ahead
            && let Some(Ok(entry)) = self.entries.next_if(|entry| entry.as_ref().is_ok_and(Entry::is_of_frame))
        {
            if let Entry::Line { left, right, .. } = &entry {
                left_lines.extend_from_slice(left);
                right_lines.extend_from_slice(right);
            }
            self.ahead.push_back(entry);
        }
        // Without a line there is nothing to balance.
        let pair = MemoryPair::new(self.width, left_lines, right_lines);
        self.balance = pair.and_then(|mut pair| measure_balance(&mut pair).ok()).unwrap_or(Balance::NONE);
        self.frames.fetch_add(u32::from(self.balance != Balance::NONE), Ordering::Relaxed);
    }
}

impl<I: Iterator<Item = Result<Entry, RecordingError>>> Iterator for Balanced<'_, I> {
    type Item = Result<Entry, RecordingError>;

    fn next(&mut self) -> Option<Self::Item> {
        if std::mem::take(&mut self.is_new) {
            self.read_ahead();
        }
        let mut entry = self.ahead.pop_front().map(Ok).or_else(|| self.entries.next())?;
        match &mut entry {
            Ok(Entry::Frame(_)) => self.is_new = true,
            Ok(Entry::Line { right, .. }) => self.balance.line(right),
            _ => {}
        }
        Some(entry)
    }
}
