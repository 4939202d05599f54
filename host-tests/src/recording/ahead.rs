//! Records of a frame that are looked at before they are played.

use super::first::pictures;
use super::{Entry, Header, RecordingError, most_rows};
use crate::run::{MemoryPair, measure_balance};
use image::GrayImage;
use std::collections::VecDeque;
use std::iter::Peekable;
use std::sync::Mutex;
use stereopsis::camera::FrameStart;
use stereopsis::imaging::{Balance, Noise, NoiseMeter};

/// What was seen in the frames, for who plays them.
#[derive(Debug, Default)]
pub struct Seen(Mutex<Frames>);

/// What is known of the frames that were read.
#[derive(Debug, Default)]
struct Frames {
    noise: Noise,
    balanced: u32,
    /// Pictures of frames that nobody has taken yet; `None` where they are not kept.
    pictures: Option<VecDeque<(FrameStart, [GrayImage; 2])>>,
}

impl Seen {
    /// Of frames whose pictures are kept until they are taken.
    pub fn with_pictures() -> Self {
        Self(Mutex::new(Frames { pictures: Some(VecDeque::new()), ..Frames::default() }))
    }

    /// Takes the pictures of the frame that began so, and forgets those of the frames before it. A row that
    /// did not come is the row above it.
    pub fn take_pictures(&self, of: FrameStart) -> Option<[GrayImage; 2]> {
        let mut seen = self.0.lock().ok()?;
        let pictures = seen.pictures.as_mut()?;
        let place = pictures.iter().position(|(start, _)| *start == of)?;
        pictures.drain(..=place).next_back().map(|(_, pictures)| pictures)
    }

    /// The noise of the frame whose beginning was read last, [balanced](Ahead); none before the first.
    pub fn noise(&self) -> Noise {
        self.0.lock().map_or(Noise::None, |seen| seen.noise)
    }

    /// Frames whose exposures differ, as soon as a line was asked for.
    pub fn balanced_frames(&self) -> u32 {
        self.0.lock().map_or(0, |seen| seen.balanced)
    }
}

/// Any records, with every frame measured by its own lines, those that came, before the first of them is
/// given. (A device has not seen them when the first row goes out: there it goes by the frame before.)
pub struct Ahead<'a, I: Iterator<Item = Result<Entry, RecordingError>>> {
    entries: Peekable<I>,
    header: Header,
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
        let most_ahead = most_rows(header.height) as usize;
        let (entries, ahead, balance) = (entries.peekable(), VecDeque::new(), Balance::NONE);
        Self { entries, header, most_ahead, ahead, balances, balance, is_new: false, seen }
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
            let pair = MemoryPair::new(self.header.width, left_lines.clone(), right_lines.clone());
            // Without a line there is nothing to balance.
            self.balance = pair.and_then(|mut pair| measure_balance(&mut pair).ok()).unwrap_or(Balance::NONE);
        }
        self.balance.line(&mut right_lines);
        let mut meter = NoiseMeter::new();
        let width = usize::from(self.header.width);
        left_lines
            .chunks_exact(width)
            .chain(right_lines.chunks_exact(width))
            .for_each(|line| meter.line(line));
        if let Ok(mut seen) = self.seen.0.lock() {
            seen.noise = meter.level();
        }
    }

    /// Keeps the pictures of a frame that was read, where they are wanted.
    fn keep_pictures(&self, start: FrameStart) {
        let Ok(mut seen) = self.seen.0.lock() else { return };
        let Some(kept) = &mut seen.pictures else { return };
        let mut rows = vec![None; usize::from(self.header.height)];
        for entry in &self.ahead {
            if let Entry::Line { start, left, right } = entry
                && let Some(row) = rows.get_mut(usize::from(start.row))
            {
                *row = Some([left.clone(), right.clone()]);
            }
        }
        kept.extend(pictures(self.header, rows).map(|pictures| (start, pictures)));
    }
}

impl<I: Iterator<Item = Result<Entry, RecordingError>>> Iterator for Ahead<'_, I> {
    type Item = Result<Entry, RecordingError>;

    fn next(&mut self) -> Option<Self::Item> {
        if std::mem::take(&mut self.is_new)
            && let Ok(mut seen) = self.seen.0.lock()
        {
            seen.balanced += u32::from(self.balance != Balance::NONE);
        }
        let mut entry = self.ahead.pop_front().map(Ok).or_else(|| self.entries.next())?;
        match &mut entry {
            Ok(Entry::Frame(start)) => {
                self.read_ahead();
                self.keep_pictures(*start);
                self.is_new = true;
            }
            Ok(Entry::Line { right, .. }) => self.balance.line(right),
            _ => {}
        }
        Some(entry)
    }
}
