//! P3P: the pose of a calibrated camera from three points of known position (Persson & Nordberg 2018).

use super::plane_pair::{directions, on_plane, planes, singular_combination};
use crate::geometry::Real;
use crate::geometry::camera::Pose;
use nalgebra::{Matrix3, Point3, Vector3};

/// The poses with which a camera sees three points where it does: up to four.
///
/// Each carries a point of the camera into the world, `P = R P' + t`, as everywhere.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct P3pPoses<T: Real> {
    poses: [Pose<T>; 4],
    count: usize,
}

impl<T: Real> P3pPoses<T> {
    /// The poses, one at least.
    pub fn as_slice(&self) -> &[Pose<T>] {
        self.poses.get(..self.count).unwrap_or(&[])
    }
}

/// Why three points give no pose.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum P3pError {
    /// A coordinate is infinite or not a number.
    NotFinite,
    /// The points are on a line, or two of them are one.
    Line,
    /// Two rays are one.
    SameRay,
    /// No camera sees these points in these directions.
    NoPose,
}

error_text!(P3pError {
    Self::NotFinite => "a coordinate is not finite",
    Self::Line => "the three points are on a line",
    Self::SameRay => "two of the three rays are one",
    Self::NoPose => "no camera sees these points in these directions",
});

/// The sine of the angle between edges, and between rays, that counts as none.
const NO_ANGLE: f64 = 1e-5;
/// Newton's steps on the three distances.
const STEPS: usize = 4;
/// The sine of the angle between a ray and its point up to which a pose sees it there, in roots of the step
/// between numbers: a thousandth in `f32`.
const SAME_RAY: f64 = 3.0;

/// All poses of a camera that sees `points` (the world, any unit) along `rays` (the camera's frame, any
/// length).
///
/// The distances l of the points fulfil `|l_i y_i - l_j y_j|^2 = |x_i - x_j|^2` for the three pairs: three
/// quadratic forms. Two combinations of them vanish, and a combination of those two is a pair of planes,
/// found by one root of a cubic; each plane leaves a quadratic equation (Persson & Nordberg, "Lambda Twist",
/// ECCV 2018). The distances are then corrected by Newton's method on the three equations, at most four
/// steps. Every solution has all points before the camera, each along its ray within a thousandth of a radian
/// in `f32`, 5e-8 in `f64`.
///
/// ```
/// use stereopsis::geometry::absolute::p3p;
/// use nalgebra::{Point3, Vector3};
/// let points = [Point3::new(0.0, 0.0, 4.0), Point3::new(1.0, 0.0, 5.0), Point3::new(0.0, 1.0, 6.0_f64)];
/// // A camera one unit before the origin.
/// let rays = points.map(|p| p.coords + Vector3::z());
/// let poses = p3p(&rays, &points)?;
/// assert!(poses.as_slice().iter().any(|pose| (pose.translation() + Vector3::z()).norm() < 1e-12));
/// # Ok::<(), stereopsis::geometry::absolute::P3pError>(())
/// ```
pub fn p3p<T: Real>(rays: &[Vector3<T>; 3], points: &[Point3<T>; 3]) -> Result<P3pPoses<T>, P3pError> {
    let [x1, x2, x3] = points.map(|p| p.coords);
    if !rays.iter().chain(&[x1, x2, x3]).all(|v| v.iter().all(|x| x.is_finite())) {
        return Err(P3pError::NotFinite);
    }
    let y = rays.map(|y| y / y.norm());
    let [y1, y2, y3] = y;
    let none = T::of(NO_ANGLE);
    if [(y1, y2), (y1, y3), (y2, y3)].iter().any(|(a, b)| !(a.cross(b).norm() > none)) {
        return Err(P3pError::SameRay);
    }
    let (e12, e13, e23) = (x1 - x2, x1 - x3, x2 - x3);
    if !(e12.cross(&e13).norm() > none * e12.norm() * e13.norm()) || !(e23.norm() > none * e12.norm()) {
        return Err(P3pError::Line);
    }
    // Lengths in units of the triangle.
    let size = T::ONE / (e12.norm_squared() + e13.norm_squared() + e23.norm_squared());
    let equations = Equations {
        squares: [e12, e13, e23].map(|e| e.norm_squared() * size),
        cosines: [y1.dot(&y2), y1.dot(&y3), y2.dot(&y3)],
    };
    // By the longest edge: what the distances are off by would turn a short one, and all with it.
    let [a12, a13, a23] = equations.squares;
    let corner = |[a, b, c]: [Vector3<T>; 3]| match () {
        _ if a12 >= a13.max(a23) => triad(&(a - b), &(a - c)),
        _ if a13 >= a23 => triad(&(a - c), &(a - b)),
        _ => triad(&(b - c), &(b - a)),
    };
    let frame = corner([x1, x2, x3]).ok_or(P3pError::Line)?;
    let third = T::of(1.0 / 3.0);
    let (middle, same) = ((x1 + x2 + x3) * third, T::EPSILON.sqrt() * T::of(SAME_RAY));
    let unit = size.sqrt();
    let mut found = P3pPoses { poses: [Pose::identity(); 4], count: 0 };
    for distances in equations.distances().into_iter().flatten() {
        let l = distances / unit;
        let [c1, c2, c3] = [y1 * l.x, y2 * l.y, y3 * l.z];
        let Some(seen) = corner([c1, c2, c3]) else { continue };
        let rotation = frame * seen.transpose();
        let middle_seen = (c1 + c2 + c3) * third;
        // The equations are fulfilled beside the triangle's size, which says little of a short edge.
        let is_along = |(x, y): (&Vector3<T>, &Vector3<T>)| {
            let p = rotation.tr_mul(&(x - middle)) + middle_seen;
            p.dot(y) > T::ZERO && p.cross(y).norm() <= p.norm() * same
        };
        if ![x1, x2, x3].iter().zip(&y).all(is_along) {
            continue;
        }
        let translation = middle - rotation * middle_seen;
        let Some(pose) = Pose::of_parts(rotation, translation).sound() else { continue };
        if let Some(slot) = found.poses.get_mut(found.count) {
            *slot = pose;
            found.count += 1;
        }
    }
    if found.count == 0 { Err(P3pError::NoPose) } else { Ok(found) }
}

/// Three directions at right angles: along `a`, in the plane of both, across it.
fn triad<T: Real>(a: &Vector3<T>, b: &Vector3<T>) -> Option<Matrix3<T>> {
    let across = a.cross(b);
    let (length, size) = (a.norm(), across.norm());
    if !(length > T::ZERO && size > T::ZERO) {
        return None;
    }
    let (first, third) = (a / length, across / size);
    Some(Matrix3::from_columns(&[first, third.cross(&first), third]))
}

/// `l_i^2 + l_j^2 - 2 c_ij l_i l_j = a_ij` for the pairs 12, 13, 23.
struct Equations<T: Real> {
    squares: [T; 3],
    cosines: [T; 3],
}

impl<T: Real> Equations<T> {
    /// The forms on the left.
    fn forms(&self) -> [Matrix3<T>; 3] {
        let [c12, c13, c23] = self.cosines;
        let (o, l) = (T::ZERO, T::ONE);
        [
            Matrix3::new(l, -c12, o, -c12, l, o, o, o, o),
            Matrix3::new(l, o, -c13, o, o, o, -c13, o, l),
            Matrix3::new(o, o, o, o, l, -c23, o, -c23, l),
        ]
    }

    /// The distances that are positive, up to four.
    fn distances(&self) -> [Option<Vector3<T>>; 4] {
        let [m12, m13, m23] = self.forms();
        let [a12, a13, a23] = self.squares;
        let (d1, d2) = (m12 * a23 - m23 * a12, m13 * a23 - m23 * a13);
        let mut found = [None; 4];
        let Some(degenerate) = singular_combination(&d1, &d2) else { return found };
        let Some(planes) = planes(&degenerate) else { return found };
        // One of the two vanishes on a plane when it is the pair of planes itself.
        let mut slots = found.iter_mut();
        for plane in planes {
            let other = if on_plane(&plane, &d1) > on_plane(&plane, &d2) { &d1 } else { &d2 };
            for direction in directions(&plane, other).into_iter().flatten() {
                let scale = direction.dot(&((m12 + m13 + m23) * direction));
                if !(scale > T::ZERO) {
                    continue;
                }
                let size = ((a12 + a13 + a23) / scale).sqrt();
                let start = direction * if direction.sum() < T::ZERO { -size } else { size };
                if let (Some(l), Some(slot)) = (self.corrected(start), slots.next()) {
                    *slot = Some(l);
                }
            }
        }
        found
    }

    /// Newton's method from there, while it makes the equations better; `None` when a distance is not
    /// positive or they are not fulfilled.
    fn corrected(&self, start: Vector3<T>) -> Option<Vector3<T>> {
        let [c12, c13, c23] = self.cosines;
        let [a12, a13, a23] = self.squares;
        let two = T::of(2.0);
        let residual = |l: &Vector3<T>| {
            Vector3::new(
                l.x * l.x + l.y * l.y - two * c12 * l.x * l.y - a12,
                l.x * l.x + l.z * l.z - two * c13 * l.x * l.z - a13,
                l.y * l.y + l.z * l.z - two * c23 * l.y * l.z - a23,
            )
        };
        let mut l = start;
        let mut error = residual(&l);
        for _ in 0..STEPS {
            let (x, y, z) = (l.x, l.y, l.z);
            let [p, q, r] = [
                Vector3::new(x - c12 * y, y - c12 * x, T::ZERO),
                Vector3::new(x - c13 * z, T::ZERO, z - c13 * x),
                Vector3::new(T::ZERO, y - c23 * z, z - c23 * y),
            ];
            // The inverse by cross products of the rows.
            let determinant = p.dot(&q.cross(&r)) * two;
            let step = (q.cross(&r) * error.x + r.cross(&p) * error.y + p.cross(&q) * error.z) / determinant;
            let next = l - step;
            let then = residual(&next);
            if !(then.norm_squared() < error.norm_squared()) {
                break;
            }
            (l, error) = (next, then);
        }
        // The triangle has size one.
        let good = T::EPSILON.sqrt() * T::of(0.1);
        (l.min() > T::ZERO && error.amax() < good).then_some(l)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_camera_at_the_origin() {
        let points =
            [Point3::new(1.0, 0.0, 4.0), Point3::new(-1.0, 0.5, 5.0), Point3::new(0.0, -1.0, 3.0_f64)];
        let rays = points.map(|p| p.coords);
        let poses = p3p(&rays, &points).expect("poses");
        let best = poses.as_slice().iter().map(|p| p.translation().norm()).fold(f64::INFINITY, f64::min);
        assert!(best < 1e-12, "{best}");
    }

    #[test]
    fn what_has_no_pose_is_named() {
        let o = Point3::new(0.0, 0.0, 2.0_f64);
        let on_line = [o, o + Vector3::x(), o + Vector3::x() * 2.0];
        assert_eq!(p3p(&on_line.map(|p| p.coords), &on_line), Err(P3pError::Line));
        let apart = [o, o + Vector3::x(), o + Vector3::y()];
        assert_eq!(p3p(&[Vector3::z(); 3], &apart), Err(P3pError::SameRay));
        assert_eq!(p3p(&[Vector3::z() * f64::NAN; 3], &apart), Err(P3pError::NotFinite));
    }
}
