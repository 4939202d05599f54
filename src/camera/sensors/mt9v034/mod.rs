//! onsemi's MT9V034: 752x480 pixels of 10 bits behind a global shutter, on a parallel port.
//!
//! Registers have 16 bits at 8-bit addresses, the high byte first. Their names, numbers, limits and bits are
//! those of Linux's driver (`drivers/media/i2c/mt9v032.c`) and of OpenMV's
//! (`drivers/sensors/mt9v0xx_regs.h`); the timing is that of its automotive twin's data sheet, MT9V024/D,
//! tables 4 and 5.
//!
//! A row takes `width + horizontal blanking` clocks of the master clock, at least 704, and a frame
//! `max(rows + vertical blanking, exposure + 2)` rows and 4 clocks. The exposure is whole rows. Row binning
//! shortens a frame; column binning slows the pixel clock and saves no time (MT9V024/D, page 25).

mod settings;

pub use settings::{Mt9v034Binning, Mt9v034Mode, Mt9v034Pattern, Mt9v034Window};

use super::{ExposureControl, GainSteps, Outcome, SensorError, within};
use embedded_hal::digital::OutputPin;

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

/// Output pins on, and exposure while the frame before is read out. Bit 9 is clear: it is one after a reset,
/// and zero in normal operation.
const CONTROL: u16 = 1 << 7 | 1 << 8;
/// Bits of the read mode that have to be one.
const READ: u16 = 0x0300;
/// Values of reserved registers that the data sheet recommends.
const RECOMMENDED: [(u8, u16); 5] =
    [(0x13, 0x2d2e), (0x20, 0x03c7), (0x24, 0x001b), (0x2b, 0x0003), (0x2f, 0x0003)];
const LEAST_ROW_CLOCKS: u16 = 704;
/// Vertical blanking after a reset, rows.
const RESET_BLANKING: u16 = 45;

/// The driver over a blocking or an asynchronous bus: with `async` and `.await`, or nothing in their places.
macro_rules! driver {
    ($driver:ident, $about:expr, $i2c:path, $delay:path, [$($async:ident)?], [$($wait:tt)*]) => {
    #[doc = $about]
    #[derive(Debug)]
    pub struct $driver<I> {
        bus: I,
        address: u8,
        clock_hz: u32,
        window: Mt9v034Window,
        row_clocks: u16,
        vertical_blanking: u16,
    }

    impl<I: $i2c> $driver<I> {
        /// Addresses on the bus, 7 bits, for the pins S_CTRL_ADR1 and S_CTRL_ADR0 at 00, 01, 10, 11.
        pub const ADDRESSES: [u8; 4] = [0x48, 0x4c, 0x58, 0x5c];
        /// Version number that the chip reports.
        pub const IDENTITY: u16 = 0x1324;

        /// Creates a driver without touching the bus. `clock_hz` is the master clock, typically 26.6 MHz.
        pub const fn new(bus: I, address: u8, clock_hz: u32) -> Self {
            let window = Mt9v034Window::WHOLE;
            Self { bus, address, clock_hz, window, row_clocks: 752 + 94, vertical_blanking: RESET_BLANKING }
        }

        /// Resets the sensor by its active-low pin RESET_BAR and by register, checks its identity, and
        /// configures the whole array, free-running, without automatic exposure, automatic gain or high
        /// dynamic range.
        pub $($async)? fn initialise<P: OutputPin, D: $delay>(
            &mut self,
            reset: &mut P,
            delay: &mut D,
        ) -> Outcome<I> {
            reset.set_low().map_err(|_| SensorError::ResetPin)?;
            // At least 20 clocks, and 10 before the bus.
            delay.delay_us(10)$($wait)*;
            reset.set_high().map_err(|_| SensorError::ResetPin)?;
            delay.delay_us(10)$($wait)*;
            self.identify()$($wait)*?;
            self.write(RESET, 1)$($wait)*?;
            self.write(RESET, 0)$($wait)*?;
            for (register, value) in RECOMMENDED {
                self.write(register, value)$($wait)*?;
            }
            self.write(AEC_AGC_ENABLE, 0)$($wait)*?;
            self.write(PIXEL_OPERATION_MODE, 0)$($wait)*?;
            self.set_window(Mt9v034Window::WHOLE)$($wait)*?;
            self.write(VERTICAL_BLANKING, RESET_BLANKING)$($wait)*?;
            self.vertical_blanking = RESET_BLANKING;
            self.set_mode(Mt9v034Mode::Master)$($wait)*
        }

        /// Checks the chip's identity.
        pub $($async)? fn identify(&mut self) -> Outcome<I> {
            match self.read(CHIP_VERSION)$($wait)*? {
                Self::IDENTITY => Ok(()),
                found => Err(SensorError::Identity { found }),
            }
        }

        /// Sets who triggers the exposure.
        pub $($async)? fn set_mode(&mut self, mode: Mt9v034Mode) -> Outcome<I> {
            let bits = match mode {
                Mt9v034Mode::Master => 1 << 3,
                Mt9v034Mode::Snapshot => 3 << 3,
            };
            self.write(CHIP_CONTROL, CONTROL | bits)$($wait)*
        }

        /// Sets the window that is read out, with the shortest rows, and clears the flips. Lines have
        /// `width / binning` pixels, frames `height / binning` lines.
        pub $($async)? fn set_window(&mut self, window: Mt9v034Window) -> Outcome<I> {
            let Mt9v034Window { left, top, width, height, binning } = window;
            // The least blanking grows by ten clocks for each binned column.
            let least_blanking = match binning {
                Mt9v034Binning::One => 61,
                Mt9v034Binning::Two => 71,
                Mt9v034Binning::Four => 91,
            };
            let bits = binning as u16;
            within(width.into(), 1, u32::from(752_u16.saturating_sub(left)))?;
            within(height.into(), 1, u32::from(480_u16.saturating_sub(top)))?;
            let blanking = LEAST_ROW_CLOCKS.saturating_sub(width).max(least_blanking);
            self.write(READ_MODE, READ | bits << 2 | bits)$($wait)*?;
            // The array begins at column 1 and row 4.
            self.write(COLUMN_START, left + 1)$($wait)*?;
            self.write(ROW_START, top + 4)$($wait)*?;
            self.write(WINDOW_WIDTH, width)$($wait)*?;
            self.write(WINDOW_HEIGHT, height)$($wait)*?;
            self.write(HORIZONTAL_BLANKING, blanking)$($wait)*?;
            (self.window, self.row_clocks) = (window, width + blanking);
            Ok(())
        }

        /// Sets whether rows are read from below and columns from the right, for a sensor mounted upside
        /// down.
        pub $($async)? fn set_flips(&mut self, rows: bool, columns: bool) -> Outcome<I> {
            let bits = self.window.binning as u16;
            let flips = u16::from(rows) << 4 | u16::from(columns) << 5;
            self.write(READ_MODE, READ | flips | bits << 2 | bits)$($wait)*
        }

        /// Sets the time between two frames by the vertical blanking, rounded to whole rows.
        pub $($async)? fn set_frame_time(&mut self, frame_us: u32) -> Outcome<I> {
            let rows = self.rows_in(frame_us);
            let read = self.rows_read();
            let least = self.rows_us(read + 2);
            let most = self.rows_us(read + 32_288);
            within(frame_us, least, most)?;
            let blanking = rows.saturating_sub(read).clamp(2, 32_288) as u16;
            self.write(VERTICAL_BLANKING, blanking)$($wait)*?;
            self.vertical_blanking = blanking;
            Ok(())
        }

        /// Returns the time between two frames while no exposure is longer, microseconds.
        pub fn frame_time_us(&self) -> u32 {
            self.rows_us(self.rows_read() + u32::from(self.vertical_blanking))
        }

        /// Returns the read-out time of a row, nanoseconds.
        pub fn row_time_ns(&self) -> u32 {
            (u64::from(self.row_clocks) * 1_000_000_000 / u64::from(self.clock_hz.max(1))) as u32
        }

        /// Sets the exposure in rows, 0 to 32765. More rows than a frame has make the frame longer.
        pub $($async)? fn set_exposure_rows(&mut self, rows: u16) -> Outcome<I> {
            within(rows.into(), 0, 32_765)?;
            self.write(TOTAL_SHUTTER_WIDTH, rows)$($wait)*
        }

        /// Sets the analog gain in sixteenths: 16 to 64.
        pub $($async)? fn set_gain(&mut self, gain_16ths: u16) -> Outcome<I> {
            within(gain_16ths.into(), 16, 64)?;
            self.write(ANALOG_GAIN, gain_16ths)$($wait)*
        }

        /// Sets whether pixels are sampled on the falling edge of the pixel clock.
        pub $($async)? fn set_inverted_pixel_clock(&mut self, inverted: bool) -> Outcome<I> {
            self.write(PIXEL_CLOCK, u16::from(inverted) << 4)$($wait)*
        }

        /// Sets a test pattern.
        pub $($async)? fn set_test_pattern(&mut self, pattern: Mt9v034Pattern) -> Outcome<I> {
            const ON: u16 = 1 << 13;
            let bits = match pattern {
                Mt9v034Pattern::Off => 0,
                Mt9v034Pattern::Grey(grey) => ON | 1 << 10 | within(grey.into(), 0, 1023)? as u16,
                Mt9v034Pattern::Vertical => ON | 1 << 11,
                Mt9v034Pattern::Horizontal => ON | 2 << 11,
                Mt9v034Pattern::Diagonal => ON | 3 << 11,
            };
            self.write(TEST_PATTERN, bits)$($wait)*
        }

        /// Returns the shortest and the longest exposure that keep the frame rate, microseconds. In a frame
        /// of two rows none does: then both are the shortest that there is, one row.
        pub fn exposure_limits_us(&self) -> (u32, u32) {
            // Two rows fewer than a frame has, blanking included.
            let most = (self.rows_read() + u32::from(self.vertical_blanking)).saturating_sub(2).max(1);
            (self.rows_us(1), self.rows_us(most))
        }

        /// Returns the time of a row, microseconds, rounded up: the step of the exposure.
        pub fn exposure_step_us(&self) -> u32 {
            self.rows_us(1)
        }

        /// Sets the exposure, rounded to whole rows, and the gain in sixteenths. The gain takes effect with
        /// the next frame, the exposure with the one after it.
        pub $($async)? fn set_exposure(&mut self, exposure_us: u32, gain_16ths: u16) -> Outcome<I> {
            self.set_exposure_rows(self.rows_in(exposure_us).clamp(1, 32_765) as u16)$($wait)*?;
            self.set_gain(gain_16ths)$($wait)*
        }

        /// Releases the bus.
        pub fn release(self) -> I {
            self.bus
        }

        /// Lines of a frame.
        fn rows_read(&self) -> u32 {
            u32::from(self.window.height >> self.window.binning as u16)
        }

        /// Duration of rows, rounded up, microseconds.
        fn rows_us(&self, rows: u32) -> u32 {
            let clocks = u64::from(rows) * u64::from(self.row_clocks) + 4;
            (clocks * 1_000_000).div_ceil(u64::from(self.clock_hz.max(1))).min(u32::MAX.into()) as u32
        }

        /// Whole rows in a time.
        fn rows_in(&self, time_us: u32) -> u32 {
            let clocks = u64::from(time_us) * u64::from(self.clock_hz) / 1_000_000;
            (clocks / u64::from(self.row_clocks.max(1))).min(u32::MAX.into()) as u32
        }

        $($async)? fn write(&mut self, register: u8, value: u16) -> Outcome<I> {
            let [high, low] = value.to_be_bytes();
            self.bus.write(self.address, &[register, high, low])$($wait)*.map_err(SensorError::Bus)
        }

        $($async)? fn read(&mut self, register: u8) -> Outcome<I, u16> {
            let mut value = [0; 2];
            self.bus.write_read(self.address, &[register], &mut value)$($wait)*.map_err(SensorError::Bus)?;
            Ok(u16::from_be_bytes(value))
        }
    }
    };
}

drivers!(driver, Mt9v034, AsyncMt9v034, "MT9V034", 64, Sixteenths);
