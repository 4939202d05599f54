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
    /// 10 bits a pixel, four pixels in five bytes as MIPI CSI-2 has them (RAW10): the high eight bits of
    /// each, then the low two of all, the first pixel's lowest.
    Grey10Packed,
    /// 12 bits a pixel, two pixels in three bytes (RAW12): the high eight bits of each, then the low four of
    /// both.
    Grey12Packed,
    /// Two pixels in four bytes, Y U Y V: brightness, with colour between (YUY2).
    Yuyv,
    /// Two pixels in four bytes, U Y V Y.
    Uyvy,
    /// Two bytes a pixel, 5 bits of red, 6 of green, 5 of blue from the high bit down.
    Rgb565 {
        /// Whether the high byte comes first, as parallel sensors send it; else the low one does, as a
        /// framebuffer has it.
        high_byte_first: bool,
    },
    /// One byte a pixel under a mosaic of colours, of any of the four Bayer patterns.
    Bayer8,
    /// Two bytes a pixel, low byte first, of which the low `bits` (8 to 16) carry brightness, under a Bayer
    /// mosaic.
    Bayer16 {
        /// Significant bits.
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
    /// Bytes of one pixel, rounded up where pixels share them.
    pub const fn bytes_per_pixel(self) -> usize {
        let (pixels, bytes) = self.group();
        bytes.div_ceil(pixels)
    }

    /// How many pixels stand together in how many bytes: a line is whole groups.
    pub const fn group(self) -> (usize, usize) {
        match self {
            Self::Grey8 | Self::Bayer8 => (1, 1),
            Self::Grey16 { .. } | Self::Bayer16 { .. } | Self::Rgb565 { .. } => (1, 2),
            Self::Grey10Packed => (4, 5),
            Self::Grey12Packed => (2, 3),
            Self::Yuyv | Self::Uyvy => (2, 4),
            Self::Rgb8 => (1, 3),
            Self::Rgb16 { .. } => (1, 6),
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
        let (pixels, bytes) = self.pixel.group();
        (self.width as usize).div_ceil(pixels) * bytes
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
    /// When the line was read out, microseconds of the source's clock; equals the frame's time stamp where
    /// the source has no clock by line.
    pub timestamp_us: u64,
}
