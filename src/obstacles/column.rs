//! What stands in a column of cells.

/// Rows without ground that do not end what is seen of it.
pub(super) const MOST_GAP: u8 = 2;
/// Columns of pixels side by side, two matching windows, up to which a window sees more than one surface of a
/// thing, so that its height is not known.
pub(super) const NARROW_PX: u32 = 18;

/// What stands in a column.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(u8)]
pub enum StixelKind {
    /// Nothing that enough cells show; that is not to say that the column is free.
    #[default]
    Nothing,
    /// A surface that rises above the ground.
    Obstacle,
    /// The edge of a surface that is deeper than the ground.
    Drop,
}

/// The nearest obstacle or drop of a column of cells, in cells.
#[derive(Clone, Copy, Default, Debug)]
pub struct Column {
    pub(super) kind: StixelKind,
    pub(super) top: u8,
    pub(super) base: u8,
    /// Cells of the segment that have an answer.
    pub(super) cells: u8,
    /// Uppermost row to which the ground is seen from the lowest row on, with gaps of [`MOST_GAP`] rows at
    /// most; the number of rows where it is not. Without a ground 0 where the whole column has answers, with
    /// such gaps.
    pub(super) seen: u8,
    /// Deviation, steps, at most 255.
    pub(super) sigma: u8,
    /// Parallax, steps; of a drop that of the ground at its edge.
    pub(super) parallax: i32,
    /// Cells of the connected surface that it belongs to; 0 where that is too small.
    pub(super) surface: u16,
}

impl Column {
    pub(super) const EMPTY: Self = Self {
        kind: StixelKind::Nothing,
        top: 0,
        base: 0,
        cells: 0,
        seen: 0,
        sigma: 0,
        parallax: 0,
        surface: 0,
    };

    /// Whether it belongs to a surface of enough cells.
    pub(super) fn is_supported(&self) -> bool {
        self.surface > 0
    }

    /// Whether the ground is seen up to its lower edge.
    pub(super) fn is_seen_up_to(&self) -> bool {
        u16::from(self.seen) <= u16::from(self.base) + 1 + u16::from(MOST_GAP)
    }
}
