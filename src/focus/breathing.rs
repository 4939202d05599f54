//! Focus breathing: the magnification of a frame beside the first.

use super::FocusLineError;

/// Where the pixels of the reference are in a frame that is larger or smaller by a factor, about the
/// picture's middle.
///
/// What is interpolated is the sharpness, never the picture: an interpolated picture is blurred, more so
/// between pixels than on them, and that would be taken for focus.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Breathing {
    /// In 1/2^16.
    scale: u32,
}

deserialize_checked! {
    Breathing { scale: u32 }
    by |stored| match stored.scale {
        scale @ 0x8000..=0x2_0000 => Ok(Self { scale }),
        _ => Err(FocusLineError::Scale),
    }
}

impl Breathing {
    /// The scale of a frame that shows its image as large as the reference frame does.
    pub const NONE: Self = Self { scale: 1 << 16 };

    /// Before the first frame.
    pub(super) const UNSET: Self = Self { scale: 0 };

    /// A frame in which all is `scale` times as large as in the reference, 1/2 to 2: of
    /// [`ThinLens::breathing`](super::ThinLens::breathing).
    pub fn new(scale: f32) -> Result<Self, FocusLineError> {
        if (0.5..=2.0).contains(&scale) {
            // At least half, so that adding a half and cutting off rounds to the nearest.
            Ok(Self { scale: (scale * 65536.0 + 0.5) as u32 })
        } else {
            Err(FocusLineError::Scale)
        }
    }

    /// Whether nothing moves.
    pub(super) fn is_none(self) -> bool {
        self == Self::NONE
    }

    /// The column or row of the frame, of `size`, that is nearest to what column or row `place` of the
    /// reference shows; the last one inside of the frame where it shows no such place. Numbers beyond 32 bits
    /// are taken for the largest that has 32.
    pub fn source(self, place: usize, size: usize) -> usize {
        // So much that nothing overflows.
        let [place, size] = [place, size].map(|x| x.min(u32::MAX as usize));
        let (before, part) = self.between(place, size);
        (before + usize::from(part >= 128)).min(size.saturating_sub(1))
    }

    /// The column or row before what column or row `place` of the reference shows, and how far it is from
    /// there to the next one, in 1/256; 0 in the last one.
    #[inline]
    pub(super) fn between(self, place: usize, size: usize) -> (usize, u32) {
        if self.is_none() {
            return (place, 0);
        }
        // Twice the distance from the middle: sizes have 16 bits.
        let last = size.saturating_sub(1) as i64;
        let off = 2 * place as i64 - last;
        let place = ((off * i64::from(self.scale) + (last << 16)) >> 9).clamp(0, last << 8);
        ((place >> 8) as usize, (place & 255) as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_beside_the_frame_are_its_last_ones() {
        let scales = [0.5, 1.0, 1.5, 2.0].map(|scale| Breathing::new(scale).expect("a scale"));
        for breathing in scales {
            let places = [9, 1000, usize::MAX].map(|place| breathing.source(place, 10));
            assert_eq!(places[1..], [9; 2], "{breathing:?}");
            assert!((7..=9).contains(&places[0]), "{breathing:?}: {}", places[0]);
            assert_eq!(breathing.source(3, 0), 0, "{breathing:?}");
            let _ = breathing.source(usize::MAX, usize::MAX);
        }
    }
}
