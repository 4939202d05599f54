//! Driver of an Arducam Mega, for pictures of 128 x 128 pixels, after Arducam's "Mega SPI Camera
//! Series Application Note" of September 2023; the registers that are read, after Arducam's SDK.
//!
//! The camera takes a picture when it is told to, keeps it in memory of its own, and gives it out at the
//! speed of the bus (SPI mode 0, 8 MHz). A register is written as its address with the highest bit set and a
//! value, and read as its address, a byte of waiting and the value.

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::spi::SpiDevice;

/// Pixels in a line, and lines.
pub const SIZE: usize = 128;
/// Bytes of a line: a pixel is five bits of red, six of green and five of blue, the high byte first.
pub const LINE_BYTES: usize = 2 * SIZE;
/// Bytes of the longest transfer: a line, its command and a byte of waiting.
pub const BURST_BYTES: usize = 2 + LINE_BYTES;
/// Bytes of a picture.
pub const PICTURE_BYTES: u32 = (LINE_BYTES * SIZE) as u32;

/// The highest bit of an address that is written to.
pub const WRITE: u8 = 0x80;
/// Control of the memory: bit 0 clears the flag of a picture that is done, bit 1 takes one.
pub const MEMORY: u8 = 0x04;
/// Bit 6 resets the camera.
pub const RESET: u8 = 0x07;
/// What a pixel is: 2 is RGB565.
pub const FORMAT: u8 = 0x20;
/// The size of a picture: [`size_code`] has the value. It is written after the format.
pub const RESOLUTION: u8 = 0x21;
/// The burst that reads the picture. Its first one has a byte of waiting.
pub const BURST: u8 = 0x3C;
/// Which camera it is: 0x81, 0x83 and 0x85 have five million pixels, 0x82, 0x84 and 0x86 three, 0x87 two.
pub const CAMERA: u8 = 0x40;
/// State: bit 1 alone of the lowest two says that settings are done, bit 2 that a picture is.
pub const STATE: u8 = 0x44;
/// The bytes of the picture, in three registers, the lowest first.
pub const LENGTH: [u8; 3] = [0x45, 0x46, 0x47];

/// The value of [`RESOLUTION`] for 128 x 128 pixels, by what [`CAMERA`] reads: from 0x85 on the codes are
/// others.
pub const fn size_code(camera: u8) -> Option<u8> {
    match camera {
        0x81..=0x84 => Some(11),
        0x85..=0x87 => Some(1),
        _ => None,
    }
}

/// Milliseconds that settings may take.
pub const SETTING_MS: u32 = 3000;
/// Milliseconds that a picture may take.
pub const PICTURE_MS: u32 = 1000;

/// Why there is no picture.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum MegaError<E> {
    /// The bus failed.
    Bus(E),
    /// What answers is no camera whose settings this driver knows.
    Unknown(u8),
    /// Settings took longer than 3 s.
    Settings,
    /// A picture took longer than 1 s.
    Picture,
    /// The picture has so many bytes, too few.
    Short(u32),
}

/// The camera on its bus.
#[derive(Debug)]
pub struct Mega<S> {
    bus: S,
    is_first_burst: bool,
    /// The command of a burst and its byte of waiting, then a line.
    burst: [u8; BURST_BYTES],
}

impl<S: SpiDevice> Mega<S> {
    /// A camera that is not set up yet.
    pub const fn new(bus: S) -> Self {
        Self { bus, is_first_burst: true, burst: [0; BURST_BYTES] }
    }

    /// Resets the camera and sets the picture's size and format.
    ///
    /// # Errors
    /// When nothing answers, something else does, or it takes too long.
    pub async fn set_up(&mut self, delay: &mut impl DelayNs) -> Result<(), MegaError<S::Error>> {
        self.write(RESET, 1 << 6).await?;
        self.settled(delay).await?;
        let camera = self.read(CAMERA).await?;
        let size = size_code(camera).ok_or(MegaError::Unknown(camera))?;
        for (register, value) in [(FORMAT, 2), (RESOLUTION, size)] {
            self.write(register, value).await?;
            self.settled(delay).await?;
        }
        Ok(())
    }

    /// Has the camera take a picture; the one before is gone.
    ///
    /// # Errors
    /// When the bus fails.
    pub async fn take(&mut self) -> Result<(), MegaError<S::Error>> {
        self.write(MEMORY, 1).await?;
        self.write(MEMORY, 2).await?;
        self.is_first_burst = true;
        Ok(())
    }

    /// Waits until the picture is whole.
    ///
    /// # Errors
    /// When it takes too long, or the picture is too short.
    pub async fn taken(&mut self, delay: &mut impl DelayNs) -> Result<(), MegaError<S::Error>> {
        for _ in 0..PICTURE_MS {
            if self.read(STATE).await? & 4 != 0 {
                let mut length = [0; 4];
                for (byte, register) in length.iter_mut().zip(LENGTH) {
                    *byte = self.read(register).await?;
                }
                let length = u32::from_le_bytes(length);
                return if length < PICTURE_BYTES { Err(MegaError::Short(length)) } else { Ok(()) };
            }
            delay.delay_ms(1).await;
        }
        Err(MegaError::Picture)
    }

    /// Reads the picture's next line as grey levels, in one transfer that begins with the first poll.
    ///
    /// # Errors
    /// When the bus fails.
    pub async fn line(&mut self, grey: &mut [u8]) -> Result<(), MegaError<S::Error>> {
        // What is sent after the command is zeros.
        self.burst.fill(0);
        let [_, rest @ ..] = &mut self.burst;
        let burst = if self.is_first_burst { &mut self.burst[..] } else { rest };
        if let [command, ..] = burst {
            *command = BURST;
        }
        self.bus.transfer_in_place(burst).await.map_err(MegaError::Bus)?;
        self.is_first_burst = false;
        let [_, _, line @ ..] = &self.burst;
        for (to, pixel) in grey.iter_mut().zip(line.as_chunks().0) {
            *to = grey_level(*pixel);
        }
        Ok(())
    }

    /// Waits until settings are done.
    async fn settled(&mut self, delay: &mut impl DelayNs) -> Result<(), MegaError<S::Error>> {
        for _ in 0..SETTING_MS {
            if self.read(STATE).await? & 3 == 2 {
                return Ok(());
            }
            delay.delay_ms(1).await;
        }
        Err(MegaError::Settings)
    }

    async fn write(&mut self, register: u8, value: u8) -> Result<(), MegaError<S::Error>> {
        self.bus.write(&[register | WRITE, value]).await.map_err(MegaError::Bus)
    }

    async fn read(&mut self, register: u8) -> Result<u8, MegaError<S::Error>> {
        let mut bytes = [register, 0, 0];
        self.bus.transfer_in_place(&mut bytes).await.map_err(MegaError::Bus)?;
        Ok(bytes[2])
    }
}

/// The grey level of a pixel, by the weights of ITU-R BT.601.
pub fn grey_level(pixel: [u8; 2]) -> u8 {
    let pixel = u32::from(u16::from_be_bytes(pixel));
    let (red, green, blue) = (pixel >> 11, pixel >> 5 & 63, pixel & 31);
    // Five and six bits to eight: the highest ones follow once more.
    let (red, green, blue) = (red << 3 | red >> 2, green << 2 | green >> 4, blue << 3 | blue >> 2);
    ((77 * red + 150 * green + 29 * blue) >> 8) as u8
}
