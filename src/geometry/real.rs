//! The number type of geometry: `f32` or `f64`.

use crate::math::{atan, atan_f64};
use nalgebra::RealField;

/// `f32` or `f64`: what every type of [`geometry`](crate::geometry) is generic over, but for
/// [`RectifiedRig`](crate::geometry::camera::RectifiedRig), which is `f32`.
///
/// `f32` is what the cores have hardware for; each function whose result needs more says so with a figure.
/// Roots and angles come from nalgebra's [`RealField`]. Sealed: no other type implements it.
pub trait Real: RealField + Copy + sealed::Sealed {
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// The step from one to the next larger number: 2^-23 or 2^-52.
    const EPSILON: Self;

    /// The number nearest to `value`.
    fn of(value: f64) -> Self;

    /// How many, as a number; exact to 2^24 in `f32`.
    fn count(n: usize) -> Self;

    /// This number as `f64`.
    fn to_f64(self) -> f64;

    /// The angle in radians whose tangent it is: the same bits on every machine, which an operating system's
    /// is not.
    fn arc_tangent(self) -> Self;
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

macro_rules! real {
    ($float:ident, $arc_tangent:ident) => {
        impl Real for $float {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const EPSILON: Self = Self::EPSILON;

            #[inline(always)]
            fn of(value: f64) -> Self {
                value as Self
            }

            #[inline(always)]
            fn count(n: usize) -> Self {
                n as Self
            }

            #[inline(always)]
            fn to_f64(self) -> f64 {
                self.into()
            }

            #[inline(always)]
            fn arc_tangent(self) -> Self {
                $arc_tangent(self)
            }
        }
    };
}

real!(f32, atan);
real!(f64, atan_f64);
