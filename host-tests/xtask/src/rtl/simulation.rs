//! The simulated block as registers and streams: `examples/fpga/sim/block.cpp` has the words spoken.

use crate::steps::{Failure, Outcome};
use std::fmt;
use std::io::{self, Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use stereopsis::matching::WinnerRecord;
use stereopsis::pipeline::winners::{Register, RegisterBus};

/// Clocks without a pixel or a record after which a row is late.
const PATIENCE: u32 = 60_000;
/// The marks of a line or a record.
const BEGINS: u8 = 1;
const ENDS: u8 = 2;

/// What is wrong with a frame's lines on their way into the block.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Spoiled {
    /// A line has a pixel less.
    Short(u16),
    /// A line has a pixel more.
    Long(u16),
    /// A line begins the next frame.
    CutOff(u16),
}

/// A simulation that runs.
pub struct Simulation {
    child: Child,
    to: ChildStdin,
    from: ChildStdout,
    lines: u16,
    /// What is wrong with the lines.
    pub spoiled: Option<Spoiled>,
    /// All records that came, as they came.
    pub taken: Vec<WinnerRecord>,
}

/// The clocks of a simulation.
#[derive(Clone, Copy, Debug)]
pub struct Clocks {
    /// Those of the last frame's first pixel.
    pub first_pixel: u64,
    /// Of its first record.
    pub first_record: u64,
    /// Of its last one.
    pub last_record: u64,
}

impl Simulation {
    /// Starts a program that [`Block::build`](super::block::Block::build) made.
    pub fn start(program: &Path) -> Outcome<Self> {
        let failed = |what: &dyn fmt::Display| Failure::new(format!("{}: {what}", program.display()));
        let child = Command::new(program).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
        let mut child = child.map_err(|e| failed(&e))?;
        let (to, from) = (child.stdin.take(), child.stdout.take());
        let (to, from) = to.zip(from).ok_or_else(|| failed(&"has no pipes"))?;
        Ok(Self { child, to, from, lines: 0, spoiled: None, taken: Vec::new() })
    }

    /// Pauses from here on: percent of clocks without a pixel, and without taking a record.
    pub fn pause(&mut self, seed: u32, gaps: u8, stalls: u8) -> io::Result<()> {
        self.to.write_all(b"P")?;
        self.to.write_all(&seed.to_le_bytes())?;
        self.to.write_all(&[gaps, stalls])
    }

    /// When the last frame's pixels and records passed.
    pub fn clocks(&mut self) -> io::Result<Clocks> {
        self.to.write_all(b"C")?;
        let mut numbers = [0; 5];
        for number in &mut numbers {
            *number = u64::from_le_bytes(self.read()?);
        }
        let [_, first_pixel, _, first_record, last_record] = numbers;
        Ok(Clocks { first_pixel, first_record, last_record })
    }

    fn read<const N: usize>(&mut self) -> io::Result<[u8; N]> {
        let mut bytes = [0; N];
        self.to.flush()?;
        self.from.read_exact(&mut bytes)?;
        Ok(bytes)
    }
}

impl Drop for Simulation {
    fn drop(&mut self) {
        // It ends when it is told to; one that does not hear it any more has ended.
        let _ = self.to.write_all(b"Q").and_then(|()| self.to.flush());
        let _ = self.child.wait();
    }
}

impl RegisterBus for Simulation {
    type Error = io::Error;

    fn read(&mut self, register: Register) -> io::Result<u32> {
        self.to.write_all(&[b'R', register as u8])?;
        Ok(u32::from_le_bytes(Self::read(self)?))
    }

    fn write(&mut self, register: Register, value: u32) -> io::Result<()> {
        self.to.write_all(&[b'W', register as u8])?;
        self.to.write_all(&value.to_le_bytes())
    }

    fn send_line(&mut self, is_first: bool, left: &[u8], right: &[u8]) -> io::Result<()> {
        self.lines = if is_first { 0 } else { self.lines + 1 };
        let mut pixels: Vec<u8> = left.iter().zip(right).flat_map(|(&left, &right)| [left, right]).collect();
        let mut marks = ENDS | if is_first { BEGINS } else { 0 };
        match self.spoiled {
            Some(Spoiled::Short(line)) if line == self.lines => pixels.truncate(pixels.len() - 2),
            Some(Spoiled::Long(line)) if line == self.lines => pixels.extend([0, 0]),
            Some(Spoiled::CutOff(line)) if line == self.lines => marks |= BEGINS,
            _ => {}
        }
        self.to.write_all(&[b'L', marks])?;
        self.to.write_all(&(pixels.len() as u32 / 2).to_le_bytes())?;
        self.to.write_all(&pixels)
    }

    fn receive(&mut self, winners: &mut [WinnerRecord]) -> io::Result<usize> {
        self.to.write_all(b"T")?;
        self.to.write_all(&(winners.len() as u32).to_le_bytes())?;
        self.to.write_all(&PATIENCE.to_le_bytes())?;
        let count = u32::from_le_bytes(Self::read(self)?) as usize;
        for i in 0..count {
            let [a, b, c, d, e, f, g, h, marks] = Self::read(self)?;
            let record = WinnerRecord::from_bytes([a, b, c, d, e, f, g, h]);
            self.taken.push(record);
            winners[i] = record;
            // The mark of a row's end stands where it ends.
            if (marks & ENDS != 0) != (i + 1 == winners.len()) {
                return Ok(i + 1 - usize::from(marks & ENDS == 0));
            }
        }
        Ok(count)
    }

    fn forget_records(&mut self) -> io::Result<()> {
        self.taken.clear();
        Ok(())
    }
}
