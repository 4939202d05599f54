//! BRIEF descriptors (Calonder, Lepetit, Strecha & Fua 2010): 256 comparisons of two pixels.

use super::orientation::PatchOrientation;
use super::pattern::{PAIRS, PATCH_RADIUS, PATTERN};

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
            Self::of_places(|place| patch.pixel(place))
        } else {
            Self::of_places(|place| {
                let [right, down] = Patch::point(place);
                patch.at(turn.of(right, down))
            })
        }
    }

    /// The descriptor of pixels, given by the places of the pattern's points in a patch.
    #[inline(always)]
    fn of_places(pixel: impl Fn(u32) -> u8) -> Self {
        let mut words = [0; 8];
        for (word, pairs) in words.iter_mut().zip(PLACES.as_chunks::<32>().0) {
            for &pair in pairs {
                // The sign says which is darker; the first pair's ends up in the lowest bit.
                let difference = u32::from(pixel(pair & 0xffff)).wrapping_sub(pixel(pair >> 16).into());
                *word = *word >> 1 | difference & 1 << 31;
            }
        }
        Self(words)
    }
}

/// Where the points of [`PATTERN`] are in a patch, the first one in the low half of a word.
static PLACES: [u32; PAIRS] = {
    let mut places = [0; PAIRS];
    let mut i = 0;
    while i < PAIRS {
        let [[a, b], [c, d]] = PATTERN[i];
        places[i] = Patch::place(a as i32, b as i32) | Patch::place(c as i32, d as i32) << 16;
        i += 1;
    }
    places
};

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

    /// A square without pixels.
    pub(super) const BLACK: Self = Self([0; Self::STRIDE * Self::STRIDE]);

    /// The square around `column` of the middle one of these rows; `None` where it is not whole.
    pub fn cut(rows: &[&[u8]; SIDE], column: usize) -> Option<Self> {
        let mut patch = Self::BLACK;
        patch.fill(rows, column)?;
        Some(patch)
    }

    /// [`Self::cut`] in place: a patch is long to clear and to move.
    #[inline(always)]
    pub(super) fn fill(&mut self, rows: &[&[u8]; SIDE], column: usize) -> Option<()> {
        let from = column.checked_sub(PATCH_RADIUS as usize)?;
        for (place, row) in self.0.as_chunks_mut::<{ Self::STRIDE }>().0.iter_mut().zip(rows) {
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
        Some(())
    }

    /// Where the pixel so far to the right of the middle and below it is.
    const fn place(right: i32, down: i32) -> u32 {
        ((down + PATCH_RADIUS) * Self::STRIDE as i32 + right + PATCH_RADIUS) as u32
    }

    /// How far to the right of the middle and below it a place is.
    const fn point(place: u32) -> [i32; 2] {
        let stride = Self::STRIDE as u32;
        [(place % stride) as i32 - PATCH_RADIUS, (place / stride) as i32 - PATCH_RADIUS]
    }

    /// The pixel at a place.
    #[inline(always)]
    fn pixel(&self, place: u32) -> u8 {
        self.0[place as usize & (Self::STRIDE * Self::STRIDE - 1)]
    }

    /// The pixel so far to the right of the middle and below it, up to the radius.
    #[inline]
    pub(super) fn at(&self, (right, down): (i32, i32)) -> u8 {
        self.pixel(Self::place(right, down))
    }

    /// The `N` pixels in the middle of the row so far below the middle one; `N` is odd.
    #[inline(always)]
    pub(super) fn row<const N: usize>(&self, down: i32) -> [u8; N] {
        let begin = Self::place(-(N as i32 / 2), down) as usize;
        self.0.get(begin..).and_then(|pixels| pixels.first_chunk()).copied().unwrap_or([0; N])
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
