//! Orientation of a patch by its intensity centroid (Rosin 1999; ORB), in steps of 1/32 of a circle.

/// A turn by a multiple of 1/32 of a circle, from the right downwards.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PatchOrientation(u8);

/// `2^14 sin` of 0 to 8 steps.
const SINE: [i32; 9] = [0, 3196, 6270, 9102, 11585, 13623, 15137, 16069, 16384];

impl PatchOrientation {
    /// Steps in a circle: 11.25 degrees each.
    pub const STEPS: u8 = 32;
    /// No turn.
    pub const NONE: Self = Self(0);

    /// Creates an orientation of `steps`, modulo a full turn.
    pub const fn new(steps: u8) -> Self {
        Self(steps % Self::STEPS)
    }

    /// How many steps, 0 to 31.
    pub const fn steps(self) -> u8 {
        self.0
    }

    /// The turn that brings the direction `right` to that of a vector, to the nearest step; none for a vector
    /// of nothing. Of two as near, the smaller.
    ///
    /// It is the step along which the vector is longest.
    pub fn towards(right: i32, down: i32) -> Self {
        let mut best = (0, Self::NONE);
        for turn in (0..Self::STEPS).map(Self) {
            let (cosine, sine) = turn.cosine_and_sine();
            let along = i64::from(right) * i64::from(cosine) + i64::from(down) * i64::from(sine);
            if along > best.0 {
                best = (along, turn);
            }
        }
        best.1
    }

    /// A point so far to the right and down, turned; rounded to the nearest pixel, halves up. Numbers beyond
    /// 16 bits are taken for the nearest that has 16.
    #[inline]
    pub fn of(self, right: i32, down: i32) -> (i32, i32) {
        let (cosine, sine) = self.cosine_and_sine();
        let [right, down] = [right, down].map(|x| x.clamp(i16::MIN.into(), i16::MAX.into()));
        let round = |x: i32| (x + (1 << 13)) >> 14;
        (round(right * cosine - down * sine), round(right * sine + down * cosine))
    }

    /// In units of 2^-14.
    #[inline]
    fn cosine_and_sine(self) -> (i32, i32) {
        let at = |steps: u8| SINE.get(usize::from(steps)).copied().unwrap_or(0);
        let (rest, other) = (at(self.0 % 8), at(8 - self.0 % 8));
        match self.0 / 8 {
            0 => (other, rest),
            1 => (-rest, other),
            2 => (-other, -rest),
            _ => (rest, -other),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_eighth_of_a_circle() {
        assert_eq!(PatchOrientation::new(4).of(10, 0), (7, 7));
        assert_eq!(PatchOrientation::new(8).of(10, -3), (3, 10));
        assert_eq!(PatchOrientation::new(28).of(10, 0), (7, -7));
        assert_eq!(PatchOrientation::new(4).of(i32::MAX, i32::MIN), (46339, -1));
        assert_eq!(PatchOrientation::new(24).of(i32::MAX, i32::MIN), (-32768, -32767));
        assert_eq!(PatchOrientation::towards(-5, 5), PatchOrientation::new(12));
        assert_eq!(PatchOrientation::towards(0, 0), PatchOrientation::NONE);
    }
}
