//! Minimal parameters of F and E: the orthonormal representation (Bartoli & Sturm 2004).

use crate::geometry::Real;
use crate::geometry::linear::{Svd3, cayley, columns3, product};
use nalgebra::{Matrix3, Vector3};

/// `F = U diag(c, s, 0) V^T` with rotations U and V and `c^2 + s^2 = 1`: three numbers rotate U, three V, one
/// moves (c, s) along the circle (Bartoli & Sturm 2004). Whatever the step, the matrix stays singular and of
/// size one, and with `c = s` it stays an essential one.
#[derive(Clone, Copy)]
pub(super) struct Factored<T: Real> {
    pub(super) u: Matrix3<T>,
    pub(super) v: Matrix3<T>,
    pub(super) c: T,
    pub(super) s: T,
}

/// How many numbers a fundamental matrix has.
pub(super) const FREE: usize = 7;

impl<T: Real> Factored<T> {
    /// The nearest singular matrix, at size one; `None` for a matrix of rank one, or with a number that is
    /// not finite.
    pub(super) fn new(matrix: &Matrix3<T>) -> Option<Self> {
        let size = matrix.norm();
        if !(size > T::ZERO && size.is_finite()) {
            return None;
        }
        let Svd3 { u, values: [c, s, _], v } = Svd3::new(&(matrix / size));
        let norm = (c * c + s * s).sqrt();
        (s > c * T::EPSILON * T::of(16.0)).then(|| Self { u, v, c: c / norm, s: s / norm })
    }

    /// The nearest essential matrix, over the root of two: both singular values are made alike.
    pub(super) fn essential(self) -> Self {
        let half = T::of(core::f64::consts::FRAC_1_SQRT_2);
        Self { c: half, s: half, ..self }
    }

    pub(super) fn matrix(&self) -> Matrix3<T> {
        let ([u0, u1, _], [v0, v1, _]) = (columns3(&self.u), columns3(&self.v));
        u0 * v0.transpose() * self.c + u1 * v1.transpose() * self.s
    }

    /// The derivatives of `a^T diag(c, s, 0) b` with `a = U^T p`, `b = V^T q` by the seven numbers.
    #[inline(always)]
    pub(super) fn derivatives(&self, a: &Vector3<T>, b: &Vector3<T>) -> [T; FREE] {
        let (c, s) = (self.c, self.s);
        [
            s * a.z * b.y,
            -c * a.z * b.x,
            c * a.y * b.x - s * a.x * b.y,
            s * a.y * b.z,
            -c * a.x * b.z,
            c * a.x * b.y - s * a.y * b.x,
            c * a.y * b.y - s * a.x * b.x,
        ]
    }

    /// The matrix after a step of the seven numbers.
    pub(super) fn moved(&self, step: &[T; FREE]) -> Self {
        let [u0, u1, u2, v0, v1, v2, along] = *step;
        // An angle that is `along` to first order, by the tangent of its half.
        let half = along * T::of(0.5);
        let by = T::ONE / (T::ONE + half * half);
        let (sine, cosine) = (along * by, (T::ONE - half * half) * by);
        Self {
            u: product(&self.u, &cayley(&Vector3::new(u0, u1, u2))),
            v: product(&self.v, &cayley(&Vector3::new(v0, v1, v2))),
            c: self.c * cosine - self.s * sine,
            s: self.s * cosine + self.c * sine,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> Factored<f64> {
        Factored::new(&Matrix3::new(1.0, 2.0, -1.0, 0.5, -1.0, 3.0, 2.0, 0.1, 0.7)).expect("rank 3")
    }

    #[test]
    fn derivatives_are_those_of_the_steps() {
        let f = example();
        let (p, q) = (Vector3::new(0.3, -1.2, 1.0), Vector3::new(-0.4, 0.8, 1.0));
        let derivatives = f.derivatives(&f.u.tr_mul(&p), &f.v.tr_mul(&q));
        for (k, derivative) in derivatives.iter().enumerate() {
            let at = |by: f64| {
                let mut step = [0.0; FREE];
                step[k] = by;
                p.dot(&(f.moved(&step).matrix() * q))
            };
            let difference = (at(1e-6) - at(-1e-6)) / 2e-6;
            assert!((difference - derivative).abs() < 1e-9, "{k}: {difference} {derivative}");
        }
    }

    #[test]
    fn a_step_keeps_it_singular_and_of_size_one() {
        let f = example().moved(&[0.3, -0.2, 0.1, 0.5, 0.1, -0.9, 0.4]);
        assert!(f.matrix().determinant().abs() < 1e-15 && (f.matrix().norm() - 1.0).abs() < 1e-15);
        let again = Factored::new(&f.matrix()).expect("rank 2").matrix();
        assert!((again - f.matrix()).amax() < 1e-15);
        let e = f.essential().moved(&[0.3, -0.2, 0.1, 0.5, 0.1, 0.0, 0.0]);
        assert_eq!(e.c, e.s);
    }

    #[test]
    fn a_matrix_of_rank_one_has_no_factors() {
        let diagonal = |c: f64, s: f64| Factored::new(&Matrix3::from_diagonal(&Vector3::new(c, s, 0.0)));
        let found = diagonal(3.0, -4.0).expect("of rank two");
        assert!((found.c - 0.8).abs() < 1e-15 && (found.s - 0.6).abs() < 1e-15);
        // Sixteen units in the last place are rounding.
        let shares = [0.0, 4.0, 15.0, 17.0, 64.0, 1e9];
        let are_factors = shares.map(|units| diagonal(5.0, 5.0 * units * f64::EPSILON).is_some());
        assert_eq!(are_factors, [false, false, false, true, true, true]);
        for number in [f64::NAN, f64::INFINITY, 1e200] {
            assert!(diagonal(number, 1.0).is_none(), "{number}");
        }
        assert!(diagonal(0.0, 0.0).is_none());
    }
}
