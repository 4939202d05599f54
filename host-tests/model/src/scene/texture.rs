//! What a surface looks like: noise that belongs to the surface's points, not to the picture.

use nalgebra::Vector3;

/// Points that are taken together: the 4 x 4 samples of a pixel.
pub const SAMPLES: usize = 16;

/// Their x, y and z.
pub type Points = [[f32; SAMPLES]; 3];

/// Brightness over the points of an object: several octaves of value noise on a hashed lattice.
///
/// The noise does not repeat. An octave whose lattice is too fine for the camera at the point's depth is
/// faded out, so the picture has no detail that its pixels cannot hold. The depth of a point is one number
/// for both cameras of a rectified rig, so both see the same texture.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// Which noise: two seeds give textures that have nothing in common.
    pub seed: u32,
    /// Mean share of the light that is sent back, 0 to 1.
    pub brightness: f64,
    /// Deviation around the mean, as a share of it; 0 for a flat surface.
    pub contrast: f64,
    /// Lattice spacing of the coarsest octave, metres.
    pub coarsest_m: f64,
    /// Number of octaves, each half as wide as the one before.
    pub octaves: u32,
    /// Factor by which the noise is finer along each of the object's axes: wood has one axis with a small
    /// one.
    pub fineness: Vector3<f64>,
    /// Side of the squares of a chessboard along the object's x and y, metres, in place of noise: they are as
    /// much brighter and darker as the contrast says. 0 for noise.
    pub squares_m: f64,
}

/// Lattice spacing, px, below which an octave is gone, and above which it is whole.
const FADE_PX: (f64, f64) = (1.5, 3.0);
/// One over the deviation of one octave of value noise with values in -1 .. 1 (measured).
const OCTAVE_GAIN: f64 = 2.9;

impl Texture {
    /// Noise of six octaves from 20 cm down to 6 mm.
    pub fn new(seed: u32, brightness: f64, contrast: f64) -> Self {
        Self {
            seed,
            brightness,
            contrast,
            coarsest_m: 0.2,
            octaves: 6,
            fineness: Vector3::repeat(1.0),
            squares_m: 0.0,
        }
    }

    /// No texture at all: one brightness.
    pub fn flat(brightness: f64) -> Self {
        Self::new(0, brightness, 0.0)
    }

    /// The same texture with another coarsest octave.
    pub fn with_octaves(self, coarsest_m: f64, octaves: u32) -> Self {
        Self { coarsest_m, octaves, ..self }
    }

    /// The same texture drawn out along the object's axes by these factors.
    pub fn with_stretch(self, x: f64, y: f64, z: f64) -> Self {
        Self { fineness: Vector3::new(1.0 / x, 1.0 / y, 1.0 / z), ..self }
    }

    /// A chessboard with squares of this side in place of noise.
    pub fn with_squares(self, squares_m: f64) -> Self {
        Self { squares_m, ..self }
    }

    /// The shares of light that points (object coordinates, metres) send back where a pixel covers `pixel_m`
    /// metres.
    ///
    /// The points of one pixel are taken together, since that is where a rendering spends its time.
    pub fn albedos(&self, points: &Points, pixel_m: f64) -> [f32; SAMPLES] {
        let brightness = self.brightness as f32;
        if self.contrast == 0.0 {
            return [brightness; SAMPLES];
        }
        if self.squares_m > 0.0 {
            let row = |x: f32| (f64::from(x) / self.squares_m).floor() as i64;
            return std::array::from_fn(|i| {
                let is_dark = (row(points[0][i]) + row(points[1][i])) & 1 != 0;
                brightness * (1.0 + if is_dark { -self.contrast } else { self.contrast } as f32)
            });
        }
        let flat = points[2].iter().all(|&z| z == 0.0);
        // Coordinates in lattice cells, and the lattice spacing in pixels, of one octave after the other.
        let mut scale = self.fineness.map(|f| (f / self.coarsest_m) as f32);
        let mut spacing_px = self.coarsest_m / pixel_m;
        let (mut sums, mut power) = ([0.0; SAMPLES], 0.0);
        for octave in 0..self.octaves {
            let visible = ((spacing_px - FADE_PX.0) / (FADE_PX.1 - FADE_PX.0)).min(1.0);
            if visible <= 0.0 {
                break;
            }
            let seed = self.seed.wrapping_add(octave.wrapping_mul(0x9e37_79b9));
            for (i, sum) in sums.iter_mut().enumerate() {
                let [x, y, z] = [points[0][i] * scale.x, points[1][i] * scale.y, points[2][i] * scale.z];
                let noise = if flat { flat_noise(x, y, seed) } else { value_noise(x, y, z, seed) };
                *sum += visible as f32 * noise;
            }
            power += visible * visible;
            scale *= 2.0;
            spacing_px *= 0.5;
        }
        let gain = if power > 0.0 { self.contrast * OCTAVE_GAIN / power.sqrt() } else { 0.0 };
        sums.map(|sum| (brightness * (1.0 + gain as f32 * sum)).clamp(0.02, 1.0))
    }
}

/// A coordinate on the lattice: the hashed numbers of the two whole numbers around it, and the weight of the
/// second.
#[inline(always)]
fn cell(x: f32, multiplier: u32) -> ([u32; 2], f32) {
    // Adding 1.5 * 2^23 rounds to a whole number and leaves it in the low bits: no call and no branch, unlike
    // `floor` where the processor's baseline has no instruction for it.
    const ROUND: f32 = 12_582_912.0;
    let rounded = x - 0.5 + ROUND;
    let whole = rounded.to_bits().wrapping_sub(ROUND.to_bits());
    let t = x - (rounded - ROUND);
    let hashed = whole.wrapping_mul(multiplier);
    ([hashed, hashed.wrapping_add(multiplier)], t * t * (3.0 - 2.0 * t))
}

/// A random number of -1 to 1.
#[inline(always)]
fn lattice(key: u32) -> f32 {
    let h = (key ^ (key >> 15)).wrapping_mul(0x2c1b_3c6d);
    f32::from_bits(((h ^ (h >> 13)) >> 9) | 1.0_f32.to_bits()) * 2.0 - 3.0
}

#[inline(always)]
fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// Value noise: -1 to 1 at the whole numbers, smoothly joined in between.
#[inline(always)]
fn value_noise(x: f32, y: f32, z: f32, seed: u32) -> f32 {
    let (zs, t) = cell(z, 0xcb1a_b31f);
    mix(flat_noise(x, y, seed ^ zs[0]), flat_noise(x, y, seed ^ zs[1]), t)
}

/// Value noise on a layer.
#[inline(always)]
fn flat_noise(x: f32, y: f32, seed: u32) -> f32 {
    let ((xs, tx), (ys, ty)) = (cell(x, 0x8da6_b343), cell(y, 0xd816_3841));
    let row = |y: u32| mix(lattice(seed ^ xs[0] ^ y), lattice(seed ^ xs[1] ^ y), tx);
    mix(row(ys[0]), row(ys[1]), ty)
}
