//! Disparity rows on a display, with the feature `embedded-graphics`.

use crate::units::Disparity;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::{Point, Size};
use embedded_graphics_core::pixelcolor::{PixelColor, Rgb888};
use embedded_graphics_core::primitives::Rectangle;

/// Viridis (van der Walt & Smith 2015) at equal steps, far to near: legible to the colour-blind, and in grey.
const VIRIDIS: [[u8; 3]; 9] = [
    [0x44, 0x01, 0x54],
    [0x47, 0x2c, 0x7a],
    [0x3b, 0x51, 0x8b],
    [0x2c, 0x71, 0x8e],
    [0x21, 0x90, 0x8d],
    [0x27, 0xad, 0x81],
    [0x5c, 0xc8, 0x63],
    [0xaa, 0xdc, 0x32],
    [0xfd, 0xe7, 0x25],
];

/// Colour map of a disparity range: near is bright, no answer is black.
///
/// ```
/// use embedded_graphics_core::pixelcolor::Rgb888;
/// use stereopsis::depth::DisparityColours;
/// use stereopsis::units::Disparity;
/// let colours = DisparityColours::new(Disparity::from_pixels(4), Disparity::from_pixels(20));
/// assert_eq!(colours.colour(Disparity::from_pixels(12)), Rgb888::new(0x21, 0x90, 0x8d));
/// assert_eq!(colours.colour(Disparity::NONE), Rgb888::new(0, 0, 0));
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct DisparityColours {
    far: u16,
    near: u16,
}

impl DisparityColours {
    /// Creates a colour map from `far` to `near`; disparities outside take the nearest end's colour.
    pub const fn new(far: Disparity, near: Disparity) -> Self {
        let (far, near) = (far.raw(), near.raw());
        Self { far, near: if near > far { near } else { far.saturating_add(1) } }
    }

    /// Returns the colour of a disparity.
    pub fn colour(&self, disparity: Disparity) -> Rgb888 {
        if disparity.is_none() {
            return Rgb888::new(0, 0, 0);
        }
        let steps = (VIRIDIS.len() - 1) as u32;
        let from_far = u32::from(disparity.raw().clamp(self.far, self.near) - self.far);
        // In 256ths of a step of the table.
        let at = from_far * steps * 256 / u32::from(self.near.saturating_sub(self.far)).max(1);
        let index = (at / 256).min(steps - 1);
        let (index, part) = (index as usize, at - 256 * index);
        let of = |index: usize| VIRIDIS.get(index).copied().unwrap_or_default();
        let ([r0, g0, b0], [r1, g1, b1]) = (of(index), of(index + 1));
        let mix = |a: u8, b: u8| ((u32::from(a) * (256 - part) + u32::from(b) * part + 128) / 256) as u8;
        Rgb888::new(mix(r0, r1), mix(g0, g1), mix(b0, b1))
    }

    /// Draws a row with its left end at `at`, in one call to the display.
    pub fn draw_row<T>(&self, target: &mut T, at: Point, row: &[Disparity]) -> Result<(), T::Error>
    where
        T: DrawTarget<Color: PixelColor + From<Rgb888>>,
    {
        let area = Rectangle::new(at, Size::new(row.len() as u32, 1));
        target.fill_contiguous(&area, row.iter().map(|&disparity| self.colour(disparity).into()))
    }
}
