//! A seeded injector of faults before any source of lines, with a record of what it did.
//!
//! * [`Fault`]: the faults by name. [`Record`]: what was done to a frame, and what anybody can know about it.
//! * [`Faulty`]: a [`LineSource`](stereopsis::camera::LineSource) or a
//!   [`StereoSource`](stereopsis::camera::StereoSource) with faults.

mod record;
mod source;

pub use record::{Fault, Record};

use crate::scene::random::Random;
use std::fmt;
use stereopsis::camera::{CameraError, FrameStart, LineFault, LineStart};

/// The error of a source with faults.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum FaultyError<E> {
    /// The injector's.
    Injected(Fault),
    /// The source's own.
    Inner(E),
}

impl<E: fmt::Display> fmt::Display for FaultyError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Injected(fault) => write!(f, "injected: {}", fault.name()),
            Self::Inner(e) => write!(f, "{e}"),
        }
    }
}

/// A source with faults: each line has one of `faults` with a probability, and so has each frame.
#[derive(Clone, Debug)]
pub struct Faulty<S> {
    inner: S,
    faults: Vec<Fault>,
    per_line: f64,
    random: Random,
    record: Record,
    start: FrameStart,
    /// The lines handed out last, and those of the frame before.
    last: Vec<Vec<u8>>,
    older: Vec<Vec<Vec<u8>>>,
    /// The row that the inner source gives next.
    row: u16,
    /// Nothing more comes in this frame.
    is_over: bool,
    /// Nothing comes any more, and every line is waited for.
    is_dead: bool,
    /// The line above was handed out as it is.
    was_given: bool,
    /// This line failed before it was taken, and comes without another fault.
    is_pending: bool,
    has_started: bool,
    /// Frames that are seen to be missing when the next one begins.
    skipped: u32,
}

impl<S> Faulty<S> {
    /// Puts `faults` before `inner`, each line with the probability `per_line`.
    pub fn new(inner: S, faults: &[Fault], per_line: f64, seed: u64) -> Self {
        Self {
            inner,
            faults: faults.to_vec(),
            per_line,
            random: Random::new(seed),
            record: Record::default(),
            start: FrameStart::default(),
            last: Vec::new(),
            older: Vec::new(),
            row: 0,
            is_over: false,
            is_dead: false,
            was_given: false,
            is_pending: false,
            has_started: false,
            skipped: 0,
        }
    }

    /// What was done to the frame that was started last.
    pub fn record(&self) -> &Record {
        &self.record
    }

    /// The source behind the faults.
    pub fn inner(&self) -> &S {
        &self.inner
    }

    /// The same, to be changed.
    pub fn inner_mut(&mut self) -> &mut S {
        &mut self.inner
    }

    /// One of the faults for this line, or none.
    fn draw(&mut self, of_frames: bool) -> Option<Fault> {
        let (happens, which) = (self.random.unit() < self.per_line, self.random.unit());
        let among: Vec<_> =
            self.faults.iter().copied().filter(|fault| fault.is_of_frames() == of_frames).collect();
        among.get((which * among.len() as f64) as usize).copied().filter(|_| happens)
    }

    fn start<E>(
        &mut self,
        mut inner: impl FnMut(&mut S) -> Result<FrameStart, CameraError<E>>,
    ) -> Result<FrameStart, CameraError<FaultyError<E>>> {
        let own = |e: CameraError<E>| e.map_hardware(FaultyError::Inner);
        self.record = Record::default();
        (self.row, self.is_over, self.is_dead) = (0, false, false);
        (self.was_given, self.is_pending) = (false, false);
        let fault = self.draw(true);
        self.record.frame = fault;
        match fault {
            Some(Fault::FrameStale) if self.start.sequence != 0 => {
                // The same frame again; its lines are the newest ones all the same.
                inner(&mut self.inner).map_err(own)?;
                self.skipped += 1;
                return Ok(self.start);
            }
            Some(Fault::FrameSkipped) if self.has_started => {
                inner(&mut self.inner).map_err(own)?;
                self.skipped += 1;
            }
            Some(Fault::FrameStale | Fault::FrameSkipped) => self.record.frame = None,
            Some(Fault::FrameTimesOut) => return Err(CameraError::TimedOut),
            Some(Fault::FrameFails) => {
                return Err(CameraError::Hardware(FaultyError::Injected(Fault::FrameFails)));
            }
            _ => {}
        }
        self.start = inner(&mut self.inner).map_err(own)?;
        self.has_started = true;
        self.record.skipped = std::mem::take(&mut self.skipped);
        Ok(self.start)
    }

    /// One line of every camera of the source, with its faults.
    fn next<E>(
        &mut self,
        height: u16,
        line_bytes: usize,
        lines: &mut [&mut [u8]],
        mut inner: impl FnMut(&mut S, &mut [&mut [u8]]) -> Result<LineStart, CameraError<E>>,
    ) -> Result<LineStart, CameraError<FaultyError<E>>> {
        let own = |e: CameraError<E>| e.map_hardware(FaultyError::Inner);
        if self.is_over || self.row >= height {
            return Err(CameraError::NoLineLeft);
        }
        let row = self.row;
        if self.is_dead {
            self.row += 1;
            self.record.lose(row, Fault::Dead);
            return Err(CameraError::TimedOut);
        }
        // The call after a bus fault gives the line that stayed, whether a fault is drawn for it or not.
        let is_pending = std::mem::take(&mut self.is_pending);
        let fault = self.draw(false).filter(|_| !is_pending);
        let was_given = std::mem::take(&mut self.was_given);
        if let Some(Fault::LineRepeated) = fault.filter(|_| was_given) {
            self.was_given = true;
            self.record.repeated += 1;
            lines
                .iter_mut()
                .zip(&self.last)
                .for_each(|(line, last)| line[..line_bytes].copy_from_slice(last));
            return Ok(LineStart { row: row - 1, timestamp_us: self.start.timestamp_us });
        }
        if let Some(Fault::BusBefore) = fault {
            // The line stays where it is, and comes with the next call; by then its place is taken.
            self.is_pending = true;
            self.record.lose(row, Fault::BusBefore);
            return Err(CameraError::Hardware(FaultyError::Injected(Fault::BusBefore)));
        }
        let mut start = inner(&mut self.inner, lines).map_err(own)?;
        self.row += 1;
        let fresh: Vec<Vec<u8>> = lines.iter().map(|line| line[..line_bytes].to_vec()).collect();
        let stale = self.older.get(usize::from(row)).cloned();
        if self.older.len() <= usize::from(row) {
            self.older.resize(usize::from(row) + 1, Vec::new());
        }
        self.older[usize::from(row)] = fresh.clone();
        self.last = fresh;
        let Some(fault) = fault else {
            self.was_given = true;
            return Ok(start);
        };
        let tear = |lines: &mut [&mut [u8]], with: &[Vec<u8>]| {
            let from = line_bytes / 3;
            lines
                .iter_mut()
                .zip(with)
                .for_each(|(line, old)| line[from..line_bytes].copy_from_slice(&old[from..]));
        };
        match fault {
            Fault::LinePassedOver => {
                if self.row >= height {
                    self.record.lose(row, Fault::FrameShort);
                    return Err(CameraError::NoLineLeft);
                }
                self.record.lose(row, fault);
                start = inner(&mut self.inner, lines).map_err(own)?;
                self.last = lines.iter().map(|line| line[..line_bytes].to_vec()).collect();
                self.older.truncate(usize::from(self.row));
                self.older.push(self.last.clone());
                (self.row, self.was_given) = (self.row + 1, true);
                Ok(start)
            }
            Fault::LineDropped | Fault::LineTorn | Fault::LineLate => {
                self.record.lose(row, fault);
                if let Some(old) = stale.filter(|old| !old.is_empty()) {
                    tear(lines, &old);
                }
                Err(CameraError::LineLost(match fault {
                    Fault::LineTorn => LineFault::Torn,
                    Fault::LineLate => LineFault::Late,
                    _ => LineFault::Dropped,
                }))
            }
            Fault::LineStale => {
                // What stood in the buffer when the frame began, with the stamp that it had.
                let Some(old) = stale.filter(|old| !old.is_empty() && self.start.timestamp_us > 1) else {
                    self.was_given = true;
                    return Ok(start);
                };
                self.record.lose(row, fault);
                lines.iter_mut().zip(&old).for_each(|(line, old)| line[..line_bytes].copy_from_slice(old));
                Ok(LineStart { row, timestamp_us: self.start.timestamp_us - 1 })
            }
            Fault::Bus => {
                self.record.lose(row, fault);
                lines.iter_mut().for_each(|line| line[..line_bytes].fill(0x5a));
                Err(CameraError::Hardware(FaultyError::Injected(fault)))
            }
            Fault::TimesOut => {
                self.record.lose(row, fault);
                Err(CameraError::TimedOut)
            }
            Fault::FrameShort => {
                self.is_over = true;
                (row..height).for_each(|row| self.record.lose(row, fault));
                Err(CameraError::NoLineLeft)
            }
            Fault::Dead => {
                self.is_dead = true;
                self.record.lose(row, fault);
                Err(CameraError::TimedOut)
            }
            Fault::SyncLost => {
                self.is_over = true;
                self.record.ended = Some((row, fault));
                Err(CameraError::LostSync)
            }
            Fault::RowsRestart => {
                self.is_over = true;
                if row < 2 || !was_given {
                    (row..height).for_each(|row| self.record.lose(row, Fault::FrameShort));
                    return Err(CameraError::NoLineLeft);
                }
                self.record.ended = Some((row, fault));
                Ok(LineStart { row: 0, ..start })
            }
            // A line that cannot be repeated yet.
            _ => {
                self.was_given = true;
                Ok(start)
            }
        }
    }
}
