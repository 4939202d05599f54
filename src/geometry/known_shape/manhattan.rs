//! The Manhattan frame: a camera's orientation in a building by vanishing points (Coughlan & Yuille 1999).

use super::pencil::{LineSegment, Scaled, VanishingPointError, vanishing_point};
use super::vanishing::extent;
use crate::geometry::Real;
use crate::geometry::camera::{Camera, Pose};
use crate::geometry::linear::{
    Ldl, LeastSquares, NormalEquations, Svd3, all_finite, cayley, levenberg_marquardt,
};
use nalgebra::{Matrix3, Point2, Vector3};

/// How a camera stands in a building, from lines along its three orthogonal directions.
///
/// Lines have no sense: of the four orientations that fit them equally well it is the one nearest to what the
/// caller expects.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ManhattanFrame<T: Real> {
    /// R carries a direction of the building into the camera's frame: its columns are the three directions.
    pub rotation: Matrix3<T>,
    /// Focal length, px: the camera's, or what was estimated.
    pub focal_px: T,
    /// How far the segments' ends are from the lines through their middles and the vanishing points, root
    /// mean square, px.
    pub rms_px: T,
    /// Standard deviations of the rotation about the camera's axes for segments whose ends are off by one
    /// px, radians per px.
    pub sigma_rad_per_px: Vector3<T>,
    /// Standard deviation of the focal length for segments whose ends are off by one px, px per px; zero
    /// where it was known.
    pub focal_sigma_per_px: T,
}

/// Why lines give no orientation.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ManhattanFrameError {
    /// A number is infinite or not a number.
    NotFinite,
    /// Fewer than two of the bundles have two segments.
    TooFew,
    /// All segments of a bundle are on one line.
    Line,
    /// Two bundles have one direction, or their directions are nearer to each other than to orthogonal ones.
    NotOrthogonal,
    /// The focal length is open: of every two bundles, one is parallel to the image, or no focal length makes
    /// them orthogonal.
    Focal,
}

error_text!(ManhattanFrameError {
    Self::NotFinite => "a number is not finite",
    Self::TooFew => "two bundles of two segments or more are needed",
    Self::Line => "all segments of a bundle are on one line",
    Self::NotOrthogonal => "the bundles' directions are not orthogonal",
    Self::Focal => "the vanishing points leave the focal length open",
});

impl From<VanishingPointError> for ManhattanFrameError {
    fn from(error: VanishingPointError) -> Self {
        match error {
            VanishingPointError::NotFinite => Self::NotFinite,
            VanishingPointError::TooFew => Self::TooFew,
            VanishingPointError::Line => Self::Line,
        }
    }
}

/// Three bundles of segments: along the building's X, Y and Z.
type Bundles<'a, T> = [&'a [LineSegment<T>]; 3];

/// Steps of the refinement at most.
const MOST_STEPS: usize = 16;

impl<T: Real> ManhattanFrame<T> {
    /// The orientation of a known camera.
    ///
    /// `bundles` are segments along the building's X, Y and Z, undistorted px; two of them need two segments
    /// each, the third may be empty. `expected` is about what R is. The vanishing point of direction k is
    /// `K R e_k` (Hartley & Zisserman 2004, 8.6); the rotation is the one for which the segments' ends
    /// are least away from the lines through their middles and these points.
    pub fn orientation(
        camera: &Camera<T>,
        bundles: Bundles<'_, T>,
        expected: &Matrix3<T>,
    ) -> Result<Self, ManhattanFrameError> {
        finite(bundles, expected)?;
        // In the camera's own plane, where K is one; the focal length makes px of the distances.
        let (k, (fx, fy)) = (camera.inverse_matrix(), camera.focal_px());
        let plane = move |segment: &LineSegment<T>| {
            let at = |p: &Point2<T>| Point2::from((k * p.to_homogeneous()).xy());
            LineSegment { from: at(&segment.from), to: at(&segment.to) }.scaled(&Point2::origin(), T::ONE)
        };
        let vanishing = vanishing_points(bundles, plane)?;
        let start = orthogonal(vanishing, expected)?;
        let scale = (fx * fy).sqrt();
        refined(bundles, plane, start, T::ONE, false, scale).sound()
    }

    /// The orientation and the focal length of a camera with square pixels of which only the principal point
    /// (column, row, px) is known: often the middle of the image.
    ///
    /// Of two orthogonal directions with vanishing points v and w, seen from the principal point, `f^2 = -v .
    /// w` (Hartley & Zisserman 2004, 8.8): two bundles that both converge fix it, the third makes it
    /// surer.
    pub fn orientation_and_focal(
        principal_point: &Point2<T>,
        bundles: Bundles<'_, T>,
        expected: &Matrix3<T>,
    ) -> Result<Self, ManhattanFrameError> {
        finite(bundles, expected)?;
        if !all_finite(principal_point.coords.as_slice()) {
            return Err(ManhattanFrameError::NotFinite);
        }
        let (_, scale) = extent(bundles.into_iter().flatten());
        if !(scale > T::ZERO) {
            let is_line = bundles.iter().any(|b| b.len() > 1);
            return Err(if is_line { ManhattanFrameError::Line } else { ManhattanFrameError::TooFew });
        }
        let plane = move |segment: &LineSegment<T>| segment.scaled(principal_point, scale);
        let vanishing = vanishing_points(bundles, plane)?;
        let focal = focal(&vanishing).ok_or(ManhattanFrameError::Focal)?;
        let directions = vanishing.map(|v| v.map(|v| Vector3::new(v.x, v.y, v.z * focal)));
        let start = orthogonal(directions, expected)?;
        let frame = refined(bundles, plane, start, focal, true, scale);
        let found = frame.focal_px > T::ZERO && frame.focal_sigma_per_px < frame.focal_px;
        if found && frame.focal_px.is_finite() { frame.sound() } else { Err(ManhattanFrameError::Focal) }
    }

    /// This frame, if its numbers are finite and its rotation is one.
    fn sound(self) -> Result<Self, ManhattanFrameError> {
        let is_finite = all_finite(&[self.rms_px, self.focal_px, self.focal_sigma_per_px])
            && all_finite(self.sigma_rad_per_px.as_slice());
        let pose = Pose::of_parts(self.rotation, Vector3::zeros()).sound();
        pose.filter(|_| is_finite).map(|_| self).ok_or(ManhattanFrameError::NotFinite)
    }
}

/// Checks that all numbers are finite.
fn finite<T: Real>(bundles: Bundles<'_, T>, expected: &Matrix3<T>) -> Result<(), ManhattanFrameError> {
    let finite =
        bundles.into_iter().flatten().all(LineSegment::is_finite) && expected.iter().all(|x| x.is_finite());
    if finite { Ok(()) } else { Err(ManhattanFrameError::NotFinite) }
}

/// The vanishing points of the bundles that have two segments.
fn vanishing_points<T: Real>(
    bundles: Bundles<'_, T>,
    plane: impl Fn(&LineSegment<T>) -> Scaled<T> + Copy,
) -> Result<[Option<Vector3<T>>; 3], ManhattanFrameError> {
    let mut points = [None; 3];
    for (point, bundle) in points.iter_mut().zip(bundles) {
        if bundle.len() > 1 {
            *point = Some(vanishing_point(bundle.iter().map(plane))?.0);
        }
    }
    if points.iter().flatten().count() < 2 { Err(ManhattanFrameError::TooFew) } else { Ok(points) }
}

/// The focal length f of the pairs of vanishing points, weighted by how much each says of it; in the unit
/// that they are given in.
fn focal<T: Real>(points: &[Option<Vector3<T>>; 3]) -> Option<T> {
    let (mut squares, mut weights) = (T::ZERO, T::ZERO);
    let [a, b, c] = points;
    for (v, w) in [(a, b), (b, c), (c, a)].into_iter().filter_map(|(v, w)| Some(((*v)?, (*w)?))) {
        let weight = v.z * w.z;
        squares -= weight * v.xy().dot(&w.xy());
        weights += weight * weight;
    }
    // Points of 1000 units away in both directions say nothing any more.
    (weights > T::of(1e-12).max(T::EPSILON * T::EPSILON) && squares > T::ZERO)
        .then(|| (squares / weights).sqrt())
}

/// The rotation whose columns are nearest to two or three directions of any sense and length.
fn orthogonal<T: Real>(
    directions: [Option<Vector3<T>>; 3],
    expected: &Matrix3<T>,
) -> Result<Matrix3<T>, ManhattanFrameError> {
    let mut columns = [Vector3::zeros(); 3];
    for ((column, direction), expected) in columns.iter_mut().zip(directions).zip(expected.column_iter()) {
        if let Some(direction) = direction {
            let unit = direction / direction.norm();
            *column = if unit.dot(&expected) < T::ZERO { -unit } else { unit };
        }
    }
    let [x, y, z] = columns;
    let filled = match directions {
        [None, _, _] => [y.cross(&z), y, z],
        [_, None, _] => [x, z.cross(&x), z],
        [_, _, None] => [x, y, x.cross(&y)],
        _ => columns,
    };
    let matrix = Matrix3::from_columns(&filled);
    let volume = matrix.determinant();
    // Half of what orthogonal directions enclose: two at 45 degrees, and one at right angles to them.
    if !(volume.abs() > T::of(0.5)) {
        return Err(ManhattanFrameError::NotOrthogonal);
    }
    // Seen from the other side: the sense that is least sure is the other one.
    let matrix = if volume < T::ZERO {
        let agree = |k: usize| filled.get(k).map_or(T::ONE, |column| column.dot(&expected.column(k)).abs());
        let least = (1..3).fold(0, |least, k| if agree(k) < agree(least) { k } else { least });
        let mut other = matrix;
        other.column_mut(least).neg_mut();
        other
    } else {
        matrix
    };
    let svd = Svd3::new(&matrix);
    Ok(svd.u * svd.v.transpose())
}

/// The distances of the segments' ends, over a rotation in the camera's frame and the logarithm of the focal
/// length.
struct Ends<'a, T: Real, F> {
    bundles: Bundles<'a, T>,
    /// The line through a segment, in the unit of the estimate.
    plane: F,
    /// Whether the focal length is looked for.
    free: bool,
}

impl<T: Real, F: Fn(&LineSegment<T>) -> Scaled<T>> LeastSquares<T, 4> for Ends<'_, T, F> {
    /// The rotation and the focal length.
    type Estimate = (Matrix3<T>, T);

    fn equations(
        &self,
        &(rotation, focal): &(Matrix3<T>, T),
        _bound: Option<T>,
    ) -> Option<NormalEquations<T, 4>> {
        let mut equations = NormalEquations::new();
        for (bundle, direction) in self.bundles.into_iter().zip(rotation.column_iter()) {
            let v = Vector3::new(focal * direction.x, focal * direction.y, direction.z);
            for segment in bundle {
                let gradient = (self.plane)(segment).gradient(&v);
                let error = -gradient.dot(&v);
                let by_direction = Vector3::new(focal * gradient.x, focal * gradient.y, gradient.z);
                // dv = K (w x d), d(log f) moves v's first two.
                let by_turn = direction.cross(&by_direction);
                let by_focal = if self.free { gradient.x * v.x + gradient.y * v.y } else { T::ZERO };
                equations.add(&[by_turn.x, by_turn.y, by_turn.z, by_focal], error);
                equations.cost += error * error;
            }
        }
        if !self.free {
            equations.matrix[3][3] = T::ONE;
        }
        Some(equations)
    }

    fn moved(&self, (rotation, focal): &(Matrix3<T>, T), &[x, y, z, along]: &[T; 4]) -> (Matrix3<T>, T) {
        let along = along.max(-T::of(0.5)).min(T::ONE);
        (cayley(&Vector3::new(x, y, z)) * rotation, *focal * (T::ONE + along))
    }
}

/// The rotation (and focal length, if it is `free`) near the first one with the least squares of distances,
/// by Levenberg-Marquardt. `scale` is the px of a unit.
fn refined<T: Real>(
    bundles: Bundles<'_, T>,
    plane: impl Fn(&LineSegment<T>) -> Scaled<T>,
    rotation: Matrix3<T>,
    focal: T,
    free: bool,
    scale: T,
) -> ManhattanFrame<T> {
    let start = (rotation, focal);
    let found = levenberg_marquardt(&Ends { bundles, plane, free }, start, MOST_STEPS);
    let ((rotation, focal), mut equations) = found.unwrap_or((start, NormalEquations::new()));
    let count: usize = bundles.iter().map(|bundle| bundle.len()).sum();
    // The steps' products are a rotation but for rounding.
    let svd = Svd3::new(&rotation);
    let ldl = Ldl::new(&mut equations.matrix);
    let deviation = |k: usize| {
        let mut unit = [T::ZERO; 4];
        if let Some(one) = unit.get_mut(k) {
            *one = T::ONE;
        }
        ldl.solve(&unit).get(k).map_or(T::ZERO, |variance| variance.max(T::ZERO).sqrt() / scale)
    };
    // Both ends move a segment's: half of the variance.
    let half = T::of(core::f64::consts::FRAC_1_SQRT_2);
    ManhattanFrame {
        rotation: svd.u * svd.v.transpose(),
        focal_px: focal * scale,
        rms_px: (equations.cost / T::count(count.max(1))).sqrt() * scale,
        sigma_rad_per_px: Vector3::new(deviation(0), deviation(1), deviation(2)) * half,
        focal_sigma_per_px: if free { deviation(3) * focal * scale * half } else { T::ZERO },
    }
}
