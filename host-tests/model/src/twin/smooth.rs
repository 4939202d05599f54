//! Pictures smoothed against noise.

use super::Picture;
use image::GrayImage;
use stereopsis::imaging::Noise;

/// A picture as the costs of its pixels see it.
pub struct Seen<'a> {
    pub(super) picture: Picture<'a>,
    noise: Noise,
}

impl<'a> Seen<'a> {
    /// The picture, smoothed if there is `noise`.
    pub fn new(picture: Picture<'a>, noise: Noise) -> Self {
        Self { picture, noise }
    }

    /// The pixel in column `x` of the line that is `off` rows from row `y`, -2 to 2. Smoothed, a line looks
    /// at those beside it among these five, and at its own columns.
    pub fn at(&self, x: isize, y: isize, off: isize) -> u8 {
        if self.noise == Noise::None {
            return self.picture.at(x, y + off);
        }
        let line = |off: isize, x: isize| u16::from(self.picture.at(x, y + off.clamp(-2, 2)));
        let down = |x: isize| (line(off - 1, x) + 2 * line(off, x) + line(off + 1, x) + 2) / 4;
        let inside = x.clamp(0, self.picture.width as isize - 1);
        ((down(inside - 1) + 2 * down(inside) + down(inside + 1) + 2) / 4) as u8
    }

    /// How far its gradients are shifted to the right.
    pub fn gradient_shift(&self) -> u32 {
        match self.noise {
            Noise::None => 0,
            Noise::Low => 1,
            Noise::High => 2,
        }
    }

    /// The rows themselves.
    pub fn rows(&self) -> GrayImage {
        let (width, height) = (self.picture.width as u32, self.picture.height as u32);
        GrayImage::from_fn(width, height, |x, y| image::Luma([self.at(x as isize, y as isize, 0)]))
    }
}
