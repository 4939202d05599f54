//! Grey-level histogram of a frame.

/// Histogram of a frame's grey levels in 16 bins, with counts of black and saturated pixels, in 80 bytes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Histogram {
    bins: [u32; 16],
    black: u32,
    saturated: u32,
    sum: u64,
}

impl Histogram {
    /// Largest grey level that counts as black.
    pub const BLACK: u8 = 2;
    /// Least grey level that counts as saturated.
    pub const SATURATED: u8 = 253;

    /// Creates an empty histogram.
    pub const fn new() -> Self {
        Self { bins: [0; 16], black: 0, saturated: 0, sum: 0 }
    }

    /// Begins a frame.
    pub fn begin(&mut self) {
        *self = Self::new();
    }

    /// Counts every eighth pixel of a line, from column `row % 8` on: a line of 320 costs 40 look-ups.
    pub fn line(&mut self, row: usize, line: &[u8]) {
        for &grey in line.iter().skip(row % 8).step_by(8) {
            if let Some(bin) = self.bins.get_mut(usize::from(grey >> 4)) {
                *bin = bin.saturating_add(1);
            }
            self.black = self.black.saturating_add(u32::from(grey <= Self::BLACK));
            self.saturated = self.saturated.saturating_add(u32::from(grey >= Self::SATURATED));
            self.sum = self.sum.saturating_add(u64::from(grey));
        }
    }

    /// Returns the number of pixels counted.
    pub fn count(&self) -> u32 {
        self.bins.iter().fold(0, |sum, &bin| sum.saturating_add(bin))
    }

    /// Returns the counts of levels 0 to 15, 16 to 31, and so on.
    pub fn bins(&self) -> &[u32; 16] {
        &self.bins
    }

    /// Returns the mean grey level in 16ths; 0 of an empty histogram.
    pub fn mean_16ths(&self) -> u16 {
        (16 * self.sum).checked_div(self.count().into()).unwrap_or(0) as u16
    }

    /// Returns the share of black pixels, per mille.
    pub fn black_per_mille(&self) -> u16 {
        self.per_mille(self.black)
    }

    /// Returns the share of saturated pixels, per mille.
    pub fn saturated_per_mille(&self) -> u16 {
        self.per_mille(self.saturated)
    }

    fn per_mille(&self, part: u32) -> u16 {
        (u64::from(part) * 1000).checked_div(self.count().into()).unwrap_or(0) as u16
    }
}

impl Default for Histogram {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_of_eight_columns_is_counted_and_all_in_eight_rows() {
        let mut histogram = Histogram::new();
        let line: [u8; 16] = core::array::from_fn(|x| 17 * x as u8);
        histogram.line(0, &line);
        assert_eq!((histogram.count(), histogram.mean_16ths()), (2, 8 * 17 * 16 / 2));
        (1..8).for_each(|row| histogram.line(row, &line));
        assert_eq!((histogram.count(), histogram.bins()), (16, &[1; 16]));
        assert_eq!((histogram.black_per_mille(), histogram.saturated_per_mille()), (62, 62));
    }

    #[test]
    fn black_is_up_to_2_and_saturated_from_253_on() {
        let of = |levels: &[u8]| {
            let mut histogram = Histogram::new();
            levels.iter().for_each(|&grey| histogram.line(0, &[grey]));
            histogram
        };
        let four = of(&[2, 3, 252, 253]);
        assert_eq!((four.black_per_mille(), four.saturated_per_mille()), (250, 250));
        assert_eq!((four.count(), four.mean_16ths()), (4, (2 + 3 + 252 + 253) * 16 / 4));
        let mut again = of(&[7]);
        again.begin();
        assert_eq!((again, again.mean_16ths(), again.black_per_mille()), (Histogram::new(), 0, 0));
    }
}
