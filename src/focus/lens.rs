//! The thin lens equation (Siegwart, Nourbakhsh & Scaramuzza 2011, 4.2.5).

use super::LensError;
use crate::geometry::Real;

/// A thin lens: `1/z + 1/Z = 1/f` for an object at distance `Z` before it and its image at `z` behind it
/// (Siegwart, Nourbakhsh & Scaramuzza 2011, 4.2.5). All lengths are in one unit, the caller's.
///
/// ```
/// use stereopsis::focus::ThinLens;
/// let lens = ThinLens::new(0.05_f64)?;
/// let z = lens.image_distance(1.05)?;
/// assert!((z - 0.0525).abs() < 1e-12);
/// assert!((lens.object_distance(z)? - 1.05).abs() < 1e-9);
/// assert!((lens.magnification(1.05)? - 0.05).abs() < 1e-12);
/// # Ok::<(), stereopsis::focus::LensError>(())
/// ```
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ThinLens<T: Real> {
    focal: T,
}

deserialize_checked! { ThinLens<T> { focal: T } by |lens| Self::new(lens.focal) }

/// Passes a finite number on.
pub(super) fn finite<T: Real>(value: T) -> Result<T, LensError> {
    if value.is_finite() { Ok(value) } else { Err(LensError::NotFinite) }
}

impl<T: Real> ThinLens<T> {
    /// A lens of that focal length.
    pub fn new(focal: T) -> Result<Self, LensError> {
        if finite(focal)? <= T::ZERO {
            return Err(LensError::FocalLength);
        }
        Ok(Self { focal })
    }

    /// The lens that images an object at `object` before it sharply at `image` behind it: `f = Z z / (Z +
    /// z)`.
    pub fn from_distances(object: T, image: T) -> Result<Self, LensError> {
        if finite(object)? <= T::ZERO {
            return Err(LensError::ObjectWithinFocus);
        }
        if finite(image)? <= T::ZERO {
            return Err(LensError::ImageWithinFocus);
        }
        Self::new(object / (object + image) * image)
    }

    /// The focal length.
    pub fn focal(&self) -> T {
        self.focal
    }

    /// How far behind the lens an object at distance `object` is sharp: `z = f Z / (Z - f)`.
    pub fn image_distance(&self, object: T) -> Result<T, LensError> {
        if finite(object)? <= self.focal {
            return Err(LensError::ObjectWithinFocus);
        }
        finite(object / (object - self.focal) * self.focal)
    }

    /// The distance of what is sharp on a sensor `image` behind the lens: `Z = f z / (z - f)`.
    pub fn object_distance(&self, image: T) -> Result<T, LensError> {
        if finite(image)? <= self.focal {
            return Err(LensError::ImageWithinFocus);
        }
        finite(image / (image - self.focal) * self.focal)
    }

    /// The deviation of [`Self::object_distance`] of an image distance that is uncertain by `sigma`, to first
    /// order: `sigma_Z = f^2 / (z - f)^2 sigma_z`. The second order is `sigma_z / (z - f)` of it, which
    /// is to be small.
    pub fn object_sigma(&self, image: T, sigma: T) -> Result<T, LensError> {
        if finite(sigma)? < T::ZERO {
            return Err(LensError::Sigma);
        }
        if finite(image)? <= self.focal {
            return Err(LensError::ImageWithinFocus);
        }
        let ratio = self.focal / (image - self.focal);
        finite(ratio * ratio * sigma)
    }

    /// How large the image of an object at distance `object` is, of the object: `z / Z = f / (Z - f)`.
    pub fn magnification(&self, object: T) -> Result<T, LensError> {
        if finite(object)? <= self.focal {
            return Err(LensError::ObjectWithinFocus);
        }
        finite(self.focal / (object - self.focal))
    }

    /// How much larger the picture is with the sensor at `image` than at `reference`: the chief ray through
    /// the lens's middle meets a plane `z` behind it at `x = z X / Z`, sharp or not. The change between
    /// frames of a focus stack is its breathing.
    pub fn breathing(&self, image: T, reference: T) -> Result<T, LensError> {
        if finite(image)? < self.focal || finite(reference)? < self.focal {
            return Err(LensError::ImageWithinFocus);
        }
        finite(image / reference)
    }

    /// The diameter on the sensor of the blur of a point at `object` while the lens is focused at `focused`,
    /// through an aperture of that diameter: `c = A |Z - Zf| / Z f / (Zf - f)`.
    pub fn circle_of_confusion(&self, aperture: T, focused: T, object: T) -> Result<T, LensError> {
        if finite(aperture)? <= T::ZERO {
            return Err(LensError::Aperture);
        }
        if finite(object)? <= self.focal {
            return Err(LensError::ObjectWithinFocus);
        }
        let magnification = self.magnification(focused)?;
        finite((object - focused).abs() / object * aperture * magnification)
    }
}
