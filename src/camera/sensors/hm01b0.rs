//! Himax's HM01B0: 324x324 pixels of 8 bits behind a rolling shutter, a few milliwatts.
//!
//! Registers have 8 bits at 16-bit addresses, the high byte first. Their names and numbers are those of
//! OpenMV's driver (`drivers/sensors/hm01b0.c` and `.h`, MIT), and so are most values; some are reserved in
//! the data sheet, but the picture is bad without them. Three are different. Both targets of the black level
//! are 8, as in Himax's own table, where OpenMV ends with 0 for the first one. The clock divisor is written
//! once, for 8, and not by the frame rate. The edge of PCLK at which data are valid (0x3068) stays as it is
//! after a reset.
//!
//! A line takes 376 clocks. The exposure is whole lines, at most two fewer than the frame has. What is
//! written after [`Hm01b0::initialise`] takes effect with the frame after the group command.

use super::{ExposureControl, GainSteps, Outcome, SensorError, within};

const MODEL_ID_HIGH: u16 = 0x0000;
const MODEL_ID_LOW: u16 = 0x0001;
const MODE_SELECT: u16 = 0x0100;
const ORIENTATION: u16 = 0x0101;
const SOFTWARE_RESET: u16 = 0x0103;
const GROUP: u16 = 0x0104;
const INTEGRATION: u16 = 0x0202;
const ANALOG_GAIN: u16 = 0x0205;
const FRAME_LINES: u16 = 0x0340;
const LINE_CLOCKS: u16 = 0x0342;
const READOUT_X: u16 = 0x0383;
const READOUT_Y: u16 = 0x0387;
const BINNING: u16 = 0x0390;
const TEST_PATTERN: u16 = 0x0601;
const AUTO_EXPOSURE: u16 = 0x2100;
const QVGA_WINDOW: u16 = 0x3010;

/// Number of polls for the end of a reset.
const ATTEMPTS: u8 = 10;
const CLOCKS_A_LINE: u16 = 0x0178;

/// Analog settings, black level, defect correction for a sensor without colours, eight bits a pixel, and the
/// clocks: lines are counted in an eighth of the master clock, registers run at all of it, and PCLK goes on
/// between two lines.
#[rustfmt::skip]
const SETTINGS: [(u16, u8); 31] = [
    (0x1003, 0x08), (0x1007, 0x08), (0x3044, 0x0a), (0x3045, 0x00), (0x3047, 0x0a), (0x3050, 0xc0),
    (0x3051, 0x42), (0x3052, 0x50), (0x3053, 0x00), (0x3054, 0x03), (0x3055, 0xf7), (0x3056, 0xf8),
    (0x3057, 0x29), (0x3058, 0x1f), (0x3064, 0x00), (0x3065, 0x04), (0x3067, 0x00), (0x1000, 0x43),
    (0x1001, 0x43), (0x1002, 0x43), (0x0350, 0x7f), (0x1006, 0x01), (0x1008, 0x01), (0x1009, 0xa0),
    (0x100a, 0x60), (0x100b, 0x90), (0x100c, 0x40), (0x1012, 0x00), (0x3059, 0x02),
    (0x3011, 0x70), (0x3060, 0x08),
];

/// Region of the pixel array that is read out.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Hm01b0Size {
    /// Whole array: 324x324.
    Whole,
    /// Middle of the array: 324x244.
    #[default]
    Qvga,
    /// Middle of the array in bins of 2x2 pixels: 162x122.
    Qqvga,
}

impl Hm01b0Size {
    /// Least lines of a frame, blanking included.
    const fn least_lines(self) -> u16 {
        match self {
            // Open drivers write 265, fewer than its rows. By Zephyr's driver (`drivers/video/hm01b0.c`) the
            // whole array has at most 45 frames a second and the window 60, so that its 260 lines are 346.
            Self::Whole => 346,
            Self::Qvga => 0x0104,
            Self::Qqvga => 0x0084,
        }
    }

    /// Pixels in a line and lines in a frame.
    pub const fn pixels(self) -> (u16, u16) {
        match self {
            Self::Whole => (324, 324),
            Self::Qvga => (324, 244),
            Self::Qqvga => (162, 122),
        }
    }
}

/// Operating mode of the sensor.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Hm01b0Mode {
    /// Standby without frames.
    Standby,
    /// One frame after the other.
    Streaming,
    /// Frames while its pin TRIG is high. For one frame hold it until the frame's last line has come, and
    /// take it back before the next one begins. Sensors on one pin begin together.
    Triggered,
}

/// The driver over a blocking or an asynchronous bus: with `async` and `.await`, or nothing in their places.
macro_rules! driver {
    ($driver:ident, $about:expr, $i2c:path, $delay:path, [$($async:ident)?], [$($wait:tt)*]) => {
    #[doc = $about]
    #[derive(Debug)]
    pub struct $driver<I> {
        bus: I,
        /// Clock in which lines are counted, Hz.
        clock_hz: u32,
        frame_lines: u16,
        /// Lines of the exposure that was asked for; 0 before a start, which leaves it to the chip.
        exposure_lines: u16,
        size: Hm01b0Size,
    }

    impl<I: $i2c> $driver<I> {
        /// Address on the bus, 7 bits.
        pub const ADDRESS: u8 = 0x24;
        /// Model number that the chip reports.
        pub const IDENTITY: u16 = 0x01b0;

        /// Creates a driver without touching the bus. `clock_hz` is the clock in which lines are counted: an
        /// eighth of the master clock, as [`Self::initialise`] sets the register OSC_CLK_DIV.
        pub const fn new(bus: I, clock_hz: u32) -> Self {
            let size = Hm01b0Size::Qvga;
            Self { bus, clock_hz, frame_lines: size.least_lines(), exposure_lines: 0, size }
        }

        /// Resets the sensor, checks its identity, and sets it up in standby without automatic exposure, with
        /// the longest exposure that its frames have lines for.
        pub $($async)? fn initialise<D: $delay>(&mut self, delay: &mut D) -> Outcome<I> {
            self.write(SOFTWARE_RESET, 1)$($wait)*?;
            self.exposure_lines = 0;
            delay.delay_ms(1)$($wait)*;
            let mut is_ready = false;
            for _ in 0..ATTEMPTS {
                is_ready = self.read(MODE_SELECT)$($wait)*? == 0;
                if is_ready {
                    break;
                }
                delay.delay_ms(10)$($wait)*;
            }
            if !is_ready {
                return Err(SensorError::NoReset);
            }
            self.identify()$($wait)*?;
            for (register, value) in SETTINGS {
                self.write(register, value)$($wait)*?;
            }
            self.write(AUTO_EXPOSURE, 0)$($wait)*?;
            self.write_pair(LINE_CLOCKS, CLOCKS_A_LINE)$($wait)*?;
            // The chip's own exposure is longer than a frame has lines for.
            self.exposure_lines = Hm01b0Size::Qvga.least_lines().saturating_sub(2);
            self.set_size(Hm01b0Size::Qvga)$($wait)*
        }

        /// Checks the chip's identity.
        pub $($async)? fn identify(&mut self) -> Outcome<I> {
            let (high, low) = (self.read(MODEL_ID_HIGH)$($wait)*?, self.read(MODEL_ID_LOW)$($wait)*?);
            let found = u16::from_be_bytes([high, low]);
            if found == Self::IDENTITY { Ok(()) } else { Err(SensorError::Identity { found }) }
        }

        /// Sets the operating mode.
        pub $($async)? fn set_mode(&mut self, mode: Hm01b0Mode) -> Outcome<I> {
            self.write(
                MODE_SELECT,
                match mode {
                    Hm01b0Mode::Standby => 0,
                    Hm01b0Mode::Streaming => 1,
                    Hm01b0Mode::Triggered => 5,
                },
            )$($wait)*
        }

        /// Sets the region that is read out, at the clock's highest frame rate. An exposure that the frame is
        /// too short for is shortened.
        pub $($async)? fn set_size(&mut self, size: Hm01b0Size) -> Outcome<I> {
            let (readout, binning) = if size == Hm01b0Size::Qqvga { (3, 3) } else { (1, 0) };
            self.write(READOUT_X, readout)$($wait)*?;
            self.write(READOUT_Y, readout)$($wait)*?;
            self.write(BINNING, binning)$($wait)*?;
            self.write(QVGA_WINDOW, u8::from(size != Hm01b0Size::Whole))$($wait)*?;
            self.set_frame_lines(size.least_lines())$($wait)*?;
            self.size = size;
            Ok(())
        }

        /// Sets the time between two frames, rounded to whole lines. An exposure that is too long for it is
        /// shortened until the frame is longer again.
        pub $($async)? fn set_frame_time(&mut self, frame_us: u32) -> Outcome<I> {
            within(frame_us, self.lines_us(self.size.least_lines()), self.lines_us(u16::MAX))?;
            let lines = self.lines_in(frame_us).max(self.size.least_lines());
            self.set_frame_lines(lines)$($wait)*
        }

        /// Sets the lines of a frame, with the exposure within them.
        $($async)? fn set_frame_lines(&mut self, lines: u16) -> Outcome<I> {
            self.write_pair(FRAME_LINES, lines)$($wait)*?;
            if self.exposure_lines > 0 {
                self.write_pair(INTEGRATION, self.exposure_lines.min(lines.saturating_sub(2)))$($wait)*?;
            }
            self.write(GROUP, 1)$($wait)*?;
            self.frame_lines = lines;
            Ok(())
        }

        /// Returns the time between two frames, microseconds.
        pub fn frame_time_us(&self) -> u32 {
            self.lines_us(self.frame_lines)
        }

        /// Sets whether rows are read from below and columns from the right.
        pub $($async)? fn set_flips(&mut self, rows: bool, columns: bool) -> Outcome<I> {
            self.write(ORIENTATION, u8::from(columns) | u8::from(rows) << 1)$($wait)*?;
            self.write(GROUP, 1)$($wait)*
        }

        /// Sets whether bars are sent instead of the picture.
        pub $($async)? fn set_test_pattern(&mut self, is_on: bool) -> Outcome<I> {
            self.write(TEST_PATTERN, u8::from(is_on))$($wait)*
        }

        /// Returns the shortest and the longest exposure that keep the frame rate, microseconds.
        pub fn exposure_limits_us(&self) -> (u32, u32) {
            (self.lines_us(2), self.lines_us(self.frame_lines.saturating_sub(2)))
        }

        /// Returns the time of a line, microseconds, rounded up: the step of the exposure.
        pub fn exposure_step_us(&self) -> u32 {
            self.lines_us(1)
        }

        /// Sets the exposure, rounded to whole lines, and the gain in sixteenths, rounded down to 1, 2, 4 or
        /// 8.
        pub $($async)? fn set_exposure(&mut self, exposure_us: u32, gain_16ths: u16) -> Outcome<I> {
            within(gain_16ths.into(), 16, 128)?;
            let lines = self.lines_in(exposure_us).clamp(2, self.frame_lines.saturating_sub(2).max(2));
            let doublings = (gain_16ths / 16).checked_ilog2().unwrap_or(0) as u8;
            self.write_pair(INTEGRATION, lines)$($wait)*?;
            self.write(ANALOG_GAIN, doublings << 4)$($wait)*?;
            self.write(GROUP, 1)$($wait)*?;
            self.exposure_lines = lines;
            Ok(())
        }

        /// Releases the bus.
        pub fn release(self) -> I {
            self.bus
        }

        fn lines_us(&self, lines: u16) -> u32 {
            let clocks = u64::from(lines) * u64::from(CLOCKS_A_LINE);
            (clocks * 1_000_000).div_ceil(u64::from(self.clock_hz.max(1))).min(u32::MAX.into()) as u32
        }

        fn lines_in(&self, time_us: u32) -> u16 {
            let clocks = u64::from(time_us) * u64::from(self.clock_hz) / 1_000_000;
            (clocks / u64::from(CLOCKS_A_LINE)).min(u16::MAX.into()) as u16
        }

        $($async)? fn write(&mut self, register: u16, value: u8) -> Outcome<I> {
            let [high, low] = register.to_be_bytes();
            self.bus.write(Self::ADDRESS, &[high, low, value])$($wait)*.map_err(SensorError::Bus)
        }

        /// Writes two adjacent registers, the high byte first.
        $($async)? fn write_pair(&mut self, register: u16, value: u16) -> Outcome<I> {
            let [high, low] = value.to_be_bytes();
            self.write(register, high)$($wait)*?;
            self.write(register + 1, low)$($wait)*
        }

        $($async)? fn read(&mut self, register: u16) -> Outcome<I, u8> {
            let mut value = [0];
            let read = self.bus.write_read(Self::ADDRESS, &register.to_be_bytes(), &mut value)$($wait)*;
            read.map_err(SensorError::Bus)?;
            let [value] = value;
            Ok(value)
        }
    }
    };
}

drivers!(driver, Hm01b0, AsyncHm01b0, "HM01B0", 128, Doublings);
