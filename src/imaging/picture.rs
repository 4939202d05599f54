//! A whole grey image in memory, with bilinear interpolation.

/// Borrowed image of `width` x `height` grey pixels, row by row.
#[derive(Clone, Copy, Debug)]
pub struct Picture<'a> {
    pixels: &'a [u8],
    width: usize,
    height: usize,
}

/// Why pixels are not an image of the given size.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PictureError {
    /// The number of pixels is not columns times rows.
    Pixels {
        /// Number of pixels that are needed.
        needed: usize,
    },
}

error_text!(PictureError {
    Self::Pixels { needed } => "a picture of this size has {needed} pixels",
});

impl<'a> Picture<'a> {
    /// Wraps the pixels of an image.
    pub const fn new(pixels: &'a [u8], width: u16, height: u16) -> Result<Self, PictureError> {
        let needed = width as usize * height as usize;
        if pixels.len() != needed {
            return Err(PictureError::Pixels { needed });
        }
        Ok(Self { pixels, width: width as usize, height: height as usize })
    }

    /// Returns the number of columns.
    pub const fn width(&self) -> usize {
        self.width
    }

    /// Returns the number of rows.
    pub const fn height(&self) -> usize {
        self.height
    }

    /// Returns `length` pixels of a row from a column on; `None` where the image has fewer.
    #[inline]
    pub fn run(&self, column: usize, row: usize, length: usize) -> Option<&'a [u8]> {
        if column.checked_add(length)? > self.width || row >= self.height {
            return None;
        }
        let from = row * self.width + column;
        self.pixels.get(from..from + length)
    }

    /// Returns the brightness at (`x`, `y`) by bilinear interpolation; `None` outside.
    #[inline]
    pub fn sample(&self, x: f32, y: f32) -> Option<f32> {
        // What is not a number is outside, too.
        if !(x >= 0.0 && y >= 0.0) {
            return None;
        }
        // By way of 32 bits, which a processor of 64 has an instruction for; what is larger is outside.
        let (column, row) = (x as u32 as usize, y as u32 as usize);
        let (&[a, b], &[c, d]) = (
            self.run(column, row, 2)?.first_chunk::<2>()?,
            self.run(column, row + 1, 2)?.first_chunk::<2>()?,
        );
        let (right, down) = (x - column as f32, y - row as f32);
        let [a, b, c, d] = [a, b, c, d].map(f32::from);
        let (above, below) = (a + (b - a) * right, c + (d - c) * right);
        Some(above + (below - above) * down)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_four_pixels() {
        let picture = Picture::new(&[0, 4, 8, 12, 16, 20], 3, 2).expect("six pixels");
        assert_eq!(picture.sample(0.5, 0.25), Some(5.0));
        assert_eq!(picture.sample(1.75, 0.5), Some(13.0));
        assert_eq!(picture.sample(2.0, 0.0), None);
        assert_eq!(picture.sample(-0.1, 0.0), None);
        assert_eq!(picture.run(1, 1, 2), Some(&[16, 20][..]));
        assert_eq!(picture.run(2, 1, 2), None);
        assert!(matches!(Picture::new(&[0; 5], 3, 2), Err(PictureError::Pixels { needed: 6 })));
    }
}
