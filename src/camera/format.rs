//! What is known about a frame and its lines.

/// How the pixels of a line lie in memory.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PixelFormat {
    /// One byte of brightness a pixel: what the matchers take.
    Grey8,
    /// Two bytes a pixel, low byte first, of which the low `bits` (8 to 16) carry brightness.
    Grey16 {
        /// Significant bits: 10 for a sensor that gives 0 to 1023.
        bits: u8,
    },
    /// Red, green, blue, one byte each.
    Rgb8,
    /// Red, green, blue, two bytes each, low byte first, of which the low `bits` (8 to 16) carry brightness.
    Rgb16 {
        /// Significant bits.
        bits: u8,
    },
}

impl PixelFormat {
    /// Bytes of one pixel.
    pub const fn bytes_per_pixel(self) -> usize {
        match self {
            Self::Grey8 => 1,
            Self::Grey16 { .. } => 2,
            Self::Rgb8 => 3,
            Self::Rgb16 { .. } => 6,
        }
    }
}

/// The shape of a frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LineFormat {
    /// Pixels in a line.
    pub width: u16,
    /// Lines in a frame.
    pub height: u16,
    /// The pixels' layout.
    pub pixel: PixelFormat,
}

impl LineFormat {
    /// Bytes of one line: what the buffer given to `next_line` has to hold.
    pub const fn line_bytes(self) -> usize {
        self.width as usize * self.pixel.bytes_per_pixel()
    }
}

/// What is known when a frame begins.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FrameStart {
    /// Counts the frames that the sensor began, dropped ones too: a gap tells of a loss. It wraps.
    pub sequence: u32,
    /// When the exposure of the first line ended, in microseconds of the source's clock.
    pub timestamp_us: u64,
    /// How long each line was exposed, microseconds; 0 where the source does not know.
    pub exposure_us: u32,
}

/// What is known about a line that was handed out.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LineStart {
    /// The row in the frame, from 0.
    pub row: u16,
    /// When the line was read out, microseconds of the source's clock; equals the frame's time stamp where the source
    /// has no clock by line.
    pub timestamp_us: u64,
}
