//! The thin lens equation in whole micrometres, for cores without a floating-point unit.

use super::LensError;

/// A thin lens whose lengths are whole micrometres, up to 4294 m.
///
/// ```
/// use stereopsis::focus::MicroLens;
/// let lens = MicroLens::new(4_000)?;
/// assert_eq!(lens.image_distance_um(1_000_000)?, 4_016); // 4016.06
/// assert_eq!(lens.object_distance_from_extension_um(16_064)?, 1_000_016);
/// # Ok::<(), stereopsis::focus::LensError>(())
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct MicroLens {
    focal_um: u32,
}

deserialize_checked! { MicroLens { focal_um: u32 } by |lens| Self::new(lens.focal_um) }

/// `a b / c` to the nearest whole number, halves up. `c` is not 0.
fn scaled(a: u64, b: u32, c: u64) -> Result<u32, LensError> {
    // At most 42 bits by 32.
    let quotient = (u128::from(a) * u128::from(b) + u128::from(c / 2)).checked_div(u128::from(c));
    quotient.and_then(|q| u32::try_from(q).ok()).ok_or(LensError::TooLarge)
}

impl MicroLens {
    /// A lens of that focal length.
    pub const fn new(focal_um: u32) -> Result<Self, LensError> {
        if focal_um == 0 { Err(LensError::FocalLength) } else { Ok(Self { focal_um }) }
    }

    /// The focal length.
    pub const fn focal_um(self) -> u32 {
        self.focal_um
    }

    /// How far behind the lens an object is sharp, to the nearest micrometre: `z = f Z / (Z - f)`.
    pub fn image_distance_um(self, object_um: u32) -> Result<u32, LensError> {
        self.conjugate(object_um).ok_or(LensError::ObjectWithinFocus)?
    }

    /// The distance of what is sharp on a sensor `image_um` behind the lens, to the nearest micrometre: `Z =
    /// f z / (z - f)`. A micrometre of `z` moves it by `((Z - f) / f)^2`: with a short lens
    /// [`Self::object_distance_from_extension_um`] is more precise.
    pub fn object_distance_um(self, image_um: u32) -> Result<u32, LensError> {
        self.conjugate(image_um).ok_or(LensError::ImageWithinFocus)?
    }

    /// The distance of what is sharp with the sensor `extension_nm` behind the focal plane, by Newton's form
    /// of the equation: `Z = f + f^2 / (z - f)`.
    pub fn object_distance_from_extension_um(self, extension_nm: u32) -> Result<u32, LensError> {
        if extension_nm == 0 {
            return Err(LensError::ImageWithinFocus);
        }
        let beyond = scaled(u64::from(self.focal_um) * 1000, self.focal_um, extension_nm.into())?;
        beyond.checked_add(self.focal_um).ok_or(LensError::TooLarge)
    }

    /// The deviation of the object's distance where the extension's is `sigma_nm`, to first order:
    /// `sigma_Z = f^2 / (z - f)^2 sigma_z`.
    pub fn object_sigma_um(self, extension_nm: u32, sigma_nm: u32) -> Result<u32, LensError> {
        if extension_nm == 0 {
            return Err(LensError::ImageWithinFocus);
        }
        let focal_nm = u128::from(self.focal_um) * 1000;
        let square = u128::from(extension_nm) * u128::from(extension_nm);
        // 84 bits and 32, to micrometres.
        let sigma = (focal_nm * focal_nm * u128::from(sigma_nm)).checked_div(square * 1000);
        sigma.and_then(|s| u32::try_from(s).ok()).ok_or(LensError::TooLarge)
    }

    /// The equation is its own inverse. `None` within the focal length.
    fn conjugate(self, distance_um: u32) -> Option<Result<u32, LensError>> {
        let beyond = distance_um.checked_sub(self.focal_um).filter(|&beyond| beyond > 0)?;
        Some(scaled(distance_um.into(), self.focal_um, beyond.into()))
    }
}
