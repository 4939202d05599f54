//! Errors of the thin lens equations.

/// Why the thin lens's equations have no answer.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum LensError {
    /// A number is infinite or not a number.
    NotFinite,
    /// The focal length is not positive.
    FocalLength,
    /// The object is in the focal plane or nearer: no image of it is behind the lens.
    ObjectWithinFocus,
    /// The sensor is in the focal plane or nearer: nothing at a finite distance is sharp on it.
    ImageWithinFocus,
    /// The aperture's diameter or the f-number is not positive.
    Aperture,
    /// The circle of confusion that still counts as sharp is not positive.
    Blur,
    /// A deviation is negative.
    Sigma,
    /// The result does not fit the integer.
    TooLarge,
}

error_text!(LensError {
    Self::NotFinite => "a number is not finite",
    Self::FocalLength => "the focal length must be positive",
    Self::ObjectWithinFocus => "the object must be farther than the focal length",
    Self::ImageWithinFocus => "the sensor must be farther behind the lens than the focal length",
    Self::Aperture => "the aperture must be positive",
    Self::Blur => "the circle of confusion must be positive",
    Self::Sigma => "a deviation must not be negative",
    Self::TooLarge => "the result does not fit its integer",
});
