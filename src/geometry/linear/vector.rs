//! Vectors of any length, as slices, so that their code stands in a small program once.

use crate::geometry::Real;

/// `a^T b`.
#[inline]
pub(crate) fn dot<T: Real>(a: &[T], b: &[T]) -> T {
    a.iter().zip(b).fold(T::ZERO, |sum, (&a, &b)| sum + a * b)
}

/// `a = a s + b t`.
#[inline]
pub(crate) fn combine<T: Real>(a: &mut [T], s: T, b: &[T], t: T) {
    for (a, &b) in a.iter_mut().zip(b) {
        *a = *a * s + b * t;
    }
}

/// The larger of two numbers, without the call that `max` is on cores: the first where the second is not a
/// number.
#[inline(always)]
pub(crate) fn larger<T: Real>(a: T, b: T) -> T {
    if b > a { b } else { a }
}

/// Whether none is infinite or not a number.
#[inline]
pub(crate) fn all_finite<T: Real>(a: &[T]) -> bool {
    a.iter().all(|x| x.is_finite())
}

/// Brings `x` to length one.
pub(crate) fn unit<T: Real>(x: &mut [T]) {
    // By the largest element first: its square may be more than a number holds.
    let by = T::ONE / x.iter().fold(T::ZERO, |most, v| larger(most, v.abs()));
    x.iter_mut().for_each(|v| *v *= by);
    let by = T::ONE / dot(x, x).sqrt();
    x.iter_mut().for_each(|v| *v *= by);
}
