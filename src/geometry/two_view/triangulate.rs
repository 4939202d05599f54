//! Triangulation of a point from two rays (Hartley & Sturm 1997; Lindstrom 2010).

use super::correspondence::Correspondence;
use super::essential::{Essential, EssentialError};
use super::fundamental::Fundamental;
use crate::geometry::Real;
use crate::geometry::camera::{Camera, Pose, ProjectionError};
use crate::geometry::linear::{Ldl, all_finite};
use nalgebra::{Matrix2, Matrix2x3, Matrix3, Point2, Point3, Vector2, Vector3};

/// Two cameras whose pose is known: what triangulates.
///
/// Distances in px are between undistorted pixels. Lengths are in the unit of the pose.
///
/// In `f32` a point is good to about `Z^2 / (f b)` times a thousandth of a pixel; the linear method, which
/// squares its equations, to ten times that.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TwoViews<T: Real> {
    first: Camera<T>,
    second: Camera<T>,
    pose: Pose<T>,
    fundamental: Fundamental<T>,
    min_angle_rad: T,
}

/// A triangulated point.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Triangulated<T: Real> {
    /// The point in camera 1, in the unit of the pose.
    pub point: Point3<T>,
    /// What is left of the re-projection error, px: the root of the sum of both images' squared distances.
    pub residual_px: T,
    /// The angle between the two rays, radians.
    pub angle_rad: T,
}

/// Why two rays give no point.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum TriangulationError {
    /// A coordinate is infinite or not a number, or a number of the result would be.
    NotFinite,
    /// Undistortion did not converge: a pixel is outside of what its lens model describes.
    NotConverged,
    /// The rays are too nearly parallel to say where they meet.
    SmallAngle,
    /// The rays meet behind a camera.
    Behind,
}

error_text!(TriangulationError {
    Self::NotFinite => "a coordinate is not finite",
    Self::NotConverged => "the lens model has no undistorted place for a pixel",
    Self::SmallAngle => "the angle between the rays is too small",
    Self::Behind => "the rays meet behind a camera",
});

/// The rays of both cameras in camera 1, and the undistorted pixels they came from.
struct Rays<T: Real> {
    /// The rays p, and R p'.
    first: Vector3<T>,
    rotated: Vector3<T>,
    second: Vector3<T>,
    pixels: Correspondence<T>,
    angle_rad: T,
}

/// Steps to the least re-projection error, at most. Two are enough unless the residual is a good part of the
/// distance to the epipole (Lindstrom 2010, table 2).
const MOST_STEPS: usize = 10;

impl<T: Real> TwoViews<T> {
    /// Two cameras and the pose of the second beside the first. Rays that meet at less than a milliradian
    /// (0.06 degrees) are refused; [`Self::with_min_angle`] changes that.
    pub fn new(first: Camera<T>, second: Camera<T>, pose: Pose<T>) -> Result<Self, EssentialError> {
        let essential = Essential::from_pose(&pose)?;
        let fundamental = Fundamental::from_essential(&essential, &first, &second);
        Ok(Self { first, second, pose, fundamental, min_angle_rad: T::of(1e-3) })
    }

    /// Two views that refuse rays which meet at less than this angle, radians.
    pub fn with_min_angle(self, min_angle_rad: T) -> Self {
        Self { min_angle_rad, ..self }
    }

    /// The fundamental matrix of the two cameras.
    pub fn fundamental(&self) -> &Fundamental<T> {
        &self.fundamental
    }

    /// The pose of the second camera beside the first.
    pub fn pose(&self) -> &Pose<T> {
        &self.pose
    }

    /// The midpoint of the shortest segment between the rays (Hartley & Sturm 1997, 5.3): the cheapest, and
    /// not what the images say best where the two depths differ.
    pub fn midpoint(&self, seen: &Correspondence<T>) -> Result<Triangulated<T>, TriangulationError> {
        let rays = self.rays(seen)?;
        let point = self.meet(&rays)?;
        self.checked(point, &rays)
    }

    /// The homogeneous least squares of `p x (M P) = 0`, four equations with the focal lengths taken out
    /// (Hartley & Zisserman 2004, 12.2).
    pub fn linear(&self, seen: &Correspondence<T>) -> Result<Triangulated<T>, TriangulationError> {
        let rays = self.rays(seen)?;
        // Lengths in baselines, so that the fourth unknown has the size of the others.
        let baseline = self.pose.translation().norm();
        let to_second = self.pose.rotation().transpose();
        let t = to_second * (self.pose.translation() / -baseline);
        let mut squared = [[T::ZERO; 4]; 4];
        let (p, q, r) = (&rays.first, &rays.second, &to_second);
        let second_row = |k: usize, x: T| {
            [x * r[(2, 0)] - r[(k, 0)], x * r[(2, 1)] - r[(k, 1)], x * r[(2, 2)] - r[(k, 2)], x * t[2] - t[k]]
        };
        let (o, l) = (T::ZERO, T::ONE);
        for row in [[-l, o, p.x, o], [o, -l, p.y, o], second_row(0, q.x), second_row(1, q.y)] {
            for (line, &a) in squared.iter_mut().zip(&row) {
                for (sum, &b) in line.iter_mut().zip(&row) {
                    *sum += a * b;
                }
            }
        }
        let [x, y, z, w] = Ldl::<T, 4>::new(&mut squared).null_vector();
        if w == T::ZERO {
            return Err(TriangulationError::SmallAngle);
        }
        self.checked(Point3::new(x, y, z) * (baseline / w), &rays)
    }

    /// The optimum of the lecture's equation 6.2: the point with the least re-projection error
    /// `d(p, M P)^2 + d(p', M' P)^2`, px^2, which is the likeliest one if the errors of the four coordinates
    /// are normally distributed and alike.
    ///
    /// The pair of points nearest to `p, p'` that fulfils `p^T F p' = 0` is found by Lindstrom's iteration
    /// (Lindstrom 2010), at most ten steps of which each fulfils it; their rays meet.
    pub fn optimal(&self, seen: &Correspondence<T>) -> Result<Triangulated<T>, TriangulationError> {
        let rays = self.rays(seen)?;
        let nearest = self.nearest_possible(&rays.pixels);
        let first = self.first.inverse_matrix() * nearest.first.to_homogeneous();
        let second = self.second.inverse_matrix() * nearest.second.to_homogeneous();
        let rotated = self.pose.rotation() * second;
        let point = self.meet(&Rays { first, second, rotated, ..rays })?;
        self.checked(point, &rays)
    }

    /// The covariance of a triangulated point in camera 1, in the pose's unit squared, to first order, when
    /// every coordinate in both images has a standard deviation of `sigma_px`:
    /// `sigma^2 (J^T J + J'^T J')^-1` with J and J' the derivatives of both projections.
    ///
    /// In `f32` its smallest direction is lost where the largest deviation is over 2000 times the smallest.
    pub fn covariance(&self, point: &Point3<T>, sigma_px: T) -> Matrix3<T> {
        let first = pixel_jacobian(&self.first, point);
        let second = pixel_jacobian(&self.second, &self.pose.inverse_transform(point))
            * self.pose.rotation().transpose();
        let information = first.tr_mul(&first) + second.tr_mul(&second);
        // At size one: squares of px per unit are large.
        let size = information.amax();
        let ldl = Ldl::<T, 3>::new(&mut (information / size).into());
        let (o, l) = (T::ZERO, T::ONE);
        let inverse = Matrix3::from([ldl.solve(&[l, o, o]), ldl.solve(&[o, l, o]), ldl.solve(&[o, o, l])]);
        // The two triangles differ by rounding.
        (inverse + inverse.transpose()) * (T::of(0.5) * sigma_px * sigma_px / size)
    }

    /// The correspondence nearest to `seen` (undistorted px, in both images together) whose rays meet.
    pub fn nearest_possible(&self, seen: &Correspondence<T>) -> Correspondence<T> {
        let f = self.fundamental.matrix();
        let square = Matrix2::new(f.m11, f.m12, f.m21, f.m22);
        let homogeneous = |x: &Point2<T>| Vector3::new(x.x, x.y, T::ONE);
        let (p, q) = (homogeneous(&seen.first), homogeneous(&seen.second));
        let residual = p.dot(&(f * q));
        let (n0, m0): (Vector2<T>, Vector2<T>) = ((f * q).xy(), f.tr_mul(&p).xy());
        let (mut n, mut m) = (n0, m0);
        let (mut by_first, mut by_second) = (Vector2::zeros(), Vector2::zeros());
        for _ in 0..MOST_STEPS {
            // lambda of a lambda^2 - 2 b lambda + c = 0, the smaller one.
            let a = n.dot(&(square * m));
            let b = (n.dot(&n0) + m.dot(&m0)) * T::of(0.5);
            let root = (b * b - a * residual).max(T::ZERO).sqrt();
            let below = b + root;
            if !(below > T::ZERO) {
                break;
            }
            let lambda = residual / below;
            let (first, second) = (n * lambda, m * lambda);
            let change = (first - by_first).amax().max((second - by_second).amax());
            (by_first, by_second) = (first, second);
            n = n0 - square * second;
            m = m0 - square.tr_mul(&first);
            if change <= T::EPSILON * T::of(4.0) * (T::ONE + first.amax().max(second.amax())) {
                break;
            }
        }
        Correspondence { first: seen.first - by_first, second: seen.second - by_second }
    }

    /// The two rays of a correspondence, if they have an angle.
    fn rays(&self, seen: &Correspondence<T>) -> Result<Rays<T>, TriangulationError> {
        if !seen.is_finite() {
            return Err(TriangulationError::NotFinite);
        }
        let ray = |camera: &Camera<T>, pixel| {
            camera.unproject(pixel).map_err(|error| match error {
                ProjectionError::NotFinite => TriangulationError::NotFinite,
                _ => TriangulationError::NotConverged,
            })
        };
        let (first, second) = (ray(&self.first, &seen.first)?, ray(&self.second, &seen.second)?);
        let rotated = self.pose.rotation() * second;
        let (sine, cosine) = (first.cross(&rotated).norm(), first.dot(&rotated));
        if !(sine.is_finite() && cosine.is_finite()) {
            return Err(TriangulationError::NotFinite);
        }
        let angle_rad = sine.atan2(cosine);
        if !(angle_rad >= self.min_angle_rad && angle_rad > T::ZERO) {
            return Err(TriangulationError::SmallAngle);
        }
        let pixel = |camera: &Camera<T>, ray: &Vector3<T>| Point2::from((camera.matrix() * ray).xy());
        let pixels =
            Correspondence { first: pixel(&self.first, &first), second: pixel(&self.second, &second) };
        Ok(Rays { first, rotated, second, pixels, angle_rad })
    }

    /// Halfway between the two points in which the rays come nearest to each other.
    fn meet(&self, rays: &Rays<T>) -> Result<Point3<T>, TriangulationError> {
        let (p, q, t) = (&rays.first, &rays.rotated, self.pose.translation());
        let across = p.cross(q);
        let size = across.norm_squared();
        if !(size > T::ZERO) {
            return Err(TriangulationError::SmallAngle);
        }
        let (depth, other) = (t.cross(q).dot(&across) / size, t.cross(p).dot(&across) / size);
        if !(depth > T::ZERO && other > T::ZERO) {
            return Err(TriangulationError::Behind);
        }
        Ok(Point3::from((p * depth + t + q * other) * T::of(0.5)))
    }

    /// The point with its residual, if both cameras have it in front.
    fn checked(&self, point: Point3<T>, rays: &Rays<T>) -> Result<Triangulated<T>, TriangulationError> {
        let other = self.pose.inverse_transform(&point);
        if !(point.z > T::ZERO && other.z > T::ZERO) {
            return Err(TriangulationError::Behind);
        }
        let off = |camera: &Camera<T>, point: &Point3<T>, pixel: &Point2<T>| {
            let seen = camera.matrix() * (point.coords / point.z);
            (seen.xy() - pixel.coords).norm_squared()
        };
        let squared =
            off(&self.first, &point, &rays.pixels.first) + off(&self.second, &other, &rays.pixels.second);
        if !(squared.is_finite() && all_finite(point.coords.as_slice())) {
            return Err(TriangulationError::NotFinite);
        }
        Ok(Triangulated { point, residual_px: squared.sqrt(), angle_rad: rays.angle_rad })
    }
}

/// The derivative of the (distorted) pixel by the point in the camera's own frame, px per unit.
fn pixel_jacobian<T: Real>(camera: &Camera<T>, point: &Point3<T>) -> Matrix2x3<T> {
    let (o, l) = (T::ZERO, T::ONE);
    let by = l / point.z;
    let (x, y) = (point.x * by, point.y * by);
    let (_, lens) = camera.lens().distort_with_derivative(&Vector2::new(x, y));
    let plane = Matrix2x3::new(l, o, -x, o, l, -y) * by;
    let k = camera.matrix();
    Matrix2::new(k.m11, k.m12, k.m21, k.m22) * lens * plane
}

#[cfg(test)]
mod tests {
    use super::*;

    fn views() -> TwoViews<f64> {
        let camera = Camera::new(500.0, 500.0, 320.0, 240.0).expect("a camera");
        let pose = Pose::new(Matrix3::identity(), Vector3::new(0.5, 0.0, 0.0)).expect("a pose");
        TwoViews::new(camera, camera, pose).expect("a baseline")
    }

    #[test]
    fn a_rectified_pair() {
        // d = 50 px: Z = 500 * 0.5 / 50 = 5 m; the rows are two px apart, a residual of root two.
        let seen = Correspondence::new(420.0, 241.0, 370.0, 239.0);
        for found in [views().midpoint(&seen), views().linear(&seen), views().optimal(&seen)] {
            let found = found.expect("a point");
            assert!((found.point - Point3::new(1.0, 0.0, 5.0)).amax() < 1e-2, "{found:?}");
            assert!((found.residual_px - 2.0_f64.sqrt()).abs() < 2e-3);
            assert!((found.angle_rad - ((0.2_f64).atan() - (0.1_f64).atan())).abs() < 1e-4);
        }
        let best = views().optimal(&seen).expect("a point");
        assert!((best.point - Point3::new(1.0, 0.0, 5.0)).amax() < 1e-12);
    }

    #[test]
    fn the_covariance_of_a_depth() {
        // On the axis midway between the cameras, Z = 5 m: with x = X / Z small, the disparity has twice the
        // variance of a column, and sigma_Z = Z^2 / (f b) sigma_d = 25 / 250 * root two * 0.5.
        let covariance = views().covariance(&Point3::new(0.25, 0.0, 5.0), 0.5);
        assert!((covariance.m33.sqrt() - 0.1 * 2.0_f64.sqrt() * 0.5).abs() < 1e-12, "{covariance}");
        // Rows: two measurements of Y f / Z.
        assert!((covariance.m22.sqrt() - 5.0 / 500.0 * 0.5 / 2.0_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn what_has_no_point_is_refused() {
        use TriangulationError::{Behind, NotFinite, SmallAngle};
        let of = |u, u2| views().optimal(&Correspondence::new(u, 240.0, u2, 240.0)).err();
        assert_eq!(of(f64::NAN, 0.0), Some(NotFinite));
        assert_eq!(of(320.0, 320.0), Some(SmallAngle));
        assert_eq!(of(320.0, 319.9), Some(SmallAngle));
        assert_eq!(of(320.0, 370.0), Some(Behind));
    }
}
