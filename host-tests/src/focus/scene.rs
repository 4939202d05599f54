//! A scene of known depth behind a simulated lens: every point is spread over the disc that the thin lens
//! makes of it.

use crate::scene::Random;
use image::{GrayImage, Luma};
use stereopsis::focus::ThinLens;

/// A surface: its depth and its brightness for each pixel of a sharp picture, both seen through the middle of
/// the lens.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Metres; infinite where the surface has a hole.
    pub depth_m: Vec<f64>,
    /// Grey levels.
    pub grey: Vec<f64>,
}

/// A camera whose sensor moves behind a thin lens.
#[derive(Clone, Debug)]
pub struct FocusScene {
    /// Pixels in a line.
    pub width: usize,
    /// Lines.
    pub height: usize,
    /// The lens, m.
    pub lens: ThinLens<f64>,
    /// The diameter of its opening, m.
    pub aperture_m: f64,
    /// The side of a pixel, m.
    pub pixel_m: f64,
    /// The image distance for which surfaces are drawn pixel on pixel: the others breathe. `None` for a lens
    /// that does not.
    pub reference_m: Option<f64>,
    /// Deviation of the sensor's noise, grey levels.
    pub noise: f64,
    /// Surfaces, the farthest first; nearer ones cover them, blurred as they are.
    pub surfaces: Vec<Surface>,
}

/// The blur of a lens that is in focus, and of the pixels: radius of a disc, px.
const LEAST_RADIUS: f64 = 0.6;

impl FocusScene {
    /// The radius of the disc that a point at `depth_m` is on the sensor `image_m` behind the lens, px: `A |z
    /// - zo| / zo`, the cone of light from the opening to the point's image cut by the sensor.
    ///
    /// # Panics
    ///
    /// When the point is within the focal length.
    pub fn radius_px(&self, depth_m: f64, image_m: f64) -> f64 {
        let sharp = self.lens.image_distance(depth_m).expect("an object beyond the focal length");
        let diameter = self.aperture_m * (image_m - sharp).abs() / sharp / self.pixel_m;
        (diameter / 2.0).hypot(LEAST_RADIUS)
    }

    /// The frame with the sensor `image_m` behind the lens; its noise is that of the seed.
    pub fn render(&self, image_m: f64, seed: u64) -> GrayImage {
        let count = self.width * self.height;
        let mut picture = vec![0.0; count];
        for (order, surface) in self.surfaces.iter().enumerate() {
            let (mut light, mut cover) = (vec![0.0; count], vec![0.0; count]);
            for y in 0..self.height {
                for x in 0..self.width {
                    let i = y * self.width + x;
                    if surface.depth_m[i].is_finite() {
                        let disc = self.radius_px(surface.depth_m[i], image_m);
                        self.spread([x, y], image_m, disc, surface.grey[i], &mut light, &mut cover);
                    }
                }
            }
            for ((pixel, light), cover) in picture.iter_mut().zip(light).zip(cover) {
                if cover > 0.0 {
                    // The farthest surface goes on outside of the picture. Discs on whole pixels cover them
                    // but for some percent.
                    let share = if order == 0 { 1.0 } else { f64::min(1.05 * cover, 1.0) };
                    *pixel += (light / cover - *pixel) * share;
                }
            }
        }
        let mut random = Random::new(seed);
        let mut sampled = |grey: f64| (grey + self.noise * random.gauss()).round().clamp(0.0, 255.0) as u8;
        GrayImage::from_fn(self.width as u32, self.height as u32, |x, y| {
            Luma([sampled(picture[y as usize * self.width + x as usize])])
        })
    }

    /// Adds a pixel's light as a disc: pixels within it count whole, those at its edge by how much of them is
    /// inside.
    fn spread(
        &self,
        [x, y]: [usize; 2],
        image_m: f64,
        radius: f64,
        grey: f64,
        light: &mut [f64],
        cover: &mut [f64],
    ) {
        let scale = self.reference_m.map_or(1.0, |reference| image_m / reference);
        let middle = [(self.width - 1) as f64 / 2.0, (self.height - 1) as f64 / 2.0];
        let [cx, cy] =
            [(x, middle[0]), (y, middle[1])].map(|(at, middle)| middle + (at as f64 - middle) * scale);
        let reach = radius + 0.5;
        let weight = |u: i64, v: i64| (reach - (u as f64 - cx).hypot(v as f64 - cy)).clamp(0.0, 1.0);
        let bounds = |c: f64, size: usize| {
            let (least, most) = ((c - reach).ceil() as i64, (c + reach).floor() as i64);
            (least.max(0), most.min(size as i64 - 1))
        };
        let ((left, right), (top, bottom)) = (bounds(cx, self.width), bounds(cy, self.height));
        // A magnified picture is as bright: its points lie farther apart.
        let share = scale * scale / (core::f64::consts::PI * radius * radius);
        for v in top..=bottom {
            for u in left..=right {
                let part = weight(u, v) * share;
                let i = v as usize * self.width + u as usize;
                light[i] += part * grey;
                cover[i] += part;
            }
        }
    }

    /// The depth of the surface in front, m, for each pixel of a sharp picture.
    pub fn truth_m(&self) -> Vec<f64> {
        let mut truth = vec![f64::INFINITY; self.width * self.height];
        for surface in &self.surfaces {
            let seen = truth.iter_mut().zip(&surface.depth_m).filter(|(_, depth)| depth.is_finite());
            seen.for_each(|(truth, depth)| *truth = *depth);
        }
        truth
    }

    /// The image distance in which each pixel is sharp, m.
    pub fn sharp_m(&self) -> Vec<f64> {
        let sharp = |depth: &f64| self.lens.image_distance(*depth).unwrap_or(f64::NAN);
        self.truth_m().iter().map(sharp).collect()
    }
}

/// Spots of a few sizes, px, of that contrast around 128: a texture whose least details are `finest` px wide.
pub fn texture(width: usize, height: usize, finest: f64, contrast: f64, seed: u64) -> Vec<f64> {
    let mut random = Random::new(seed);
    let mut sum = vec![0.0; width * height];
    for octave in 0..3 {
        // A lattice of random numbers, interpolated smoothly.
        let cell = finest * f64::from(1 << octave);
        let (columns, rows) = ((width as f64 / cell) as usize + 3, (height as f64 / cell) as usize + 3);
        let lattice: Vec<f64> = (0..columns * rows).map(|_| random.unit() * 2.0 - 1.0).collect();
        let split = |at: usize| {
            let at = at as f64 / cell;
            let t = at.fract();
            (at as usize, t * t * (3.0 - 2.0 * t))
        };
        for (i, sum) in sum.iter_mut().enumerate() {
            let ((c, s), (r, t)) = (split(i % width), split(i / width));
            let at = |r: usize, c: usize| lattice[r * columns + c];
            let row = |r: usize| at(r, c) + (at(r, c + 1) - at(r, c)) * s;
            *sum += row(r) + (row(r + 1) - row(r)) * t;
        }
    }
    sum.into_iter().map(|value| (128.0 + value * contrast / 2.0).clamp(0.0, 255.0)).collect()
}
