//! Sharpness of a region of interest, which autofocus maximizes.

use super::{FocusLineError, Measure, SharpnessRows};

/// A rectangle of pixels.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Region {
    /// First column.
    pub left: u16,
    /// First row.
    pub top: u16,
    /// The number of columns.
    pub width: u16,
    /// The number of rows.
    pub height: u16,
}

/// Lines of a frame to the sharpness of a region, by [`Measure::Robust`].
///
/// ```
/// use stereopsis::focus::{Region, RegionSharpness};
/// let mut meter = RegionSharpness::<4>::new();
/// meter.start(4, 2, Region { left: 1, top: 0, width: 2, height: 2 });
/// for line in [[0, 8, 0, 0], [0, 0, 8, 0]] {
///     meter.push(&line)?;
/// }
/// // (64 + 32 + 32 + 64) / 4 sixteenths of a grey level per pixel, in 1/4096.
/// assert_eq!(meter.sharpness(), 12288);
/// # Ok::<(), stereopsis::focus::FocusLineError>(())
/// ```
#[derive(Debug)]
pub struct RegionSharpness<const W: usize> {
    rows: SharpnessRows<W>,
    region: Region,
    sum: u64,
    pixels: u64,
}

impl<const W: usize> RegionSharpness<W> {
    /// Waits for [`Self::start`].
    pub const fn new() -> Self {
        let region = Region { left: 0, top: 0, width: 0, height: 0 };
        Self { rows: SharpnessRows::new(), region, sum: 0, pixels: 0 }
    }

    /// Begins a frame. What of the region lies outside of the frame is left out.
    pub fn start(&mut self, width: u16, height: u16, region: Region) {
        self.rows.start(width, height, Measure::Robust, 0);
        (self.region, self.sum, self.pixels) = (region, 0, 0);
    }

    /// The next line of grey pixels.
    pub fn push(&mut self, line: &[u8]) -> Result<(), FocusLineError> {
        let Region { left, top, width, height } = self.region;
        let (left, top) = (usize::from(left), usize::from(top));
        self.rows.push(line, |y, row| {
            if (top..top + usize::from(height)).contains(&y) {
                let inside = row.iter().skip(left).take(width.into());
                self.sum += inside.clone().map(|&value| u64::from(value)).sum::<u64>();
                self.pixels += inside.count() as u64;
            }
        })
    }

    /// The mean of the measure over the region of the lines so far, in 1/4096 grey level: at most 22 bits.
    pub fn sharpness(&self) -> u32 {
        (self.sum * 256).checked_div(self.pixels).unwrap_or(0) as u32
    }
}

impl<const W: usize> Default for RegionSharpness<W> {
    fn default() -> Self {
        Self::new()
    }
}
