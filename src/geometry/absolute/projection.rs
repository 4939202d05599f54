//! Projection matrices, and resection by the direct linear transform, DLT (Hartley & Zisserman 2004, 7.1).

use crate::geometry::Real;
use crate::geometry::camera::{Camera, CameraModelError, Pose};
use crate::geometry::linear::{Ldl, Projective, all_finite, rank};
use nalgebra::{Matrix3, Matrix3x4, Point2, Point3, Vector3};

/// M, with `p ~ M P` for a point P of the world and its undistorted pixel p: `M = K [R^T | -R^T t]`, where R
/// and t carry a point of the camera into the world (Hartley & Zisserman 2004, 6.1; there `K R [1 | -C]`).
///
/// Held with a third row whose first three elements have length one, so that the third number of `M P` is the
/// depth.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Projection<T: Real> {
    matrix: Matrix3x4<T>,
}

deserialize_checked! { Projection<T> { matrix: Matrix3x4<T> } by |stored| Self::from_matrix(&stored.matrix) }

/// A point of known position, and where it is seen.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Landmark<T: Real> {
    /// In the world, metres.
    pub world: Point3<T>,
    /// Undistorted px.
    pub pixel: Point2<T>,
}

/// Why there is no projection matrix, or none of a camera.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ResectionError {
    /// A number is infinite or not a number.
    NotFinite,
    /// Fewer than six landmarks, or fewer than six that are not the same.
    TooFew,
    /// All landmarks are on a plane.
    Plane,
    /// More than one matrix fits: all but one landmark on a plane, or all and the camera on one twisted
    /// cubic.
    Undetermined,
    /// Some landmarks are behind the camera that fits.
    Behind,
    /// The matrix is that of a camera at infinity: its first three columns are singular.
    Infinite,
    /// The inner parameters are out of range.
    Camera(CameraModelError),
}

error_text!(ResectionError {
    Self::NotFinite => "a number is not finite",
    Self::TooFew => "a projection matrix needs six different landmarks",
    Self::Plane => "the landmarks are on a plane",
    Self::Undetermined => "more than one projection matrix fits the landmarks",
    Self::Behind => "landmarks are behind the camera that fits them",
    Self::Infinite => "the matrix is that of a camera at infinity",
    Self::Camera(error) => "{error}",
});

impl<T: Real> Projection<T> {
    /// A camera at a place in the world: `pose` carries a point of the camera into the world. Its lens is
    /// left out.
    pub fn new(camera: &Camera<T>, pose: &Pose<T>) -> Self {
        let inverse = pose.inverse();
        let outer = Matrix3x4::from_fn(|i, j| match inverse.rotation().get((i, j)) {
            Some(&r) => r,
            None => inverse.translation()[i],
        });
        Self { matrix: camera.matrix() * outer }
    }

    /// The camera matrix of any scale, of either sign, but zero.
    pub fn from_matrix(matrix: &Matrix3x4<T>) -> Result<Self, ResectionError> {
        if !matrix.iter().all(|x| x.is_finite()) {
            return Err(ResectionError::NotFinite);
        }
        let size = matrix.fixed_view::<3, 3>(0, 0).amax();
        if size == T::ZERO {
            return Err(ResectionError::Infinite);
        }
        let scaled = matrix / size;
        let [a, b, c] = rows(&scaled);
        let determinant = a.cross(&b).dot(&c);
        // The sine of the angle between the third row and the first two, times the sine between those.
        if !(determinant.abs() > a.norm() * b.norm() * c.norm() * T::EPSILON * T::of(16.0)) {
            return Err(ResectionError::Infinite);
        }
        let by = if determinant < T::ZERO { -c.norm() } else { c.norm() };
        let matrix = scaled / by;
        if !all_finite(matrix.as_slice()) {
            return Err(ResectionError::NotFinite);
        }
        Ok(Self { matrix })
    }

    /// The matrix of six landmarks or more that are not on a plane, by the direct linear transform on
    /// normalised points (Hartley & Zisserman 2004, algorithm 7.1, its linear part); all are used, the
    /// algebraic error is least.
    ///
    /// Squares its equations: with exact landmarks `f64` comes to 1e-9 px. In `f32` it is a starting value,
    /// good to a tenth of a pixel.
    pub fn from_landmarks(landmarks: &[Landmark<T>]) -> Result<Self, ResectionError> {
        if landmarks.len() < 6 {
            return Err(ResectionError::TooFew);
        }
        if !landmarks.iter().all(|l| l.world.iter().chain(l.pixel.iter()).all(|x| x.is_finite())) {
            return Err(ResectionError::NotFinite);
        }
        if distinct(landmarks) < 6 {
            return Err(ResectionError::TooFew);
        }
        let (world, pixel) = (Centred::of(landmarks.iter().map(|l| l.world.coords)), {
            Centred::of(landmarks.iter().map(|l| Vector3::new(l.pixel.x, l.pixel.y, T::ZERO)))
        });
        // All in one pixel: what is left is the camera's centre and a line.
        let (Some(world), Some(pixel)) = (world, pixel) else { return Err(ResectionError::Undetermined) };
        if world.is_flat(landmarks.iter().map(|l| l.world.coords)) {
            return Err(ResectionError::Plane);
        }
        let (o, l) = (T::ZERO, T::ONE);
        let mut equations = Projective::<T, 4>::new();
        for landmark in landmarks {
            let point = world.apply(&landmark.world.coords);
            let seen = pixel.apply(&Vector3::new(landmark.pixel.x, landmark.pixel.y, o));
            equations.add(seen.x, seen.y, &[point.x, point.y, point.z, l]);
        }
        let ldl = Ldl::<T, 12>::new(&mut equations.normal_matrix());
        if rank(ldl.pivots(), T::EPSILON * T::of(4.0)) < 11 {
            return Err(ResectionError::Undetermined);
        }
        let [a, b, c, d, e, f, g, h, i, j, k, m] = ldl.null_vector();
        let normalised = Matrix3x4::new(a, b, c, d, e, f, g, h, i, j, k, m);
        // M = N_p^-1 M_n N_P.
        let per_pixel = l / pixel.scale;
        let [x, y, z] = rows(&normalised).map(|row| row * world.scale);
        let shift = |row: &Vector3<T>, last: T| last - row.dot(&world.centre);
        let (x, y, z) = (
            x.push(shift(&x, normalised.m14)) * per_pixel,
            y.push(shift(&y, normalised.m24)) * per_pixel,
            z.push(shift(&z, normalised.m34)),
        );
        let rows = [x + z * pixel.centre.x, y + z * pixel.centre.y, z].map(|row| row.transpose());
        let found = Self::from_matrix(&Matrix3x4::from_rows(&rows))?;
        if landmarks.iter().any(|l| !(found.depth(&l.world) > o)) {
            return Err(ResectionError::Behind);
        }
        Ok(found)
    }

    /// The camera and its place: K by a triangular factor times a rotation (RQ), and the pose that carries a
    /// point of the camera into the world (Hartley & Zisserman 2004, 6.2.4).
    pub fn decompose(&self) -> Result<(Camera<T>, Pose<T>), ResectionError> {
        let [a, b, r2] = rows(&self.matrix);
        // Gram-Schmidt from the last row up; that row has length one.
        let cy = b.dot(&r2);
        let b = b - r2 * cy;
        let fy = b.norm();
        let r1 = b / fy;
        // The first row of a rotation is the cross product of the others; K's signs are then right.
        let r0 = r1.cross(&r2);
        let camera =
            Camera::new(a.dot(&r0), fy, a.dot(&r2), cy).and_then(|camera| camera.with_skew(a.dot(&r1)));
        let camera = camera.map_err(ResectionError::Camera)?;
        let shift = Vector3::new(self.matrix.m14, self.matrix.m24, self.matrix.m34);
        let rotation = Matrix3::from_columns(&[r0, r1, r2]);
        let pose = Pose::new(rotation, -(rotation * (camera.inverse_matrix() * shift)));
        Ok((camera, pose.map_err(|_| ResectionError::Infinite)?))
    }

    /// M, with depth as its third number.
    pub fn matrix(&self) -> &Matrix3x4<T> {
        &self.matrix
    }

    /// The depth of a point before the camera, metres.
    pub fn depth(&self, world: &Point3<T>) -> T {
        (self.matrix * world.to_homogeneous()).z
    }

    /// Where a point of the world is seen, undistorted px; `None` when it is not in front of the camera.
    pub fn project(&self, world: &Point3<T>) -> Option<Point2<T>> {
        let h = self.matrix * world.to_homogeneous();
        let pixel = Point2::new(h.x / h.z, h.y / h.z);
        (h.z > T::ZERO && all_finite(pixel.coords.as_slice())).then_some(pixel)
    }
}

/// The first three columns of M, row by row.
fn rows<T: Real>(m: &Matrix3x4<T>) -> [Vector3<T>; 3] {
    [Vector3::new(m.m11, m.m12, m.m13), Vector3::new(m.m21, m.m22, m.m23), Vector3::new(m.m31, m.m32, m.m33)]
}

/// How many landmarks have different places in the world, counted up to six.
fn distinct<T: Real>(landmarks: &[Landmark<T>]) -> usize {
    let mut kept: [Option<Point3<T>>; 6] = [None; 6];
    for new in landmarks {
        if let Some(slot) = kept.iter_mut().find(|slot| slot.is_none_or(|old| old == new.world)) {
            *slot = Some(new.world);
        }
    }
    kept.iter().filter(|slot| slot.is_some()).count()
}

/// Points moved to their centroid and scaled to a root mean square distance of one from it.
struct Centred<T: Real> {
    centre: Vector3<T>,
    scale: T,
}

impl<T: Real> Centred<T> {
    /// `None` when all are one point.
    fn of(points: impl Iterator<Item = Vector3<T>> + Clone) -> Option<Self> {
        let (sum, count) = points.clone().fold((Vector3::zeros(), 0), |(sum, n), p| (sum + p, n + 1));
        let per_point = T::ONE / T::count(count);
        let centre: Vector3<T> = sum * per_point;
        let variance = points.fold(T::ZERO, |sum, p| sum + (p - centre).norm_squared()) * per_point;
        let rounding = centre.amax() * T::EPSILON;
        (variance > rounding * rounding).then(|| Self { centre, scale: T::ONE / variance.sqrt() })
    }

    fn apply(&self, point: &Vector3<T>) -> Vector3<T> {
        (point - self.centre) * self.scale
    }

    /// Whether the points are within a millionth of their spread of one plane (in `f32`, 32 roundings).
    fn is_flat(&self, points: impl Iterator<Item = Vector3<T>> + Clone) -> bool {
        let scatter = points.clone().fold(Matrix3::zeros(), |sum, p| {
            let p = self.apply(&p);
            sum + p * p.transpose()
        });
        let normal = Vector3::from(Ldl::<T, 3>::new(&mut scatter.into()).null_vector());
        let most = T::of(1e-6).max(T::EPSILON * T::of(32.0));
        let (off, count) = points.fold((T::ZERO, T::ZERO), |(off, count), p| {
            let distance = self.apply(&p).dot(&normal);
            (off + distance * distance, count + T::ONE)
        });
        off <= most * most * count
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_camera_two_metres_back() {
        let camera =
            Camera::new(500.0, 400.0, 320.0, 240.0_f64).and_then(|c| c.with_skew(2.0)).expect("a camera");
        // A quarter turn about Y, and two metres back: the camera's Z is the world's X.
        let rotation = Matrix3::new(0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0);
        let pose = Pose::new(rotation, Vector3::new(-2.0, 0.0, 0.0)).expect("a pose");
        let projection = Projection::new(&camera, &pose);
        // (2, 1, 0) is 4 m ahead, 1 m down: x = 0, y = 1/4.
        let point = Point3::new(2.0, 1.0, 0.0);
        assert_eq!(projection.depth(&point), 4.0);
        assert_eq!(projection.project(&point), Some(Point2::new(320.5, 340.0)));
        assert_eq!(projection.project(&Point3::new(-3.0, 0.0, 0.0)), None);
        let (inner, place) = projection.decompose().expect("a camera");
        assert!((inner.matrix() - camera.matrix()).amax() < 1e-12);
        assert!(
            (place.rotation() - rotation).amax() < 1e-15
                && (place.translation() - pose.translation()).amax() < 1e-12
        );
        // Neither scale nor sign matters.
        let again = Projection::from_matrix(&(projection.matrix() * -3.0)).expect("a camera");
        assert!((again.matrix() - projection.matrix()).amax() < 1e-12);
    }

    #[test]
    fn a_camera_at_infinity_is_refused() {
        let affine = Matrix3x4::new(1.0, 0.0, 0.0, 5.0, 0.0, 1.0, 0.0, 5.0, 0.0, 0.0, 0.0, 1.0_f64);
        assert_eq!(Projection::from_matrix(&affine), Err(ResectionError::Infinite));
        assert_eq!(Projection::from_matrix(&Matrix3x4::<f64>::zeros()), Err(ResectionError::Infinite));
    }
}
