//! A corner: its place to a fraction of a pixel, and its score.

/// A corner of a picture. Until its patch is whole, it lies at the centre of the strongest pixel.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Corner {
    /// The column of the strongest pixel.
    pub column: u16,
    /// The row of the strongest pixel.
    pub row: u16,
    /// How far the corner lies to the right of that pixel's centre, 1/64 px; -112 to 112.
    pub right: i8,
    /// How far it lies below, 1/64 px; -112 to 112.
    pub down: i8,
    /// How strong it is: the score of [`fast_scores`](super::fast_scores). 0 is no corner.
    pub score: u8,
}

impl Corner {
    /// Steps of [`Self::right`] and [`Self::down`] in a pixel.
    pub const STEPS: i8 = 64;

    /// No corner.
    pub const NONE: Self = Self { column: 0, row: 0, right: 0, down: 0, score: 0 };

    /// Where it is, px: column and row, exactly.
    pub fn position_px(&self) -> [f32; 2] {
        let px = |whole: u16, steps: i8| f32::from(whole) + f32::from(steps) / f32::from(Self::STEPS);
        [px(self.column, self.right), px(self.row, self.down)]
    }
}
