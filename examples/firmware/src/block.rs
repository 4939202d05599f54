//! A simulated block of `examples/fpga` as a bus: its registers and streams over two pipes on the host.
//!
//! `examples/fpga/sim/block.cpp` has the words spoken. On a board with the real block, registers are volatile
//! accesses, lines come from the cameras, and records from a ring that a DMA fills.

use crate::host::{HostError, HostFile};
use core::ffi::CStr;
use stereopsis::matching::WinnerRecord;
use stereopsis::pipeline::winners::{Register, RegisterBus};

/// The pipes, in the emulator's working directory.
const TO_BLOCK: &CStr = c"to_block";
const FROM_BLOCK: &CStr = c"from_block";
/// Clocks without a pixel or a record after which a row is late.
const PATIENCE: u32 = 60_000;
/// The marks of a line and of a record: one begins a frame, one ends a line.
const BEGINS: u8 = 1;
const ENDS: u8 = 2;
/// Pixels that are sent at a time.
const PIXELS: usize = 32;
/// Bytes of a record with its marks.
const RECORD: usize = WinnerRecord::BYTES + 1;

/// The block behind its pipes.
pub struct Block {
    to: HostFile,
    from: HostFile,
}

impl Block {
    /// Opens the pipes; the simulation opens its ends in the same order.
    ///
    /// # Errors
    /// When there are none.
    pub fn open() -> Result<Self, HostError> {
        let to = HostFile::create(TO_BLOCK)?;
        Ok(Self { to, from: HostFile::open(FROM_BLOCK)?.ok_or(HostError)? })
    }

    /// Ends the simulation.
    ///
    /// # Errors
    /// When it has ended already.
    pub fn end(&mut self) -> Result<(), HostError> {
        self.to.write(b"Q")
    }

    /// Fills `bytes`: a pipe gives what there is.
    fn read_all(&self, mut bytes: &mut [u8]) -> Result<(), HostError> {
        while !bytes.is_empty() {
            let count = self.from.read(bytes)?;
            let (_, rest) = bytes.split_at_mut_checked(count.max(1)).ok_or(HostError)?;
            if count == 0 {
                return Err(HostError);
            }
            bytes = rest;
        }
        Ok(())
    }

    fn read_number(&self) -> Result<u32, HostError> {
        let mut bytes = [0; 4];
        self.read_all(&mut bytes)?;
        Ok(u32::from_le_bytes(bytes))
    }
}

impl RegisterBus for Block {
    type Error = HostError;

    fn read(&mut self, register: Register) -> Result<u32, HostError> {
        self.to.write(&[b'R', register as u8])?;
        self.read_number()
    }

    fn write(&mut self, register: Register, value: u32) -> Result<(), HostError> {
        let [a, b, c, d] = value.to_le_bytes();
        self.to.write(&[b'W', register as u8, a, b, c, d])
    }

    fn send_line(&mut self, is_first: bool, left: &[u8], right: &[u8]) -> Result<(), HostError> {
        let [a, b, c, d] = (left.len() as u32).to_le_bytes();
        self.to.write(&[b'L', ENDS | if is_first { BEGINS } else { 0 }, a, b, c, d])?;
        for (left, right) in left.chunks(PIXELS).zip(right.chunks(PIXELS)) {
            let mut pixels = [[0; 2]; PIXELS];
            for (to, (&left, &right)) in pixels.iter_mut().zip(left.iter().zip(right)) {
                *to = [left, right];
            }
            self.to.write(pixels.as_flattened().get(..2 * left.len()).unwrap_or_default())?;
        }
        Ok(())
    }

    fn receive(&mut self, winners: &mut [WinnerRecord]) -> Result<usize, HostError> {
        let [a, b, c, d] = (winners.len() as u32).to_le_bytes();
        let [e, f, g, h] = PATIENCE.to_le_bytes();
        self.to.write(&[b'T', a, b, c, d, e, f, g, h])?;
        let count = self.read_number()?;
        let mut places = winners.iter_mut();
        // Records after the one that ends the row are of the next one, and are counted.
        for _ in 0..count {
            let mut bytes = [0; RECORD];
            self.read_all(&mut bytes)?;
            let [a, b, c, d, e, f, g, h, _] = bytes;
            if let Some(place) = places.next() {
                *place = WinnerRecord::from_bytes([a, b, c, d, e, f, g, h]);
            }
        }
        Ok(count as usize)
    }

    fn forget_records(&mut self) -> Result<(), HostError> {
        Ok(())
    }
}
