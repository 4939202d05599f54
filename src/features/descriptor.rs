//! BRIEF descriptors (Calonder, Lepetit, Strecha & Fua 2010): 256 comparisons of two pixels.

use super::orientation::PatchOrientation;
use super::pattern::{PATCH_RADIUS, PATTERN};

/// What a corner's surroundings look like: bit `i` says whether in the `i`-th pair of points the first is
/// darker.
///
/// BRIEF (Calonder, Lepetit, Strecha & Fua 2010) on a patch of radius 15 px of smoothed lines. As it is, it
/// tolerates turns of about 15 degrees.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(transparent)]
pub struct Descriptor(pub [u32; 8]);

impl Descriptor {
    /// The bits of a descriptor.
    pub const BITS: u16 = 256;

    /// No bit set.
    pub const NONE: Self = Self([0; 8]);

    /// How many bits differ, 0 to 256.
    #[inline]
    pub fn distance(&self, other: &Self) -> u16 {
        let differing = self.0.iter().zip(&other.0).map(|(a, b)| (a ^ b).count_ones());
        differing.sum::<u32>() as u16
    }

    /// The descriptor of a patch whose points are taken from a picture turned by `turn`.
    pub fn of(patch: &Patch, turn: PatchOrientation) -> Self {
        if turn == PatchOrientation::NONE {
            Self::of_points(|[x, y]| patch.at((x.into(), y.into())))
        } else {
            Self::of_points(|[x, y]| patch.at(turn.of(x.into(), y.into())))
        }
    }

    /// The descriptor of pixels, given by the points of the pattern.
    #[inline(always)]
    fn of_points(pixel: impl Fn([i8; 2]) -> u8) -> Self {
        let mut words = [0; 8];
        for (word, pairs) in words.iter_mut().zip(PATTERN.as_chunks::<32>().0) {
            for &[first, second] in pairs {
                // The sign says which is darker; the first pair's ends up in the lowest bit.
                let difference = u32::from(pixel(first)).wrapping_sub(pixel(second).into());
                *word = *word >> 1 | difference & 1 << 31;
            }
        }
        Self(words)
    }
}

/// Pixels in a row of a patch, and rows.
const SIDE: usize = 2 * PATCH_RADIUS as usize + 1;

/// The square around a corner, of smoothed pixels.
#[derive(Clone, Debug)]
pub struct Patch([u8; Self::STRIDE * Self::STRIDE]);

impl Patch {
    /// Rows and columns of the square.
    pub const SIDE: usize = SIDE;
    /// A power of two: a place is masked, and so is always inside.
    const STRIDE: usize = 32;

    /// The square around `column` of the middle one of these rows; `None` where it is not whole.
    pub fn cut(rows: &[&[u8]; SIDE], column: usize) -> Option<Self> {
        let from = column.checked_sub(PATCH_RADIUS as usize)?;
        let mut patch = Self([0; Self::STRIDE * Self::STRIDE]);
        for (place, row) in patch.0.as_chunks_mut::<{ Self::STRIDE }>().0.iter_mut().zip(rows) {
            let pixels: &[u8; SIDE] = row.get(from..)?.first_chunk()?;
            // In two parts that overlap by a pixel: for one of this length the compiler calls a routine.
            if let (Some(from), Some(to)) = (pixels.first_chunk::<16>(), place.first_chunk_mut::<16>()) {
                *to = *from;
            }
            if let (Some(from), Some(to)) = (pixels.last_chunk::<16>(), place[..SIDE].last_chunk_mut::<16>())
            {
                *to = *from;
            }
        }
        Some(patch)
    }

    /// The pixel so far to the right of the middle and below it, up to the radius.
    #[inline]
    pub(super) fn at(&self, (right, down): (i32, i32)) -> u8 {
        let place = (down + PATCH_RADIUS) as usize * Self::STRIDE + (right + PATCH_RADIUS) as usize;
        self.0[place & (Self::STRIDE * Self::STRIDE - 1)]
    }

    /// In which direction the patch is brighter, seen from its middle: that of the first moments `sum of x I`
    /// and `sum of y I` of a circle of the radius (Rosin 1999, as in ORB).
    pub fn direction(&self) -> PatchOrientation {
        let (mut right, mut down) = (0, 0);
        for y in -PATCH_RADIUS..=PATCH_RADIUS {
            let mut row = 0;
            for x in -PATCH_RADIUS..=PATCH_RADIUS {
                if x * x + y * y <= PATCH_RADIUS * PATCH_RADIUS {
                    let pixel = i32::from(self.at((x, y)));
                    right += x * pixel;
                    row += pixel;
                }
            }
            down += y * row;
        }
        PatchOrientation::towards(right, down)
    }
}
