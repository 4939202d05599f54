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
        Some(between([a, b, c, d].map(f32::from), right, down))
    }

    /// Fills `N` rows of `N` with the brightness at `start`, `along` a row, and `across` from row to row, px,
    /// by bilinear interpolation; `None` where one is outside, or a step is 64 px or more.
    ///
    /// Places are rounded to 2^-14 px.
    pub(crate) fn sample_parallelogram<const N: usize>(
        &self,
        start: [f32; 2],
        along: [f32; 2],
        across: [f32; 2],
        out: &mut [f32],
    ) -> Option<()> {
        const BITS: u32 = 14;
        const ONE: f32 = (1 << BITS) as f32;
        const MOST_STEP: f32 = 64.0;
        // To the nearest: what is more than 0 is rounded down. What is not a number is refused, too.
        let nearest = |x: f32| ((x + MOST_STEP) * ONE + 0.5) as i32 - (MOST_STEP * ONE) as i32;
        let fixed = |[x, y]: [f32; 2], most: f32| {
            (x.abs() < most && y.abs() < most).then(|| [nearest(x), nearest(y)])
        };
        let (start, along, across) =
            (fixed(start, 65536.0)?, fixed(along, MOST_STEP)?, fixed(across, MOST_STEP)?);
        let end = N as i32 - 1;
        for (i, j) in [(0, 0), (0, end), (end, 0), (end, end)] {
            let ([x, y], [a, c], [b, d]) = (start, along, across);
            let (x, y) = (x + i * a + j * b, y + i * c + j * d);
            let inside = |place: i32, size: usize| place >= 0 && ((place >> BITS) as usize + 1) < size;
            if !inside(x, self.width) || !inside(y, self.height) {
                return None;
            }
        }
        // All others lie between the corners.
        let ([mut first_x, mut first_y], [a, c], [b, d]) = (start, along, across);
        for row in out.chunks_exact_mut(N) {
            let (mut x, mut y) = (first_x, first_y);
            for out in row {
                let from = (y >> BITS) as usize * self.width + (x >> BITS) as usize;
                let two = |from: usize| self.pixels.get(from..)?.first_chunk::<2>();
                let (&[p, q], &[r, s]) = (two(from)?, two(from + self.width)?);
                let part = |place: i32| (place & ((1 << BITS) - 1)) as f32 * (1.0 / ONE);
                *out = between([p, q, r, s].map(f32::from), part(x), part(y));
                (x, y) = (x + a, y + c);
            }
            (first_x, first_y) = (first_x + b, first_y + d);
        }
        Some(())
    }

    /// Fills rows of `N` with the brightness at (`x`, `y`) and to the right and below at steps of a pixel, by
    /// bilinear interpolation; `None` where one of them is outside.
    pub(crate) fn sample_square<const N: usize>(&self, x: f32, y: f32, out: &mut [f32]) -> Option<()> {
        if !(x >= 0.0 && y >= 0.0) {
            return None;
        }
        let (column, first_row) = (x as u32 as usize, y as u32 as usize);
        let (right, down) = (x - column as f32, y - first_row as f32);
        let mut above = self.between_columns::<N>(column, first_row, right)?;
        for (row, out) in (first_row + 1..).zip(out.chunks_exact_mut(N)) {
            let below = self.between_columns::<N>(column, row, right)?;
            for (out, (above, below)) in out.iter_mut().zip(above.iter().zip(&below)) {
                *out = above + (below - above) * down;
            }
            above = below;
        }
        Some(())
    }

    /// The brightness of a row from a column on, each so far to the right of a pixel.
    #[inline(always)]
    fn between_columns<const N: usize>(&self, column: usize, row: usize, right: f32) -> Option<[f32; N]> {
        let run = self.run(column, row, N + 1)?;
        let (here, next) = (run.first_chunk::<N>()?, run.last_chunk::<N>()?);
        let mut between = [0.0; N];
        for (between, (&here, &next)) in between.iter_mut().zip(here.iter().zip(next)) {
            let [here, next] = [here, next].map(f32::from);
            *between = here + (next - here) * right;
        }
        Some(between)
    }
}

/// The brightness between two pixels and the two below them.
#[inline(always)]
fn between([a, b, c, d]: [f32; 4], right: f32, down: f32) -> f32 {
    let (above, below) = (a + (b - a) * right, c + (d - c) * right);
    above + (below - above) * down
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_four_pixels() {
        let picture = Picture::new(&[0, 4, 8, 12, 16, 20], 3, 2).expect("six pixels");
        assert_eq!((picture.width(), picture.height()), (3, 2));
        assert_eq!(picture.sample(0.5, 0.25), Some(5.0));
        assert_eq!(picture.sample(1.75, 0.5), Some(13.0));
        assert_eq!(picture.sample(2.0, 0.0), None);
        assert_eq!(picture.sample(-0.1, 0.0), None);
        assert_eq!(picture.run(1, 1, 2), Some(&[16, 20][..]));
        assert_eq!(picture.run(2, 1, 2), None);
        assert!(matches!(Picture::new(&[0; 5], 3, 2), Err(PictureError::Pixels { needed: 6 })));
    }

    /// Waves of 20 x 12 pixels.
    fn waves() -> [u8; 240] {
        core::array::from_fn(|i| ((i % 20) * (i % 20) * 7 + (i / 20) * 31) as u8)
    }

    #[test]
    fn a_square_is_its_samples() {
        let pixels = waves();
        let picture = Picture::new(&pixels, 20, 12).expect("as many pixels");
        for (x, y) in [(0.0, 0.0), (3.25, 1.5), (14.75, 6.9), (7.0, 6.999)] {
            let mut seen = [0.0; 25];
            picture.sample_square::<5>(x, y, &mut seen).expect("inside");
            for (i, &seen) in seen.iter().enumerate() {
                let expected = picture.sample(x + (i % 5) as f32, y + (i / 5) as f32).expect("inside");
                assert!((seen - expected).abs() < 1e-3, "{x} {y} {i}: {seen} {expected}");
            }
        }
        // The last sample, and the one after it, lie inside or on the edge.
        for (x, y) in [(15.0, 0.0), (0.0, 7.0), (-0.1, 0.0), (0.0, -0.1), (f32::NAN, 0.0), (1e30, 0.0)] {
            assert_eq!(picture.sample_square::<5>(x, y, &mut [0.0; 25]), None, "{x} {y}");
        }
    }

    #[test]
    fn a_parallelogram_is_its_samples() {
        let pixels = waves();
        let picture = Picture::new(&pixels, 20, 12).expect("as many pixels");
        // Turned, mirrored, sheared, and next to the edges.
        let cases = [
            ([2.5, 1.25], [1.0, 0.0], [0.0, 1.0]),
            ([9.0, 2.0], [0.75, 0.5], [-0.5, 0.75]),
            ([18.9, 0.0], [-1.5, 0.25], [-0.25, 2.0]),
            ([0.0, 10.9], [4.5, -0.1], [0.1, -2.5]),
        ];
        for (start, along, across) in cases {
            let mut seen = [0.0; 25];
            picture.sample_parallelogram::<5>(start, along, across, &mut seen).expect("inside");
            for (i, &seen) in seen.iter().enumerate() {
                let (a, b) = ((i % 5) as f32, (i / 5) as f32);
                let [x, y] = [0, 1].map(|k| start[k] + a * along[k] + b * across[k]);
                let expected = picture.sample(x.max(0.0), y.max(0.0)).expect("inside");
                // A place and each step are rounded by 2^-14 px at most: nine of them, times 255 levels a px.
                assert!((seen - expected).abs() < 9.0 * 2.0 * 255.0 / 16384.0, "{i}: {seen} {expected}");
            }
        }
        let refused = [
            ([-0.1, 0.0], [1.0, 0.0], [0.0, 1.0]),
            ([0.0, 0.0], [1.0, -0.1], [0.0, 1.0]),
            ([5.0, 1.0], [1.0, -0.5], [0.0, 1.0]),
            ([5.0, 1.0], [1.0, 0.0], [0.0, -0.5]),
            ([1.0, 5.0], [-0.5, 0.0], [0.0, 1.0]),
            ([1.0, 5.0], [1.0, 0.0], [-0.5, 1.0]),
            ([5.0, 10.0], [1.0, 0.5], [0.0, 0.0]),
            ([5.0, 10.0], [1.0, 0.0], [0.0, 0.5]),
            ([18.0, 5.0], [0.5, 0.0], [0.0, 1.0]),
            ([18.0, 5.0], [0.0, 1.0], [0.5, 0.0]),
            ([15.0, 0.0], [1.0, 0.0], [0.0, 1.0]),
            ([0.0, 0.0], [64.0, 0.0], [0.0, 1.0]),
            ([0.0, 0.0], [1.0, f32::NAN], [0.0, 1.0]),
            ([f32::INFINITY, 0.0], [1.0, 0.0], [0.0, 1.0]),
        ];
        for (start, along, across) in refused {
            assert_eq!(picture.sample_parallelogram::<5>(start, along, across, &mut [0.0; 25]), None);
        }
    }

    #[test]
    fn steps_of_64_px_are_too_long() {
        let pixels: [u8; 6400] = core::array::from_fn(|i| (i % 80) as u8);
        let picture = Picture::new(&pixels, 80, 80).expect("as many pixels");
        for axis in 0..4 {
            let sample = |step: f32| {
                let mut steps = [1.0, 0.0, 0.0, 1.0];
                steps[axis] = step;
                let [a, c, b, d] = steps;
                picture.sample_parallelogram::<2>([2.0, 3.0], [a, c], [b, d], &mut [0.0; 4])
            };
            assert_eq!(
                [63.5, 64.0, f32::NAN, f32::INFINITY].map(|step| sample(step).is_some()),
                [true, false, false, false],
                "{axis}"
            );
        }
        let from =
            |start: [f32; 2]| picture.sample_parallelogram::<2>(start, [1.0, 0.0], [0.0, 1.0], &mut [0.0; 4]);
        assert!(from([0.0, 77.9]).is_some() && from([77.9, 0.0]).is_some());
        for start in [[f32::NAN, 3.0], [3.0, f32::NAN], [65536.0, 3.0], [3.0, 1e9], [78.0, 3.0], [3.0, 78.0]]
        {
            assert!(from(start).is_none(), "{start:?}");
        }
    }
}
