//! The block of `examples/fpga` behind its registers.

use super::source::{WinnerError, WinnerSearch, WinnerSource};
use crate::imaging::Noise;
use crate::matching::{Block, Fast, Method, Sgm, WinnerRecord};

/// A register of the block, by its offset in bytes; each has 32 bits.
///
/// | offset | register | access | bits |
/// | --- | --- | --- | --- |
/// | 00 | ID | r | 0x53420001: "SB", version 1 of this map |
/// | 04 | CONTROL | rw | 0: enable, the next frame that begins is taken; 1: forget what is under way |
/// | 08 | STATUS | rw1c | 0: running (r); 1: done; 2: too short; 3: too long; 4: cut off; 5: bad value |
/// | 0c | SIZE | rw | 15..0: pixels in a line; 31..16: lines |
/// | 10 | SEARCH | rw | 7..0: disparities; 9..8: noise, none, low or high; 23..16: smallest disparity |
/// | 14 | CAPACITY | r | 15..0: pixels in a line; 23..16: disparities; 31..24: disparities in a clock |
/// | 18 | METHOD | r | 7..0: 0 for `fast`, 1 for `block`, 2 `sgm`; 15..8: rows up and down; 16: second best |
/// | 1c | CLOCKS | r | clocks of the frame that is under way, or of the last one |
/// | 20 | ROWS | r | rows of this frame whose last record was taken |
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Register {
    /// Which block it is.
    Id = 0x00,
    /// What it shall do.
    Control = 0x04,
    /// What has happened: writing a bit's 1 clears it.
    Status = 0x08,
    /// The size of a frame.
    Size = 0x0c,
    /// The search.
    Search = 0x10,
    /// What the block has room for.
    Capacity = 0x14,
    /// The block's method.
    Method = 0x18,
    /// How long a frame took.
    Clocks = 0x1c,
    /// How far it is.
    Rows = 0x20,
}

/// The bits of [`Register::Status`].
pub mod status {
    /// A frame is under way.
    pub const RUNNING: u32 = 1;
    /// A frame is done.
    pub const DONE: u32 = 1 << 1;
    /// A line was too short, and its frame is given up.
    pub const TOO_SHORT: u32 = 1 << 2;
    /// A line was too long, and its frame is given up.
    pub const TOO_LONG: u32 = 1 << 3;
    /// A frame was cut off by the next one.
    pub const CUT_OFF: u32 = 1 << 4;
    /// A register was written that has no such value.
    pub const BAD_VALUE: u32 = 1 << 5;
    /// All that writing a 1 clears.
    pub const ALL: u32 = DONE | TOO_SHORT | TOO_LONG | CUT_OFF | BAD_VALUE;
}

/// What [`Register::Id`] holds.
const ID: u32 = 0x5342_0001;
/// The bits of [`Register::Control`].
const ENABLE: u32 = 1;
const FORGET: u32 = 1 << 1;
/// Where noise and smallest disparity begin in [`Register::Search`], and the largest of these that it holds.
const NOISE: u32 = 8;
const LEAST: u32 = 16;
const MOST_LEAST: u16 = 255;
/// The bit of [`Register::Method`] of a block that seeks the second best.
const SECOND_BEST: u32 = 1 << 16;

/// How this core reaches the block: its registers, the ring that its records are written to, and the stream
/// that it reads pixels from, where they come by this core.
///
/// With registers in the address space, `read` and `write` are a volatile access each; a ring filled by DMA
/// hands over a row once its channel is past it.
pub trait RegisterBus {
    /// The bus's own error.
    type Error;

    /// Reads a register.
    fn read(&mut self, register: Register) -> Result<u32, Self::Error>;

    /// Writes a register.
    fn write(&mut self, register: Register, value: u32) -> Result<(), Self::Error>;

    /// Sends a line of both cameras to the block's stream, the first of a frame or another one. Nothing where
    /// the cameras do it.
    fn send_line(&mut self, is_first: bool, left: &[u8], right: &[u8]) -> Result<(), Self::Error>;

    /// Takes the records of the next row from the ring, up to the one that ends the row, and says how many
    /// there were: 0 when none came within the bus's own limit of time. Records of the row that `winners` has
    /// no room for are dropped, and counted.
    fn receive(&mut self, winners: &mut [WinnerRecord]) -> Result<usize, Self::Error>;

    /// Empties the ring.
    fn forget_records(&mut self) -> Result<(), Self::Error>;
}

/// The block of `examples/fpga` as a [`WinnerSource`].
#[derive(Debug)]
pub struct WinnerRegisters<B> {
    bus: B,
    lines: u16,
    height: u16,
    /// Whether nothing is under way: a frame that was taken whole leaves nothing behind.
    is_clean: bool,
}

impl<B: RegisterBus> WinnerRegisters<B> {
    /// The block on a bus.
    pub const fn new(bus: B) -> Self {
        Self { bus, lines: 0, height: 0, is_clean: false }
    }

    /// The bus.
    pub fn bus(&mut self) -> &mut B {
        &mut self.bus
    }

    /// What has happened to the frame, if it is over, and forgets it.
    fn take_fault(&mut self) -> Result<Option<WinnerError<B::Error>>, B::Error> {
        let faults = self.bus.read(Register::Status)? & (status::ALL & !status::DONE);
        if faults != 0 {
            self.bus.write(Register::Status, faults)?;
        }
        Ok(if faults & (status::TOO_SHORT | status::TOO_LONG) != 0 {
            Some(WinnerError::LineLength)
        } else if faults & status::CUT_OFF != 0 {
            Some(WinnerError::FrameCutOff)
        } else if faults != 0 {
            Some(WinnerError::Search)
        } else {
            None
        })
    }

    /// Whether the block is the method's and has room for the search.
    fn can(&mut self, search: &WinnerSearch) -> Result<bool, B::Error> {
        let method = match search.method {
            name if name == Fast::NAME => 0,
            name if name == Block::NAME => 1,
            name if name == Sgm::NAME => 2,
            _ => return Ok(false),
        };
        // The penalties of its paths are built in.
        let penalties = if search.noise == Noise::None { Sgm::PENALTIES } else { Sgm::PENALTIES_IN_NOISE };
        if method == 2 && search.penalties != penalties {
            return Ok(false);
        }
        if search.min_disparity > MOST_LEAST || self.bus.read(Register::Id)? != ID {
            return Ok(false);
        }
        let has = self.bus.read(Register::Method)?;
        Ok(has & 0xff == method && (has & SECOND_BEST != 0 || !search.second_best))
    }
}

impl<B: RegisterBus> WinnerSource for WinnerRegisters<B> {
    type Error = B::Error;

    fn start(&mut self, search: &WinnerSearch) -> Result<(), WinnerError<B::Error>> {
        if !self.can(search).map_err(WinnerError::Device)? {
            return Err(WinnerError::Search);
        }
        let size = u32::from(search.width) | u32::from(search.height) << 16;
        let mut write = |register, value| self.bus.write(register, value).map_err(WinnerError::Device);
        write(Register::Control, FORGET)?;
        write(Register::Size, size)?;
        let noise: u32 = match search.noise {
            Noise::None => 0,
            Noise::Low => 1,
            Noise::High => 2,
        };
        let least = u32::from(search.min_disparity) << LEAST;
        write(Register::Search, u32::from(search.disparities) | noise << NOISE | least)?;
        write(Register::Status, status::ALL)?;
        write(Register::Control, ENABLE)?;
        // With values that the block has no room for it does not come to be enabled.
        let enabled = self.bus.read(Register::Control).map_err(WinnerError::Device)? & ENABLE != 0;
        (self.height, self.is_clean) = (search.height, false);
        if !enabled {
            return Err(WinnerError::Search);
        }
        self.bus.forget_records().map_err(WinnerError::Device)?;
        self.is_clean = true;
        Ok(())
    }

    fn begin_frame(&mut self) -> Result<(), WinnerError<B::Error>> {
        self.lines = 0;
        if self.is_clean {
            // Cameras that feed the block themselves may be in the next frame already.
            self.is_clean = false;
            return Ok(());
        }
        let mut write = |register, value| self.bus.write(register, value).map_err(WinnerError::Device);
        write(Register::Control, FORGET | ENABLE)?;
        write(Register::Status, status::ALL)?;
        self.bus.forget_records().map_err(WinnerError::Device)
    }

    fn push_lines(&mut self, left: &[u8], right: &[u8]) -> Result<(), WinnerError<B::Error>> {
        self.bus.send_line(self.lines == 0, left, right).map_err(WinnerError::Device)?;
        self.lines = self.lines.saturating_add(1);
        Ok(())
    }

    fn next_row(&mut self, row: u16, winners: &mut [WinnerRecord]) -> Result<(), WinnerError<B::Error>> {
        let mut given = self.bus.receive(winners).map_err(WinnerError::Device)?;
        // The row above, which came too late.
        if row > 0 && given > 0 && winners.first().is_some_and(|first| first.is_intact(row - 1)) {
            given = self.bus.receive(winners).map_err(WinnerError::Device)?;
        }
        let damaged = winners.iter().take(given).position(|winner| !winner.is_intact(row));
        if given == winners.len() && damaged.is_none() {
            self.is_clean = row.checked_add(1) == Some(self.height);
            return Ok(());
        }
        Err(match self.take_fault().map_err(WinnerError::Device)? {
            Some(fault) => fault,
            None if given == 0 => WinnerError::Late { row },
            None if given != winners.len() => WinnerError::Count { row, given },
            None => WinnerError::Damaged { row, column: damaged.unwrap_or(0) as u16 },
        })
    }
}
