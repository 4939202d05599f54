//! Real functions that `core` lacks: the one file that names `libm`.

/// Rounds to the nearest integer, halves away from zero.
#[inline]
pub(crate) fn round(x: f32) -> f32 {
    libm::roundf(x)
}

/// The angle in radians whose tangent is `x`.
#[inline]
pub(crate) fn atan(x: f32) -> f32 {
    libm::atanf(x)
}

/// The angle in radians whose tangent is `x`.
#[inline]
pub(crate) fn atan_f64(x: f64) -> f64 {
    libm::atan(x)
}
