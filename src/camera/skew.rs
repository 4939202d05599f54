//! How far apart in time two cameras read out their rows.

/// Row skew of a frame so far: how much later than the left camera the right one read out its rows.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RowSkew {
    /// Number of rows measured; with none the other fields are 0.
    pub rows: u16,
    /// Least skew, microseconds; negative where the right camera was first.
    pub least_us: i64,
    /// Largest skew, microseconds.
    pub most_us: i64,
}

impl RowSkew {
    pub(super) fn add(&mut self, left_us: u64, right_us: u64) {
        // Stamps near 2^64 us are 584 000 years: the difference fits.
        let skew = right_us.wrapping_sub(left_us) as i64;
        let first = self.rows == 0;
        self.least_us = if first { skew } else { self.least_us.min(skew) };
        self.most_us = if first { skew } else { self.most_us.max(skew) };
        self.rows = self.rows.saturating_add(1);
    }
}
