//! The pinhole camera (Hartley & Zisserman 2004, 6.1) with a lens.

use super::lens::Lens;
use crate::geometry::Real;
use nalgebra::{Matrix3, Point2, Point3, Vector2, Vector3};

/// A pinhole camera: focal lengths, principal point and skew in px, and the lens before it.
///
/// A point `(X, Y, Z)` of the camera's frame (X right, Y down, Z forward) is seen at
/// `u = fx x + s y + cx`, `v = fy y + cy` with `(x, y) = (X / Z, Y / Z)` after the [`Lens`]; pixel centres
/// are at integers (Hartley & Zisserman 2004, 6.1). A camera with `fx = fy = 1` and all else zero has no
/// pixels: its coordinates are those of the plane Z = 1.
///
/// ```
/// use stereopsis::geometry::camera::Camera;
/// use nalgebra::{Point2, Point3};
/// let camera = Camera::new(500.0, 500.0, 320.0, 240.0)?;
/// assert_eq!(camera.project(&Point3::new(0.2, -0.1, 2.0))?, Point2::new(370.0, 215.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Camera<T: Real> {
    fx: T,
    fy: T,
    cx: T,
    cy: T,
    skew: T,
    lens: Lens<T>,
}

deserialize_checked! {
    Camera<T> { fx: T, fy: T, cx: T, cy: T, skew: T, lens: Lens<T> }
    by |c| Self::new(c.fx, c.fy, c.cx, c.cy)?.with_skew(c.skew)?.with_distortion(c.lens)
}

/// Why numbers are no camera.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum CameraModelError {
    /// A number is infinite or not a number.
    NotFinite,
    /// A focal length is not from 0.001 to 1 000 000 px.
    FocalLength,
    /// The principal point or the skew is over 1 000 000 px.
    OutOfRange,
}

error_text!(CameraModelError {
    Self::NotFinite => "a number of the camera is not finite",
    Self::FocalLength => "the focal lengths must be from 0.001 to 1000000 px",
    Self::OutOfRange => "the principal point and the skew must be within 1000000 px",
});

/// Why a point is not seen, or a pixel has no ray.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ProjectionError {
    /// The point is in the plane of the optical centre or behind it.
    Behind,
    /// Undistortion did not converge: the pixel is outside of what the lens model describes.
    NotConverged,
    /// A coordinate is infinite or not a number, or the place of the point or the ray would be.
    NotFinite,
}

error_text!(ProjectionError {
    Self::Behind => "the point is not in front of the camera",
    Self::NotConverged => "the lens model has no undistorted place for this pixel",
    Self::NotFinite => "a coordinate is not finite, or its place would not be",
});

impl<T: Real> Camera<T> {
    /// What fills a slot that is not in use: zeros, which are no camera.
    pub(crate) const EMPTY: Self =
        Self { fx: T::ZERO, fy: T::ZERO, cx: T::ZERO, cy: T::ZERO, skew: T::ZERO, lens: Lens::NONE };

    /// A camera without skew and distortion: focal lengths and principal point, px.
    pub fn new(fx: T, fy: T, cx: T, cy: T) -> Result<Self, CameraModelError> {
        if ![fx, fy, cx, cy].iter().all(|x| x.is_finite()) {
            return Err(CameraModelError::NotFinite);
        }
        let (least, most) = (T::of(1e-3), T::of(1e6));
        if [fx, fy].iter().any(|&f| f < least || f > most) {
            return Err(CameraModelError::FocalLength);
        }
        if [cx, cy].iter().any(|c| c.abs() > most) {
            return Err(CameraModelError::OutOfRange);
        }
        Ok(Self { fx, fy, cx, cy, skew: T::ZERO, lens: Lens::NONE })
    }

    /// The camera whose matrix is K, upper triangular, of any scale but zero.
    pub fn from_matrix(k: &Matrix3<T>) -> Result<Self, CameraModelError> {
        let by = T::ONE / k.m33;
        Self::new(k.m11 * by, k.m22 * by, k.m13 * by, k.m23 * by)?.with_skew(k.m12 * by)
    }

    /// The camera with pixels that are no rectangles: `skew` px of u for every unit of y.
    pub fn with_skew(self, skew: T) -> Result<Self, CameraModelError> {
        if !skew.is_finite() {
            return Err(CameraModelError::NotFinite);
        }
        if skew.abs() > T::of(1e6) {
            return Err(CameraModelError::OutOfRange);
        }
        Ok(Self { skew, ..self })
    }

    /// The camera behind another lens.
    pub fn with_distortion(self, lens: impl Into<Lens<T>>) -> Result<Self, CameraModelError> {
        let lens = lens.into();
        if !lens.is_finite() {
            return Err(CameraModelError::NotFinite);
        }
        Ok(Self { lens, ..self })
    }

    /// Focal lengths along u and v, px.
    pub fn focal_px(&self) -> (T, T) {
        (self.fx, self.fy)
    }

    /// Principal point (column, row), px.
    pub fn principal_point(&self) -> (T, T) {
        (self.cx, self.cy)
    }

    /// Skew, px.
    pub fn skew_px(&self) -> T {
        self.skew
    }

    /// The lens.
    pub fn lens(&self) -> &Lens<T> {
        &self.lens
    }

    /// `K = [fx s cx; 0 fy cy; 0 0 1]`, px; the lens is not in it.
    pub fn matrix(&self) -> Matrix3<T> {
        let (o, l) = (T::ZERO, T::ONE);
        Matrix3::new(self.fx, self.skew, self.cx, o, self.fy, self.cy, o, o, l)
    }

    /// `K^-1`, in closed form.
    pub fn inverse_matrix(&self) -> Matrix3<T> {
        let (o, l) = (T::ZERO, T::ONE);
        let (gx, gy) = (l / self.fx, l / self.fy);
        let skew = -self.skew * gx * gy;
        Matrix3::new(gx, skew, -self.cx * gx - self.cy * skew, o, gy, -self.cy * gy, o, o, l)
    }

    /// Where a point of the camera's frame is seen, px. The unit of length does not matter.
    pub fn project(&self, point: &Point3<T>) -> Result<Point2<T>, ProjectionError> {
        if !(point.z > T::ZERO) {
            return Err(ProjectionError::Behind);
        }
        let by = T::ONE / point.z;
        self.pixel_of(&self.lens.distort(&Vector2::new(point.x * by, point.y * by)))
    }

    /// The ray of a pixel: the direction `(x, y, 1)` in the camera's frame of all that is seen there.
    ///
    /// Exact without distortion; with it, to 5e-11 px in `f64` and ten roundings of `f (1 + |x|)` in `f32`,
    /// for fx near fy.
    #[inline(never)]
    pub fn unproject(&self, pixel: &Point2<T>) -> Result<Vector3<T>, ProjectionError> {
        let y = (pixel.y - self.cy) / self.fy;
        let x = (pixel.x - self.cx - self.skew * y) / self.fx;
        if !(x.is_finite() && y.is_finite()) {
            return Err(ProjectionError::NotFinite);
        }
        if self.lens.is_none() {
            return Ok(Vector3::new(x, y, T::ONE));
        }
        let rounding = T::EPSILON * T::of(10.0) * (T::ONE + x.abs().max(y.abs()));
        let tolerance = rounding.max(T::EPSILON.sqrt() * T::of(3e-3) / self.fx.max(self.fy));
        let plane = self.lens.undistort(&Vector2::new(x, y), tolerance);
        plane.map(|p| Vector3::new(p.x, p.y, T::ONE)).ok_or(ProjectionError::NotConverged)
    }

    /// Where the pixel would be without the lens's distortion, px.
    pub fn undistort(&self, pixel: &Point2<T>) -> Result<Point2<T>, ProjectionError> {
        let ray = self.unproject(pixel)?;
        self.pixel_of(&ray.xy())
    }

    /// From the plane Z = 1, after the lens, to pixels.
    fn pixel_of(&self, plane: &Vector2<T>) -> Result<Point2<T>, ProjectionError> {
        let u = self.fx * plane.x + self.skew * plane.y + self.cx;
        let v = self.fy * plane.y + self.cy;
        if u.is_finite() && v.is_finite() { Ok(Point2::new(u, v)) } else { Err(ProjectionError::NotFinite) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inverse_is_the_inverse() {
        let camera =
            Camera::new(500.0, 400.0, 320.0, 240.0).and_then(|c| c.with_skew(2.0)).expect("a camera");
        assert_eq!(camera.inverse_matrix() * camera.matrix(), Matrix3::identity());
    }

    #[test]
    fn skew_moves_columns_only() {
        let camera =
            Camera::new(500.0, 400.0, 320.0, 240.0).and_then(|c| c.with_skew(2.0)).expect("a camera");
        // (x, y) = (1/2, 1/4): u = 250 + 0.5 + 320, v = 100 + 240.
        let pixel = camera.project(&Point3::new(1.0, 0.5, 2.0)).expect("in front");
        assert_eq!(pixel, Point2::new(570.5, 340.0_f64));
        assert_eq!(camera.unproject(&pixel), Ok(Vector3::new(0.5, 0.25, 1.0)));
    }

    #[test]
    fn what_is_no_camera_is_refused() {
        assert_eq!(Camera::new(f32::NAN, 1.0, 0.0, 0.0), Err(CameraModelError::NotFinite));
        assert_eq!(Camera::new(500.0, 0.0, 0.0, 0.0_f32), Err(CameraModelError::FocalLength));
        assert_eq!(Camera::new(500.0, 500.0, 2e6, 0.0_f32), Err(CameraModelError::OutOfRange));
        let camera = Camera::new(500.0, 500.0, 320.0, 240.0_f32).expect("a camera");
        assert_eq!(camera.project(&Point3::new(0.0, 0.0, 0.0)), Err(ProjectionError::Behind));
        assert_eq!(camera.with_skew(f32::INFINITY), Err(CameraModelError::NotFinite));
    }
}
