//! The covariance of six numbers as the inverse of their information matrix.

use super::ldl::Ldl;
use crate::geometry::Real;
use nalgebra::{ArrayStorage, Matrix6};

/// The covariance of six numbers of this information, its inverse; a direction in which nothing is known is
/// as wide as [`Real::EPSILON`] of what is known along the axes makes it.
pub(crate) fn covariance6<T: Real>(information: &[[T; 6]; 6]) -> Matrix6<T> {
    Matrix6::from_array_storage(ArrayStorage(inverse_information(information)))
}

/// The inverse of the information matrix of N numbers, symmetric, as [`covariance6`].
pub(crate) fn inverse_information<T: Real, const N: usize>(information: &[[T; N]; N]) -> [[T; N]; N] {
    // At size one along every axis: rotations and steps have units of their own.
    let mut m = *information;
    let mut scale = [T::ONE; N];
    for (i, (scale, row)) in scale.iter_mut().zip(information).enumerate() {
        let d = row.get(i).copied().unwrap_or(T::ZERO);
        *scale = T::ONE / d.max(T::of(1e-12)).sqrt();
    }
    for (row, &a) in m.iter_mut().zip(&scale) {
        row.iter_mut().zip(&scale).for_each(|(x, &b)| *x *= a * b);
    }
    let ldl = Ldl::<T, N>::new(&mut m);
    let mut out = [[T::ZERO; N]; N];
    for (i, (column, &a)) in out.iter_mut().zip(&scale).enumerate() {
        let mut unit = [T::ZERO; N];
        if let Some(one) = unit.get_mut(i) {
            *one = T::ONE;
        }
        for ((to, x), &b) in column.iter_mut().zip(ldl.solve(&unit)).zip(&scale) {
            *to = x * a * b;
        }
    }
    let other = out;
    for (i, row) in out.iter_mut().enumerate() {
        for (x, column) in row.iter_mut().zip(&other) {
            *x = (*x + column.get(i).copied().unwrap_or(T::ZERO)) * T::of(0.5);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inverse_of_a_small_block() {
        let mut information = [[0.0_f64; 6]; 6];
        for (i, row) in information.iter_mut().enumerate() {
            row[i] = 1e6;
        }
        // [4 2; 2 3] has the inverse [3 -2; -2 4] / 8.
        (information[0][0], information[0][1], information[1][0], information[1][1]) = (4.0, 2.0, 2.0, 3.0);
        let c = covariance6(&information);
        for (value, expected) in [(c.m11, 0.375), (c.m12, -0.25), (c.m21, -0.25), (c.m22, 0.5), (c.m33, 1e-6)]
        {
            assert!((value - expected).abs() < 1e-15, "{value} {expected}");
        }
    }
}
