//! A camera without hardware: the other end of its bus. It holds the driver to the application note: a
//! command that it does not describe, and one at the wrong time, is an error.

use crate::mega::{
    BURST, CAMERA, FORMAT, LENGTH, LINE_BYTES, MEMORY, PICTURE_BYTES, RESET, RESOLUTION, SIZE, STATE, WRITE,
    size_code,
};
use embedded_hal::spi::{Error, ErrorKind, ErrorType};
use embedded_hal_async::spi::{Operation, SpiDevice};

/// How often the state is read until settings or a picture are done.
const READS: u32 = 3;

/// What the driver did that the application note does not have.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Misuse {
    /// A command that there is not.
    Command,
    /// A setting while the one before is not done, or before a reset.
    Unsettled,
    /// A burst without a picture, or beyond its end.
    NoPicture,
}

impl Error for Misuse {
    fn kind(&self) -> ErrorKind {
        ErrorKind::Other
    }
}

/// The camera: what it sees in a row of its picture, as grey levels.
#[derive(Debug)]
pub struct Simulated<F> {
    sees: F,
    /// Which camera it is.
    camera: u8,
    line: [u8; SIZE],
    /// Reads of the state to come until settings are done; `None` before a reset.
    settings: Option<u32>,
    /// The same of a picture, of which there is one when it has come to 0.
    picture: Option<u32>,
    /// What was set: format and size.
    set: [u8; 2],
    /// Bytes of the picture that were read.
    read: usize,
    is_waited: bool,
}

impl<F: FnMut(u16, &mut [u8; SIZE])> Simulated<F> {
    /// A camera with its power on, which says that it is a 3MP.
    pub const fn new(sees: F) -> Self {
        Self::of(0x82, sees)
    }

    /// A camera with its power on, which says that it is this one.
    pub const fn of(camera: u8, sees: F) -> Self {
        let (line, set) = ([0; SIZE], [0; 2]);
        Self { sees, camera, line, settings: None, picture: None, set, read: 0, is_waited: false }
    }

    /// A register is written.
    fn write(&mut self, register: u8, value: u8) -> Result<(), Misuse> {
        if register == RESET && value == 1 << 6 {
            self.settings = Some(READS);
            return Ok(());
        }
        if self.settings != Some(0) {
            return Err(Misuse::Unsettled);
        }
        match (register, value) {
            (FORMAT, format) => (self.set[0], self.settings) = (format, Some(READS)),
            (RESOLUTION, size) => (self.set[1], self.settings) = (size, Some(READS)),
            (MEMORY, 1) => self.picture = None,
            // RGB565, 128 x 128 pixels.
            (MEMORY, 2) if self.set[0] == 2 && Some(self.set[1]) == size_code(self.camera) => {
                (self.picture, self.read, self.is_waited) = (Some(READS), 0, false);
            }
            _ => return Err(Misuse::Command),
        }
        Ok(())
    }

    /// A register is read.
    fn read(&mut self, register: u8) -> Result<u8, Misuse> {
        let passed = |count: &mut Option<u32>| *count = count.map(|reads| reads.saturating_sub(1));
        match register {
            CAMERA => Ok(self.camera),
            STATE => {
                passed(&mut self.settings);
                passed(&mut self.picture);
                let (settled, taken) = (self.settings == Some(0), self.picture == Some(0));
                Ok(if settled { 2 } else { 1 } | if taken { 4 } else { 0 })
            }
            length => {
                let byte = LENGTH.iter().position(|&at| at == length).ok_or(Misuse::Command)?;
                Ok((PICTURE_BYTES >> (8 * byte)) as u8)
            }
        }
    }

    /// Whole lines of the picture go out.
    fn burst(&mut self, bytes: &mut [u8]) -> Result<(), Misuse> {
        // The first one needs a byte of waiting, and no other has one.
        let waits = if self.is_waited { 1 } else { 2 };
        let (command, bytes) = bytes.split_at_mut_checked(waits).ok_or(Misuse::Command)?;
        if command.iter().chain(&*bytes).skip(1).any(|&sent| sent != 0) {
            return Err(Misuse::Command);
        }
        let end = self.read + bytes.len();
        let is_whole = bytes.len().is_multiple_of(LINE_BYTES);
        if !is_whole || self.picture != Some(0) || end > PICTURE_BYTES as usize {
            return Err(Misuse::NoPicture);
        }
        self.is_waited = true;
        for byte in bytes {
            let (row, at) = (self.read / LINE_BYTES, self.read % LINE_BYTES);
            if at == 0 {
                (self.sees)(row as u16, &mut self.line);
            }
            let grey = u16::from(self.line[at / 2]);
            let pixel = (grey >> 3) << 11 | (grey >> 2) << 5 | grey >> 3;
            *byte = pixel.to_be_bytes()[at % 2];
            self.read += 1;
        }
        Ok(())
    }
}

impl<F> ErrorType for Simulated<F> {
    type Error = Misuse;
}

impl<F: FnMut(u16, &mut [u8; SIZE])> SpiDevice for Simulated<F> {
    async fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Misuse> {
        match operations {
            [Operation::Write([register, value])] if register & WRITE != 0 => {
                self.write(register & !WRITE, *value)
            }
            [Operation::TransferInPlace(bytes @ [BURST, ..])] => self.burst(bytes),
            [Operation::TransferInPlace([register, _, value])] if *register & WRITE == 0 => {
                *value = self.read(*register)?;
                Ok(())
            }
            _ => Err(Misuse::Command),
        }
    }
}
