//! Distance and bearing of an object of known size (Siegwart, Nourbakhsh & Scaramuzza 2011, 4.2.5).

use crate::geometry::Real;
use crate::geometry::camera::{Camera, ProjectionError};
use crate::geometry::linear::all_finite;
use nalgebra::{Point2, Point3, Unit, Vector3};

/// Where an object of known size is, from one camera.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Sighting<T: Real> {
    /// From the optical centre to the object's middle, m.
    pub distance_m: T,
    /// The standard deviation of the distance that the pixels' noise makes, m; what the object's size is off
    /// adds its own share, in proportion.
    pub sigma_m: T,
    /// The direction of the object's middle, in the camera's frame (X right, Y down, Z forward).
    pub bearing: Unit<Vector3<T>>,
    /// The angle under which the object is seen, radians.
    pub angle_rad: T,
}

deserialize_checked! {
    Sighting<T> { distance_m: T, sigma_m: T, bearing: Vector3<T>, angle_rad: T }
    by |stored| {
        let Sighting { distance_m, sigma_m, angle_rad, .. } = stored;
        let is_seen = distance_m > T::ZERO && sigma_m >= T::ZERO && angle_rad > T::ZERO;
        if !(is_seen && all_finite(&[distance_m, sigma_m, angle_rad])) {
            return Err("distance and angle must be positive, the deviation not negative, and all finite");
        }
        match Unit::try_new(stored.bearing, T::ZERO) {
            Some(bearing) if bearing.iter().all(|x| x.is_finite()) => {
                Ok(Self { distance_m, sigma_m, bearing, angle_rad })
            }
            _ => Err("the bearing must be finite and not zero"),
        }
    }
}

/// Why there is no distance.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SightingError {
    /// A number is infinite or not a number, or one of the sighting would be.
    NotFinite,
    /// The size of the object is not positive, or the deviation of a pixel is negative.
    Size,
    /// The two pixels are no more than a deviation apart, or ten roundings: the distance is anything.
    TooSmall,
    /// A pixel has no ray.
    Pixel(ProjectionError),
}

error_text!(SightingError {
    Self::NotFinite => "a number is not finite",
    Self::Size => "the object's size must be positive, the pixels' deviation not negative",
    Self::TooSmall => "the object's ends are seen at one place, as far as the noise tells",
    Self::Pixel(error) => "{error}",
});

impl<T: Real> Sighting<T> {
    /// An object of known length across the line of sight, a pole or the height of a door, whose two ends are
    /// seen.
    ///
    /// With the angle `a` between the two rays, `d = L / (2 tan(a / 2))`; in the middle of the image and
    /// far away that is the thin law `Z = f L / l` for `l` px (Siegwart, Nourbakhsh & Scaramuzza 2011,
    /// 4.2.5). An object that leans along the ray by an angle looks shorter by its cosine, and farther.
    ///
    /// `ends` are px as the camera gives them, each with the standard deviation `sigma_px` along the object.
    ///
    /// ```
    /// use nalgebra::Point2;
    /// use stereopsis::geometry::{camera::Camera, known_shape::Sighting};
    /// let camera = Camera::new(500.0, 500.0, 320.0, 240.0)?;
    /// // A man of 1.8 m, 90 px tall.
    /// let ends = [Point2::new(320.0, 195.0), Point2::new(320.0, 285.0)];
    /// let seen = Sighting::of_length(&camera, &ends, 1.8, 0.5)?;
    /// assert!((seen.distance_m - 10.0_f32).abs() < 1e-4);
    /// assert!(seen.sigma_m < 0.08);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of_length(
        camera: &Camera<T>,
        ends: &[Point2<T>; 2],
        length_m: T,
        sigma_px: T,
    ) -> Result<Self, SightingError> {
        let angle = Angle::between(camera, ends, length_m, sigma_px)?;
        let distance_m = length_m * T::of(0.5) / angle.half_tangent;
        // dd/da = -d / sin a
        angle.sighting(distance_m, distance_m / angle.radians.sin())
    }

    /// A ball of known diameter, of which two opposite points of the outline are seen: `d = D / (2 sin(a /
    /// 2))`, for the rays touch it. The bearing is that of the middle between the two rays, which is
    /// the ball's centre.
    pub fn of_ball(
        camera: &Camera<T>,
        rim: &[Point2<T>; 2],
        diameter_m: T,
        sigma_px: T,
    ) -> Result<Self, SightingError> {
        let angle = Angle::between(camera, rim, diameter_m, sigma_px)?;
        let tangent = angle.half_tangent;
        let distance_m = diameter_m * T::of(0.5) * (T::ONE + tangent * tangent).sqrt() / tangent;
        // dd/da = -d / (2 tan(a / 2))
        angle.sighting(distance_m, distance_m / (tangent + tangent))
    }

    /// The object's middle in the camera's frame, m.
    pub fn point(&self) -> Point3<T> {
        Point3::from(self.bearing.scale(self.distance_m))
    }

    /// The bearing to the right of the optical axis, radians, -pi to pi.
    pub fn azimuth_rad(&self) -> T {
        self.bearing.x.atan2(self.bearing.z)
    }

    /// The bearing above the plane of the optical axis and the camera's X, radians, -pi / 2 to pi / 2.
    pub fn elevation_rad(&self) -> T {
        let across = (self.bearing.x * self.bearing.x + self.bearing.z * self.bearing.z).sqrt();
        (-self.bearing.y).atan2(across)
    }
}

/// The angle between two rays, with its deviation.
struct Angle<T: Real> {
    radians: T,
    half_tangent: T,
    sigma_rad: T,
    middle: Unit<Vector3<T>>,
}

impl<T: Real> Angle<T> {
    fn between(
        camera: &Camera<T>,
        ends: &[Point2<T>; 2],
        size_m: T,
        sigma_px: T,
    ) -> Result<Self, SightingError> {
        let [a, b] = ends;
        if ![a.x, a.y, b.x, b.y, size_m, sigma_px].iter().all(|x| x.is_finite()) {
            return Err(SightingError::NotFinite);
        }
        if !(size_m > T::ZERO && sigma_px >= T::ZERO) {
            return Err(SightingError::Size);
        }
        let along = b - a;
        let apart = along.norm();
        let rounding = T::EPSILON * T::of(10.0) * (T::ONE + a.coords.amax().max(b.coords.amax()));
        if !(apart > sigma_px.max(rounding)) {
            return Err(SightingError::TooSmall);
        }
        let ray = |pixel: &Point2<T>| -> Result<Vector3<T>, SightingError> {
            let ray = camera.unproject(pixel).map_err(SightingError::Pixel)?;
            Ok(ray / ray.norm())
        };
        let (first, second) = (ray(a)?, ray(b)?);
        let (sum, difference) = (first + second, first - second);
        // The half angle's tangent, exact for small angles too.
        let half_tangent = difference.norm() / sum.norm();
        let two = T::of(2.0);
        // By what angle a ray moves when its pixel moves along the object: over a pixel, or as far as the
        // object is long.
        let step = along * (T::ONE.min(apart) / (apart * two));
        let angle = |pixel: &Point2<T>| -> Result<T, SightingError> {
            let around = ray(&(pixel + step))? - ray(&(pixel - step))?;
            Ok(around.norm() / (step.norm() * two))
        };
        let (at_first, at_second) = (angle(a)?, angle(b)?);
        Ok(Self {
            radians: two * half_tangent.atan(),
            half_tangent,
            sigma_rad: sigma_px * (at_first * at_first + at_second * at_second).sqrt(),
            middle: Unit::new_unchecked(sum / sum.norm()),
        })
    }

    fn sighting(&self, distance_m: T, distance_per_rad: T) -> Result<Sighting<T>, SightingError> {
        let (sigma_m, bearing, angle_rad) = (self.sigma_rad * distance_per_rad, self.middle, self.radians);
        let is_unit = (bearing.norm() - T::ONE).abs() < T::of(1e-4);
        if !(is_unit && distance_m > T::ZERO && all_finite(&[distance_m, sigma_m, angle_rad])) {
            return Err(SightingError::NotFinite);
        }
        Ok(Sighting { distance_m, sigma_m, bearing, angle_rad })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Camera<f64> {
        Camera::new(500.0, 500.0, 320.0, 240.0).expect("a camera")
    }

    #[test]
    fn a_pole_in_the_middle() {
        // 2 m at 10 m: 1 m is 50 px on either side.
        let seen =
            Sighting::of_length(&camera(), &[Point2::new(270.0, 240.0), Point2::new(370.0, 240.0)], 2.0, 0.5);
        let seen = seen.expect("a distance");
        assert!((seen.distance_m - 10.0).abs() < 1e-12);
        assert!((seen.angle_rad - 2.0 * 0.1_f64.atan()).abs() < 1e-15);
        // l = 100 px, with sqrt(2) / 2 px: 0.0707 m; a little less, for rays at the side turn less.
        assert!((seen.sigma_m - 10.0 * 0.5_f64.sqrt() / 100.0).abs() < 1e-6, "{}", seen.sigma_m);
        assert!((seen.point() - Point3::new(0.0, 0.0, 10.0)).norm() < 1e-12);
    }

    #[test]
    fn a_ball_at_the_side() {
        // Centre (3, -4, 12), 13 m away, radius 1.3: the tangent rays are asin(0.1) off the bearing.
        let centre = Vector3::new(3.0, -4.0, 12.0);
        let up = centre.cross(&Vector3::x()).normalize();
        let turned = |sine: f64| centre / 13.0 * (1.0 - sine * sine).sqrt() + up * sine;
        let rim = [0.1, -0.1].map(|sine| camera().project(&Point3::from(turned(sine))).expect("in front"));
        let seen = Sighting::of_ball(&camera(), &rim, 2.6, 0.5).expect("a distance");
        assert!((seen.distance_m - 13.0).abs() < 1e-11);
        assert!((seen.point().coords - centre).norm() < 1e-11);
        assert!((seen.azimuth_rad() - 0.25_f64.atan()).abs() < 1e-12);
        assert!((seen.elevation_rad() - (4.0 / 153.0_f64.sqrt()).atan()).abs() < 1e-12);
    }

    #[test]
    fn what_has_no_distance_is_refused() {
        let [a, b] = [Point2::new(320.0, 240.0), Point2::new(330.0, 240.0)];
        let of = |ends: [Point2<f64>; 2], length, sigma| Sighting::of_length(&camera(), &ends, length, sigma);
        assert_eq!(of([a, Point2::new(f64::NAN, 0.0)], 1.0, 0.5), Err(SightingError::NotFinite));
        assert_eq!(of([a, b], 0.0, 0.5), Err(SightingError::Size));
        assert_eq!(of([a, a], 1.0, 0.0), Err(SightingError::TooSmall));
        assert_eq!(of([a, b], 1.0, 10.0), Err(SightingError::TooSmall));
    }
}
