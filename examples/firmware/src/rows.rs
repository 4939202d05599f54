//! Rows of disparity to a file on the host, with their checksum.
//!
//! A pixel is three bytes: the disparity's steps, low byte first, then the flags.

use crate::host::{HostError, HostFile};
use core::ffi::CStr;
use heapless::Vec;
use stereopsis::matching::Row;

/// The file, in the emulator's working directory.
pub const NAME: &CStr = c"rows.bin";

/// Pixels that are written at a time.
const PIXELS: usize = 32;
/// Bytes of a pixel.
const BYTES: usize = 3;

/// The file and what it holds so far.
pub struct Rows {
    file: HostFile,
    crc: u32,
    count: u16,
}

impl Rows {
    /// An empty file.
    ///
    /// # Errors
    /// When the host does not let it be made.
    pub fn create() -> Result<Self, HostError> {
        let file = HostFile::create(NAME)?;
        Ok(Self { file, crc: u32::MAX, count: 0 })
    }

    /// Adds a row.
    ///
    /// # Errors
    /// When the host does not take all of it.
    pub fn write(&mut self, row: &Row<'_>) -> Result<(), HostError> {
        let mut pixels = row.disparities().iter().zip(row.flags());
        for _ in 0..pixels.len().div_ceil(PIXELS) {
            let mut bytes = Vec::<u8, { BYTES * PIXELS }>::new();
            for (disparity, flags) in pixels.by_ref().take(PIXELS) {
                let [low, high] = disparity.raw().to_le_bytes();
                // There is room for so many pixels.
                let _ = bytes.extend_from_slice(&[low, high, flags.bits()]);
            }
            self.crc = bytes.iter().fold(self.crc, |crc, &byte| with_byte(crc, byte));
            self.file.write(&bytes)?;
        }
        self.count += 1;
        Ok(())
    }

    /// How many rows there are.
    pub fn count(&self) -> u16 {
        self.count
    }

    /// CRC-32 of all bytes, as in Ethernet and PNG.
    pub fn crc32(&self) -> u32 {
        !self.crc
    }
}

/// The checksum with one more byte: reflected 0x04C11DB7, bit by bit.
fn with_byte(crc: u32, byte: u8) -> u32 {
    (0..8).fold(crc ^ u32::from(byte), |crc, _| (crc >> 1) ^ (0xEDB8_8320 & (crc & 1).wrapping_neg()))
}
