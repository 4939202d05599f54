//! Units: types that carry the meaning and the unit of a number.

use core::fmt;

/// A disparity `d = u - u' >= 0` in pixels, as fixed point with [`Disparity::FRACTION_BITS`] fractional bits.
///
/// One value, [`Disparity::NONE`], means "no answer"; why there is none is in the pixel's [`PixelFlags`].
///
/// ```
/// use stereopsis::units::Disparity;
/// let d = Disparity::from_pixels(12);
/// assert_eq!(d.to_f32(), Some(12.0));
/// assert_eq!(Disparity::from_raw(12 * 32 + 8).to_f32(), Some(12.25));
/// assert!(Disparity::NONE.to_f32().is_none());
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(transparent)]
pub struct Disparity(u16);

impl Disparity {
    /// Bits after the binary point: the step is 1/32 px.
    pub const FRACTION_BITS: u32 = 5;
    /// Steps per pixel.
    pub const ONE: u16 = 1 << Self::FRACTION_BITS;
    /// One pixel.
    pub const ONE_PIXEL: Self = Self(Self::ONE);
    /// Infinitely far, for cameras with parallel axes.
    pub const ZERO: Self = Self(0);
    /// The value that means "no answer".
    pub const NONE: Self = Self(u16::MAX);
    /// The largest disparity that can be represented: just under 2048 px.
    pub const MAX: Self = Self(u16::MAX - 1);
    /// The largest whole disparity, px.
    pub const MAX_PIXELS: u16 = Self::MAX.0 >> Self::FRACTION_BITS;

    /// Converts whole pixels; more than [`Self::MAX_PIXELS`] gives [`Self::MAX`].
    pub const fn from_pixels(pixels: u16) -> Self {
        if pixels > Self::MAX_PIXELS { Self::MAX } else { Self(pixels << Self::FRACTION_BITS) }
    }

    /// Converts steps of 1/32 px; `u16::MAX` is [`Self::NONE`].
    pub const fn from_raw(steps: u16) -> Self {
        Self(steps)
    }

    /// Returns the steps of 1/32 px; `u16::MAX` for [`Self::NONE`].
    pub const fn raw(self) -> u16 {
        self.0
    }

    /// Returns whether there is an answer.
    pub const fn is_some(self) -> bool {
        self.0 != Self::NONE.0
    }

    /// Returns whether there is no answer.
    pub const fn is_none(self) -> bool {
        !self.is_some()
    }

    /// Returns the exact disparity in px; `None` when there is no answer.
    pub fn to_f32(self) -> Option<f32> {
        self.is_some().then(|| f32::from(self.0) / f32::from(Self::ONE))
    }

    /// Returns the distance to another answer in steps of 1/32 px; `None` unless both are answers.
    pub const fn distance(self, other: Self) -> Option<u16> {
        if self.is_some() && other.is_some() { Some(self.0.abs_diff(other.0)) } else { None }
    }
}

impl Default for Disparity {
    fn default() -> Self {
        Self::NONE
    }
}

impl fmt::Display for Disparity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.to_f32() {
            Some(pixels) => write!(f, "{pixels} px"),
            None => f.write_str("none"),
        }
    }
}

/// Why a pixel has no answer, or a reservation about its answer: one byte, one bit per reason.
///
/// A pixel without an answer has at least one bit set. A pixel with an answer can have
/// [`PixelFlags::CEILING`], when the checks accept such answers, [`PixelFlags::DAMAGED`], when a camera lost
/// a line, and [`PixelFlags::FILLED`] beside the bits that say why it had no answer of its own.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(transparent)]
pub struct PixelFlags(u8);

impl PixelFlags {
    /// No bit set.
    pub const CLEAR: Self = Self(0);
    /// No candidate lies inside the right image, or the pixel is outside the valid area.
    pub const OUTSIDE: Self = Self(1);
    /// The winner is the largest disparity searched, or its partner is the first column of the right image:
    /// the surface may be nearer, or the right camera may not see it.
    pub const CEILING: Self = Self(1 << 1);
    /// The winner costs as much as both its neighbours, too few pixels of the window have a gradient, or the
    /// answer had spread from an edge over a place without any.
    pub const UNTEXTURED: Self = Self(1 << 2);
    /// Another disparity matches nearly as well, the answer was less sure than asked for, or it stood on a
    /// pattern that repeats.
    pub const AMBIGUOUS: Self = Self(1 << 3);
    /// The right image's pixel found a better partner elsewhere: occluded or mismatched.
    pub const MISMATCH: Self = Self(1 << 4);
    /// Too few answers around the pixel belong to its surface.
    pub const SPECKLE: Self = Self(1 << 5);
    /// The answer is the farther one of those on both sides of a small gap in the row.
    pub const FILLED: Self = Self(1 << 6);
    /// A line that the pixel depends on was lost and replaced: an answer may be wrong, and there is none
    /// where the matching window contains the lost line.
    pub const DAMAGED: Self = Self(1 << 7);

    /// All flags with their names, in the order of the bits.
    pub const NAMES: [(Self, &'static str); 8] = [
        (Self::OUTSIDE, "outside"),
        (Self::CEILING, "ceiling"),
        (Self::UNTEXTURED, "untextured"),
        (Self::AMBIGUOUS, "ambiguous"),
        (Self::MISMATCH, "mismatch"),
        (Self::SPECKLE, "speckle"),
        (Self::FILLED, "filled"),
        (Self::DAMAGED, "damaged"),
    ];

    /// Returns the bits as a byte.
    pub const fn bits(self) -> u8 {
        self.0
    }

    /// Converts a byte; bits without a name are kept.
    pub const fn from_bits(bits: u8) -> Self {
        Self(bits)
    }

    /// Returns whether all bits of `other` are set.
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Returns the bits of both.
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Returns the bits without those of `other`.
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Returns whether any bit of `other` is set.
    pub const fn intersects(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Returns `self` if `condition`, else no bit, without a branch where the compiler can.
    pub const fn when(self, condition: bool) -> Self {
        Self(self.0 * condition as u8)
    }
}

/// Depth along the optical axis in whole millimetres, for cores without a floating-point unit; 0 means
/// "none".
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, Debug, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(transparent)]
pub struct Millimetres(pub u16);

impl Millimetres {
    /// No depth: no answer, at or behind infinity, or beyond [`Self::MAX`].
    pub const NONE: Self = Self(0);
    /// The farthest depth that can be represented: 65.535 m.
    pub const MAX: Self = Self(u16::MAX);

    /// Returns whether there is a depth.
    pub const fn is_some(self) -> bool {
        self.0 != 0
    }

    /// Returns the depth in metres; `None` for [`Self::NONE`].
    pub fn to_metres(self) -> Option<Metres> {
        self.is_some().then(|| Metres(f32::from(self.0) / 1000.0))
    }
}

/// A length in metres.
#[derive(Clone, Copy, PartialEq, PartialOrd, Default, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[repr(transparent)]
pub struct Metres(pub f32);
