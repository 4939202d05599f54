//! Distances of a correspondence from a fundamental matrix: Sampson's, symmetric, algebraic.

use super::correspondence::Correspondence;
use super::fundamental::Fundamental;
use crate::geometry::Real;
use nalgebra::Vector3;

/// `p^T F p'` and the lines it is made of.
struct Parts<T: Real> {
    residual: T,
    /// `l = F p'`.
    first: Vector3<T>,
    /// `l' = F^T p`.
    second: Vector3<T>,
}

impl<T: Real> Fundamental<T> {
    #[inline(always)]
    fn parts(&self, seen: &Correspondence<T>) -> Parts<T> {
        let p = Vector3::new(seen.first.x, seen.first.y, T::ONE);
        let first = self.matrix() * Vector3::new(seen.second.x, seen.second.y, T::ONE);
        Parts { residual: p.dot(&first), first, second: self.matrix().tr_mul(&p) }
    }

    /// The algebraic residual `p^T F p'`, with |F| = 1: zero when the correspondence is possible. It has no
    /// unit that means anything; the distances below have.
    pub fn residual(&self, seen: &Correspondence<T>) -> T {
        self.parts(seen).residual
    }

    /// Sampson's distance squared, px^2: `(p^T F p')^2 / (l_1^2 + l_2^2 + l'_1^2 + l'_2^2)`, to first order
    /// the squared distance in (u, v, u', v') to the nearest possible correspondence (Hartley & Zisserman
    /// 2004, 11.9).
    ///
    /// Zero when both points are epipoles.
    #[inline]
    pub fn sampson_squared_px2(&self, seen: &Correspondence<T>) -> T {
        let Parts { residual, first, second } = self.parts(seen);
        let gradient = first.x * first.x + first.y * first.y + second.x * second.x + second.y * second.y;
        if gradient > T::ZERO { residual * residual / gradient } else { T::ZERO }
    }

    /// Sampson's distance, px: the root of the above with the residual's sign.
    pub fn sampson_px(&self, seen: &Correspondence<T>) -> T {
        let Parts { residual, first, second } = self.parts(seen);
        let gradient = (first.xy().norm_squared() + second.xy().norm_squared()).sqrt();
        if gradient > T::ZERO { residual / gradient } else { T::ZERO }
    }

    /// The distances of p and p' to their epipolar lines in the first and the second image, px, not negative.
    /// Zero for an epipole, through which all epipolar lines pass.
    pub fn line_distances_px(&self, seen: &Correspondence<T>) -> (T, T) {
        let Parts { residual, first, second } = self.parts(seen);
        let distance = |line: Vector3<T>| {
            let gradient = line.xy().norm();
            if gradient > T::ZERO { residual.abs() / gradient } else { T::ZERO }
        };
        (distance(first), distance(second))
    }

    /// The symmetric epipolar distance squared, px^2: the sum of both squared distances to the lines (Hartley
    /// & Zisserman 2004, 11.10).
    pub fn symmetric_squared_px2(&self, seen: &Correspondence<T>) -> T {
        let (first, second) = self.line_distances_px(seen);
        first * first + second * second
    }

    /// The mean of the distances to the lines in both images, px.
    pub fn symmetric_px(&self, seen: &Correspondence<T>) -> T {
        let (first, second) = self.line_distances_px(seen);
        (first + second) * T::of(0.5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;

    #[test]
    fn rows_that_are_two_off() {
        // A rectified pair: the distance to either line is 2; the nearest possible pair moves both points by
        // 1.
        let f = Fundamental::from_matrix(&Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0_f64))
            .expect("a fundamental matrix");
        let seen = Correspondence::new(100.0, 50.0, 90.0, 52.0);
        let close = |a: f64, b: f64| (a - b).abs() < 1e-12;
        let (first, second) = f.line_distances_px(&seen);
        assert!(close(first, 2.0) && close(second, 2.0), "{first} {second}");
        assert!(close(f.symmetric_px(&seen), 2.0) && close(f.symmetric_squared_px2(&seen), 8.0));
        assert!(close(f.sampson_squared_px2(&seen), 2.0) && close(f.sampson_px(&seen).abs(), 2.0_f64.sqrt()));
        assert!(close(f.residual(&seen).abs(), 2.0_f64.sqrt()));
    }
}
