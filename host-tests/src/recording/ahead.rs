//! Records of a frame that are looked at before they are played.

use super::{Entry, Header, RecordingError, most_rows};
use crate::run::{MemoryPair, measure_balance};
use std::collections::VecDeque;
use std::iter::Peekable;
use std::sync::Mutex;
use stereopsis::imaging::{Balance, Noise, NoiseMeter};

/// What was seen in the frames, for who plays them.
#[derive(Debug, Default)]
pub struct Seen(Mutex<(Noise, u32)>);

impl Seen {
    /// The noise of the frame whose beginning was read last, [balanced](Ahead); none before the first.
    pub fn noise(&self) -> Noise {
        self.0.lock().map_or(Noise::None, |seen| seen.0)
    }

    /// Frames whose exposures differ, as soon as a line was asked for.
    pub fn balanced_frames(&self) -> u32 {
        self.0.lock().map_or(0, |seen| seen.1)
    }
}

/// Any records, with every frame measured by its own lines, those that came, before the first of them is
/// given. (A device has not seen them when the first row goes out: there it goes by the frame before.)
pub struct Ahead<'a, I: Iterator<Item = Result<Entry, RecordingError>>> {
    entries: Peekable<I>,
    width: u16,
    /// How many records a frame is read ahead.
    most_ahead: usize,
    ahead: VecDeque<Entry>,
    /// Whether frames are [balanced](Balance).
    balances: bool,
    /// The frame's balance.
    balance: Balance,
    /// A frame began of which nothing was asked for yet.
    is_new: bool,
    seen: &'a Seen,
}

impl<'a, I: Iterator<Item = Result<Entry, RecordingError>>> Ahead<'a, I> {
    /// Of records of such lines, the right ones balanced if asked for.
    pub fn new(entries: I, header: Header, balances: bool, seen: &'a Seen) -> Self {
        // As many as a frame has that is recorded: a file may be any.
        let (width, most_ahead) = (header.width, most_rows(header.height) as usize);
        let (entries, ahead, balance) = (entries.peekable(), VecDeque::new(), Balance::NONE);
        Self { entries, width, most_ahead, ahead, balances, balance, is_new: false, seen }
    }

    /// Reads the frame that begins, and measures what it asks for.
    fn read_ahead(&mut self) {
        let (mut left_lines, mut right_lines) = (Vec::new(), Vec::new());
        while self.ahead.len() < self.most_ahead
            && let Some(Ok(entry)) =
                self.entries.next_if(|entry| entry.as_ref().is_ok_and(Entry::is_of_frame))
        {
            if let Entry::Line { left, right, .. } = &entry {
                left_lines.extend_from_slice(left);
                right_lines.extend_from_slice(right);
            }
            self.ahead.push_back(entry);
        }
        self.balance = Balance::NONE;
        if self.balances {
            let pair = MemoryPair::new(self.width, left_lines.clone(), right_lines.clone());
            // Without a line there is nothing to balance.
            self.balance = pair.and_then(|mut pair| measure_balance(&mut pair).ok()).unwrap_or(Balance::NONE);
        }
        self.balance.line(&mut right_lines);
        let mut meter = NoiseMeter::new();
        let width = usize::from(self.width);
        left_lines
            .chunks_exact(width)
            .chain(right_lines.chunks_exact(width))
            .for_each(|line| meter.line(line));
        if let Ok(mut seen) = self.seen.0.lock() {
            seen.0 = meter.level();
        }
    }
}

impl<I: Iterator<Item = Result<Entry, RecordingError>>> Iterator for Ahead<'_, I> {
    type Item = Result<Entry, RecordingError>;

    fn next(&mut self) -> Option<Self::Item> {
        if std::mem::take(&mut self.is_new)
            && let Ok(mut seen) = self.seen.0.lock()
        {
            seen.1 += u32::from(self.balance != Balance::NONE);
        }
        let mut entry = self.ahead.pop_front().map(Ok).or_else(|| self.entries.next())?;
        match &mut entry {
            Ok(Entry::Frame(_)) => {
                self.read_ahead();
                self.is_new = true;
            }
            Ok(Entry::Line { right, .. }) => self.balance.line(right),
            _ => {}
        }
        Some(entry)
    }
}
