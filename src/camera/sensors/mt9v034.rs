//! onsemi's MT9V034: 752x480 pixels of 10 bits behind a global shutter, on a parallel port.
//!
//! Registers have 16 bits at addresses of 8, the high byte first. Their names, numbers, limits and bits are those of Linux's driver
//! (`drivers/media/i2c/mt9v032.c`) and of OpenMV's (`drivers/sensors/mt9v0xx_regs.h`); the timing is that of the data sheet of
//! its twin for cars, MT9V024/D, tables 4 and 5.
//!
//! A row takes `width + horizontal blanking` clocks of the master clock, 704 at least, and a frame
//! `max(rows + vertical blanking, exposure + 2)` rows and 4 clocks. The exposure is whole rows. Binned rows are read out in as many
//! fewer row times; binned columns are clocked out slower and save none.

use super::{ExposureControl, SensorError, within};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_hal::i2c::I2c;

const CHIP_VERSION: u8 = 0x00;
const COLUMN_START: u8 = 0x01;
const ROW_START: u8 = 0x02;
const WINDOW_HEIGHT: u8 = 0x03;
const WINDOW_WIDTH: u8 = 0x04;
const HORIZONTAL_BLANKING: u8 = 0x05;
const VERTICAL_BLANKING: u8 = 0x06;
const CHIP_CONTROL: u8 = 0x07;
const TOTAL_SHUTTER_WIDTH: u8 = 0x0b;
const RESET: u8 = 0x0c;
const READ_MODE: u8 = 0x0d;
const PIXEL_OPERATION_MODE: u8 = 0x0f;
const ANALOG_GAIN: u8 = 0x35;
const PIXEL_CLOCK: u8 = 0x72;
const TEST_PATTERN: u8 = 0x7f;
const AEC_AGC_ENABLE: u8 = 0xaf;

/// Output pins on, exposure while the frame before is read out, and a bit that has to be one.
const CONTROL: u16 = 1 << 7 | 1 << 8 | 1 << 9;
/// Bits of the read mode that have to be one.
const READ: u16 = 0x0300;
/// Values of reserved registers that the data sheet recommends.
const RECOMMENDED: [(u8, u16); 5] = [(0x13, 0x2d2e), (0x20, 0x03c7), (0x24, 0x001b), (0x2b, 0x0003), (0x2f, 0x0003)];
const LEAST_ROW_CLOCKS: u16 = 704;

/// Who says when a frame is exposed.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Mt9v034Mode {
    /// The sensor, one frame after the other.
    #[default]
    Master,
    /// A pulse on its pin EXPOSURE: both sensors of a pair on one pin ([`Triggered`](crate::camera::Triggered)) expose together,
    /// for as long as the register says.
    Snapshot,
    /// Pulses on EXPOSURE and STFRM_OUT, which say when the exposure begins and ends.
    Slave,
}

/// The part of the array that is read out, in its pixels, and how many of them become one.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Mt9v034Window {
    /// The first column, from 0.
    pub left: u16,
    /// The first row, from 0.
    pub top: u16,
    /// Columns: at most 752.
    pub width: u16,
    /// Rows: at most 480.
    pub height: u16,
    /// Columns and rows that become one pixel: 1, 2 or 4.
    pub binning: u8,
}

impl Mt9v034Window {
    /// The whole array.
    pub const WHOLE: Self = Self { left: 0, top: 0, width: 752, height: 480, binning: 1 };
}

/// What the sensor sends instead of what it sees.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Mt9v034Pattern {
    /// What it sees.
    Off,
    /// One grey, of 10 bits.
    Grey(u16),
    /// Brightness rises down the columns.
    Vertical,
    /// Along the rows.
    Horizontal,
    /// Both.
    Diagonal,
}

/// A MT9V034 on an I2C bus.
#[derive(Debug)]
pub struct Mt9v034<I> {
    bus: I,
    address: u8,
    clock_hz: u32,
    window: Mt9v034Window,
    row_clocks: u16,
    vertical_blanking: u16,
}

impl<I: I2c> Mt9v034<I> {
    /// Its addresses on the bus, 7 bits, by its pins S_CTRL_ADR1 and S_CTRL_ADR0: 00, 01, 10, 11.
    pub const ADDRESSES: [u8; 4] = [0x48, 0x4c, 0x58, 0x5c];
    /// What it says that it is.
    pub const IDENTITY: u16 = 0x1324;

    /// A sensor on that bus, with a master clock of so many hertz: 26.6 MHz as a rule. Nothing is sent.
    pub const fn new(bus: I, address: u8, clock_hz: u32) -> Self {
        let window = Mt9v034Window::WHOLE;
        Self { bus, address, clock_hz, window, row_clocks: 752 + 94, vertical_blanking: 45 }
    }

    /// Resets the sensor by its pin RESET_BAR, which is low for a reset, and by its register, asks who it is, and sets what the data
    /// sheet recommends: the whole array, no automatic exposure or gain, no high dynamic range, free-running.
    pub fn initialise<P: OutputPin, D: DelayNs>(
        &mut self,
        reset: &mut P,
        delay: &mut D,
    ) -> Result<(), SensorError<I::Error>> {
        reset.set_low().map_err(|_| SensorError::ResetPin)?;
        // At least 20 clocks, and 10 before the bus.
        delay.delay_us(10);
        reset.set_high().map_err(|_| SensorError::ResetPin)?;
        delay.delay_us(10);
        self.identify()?;
        self.write(RESET, 1)?;
        self.write(RESET, 0)?;
        for (register, value) in RECOMMENDED {
            self.write(register, value)?;
        }
        self.write(AEC_AGC_ENABLE, 0)?;
        self.write(PIXEL_OPERATION_MODE, 0)?;
        self.set_window(Mt9v034Window::WHOLE)?;
        self.set_mode(Mt9v034Mode::Master)
    }

    /// Asks the chip who it is.
    pub fn identify(&mut self) -> Result<(), SensorError<I::Error>> {
        match self.read(CHIP_VERSION)? {
            Self::IDENTITY => Ok(()),
            found => Err(SensorError::Identity { found }),
        }
    }

    /// Says who tells the sensor when to expose.
    pub fn set_mode(&mut self, mode: Mt9v034Mode) -> Result<(), SensorError<I::Error>> {
        let bits = match mode {
            Mt9v034Mode::Slave => 0,
            Mt9v034Mode::Master => 1 << 3,
            Mt9v034Mode::Snapshot => 3 << 3,
        };
        self.write(CHIP_CONTROL, CONTROL | bits)
    }

    /// Reads out that part of the array, with the shortest rows; flips go. Lines have `width / binning` pixels, frames `height / binning`
    /// lines.
    pub fn set_window(&mut self, window: Mt9v034Window) -> Result<(), SensorError<I::Error>> {
        let Mt9v034Window { left, top, width, height, binning } = window;
        // The least blanking grows by ten clocks for each binned column.
        let (bits, least_blanking) = match binning {
            1 => (0, 61),
            2 => (1, 71),
            4 => (2, 91),
            _ => return Err(SensorError::OutOfRange { least: 1, most: 4 }),
        };
        within(width.into(), 1, u32::from(752_u16.saturating_sub(left)))?;
        within(height.into(), 1, u32::from(480_u16.saturating_sub(top)))?;
        let blanking = LEAST_ROW_CLOCKS.saturating_sub(width).max(least_blanking);
        self.write(READ_MODE, READ | bits << 2 | bits)?;
        // The array begins at column 1 and row 4.
        self.write(COLUMN_START, left + 1)?;
        self.write(ROW_START, top + 4)?;
        self.write(WINDOW_WIDTH, width)?;
        self.write(WINDOW_HEIGHT, height)?;
        self.write(HORIZONTAL_BLANKING, blanking)?;
        (self.window, self.row_clocks) = (window, width + blanking);
        Ok(())
    }

    /// Reads rows from below, columns from the right: for a sensor that stands on its head.
    pub fn set_flips(&mut self, rows: bool, columns: bool) -> Result<(), SensorError<I::Error>> {
        let bits = u16::from(self.window.binning.trailing_zeros() as u8);
        let flips = u16::from(rows) << 4 | u16::from(columns) << 5;
        self.write(READ_MODE, READ | flips | bits << 2 | bits)
    }

    /// Sets the time between two frames by the vertical blanking, to the next whole row.
    pub fn set_frame_time(&mut self, frame_us: u32) -> Result<(), SensorError<I::Error>> {
        let rows = self.rows_in(frame_us);
        let read = self.rows_read();
        let least = self.rows_us(read + 2);
        let most = self.rows_us(read + 32_288);
        within(frame_us, least, most)?;
        let blanking = rows.saturating_sub(read).clamp(2, 32_288) as u16;
        self.write(VERTICAL_BLANKING, blanking)?;
        self.vertical_blanking = blanking;
        Ok(())
    }

    /// The time between two frames, as long as no exposure is longer, microseconds.
    pub fn frame_time_us(&self) -> u32 {
        self.rows_us(self.rows_read() + u32::from(self.vertical_blanking))
    }

    /// How long a row takes to be read out, nanoseconds.
    pub fn row_time_ns(&self) -> u32 {
        (u64::from(self.row_clocks) * 1_000_000_000 / u64::from(self.clock_hz.max(1))) as u32
    }

    /// Exposes for so many rows' time: 0 to 32765. More than a frame's makes the frame longer.
    pub fn set_exposure_rows(&mut self, rows: u16) -> Result<(), SensorError<I::Error>> {
        within(rows.into(), 0, 32_765)?;
        self.write(TOTAL_SHUTTER_WIDTH, rows)
    }

    /// Sets the analog gain in sixteenths: 16 to 64.
    pub fn set_gain(&mut self, gain_16ths: u16) -> Result<(), SensorError<I::Error>> {
        within(gain_16ths.into(), 16, 64)?;
        self.write(ANALOG_GAIN, gain_16ths)
    }

    /// Samples on the falling edge of the pixel clock instead of the rising one.
    pub fn set_inverted_pixel_clock(&mut self, inverted: bool) -> Result<(), SensorError<I::Error>> {
        self.write(PIXEL_CLOCK, u16::from(inverted) << 4)
    }

    /// Sends a pattern.
    pub fn set_test_pattern(&mut self, pattern: Mt9v034Pattern) -> Result<(), SensorError<I::Error>> {
        const ON: u16 = 1 << 13;
        let bits = match pattern {
            Mt9v034Pattern::Off => 0,
            Mt9v034Pattern::Grey(grey) => ON | 1 << 10 | within(grey.into(), 0, 1023)? as u16,
            Mt9v034Pattern::Vertical => ON | 1 << 11,
            Mt9v034Pattern::Horizontal => ON | 2 << 11,
            Mt9v034Pattern::Diagonal => ON | 3 << 11,
        };
        self.write(TEST_PATTERN, bits)
    }

    /// Gives the bus back.
    pub fn release(self) -> I {
        self.bus
    }

    /// Lines of a frame.
    fn rows_read(&self) -> u32 {
        u32::from(self.window.height) / u32::from(self.window.binning.max(1))
    }

    /// The time of so many rows, rounded up.
    fn rows_us(&self, rows: u32) -> u32 {
        let clocks = u64::from(rows) * u64::from(self.row_clocks) + 4;
        (clocks * 1_000_000).div_ceil(u64::from(self.clock_hz.max(1))).min(u32::MAX.into()) as u32
    }

    /// Whole rows in that time.
    fn rows_in(&self, time_us: u32) -> u32 {
        let clocks = u64::from(time_us) * u64::from(self.clock_hz) / 1_000_000;
        (clocks / u64::from(self.row_clocks.max(1))).min(u32::MAX.into()) as u32
    }

    fn write(&mut self, register: u8, value: u16) -> Result<(), SensorError<I::Error>> {
        let [high, low] = value.to_be_bytes();
        self.bus.write(self.address, &[register, high, low]).map_err(SensorError::Bus)
    }

    fn read(&mut self, register: u8) -> Result<u16, SensorError<I::Error>> {
        let mut value = [0; 2];
        self.bus.write_read(self.address, &[register], &mut value).map_err(SensorError::Bus)?;
        Ok(u16::from_be_bytes(value))
    }
}

impl<I: I2c> ExposureControl for Mt9v034<I> {
    type Error = SensorError<I::Error>;

    fn exposure_limits_us(&self) -> (u32, u32) {
        // Two rows fewer than a frame has, blanking included.
        let most = (self.rows_read() + u32::from(self.vertical_blanking)).saturating_sub(2);
        (self.rows_us(1), self.rows_us(most))
    }

    fn most_gain_16ths(&self) -> u16 {
        64
    }

    /// The gain counts for the next frame, and the exposure for the one after it: its exposure has not begun.
    fn set_exposure(&mut self, exposure_us: u32, gain_16ths: u16) -> Result<(), Self::Error> {
        self.set_exposure_rows(self.rows_in(exposure_us).clamp(1, 32_765) as u16)?;
        self.set_gain(gain_16ths)
    }
}
