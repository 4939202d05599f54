//! Frame and line formats: size, pixel layout, time stamps.

/// Memory layout of the pixels of a line.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum PixelFormat {
    /// 8-bit grey, the format that the matchers take.
    Grey8,
    /// Grey in two bytes per pixel, low byte first, of which the low `bits` (8 to 16) are significant.
    Grey16 {
        /// Significant bits: 10 for a sensor with levels 0 to 1023.
        bits: u8,
    },
    /// MIPI CSI-2 RAW10, four pixels in five bytes: the high eight bits of each, then the low two of all
    /// four, the first pixel's lowest.
    Grey10Packed,
    /// MIPI CSI-2 RAW12, two pixels in three bytes: the high eight bits of each, then the low four of both.
    Grey12Packed,
    /// YUV 4:2:2, two pixels in four bytes, Y U Y V (YUY2).
    Yuyv,
    /// YUV 4:2:2, two pixels in four bytes, U Y V Y.
    Uyvy,
    /// RGB in two bytes per pixel: 5 bits of red, 6 of green, 5 of blue from the high bit down.
    Rgb565 {
        /// Whether the high byte comes first, as from parallel sensors; a framebuffer has the low byte
        /// first.
        high_byte_first: bool,
    },
    /// Bayer mosaic of any of the four patterns, one byte per pixel.
    Bayer8,
    /// Bayer mosaic in two bytes per pixel, low byte first, of which the low `bits` (8 to 16) are
    /// significant.
    Bayer16 {
        /// Significant bits.
        bits: u8,
    },
    /// Red, green, blue, one byte each.
    Rgb8,
    /// Red, green, blue, two bytes each, low byte first, of which the low `bits` (8 to 16) are significant.
    Rgb16 {
        /// Significant bits.
        bits: u8,
    },
}

impl PixelFormat {
    /// Bytes per pixel, rounded up where pixels share bytes.
    pub const fn bytes_per_pixel(self) -> usize {
        let (pixels, bytes) = self.group();
        bytes.div_ceil(pixels)
    }

    /// Pixels and bytes of the smallest whole group of pixels; a line is whole groups.
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

/// Size and pixel layout of a frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LineFormat {
    /// Pixels in a line.
    pub width: u16,
    /// Lines in a frame.
    pub height: u16,
    /// Layout of the pixels.
    pub pixel: PixelFormat,
}

impl LineFormat {
    /// Bytes of one line, the least size of a buffer for `next_line`.
    pub const fn line_bytes(self) -> usize {
        let (pixels, bytes) = self.pixel.group();
        (self.width as usize).div_ceil(pixels) * bytes
    }
}

/// Sequence number and time of a frame that begins.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FrameStart {
    /// Number of the frame, counting dropped ones too, so that a gap is a loss. Wraps around.
    pub sequence: u32,
    /// End of the first line's exposure, microseconds of the source's clock.
    pub timestamp_us: u64,
    /// Exposure of each line, microseconds; 0 where the source does not know it.
    pub exposure_us: u32,
}

/// Row and time of a line that a source delivered.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LineStart {
    /// The row in the frame, from 0.
    pub row: u16,
    /// Time of read-out, microseconds of the source's clock; the frame's time stamp where the source has no
    /// clock by line.
    pub timestamp_us: u64,
}
