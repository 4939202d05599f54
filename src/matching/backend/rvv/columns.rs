//! How a column's candidates are a group of registers.

/// Bytes of a register that every core has at least (Zvl128b).
const REGISTER: usize = 16;
/// The most registers of a group.
const MOST: usize = 8;

/// Columns of as many bytes as a group of registers holds.
#[derive(Clone, Copy)]
pub(super) struct Columns {
    /// Bytes of a column.
    pub stride: usize,
    /// The type of vectors, as `vsetvl` takes it: bytes, with no care for what stands behind the column's, in
    /// groups of one, two, four or eight registers.
    pub vtype: usize,
}

impl Columns {
    /// Columns of so many bytes; none where that is too many.
    #[inline(always)]
    pub fn of(stride: usize) -> Option<Self> {
        const NO_CARE: usize = 0b11 << 6;
        let registers = stride.div_ceil(REGISTER).next_power_of_two();
        (stride > 0 && registers <= MOST)
            .then_some(Self { stride, vtype: NO_CARE | registers.trailing_zeros() as usize })
    }
}
