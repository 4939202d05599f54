//! Self-calibration of a rig that runs: rows that no longer agree, and the small rotation that
//! explains them.

use super::rectification::Rectification;
use super::warp::Warp;
use crate::geometry::Real;
use crate::geometry::camera::{Camera, ImageSize};
use crate::geometry::linear::{Ldl, all_finite, cayley};
use crate::geometry::two_view::Correspondence;
use nalgebra::Vector3;

/// Gathers correspondences of rectified images, frame by frame, and estimates by what rotation the second
/// camera was rotated since it was calibrated.
///
/// A camera that rotates by a small `w = (pitch, yaw, roll)` about X, Y and Z moves the row of what it sees,
/// in units of the focal length and whatever the depth is, by (Longuet-Higgins & Prazdny 1980, the rotational
/// flow)
///
/// `v' - v = w_x (-1 - y^2) + w_y x y + w_z x`, with `(x, y)` of the plane Z = 1.
///
/// The least weighted sum of squares over a frame's correspondences gives w. Wrong ones are weighted down by
/// how far they are from it, `1 / (1 + (r / c)^2)^2` (Geman & McClure 1987), where c falls from 8 px to 1 px
/// from step to step; the work is the same for every frame. Frames add up, each older one counting nine
/// tenths of the next.
///
/// A rotation about Y is seen in the image's corners alone, and a step along the baseline is not seen at all:
/// neither moves rows by much, and both change depths. [`RowAlignment::sigma_rad`] says how little is known.
///
/// ```
/// use stereopsis::geometry::{camera::Camera, rectify::RowMeter, two_view::Correspondence};
/// use nalgebra::Point2;
/// let camera = Camera::new(300.0_f64, 300.0, 160.0, 120.0)?;
/// let mut meter = RowMeter::new();
/// // The right camera sees everything 1.5 px too low.
/// let seen: [_; 30] = std::array::from_fn(|i| {
///     let (u, v) = (10.0 * i as f64 + 12.0, (37 * i % 240) as f64);
///     Correspondence { first: Point2::new(u, v), second: Point2::new(u - 9.0, v + 1.5) }
/// });
/// meter.add(&camera, &seen)?;
/// let found = meter.alignment()?;
/// assert!((found.rotation_rad[0].to_degrees() + 0.28).abs() < 0.03);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct RowMeter<T: Real> {
    /// `sum A^T A / sigma^2` and `sum A^T r / sigma^2`, angles in radians.
    information: [[T; 3]; 3],
    vector: [T; 3],
}

/// Why rows give no alignment.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RowMeterError {
    /// Too few correspondences in a frame, or too few that agree with each other.
    TooFew {
        /// How many would have been enough.
        needed: usize,
    },
    /// A number is infinite or not a number.
    NotFinite,
    /// No frame was added.
    Empty,
}

error_text!(RowMeterError {
    Self::TooFew { needed } => "{needed} correspondences that agree are needed",
    Self::NotFinite => "a correspondence is not finite, or the result would not be",
    Self::Empty => "no frame was added",
});

/// Small rotation of the second camera, estimated from row differences, with its standard deviations.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RowAlignment<T: Real> {
    /// Rotation of the right camera about X (pitch), Y (yaw) and Z (roll) of the rectified frame, radians:
    /// what it should see at P it sees at `P + w x P`.
    pub rotation_rad: [T; 3],
    /// Standard deviations of the three angles, radians.
    pub sigma_rad: [T; 3],
}

/// What rows that are off mean for matching.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum RowHealth {
    /// Under a quarter of a pixel: nothing that matching would show.
    Good,
    /// Up to half a pixel. Half a row off, all methods miss over two fifths more answers
    /// (docs/performance.md, altered images): correct the remap.
    Worn,
    /// More: answers are lost, and those that are left are worse. Correct the remap, and calibrate anew.
    Bad,
}

/// The scales of the weights, px.
const SCALES: [f64; 8] = [8.0, 6.0, 4.0, 3.0, 2.0, 1.5, 1.0, 1.0];
/// What an older frame counts beside the next.
const OLDER: f64 = 0.9;
/// The least deviation that a correspondence is taken to have: features are found to about that, px.
const LEAST_SIGMA_PX: f64 = 0.15;
/// What is known of angles before the first frame: under ten degrees.
const PRIOR_RAD: f64 = 0.17;

impl<T: Real> RowMeter<T> {
    /// The fewest correspondences of a frame.
    pub const FEWEST: usize = 12;

    /// A meter that has seen nothing.
    pub const fn new() -> Self {
        Self { information: [[T::ZERO; 3]; 3], vector: [T::ZERO; 3] }
    }

    /// Adds a frame: points of the left and the right rectified image, px, of which some may be wrong.
    /// `camera` is the rectified one.
    pub fn add(&mut self, camera: &Camera<T>, seen: &[Correspondence<T>]) -> Result<(), RowMeterError> {
        let too_few = RowMeterError::TooFew { needed: Self::FEWEST };
        if seen.len() < Self::FEWEST {
            return Err(too_few);
        }
        if !seen.iter().all(Correspondence::is_finite) {
            return Err(RowMeterError::NotFinite);
        }
        let mut rotation = [T::ZERO; 3];
        let mut normal = Normal::ZERO;
        for scale in SCALES {
            normal = Normal::of(camera, seen, &rotation, T::of(scale));
            rotation = normal.solved();
        }
        // Weights add up to a number of correspondences.
        if !(normal.weights > T::count(Self::FEWEST / 2)) {
            return Err(too_few);
        }
        let least = T::of(LEAST_SIGMA_PX);
        let variance = (normal.squares / normal.weights).max(least * least);
        let older = T::of(OLDER);
        let rows = self.information.iter_mut().flatten().zip(normal.matrix.iter().flatten());
        rows.chain(self.vector.iter_mut().zip(&normal.vector))
            .for_each(|(to, new)| *to = *to * older + *new / variance);
        Ok(())
    }

    /// What all frames say.
    pub fn alignment(&self) -> Result<RowAlignment<T>, RowMeterError> {
        if self.information.iter().flatten().all(|&x| x == T::ZERO) {
            return Err(RowMeterError::Empty);
        }
        let mut matrix = self.information;
        let prior = T::ONE / T::of(PRIOR_RAD * PRIOR_RAD);
        (0..3).for_each(|i| matrix[i][i] += prior);
        let factors = Ldl::new(&mut matrix);
        let rotation_rad = factors.solve(&self.vector);
        let column = |i: usize| {
            let mut unit = [T::ZERO; 3];
            unit[i] = T::ONE;
            factors.solve(&unit)[i].max(T::ZERO).sqrt()
        };
        let sigma_rad = [column(0), column(1), column(2)];
        if !(all_finite(rotation_rad.as_slice()) && all_finite(&sigma_rad)) {
            return Err(RowMeterError::NotFinite);
        }
        Ok(RowAlignment { rotation_rad, sigma_rad })
    }
}

impl<T: Real> Default for RowMeter<T> {
    fn default() -> Self {
        Self::new()
    }
}

/// Sums over a frame, px and radians.
struct Normal<T> {
    matrix: [[T; 3]; 3],
    vector: [T; 3],
    weights: T,
    squares: T,
}

impl<T: Real> Normal<T> {
    const ZERO: Self =
        Self { matrix: [[T::ZERO; 3]; 3], vector: [T::ZERO; 3], weights: T::ZERO, squares: T::ZERO };

    /// The sums, with weights by what `rotation` leaves.
    fn of(camera: &Camera<T>, seen: &[Correspondence<T>], rotation: &[T; 3], scale: T) -> Self {
        let mut sums = Self::ZERO;
        for seen in seen {
            let a = row_moves(camera, seen.second.x, seen.second.y);
            let moved = seen.second.y - seen.first.y;
            let [x, y, z] = [a[0] * rotation[0], a[1] * rotation[1], a[2] * rotation[2]];
            let rest = moved - (x + y + z);
            let ratio = rest / scale;
            let weight = T::ONE / (T::ONE + ratio * ratio);
            let weight = weight * weight;
            sums.weights += weight;
            sums.squares += weight * rest * rest;
            for (i, row) in sums.matrix.iter_mut().enumerate() {
                sums.vector[i] += weight * a[i] * moved;
                row.iter_mut().zip(a).for_each(|(to, b)| *to += weight * a[i] * b);
            }
        }
        sums
    }

    /// The rotation with the least sum; what the frame leaves open stays small.
    fn solved(&self) -> [T; 3] {
        // An angle of `PRIOR_RAD` weighs as much as a residual of a pixel.
        let prior = T::ONE / T::of(PRIOR_RAD * PRIOR_RAD);
        let mut matrix = self.matrix;
        (0..3).for_each(|i| matrix[i][i] += prior);
        Ldl::new(&mut matrix).solve(&self.vector)
    }
}

/// Jacobian of a pixel's row by rotations about X, Y and Z, px for each radian.
fn row_moves<T: Real>(camera: &Camera<T>, u: T, v: T) -> [T; 3] {
    let ((fx, fy), (cx, cy)) = (camera.focal_px(), camera.principal_point());
    let (x, y) = ((u - cx) / fx, (v - cy) / fy);
    [-fy * (T::ONE + y * y), fy * x * y, fy * x]
}

impl<T: Real> RowAlignment<T> {
    /// The root mean square of how far rows are off, px, over images of `size` of the rectified `camera`: as
    /// a lattice of 9 x 9 places has it.
    pub fn row_error_px(&self, camera: &Camera<T>, size: ImageSize) -> T {
        const PLACES: usize = 9;
        let place = |i: usize, side: u16| {
            T::count(i) * T::count(usize::from(side.saturating_sub(1))) / T::count(PLACES - 1)
        };
        let mut squares = T::ZERO;
        for (i, j) in (0..PLACES).flat_map(|j| (0..PLACES).map(move |i| (i, j))) {
            let [x, y, z] = row_moves(camera, place(i, size.width), place(j, size.height));
            let moved = x * self.rotation_rad[0] + y * self.rotation_rad[1] + z * self.rotation_rad[2];
            squares += moved * moved;
        }
        (squares / T::count(PLACES * PLACES)).sqrt()
    }

    /// What that means for matching.
    pub fn health(&self, camera: &Camera<T>, size: ImageSize) -> RowHealth {
        RowHealth::of_error_px(self.row_error_px(camera, size))
    }
}

impl RowHealth {
    /// Of rows that are so far off, px: the root mean square over the image.
    pub fn of_error_px<T: Real>(error_px: T) -> Self {
        if error_px < T::of(0.25) {
            Self::Good
        } else if error_px < T::of(0.5) {
            Self::Worn
        } else {
            // Also what is not a number.
            Self::Bad
        }
    }
}

impl<T: Real> Rectification<T> {
    /// The rectification for a second camera that was rotated as `found` says: its warp takes the rotation
    /// back.
    pub fn corrected(&self, found: &RowAlignment<T>) -> Self {
        let [first, second] = self.warps();
        let back = -Vector3::from(found.rotation_rad);
        let rotation = cayley(&back) * second.rotation();
        let second = Warp::new(*second.camera(), second.raw_size(), rotation, *self.camera(), self.size());
        self.with_warps([*first, second])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_moves_as_its_point_turns() {
        let camera = Camera::new(100.0_f64, 100.0, 0.0, 0.0).expect("a camera");
        // (0.5, 0.2, 1) + w x it, of w = (0.01, 0, 0.02): (0.496, 0.2, 1.002).
        let [x, _, z] = row_moves(&camera, 50.0, 20.0);
        assert!((0.01 * x + 0.02 * z - (100.0 * 0.2 / 1.002 - 20.0)).abs() < 2e-2);
        let rotation = cayley(&Vector3::new(0.01, 0.0, 0.02));
        let moved = rotation * Vector3::new(0.5, 0.2, 1.0);
        assert!((moved - Vector3::new(0.496, 0.2, 1.002)).amax() < 3e-4);
    }
}
