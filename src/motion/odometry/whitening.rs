//! Whitening: residuals in units of their own uncertainty.

use crate::geometry::Real;
use nalgebra::{Matrix3, SMatrix, Vector3};

/// An observation of a point: x and y of its ray `(x, y, 1)`, and its disparity `x - x'` over the focal
/// length where the right camera sees it. A disparity is measured from the very place in the left picture,
/// and so has an error of its own.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct PointObservation<T: Real> {
    pub at: Vector3<T>,
    /// Whether the disparity counts.
    pub in_right: bool,
    /// The standard deviation of each number.
    pub sigma: T,
}

impl<T: Real> PointObservation<T> {
    /// All zeros.
    pub const ZERO: Self =
        Self { at: Vector3::new(T::ZERO, T::ZERO, T::ZERO), in_right: false, sigma: T::ZERO };

    /// How many numbers count.
    pub fn rows(&self) -> usize {
        if self.in_right { 3 } else { 2 }
    }
}

/// The factor L of `S = J C J^T + sigma^2 = L L^T`, of two rows or three.
pub(super) struct Whitener<T: Real> {
    l: Matrix3<T>,
    rows: usize,
}

impl<T: Real> Whitener<T> {
    /// The whitening of an observation whose Jacobian by a point of covariance C is J; `None` where S is not
    /// positive.
    pub fn of(
        slope: &Matrix3<T>,
        covariance: &Matrix3<T>,
        observation: &PointObservation<T>,
    ) -> Option<Self> {
        let noise = Matrix3::identity() * (observation.sigma * observation.sigma);
        let s = slope * covariance * slope.transpose() + noise;
        let o = T::ZERO;
        // Cholesky's factor by hand: nalgebra's leaves a panic.
        let a = s.m11.sqrt();
        let (b, c) = (s.m21 / a, s.m31 / a);
        let d = (s.m22 - b * b).sqrt();
        let e = (s.m32 - c * b) / d;
        let f = (s.m33 - c * c - e * e).sqrt();
        let l = Matrix3::new(a, o, o, b, d, o, c, e, f);
        // Not a number is not greater either.
        let good = a > o && d > o && (f > o || !observation.in_right);
        good.then_some(Self { l, rows: observation.rows() })
    }

    /// `L^-1 M`; a row that does not count is zero.
    pub fn apply<const C: usize>(&self, m: &SMatrix<T, 3, C>) -> SMatrix<T, 3, C> {
        let mut out = SMatrix::<T, 3, C>::zeros();
        // Columns as they are held: indices that are not known to be inside leave a panic.
        for (to, &[a, b, c]) in out.data.0.iter_mut().zip(&m.data.0) {
            let x = a / self.l.m11;
            let y = (b - self.l.m21 * x) / self.l.m22;
            let z = (c - self.l.m31 * x - self.l.m32 * y) / self.l.m33;
            *to = [x, y, if self.rows == 3 { z } else { T::ZERO }];
        }
        out
    }
}
