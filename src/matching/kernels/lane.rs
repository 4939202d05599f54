//! The integers that window sums are made of.

/// Disparities are worked on in whole groups of this many lanes.
pub const STEP: usize = 16;

/// An unsigned value in a lane. `i16` is used over `u16` because x86-64's baseline has a minimum for it.
pub trait Lane: Copy + Ord + 'static {
    /// Nothing.
    const ZERO: Self;
    /// More than any sum: the cost of a lane that is no candidate.
    const MAX: Self;
    /// 256 lanes of zero, then 256 of [`Self::MAX`]: a slice of it masks the lanes from any one on.
    const MASKS: &'static [Self; 512];
    /// A column's sum.
    fn widen(column: u8) -> Self;
    /// The numbers of the lanes, 0 to 255.
    const INDICES: &'static [Self; 256];
    /// [`Self::MAX`] where the two are not equal, else nothing.
    fn differs(self, other: Self) -> Self;
    /// Sum modulo the lane's size.
    fn add(self, other: Self) -> Self;
    /// Difference modulo the lane's size.
    fn sub(self, other: Self) -> Self;
    /// Bitwise or.
    fn or(self, other: Self) -> Self;
    /// The value.
    fn get(self) -> u16;
}

macro_rules! lane {
    ($lane:ty) => {
        impl Lane for $lane {
            const ZERO: Self = 0;
            const MAX: Self = <$lane>::MAX;
            const MASKS: &'static [Self; 512] = &{
                let mut masks = [0; 512];
                let mut i = 256;
                while i < 512 {
                    masks[i] = <$lane>::MAX;
                    i += 1;
                }
                masks
            };

            #[inline(always)]
            fn widen(column: u8) -> Self {
                column as $lane
            }

            const INDICES: &'static [Self; 256] = &{
                let mut indices = [0; 256];
                let mut i = 0;
                while i < 256 {
                    indices[i] = i as $lane;
                    i += 1;
                }
                indices
            };

            #[inline(always)]
            fn differs(self, other: Self) -> Self {
                if self != other { Self::MAX } else { 0 }
            }

            #[inline(always)]
            fn add(self, other: Self) -> Self {
                self.wrapping_add(other)
            }

            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                self.wrapping_sub(other)
            }

            #[inline(always)]
            fn or(self, other: Self) -> Self {
                self | other
            }

            #[inline(always)]
            fn get(self) -> u16 {
                self as u16
            }
        }
    };
}

lane!(u8);
lane!(i16);
