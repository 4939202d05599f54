//! The block's registers in the address space, and the ring of records that DMA fills.

use super::registers::{Register, RegisterBus};
use crate::matching::WinnerRecord;
use core::sync::atomic::{AtomicU32, Ordering, fence};

/// The DMA channels that serve the block.
pub trait BlockDma {
    /// The channels' own error.
    type Error;

    /// Place in the ring, in records, of the one that the channel writes next.
    ///
    /// ```text
    /// ring   | 5 | 6 | 7 | . | . | 3 | 4 |      three records to a row, seven places
    ///                      ^       ^
    ///               position       what was taken last is before here
    /// ```
    fn position(&mut self) -> Result<usize, Self::Error>;

    /// Sends a line of both cameras to the block's stream, the first of a frame or another one. Nothing where
    /// the cameras do it.
    fn send_line(&mut self, is_first: bool, left: &[u8], right: &[u8]) -> Result<(), Self::Error>;
}

/// The block of `examples/fpga` in a core's address space: a [`RegisterBus`] over its registers, and over a
/// ring in memory that a DMA channel writes its records to.
///
/// A firmware makes the two references of the addresses that its hardware has. No cache may stand before
/// either. The ring has room for two rows at least, so that a core that is late for one still gets the next;
/// what is overwritten before it was taken is damaged rows, which are told.
///
/// ```no_run
/// use core::sync::atomic::AtomicU32;
/// use stereopsis::pipeline::winners::{BlockDma, MappedBlock, WinnerRegisters};
///
/// # struct Channels;
/// # impl BlockDma for Channels {
/// #     type Error = core::convert::Infallible;
/// #     fn position(&mut self) -> Result<usize, Self::Error> { Ok(0) }
/// #     fn send_line(&mut self, _: bool, _: &[u8], _: &[u8]) -> Result<(), Self::Error> { Ok(()) }
/// # }
/// static RING: [[AtomicU32; 2]; 1280] = [const { [const { AtomicU32::new(0) }; 2] }; 1280];
/// // SAFETY: the block's nine registers stand there, and nothing else refers to them.
/// let registers = unsafe { &*(0x4300_0000 as *const [AtomicU32; 9]) };
/// let block = WinnerRegisters::new(MappedBlock::new(registers, &RING, Channels, 100_000));
/// ```
#[derive(Debug)]
pub struct MappedBlock<'a, D> {
    registers: &'a [AtomicU32; 9],
    ring: &'a [[AtomicU32; 2]],
    dma: D,
    most_looks: u32,
    /// The place of the record that is taken next.
    next: usize,
}

impl<'a, D: BlockDma> MappedBlock<'a, D> {
    /// The block whose registers and ring these are. A row is late that is not whole after `most_looks` looks
    /// at the channel's position.
    pub const fn new(
        registers: &'a [AtomicU32; 9],
        ring: &'a [[AtomicU32; 2]],
        dma: D,
        most_looks: u32,
    ) -> Self {
        Self { registers, ring, dma, most_looks, next: 0 }
    }

    /// The channels.
    pub fn dma(&mut self) -> &mut D {
        &mut self.dma
    }

    fn register(&self, register: Register) -> Option<&AtomicU32> {
        self.registers.get(register as usize / 4)
    }

    /// The record in a place of the ring.
    fn record(&self, place: usize) -> Option<WinnerRecord> {
        let [low, high] = self.ring.get(place)?;
        let words = [low, high].map(|word| word.load(Ordering::Relaxed).to_le_bytes());
        words.as_flattened().first_chunk().map(|&bytes| WinnerRecord::from_bytes(bytes))
    }
}

impl<D: BlockDma> RegisterBus for MappedBlock<'_, D> {
    type Error = D::Error;

    fn read(&mut self, register: Register) -> Result<u32, D::Error> {
        Ok(self.register(register).map_or(0, |register| register.load(Ordering::SeqCst)))
    }

    fn write(&mut self, register: Register, value: u32) -> Result<(), D::Error> {
        if let Some(register) = self.register(register) {
            register.store(value, Ordering::SeqCst);
        }
        Ok(())
    }

    fn send_line(&mut self, is_first: bool, left: &[u8], right: &[u8]) -> Result<(), D::Error> {
        self.dma.send_line(is_first, left, right)
    }

    // A row ends with its last pixel, or where a record of another row stands; the row of a damaged one is
    // not known. Records of the row beyond its last pixel are counted as far as they are there.
    fn receive(&mut self, winners: &mut [WinnerRecord]) -> Result<usize, D::Error> {
        let (mut count, mut row) = (0, None);
        for _ in 0..self.most_looks.max(1) {
            let end = self.dma.position()?;
            // What the channel wrote before it went on is there.
            fence(Ordering::Acquire);
            for _ in 0..self.ring.len() {
                if self.next == end {
                    break;
                }
                let Some(record) = self.record(self.next) else { break };
                let of = Some(record.row()).filter(|&row| record.is_intact(row.into()));
                match winners.get_mut(count) {
                    Some(to) if of.is_none() || row.is_none() || of == row => *to = record,
                    None if of.is_some() && of == row => {}
                    _ => return Ok(count),
                }
                row = of.or(row);
                count += 1;
                self.next = if self.next + 1 < self.ring.len() { self.next + 1 } else { 0 };
            }
            if count >= winners.len() {
                break;
            }
        }
        Ok(count)
    }

    fn forget_records(&mut self) -> Result<(), D::Error> {
        self.next = self.dma.position()?;
        Ok(())
    }
}
