//! A picture at another size, smoothed.

use image::GrayImage;
use nalgebra::{Point2, Vector2};

/// Brightness as numbers.
#[derive(Clone, Debug)]
pub(super) struct Level {
    pub width: usize,
    pub height: usize,
    pixels: Vec<f32>,
    scale: f64,
}

impl Level {
    /// The picture at `scale`, smoothed with a deviation of one of the new pixels.
    pub fn new(picture: &GrayImage, scale: f64) -> Self {
        let mut level = Self {
            width: picture.width() as usize,
            height: picture.height() as usize,
            pixels: picture.as_raw().iter().map(|&p| f32::from(p)).collect(),
            scale: 1.0,
        };
        while level.scale > scale * 1.01 {
            level = level.halved();
        }
        if scale > level.scale * 1.5 {
            level = level.doubled();
        }
        level.smoothed()
    }

    /// Means of two by two.
    fn halved(&self) -> Self {
        let (width, height) = (self.width / 2, self.height / 2);
        let mut pixels = Vec::with_capacity(width * height);
        for two in self.pixels.chunks_exact(2 * self.width.max(1)) {
            let (above, below) = two.split_at(self.width);
            let blocks = above.chunks_exact(2).zip(below.chunks_exact(2));
            pixels.extend(blocks.map(|(a, b)| (a[0] + a[1] + b[0] + b[1]) / 4.0));
        }
        Self { width, height, pixels, scale: self.scale / 2.0 }
    }

    fn doubled(&self) -> Self {
        let (width, height, scale) = (self.width * 2, self.height * 2, self.scale * 2.0);
        let empty = Self { width, height, pixels: Vec::new(), scale };
        let pixels = (0..width * height).map(|i| {
            let here = Point2::new((i % width) as f64, (i / width) as f64);
            let there = (here.coords.add_scalar(0.5)) / 2.0;
            self.value(&Point2::from(there.add_scalar(-0.5)))
        });
        let pixels = pixels.collect();
        Self { pixels, ..empty }
    }

    fn smoothed(self) -> Self {
        // Of a Gaussian with deviation 1.
        const WEIGHTS: [f32; 4] = [0.3991, 0.2420, 0.0540, 0.0045];
        let (width, height) = (self.width, self.height);
        let smooth = |seven: [f32; 7]| {
            let [a, b, c, d, e, f, g] = seven;
            d * WEIGHTS[0] + ((c + e) * WEIGHTS[1] + (b + f) * WEIGHTS[2] + (a + g) * WEIGHTS[3])
        };
        let mut rows = vec![0.0; self.pixels.len()];
        for (y, out) in rows.chunks_exact_mut(width.max(1)).enumerate() {
            let row = &self.pixels[y * width..][..width];
            for (x, out) in out.iter_mut().enumerate() {
                let near = |k: usize| row[(x + k).saturating_sub(3).min(width - 1)];
                let inside = x.checked_sub(3).and_then(|first| row.get(first..first + 7)?.first_chunk::<7>());
                *out = smooth(inside.copied().unwrap_or_else(|| std::array::from_fn(near)));
            }
        }
        let mut pixels = vec![0.0; self.pixels.len()];
        for (y, out) in pixels.chunks_exact_mut(width.max(1)).enumerate() {
            let seven: [&[f32]; 7] =
                std::array::from_fn(|k| &rows[(y + k).saturating_sub(3).min(height - 1) * width..][..width]);
            for (x, out) in out.iter_mut().enumerate() {
                *out = smooth(seven.map(|row| row[x]));
            }
        }
        Self { pixels, ..self }
    }

    /// A pixel, or the nearest one inside.
    #[inline]
    pub fn at(&self, x: isize, y: isize) -> f32 {
        let x = x.clamp(0, self.width as isize - 1) as usize;
        let y = y.clamp(0, self.height as isize - 1) as usize;
        self.pixels[y * self.width + x]
    }

    /// Brightness between pixels.
    pub fn value(&self, p: &Point2<f64>) -> f32 {
        // Without an instruction for it, `floor` is a call.
        let floor = |x: f64| x as isize - isize::from((x as isize as f64) > x);
        let (x, y) = (floor(p.x), floor(p.y));
        let (fx, fy) = ((p.x - x as f64) as f32, (p.y - y as f64) as f32);
        let inside = |x: isize, y: isize| {
            let (x, y) = (usize::try_from(x).ok()?, usize::try_from(y).ok()?);
            let here = (x + 1 < self.width).then_some(y * self.width + x)?;
            let above = self.pixels.get(here..here + 2)?;
            Some(
                [above, self.pixels.get(here + self.width..here + self.width + 2)?]
                    .map(|two| [two[0], two[1]]),
            )
        };
        let border = || [0, 1].map(|dy| [0, 1].map(|dx| self.at(x + dx, y + dy)));
        let [top, bottom] = inside(x, y).unwrap_or_else(border).map(|[a, b]| a * (1.0 - fx) + b * fx);
        top * (1.0 - fy) + bottom * fy
    }

    /// Whether a place is so far inside.
    pub fn is_inside(&self, p: &Point2<f64>, margin: f64) -> bool {
        p.x >= margin
            && p.y >= margin
            && p.x <= (self.width - 1) as f64 - margin
            && p.y <= (self.height - 1) as f64 - margin
    }

    /// How much of a saddle brightness is at each pixel of row `y`, without the border: `xy^2 - xx yy` of the
    /// second derivatives.
    pub fn saddles(&self, y: usize) -> impl Iterator<Item = f32> {
        let row = |y: usize| self.pixels[y * self.width..][..self.width].windows(3);
        row(y - 1).zip(row(y)).zip(row(y + 1)).map(|((above, here), below)| {
            let twice = 2.0 * here[1];
            let xy = (below[2] + above[0] - above[2] - below[0]) / 4.0;
            let (xx, yy) = (here[2] + here[0] - twice, below[1] + above[1] - twice);
            xy * xy - xx * yy
        })
    }

    /// The saddle near a place, by Newton's method, at most `most` px away.
    pub fn saddle(&self, from: &Point2<f64>, most: f64) -> Option<Point2<f64>> {
        let mut place = *from;
        for _ in 0..6 {
            if !self.is_inside(&place, 1.0) {
                return None;
            }
            let v = |dx: f64, dy: f64| f64::from(self.value(&Point2::new(place.x + dx, place.y + dy)));
            let slope = Vector2::new(v(1.0, 0.0) - v(-1.0, 0.0), v(0.0, 1.0) - v(0.0, -1.0)) / 2.0;
            let middle = 2.0 * v(0.0, 0.0);
            let xx = v(1.0, 0.0) + v(-1.0, 0.0) - middle;
            let yy = v(0.0, 1.0) + v(0.0, -1.0) - middle;
            let xy = (v(1.0, 1.0) + v(-1.0, -1.0) - v(1.0, -1.0) - v(-1.0, 1.0)) / 4.0;
            let determinant = xx * yy - xy * xy;
            if determinant >= -1e-6 {
                return None;
            }
            let step = -Vector2::new(yy * slope.x - xy * slope.y, xx * slope.y - xy * slope.x) / determinant;
            place += step;
            if (place - from).norm() > most {
                return None;
            }
            if step.norm() < 0.02 {
                break;
            }
        }
        Some(place)
    }

    /// A place of this level in the picture: pixel centres are at integers in both.
    pub fn to_picture(&self, p: &Point2<f64>) -> Point2<f64> {
        Point2::from((p.coords.add_scalar(0.5) / self.scale).add_scalar(-0.5))
    }
}
