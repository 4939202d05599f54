//! The step of a bundle adjustment, with all unknowns in one matrix and derivatives by differences.

use nalgebra::{DMatrix, DVector, Point3, Vector3};
use stereopsis::motion::bundle::{Loss, Observation, View};

/// A problem, and which views are held.
pub struct Dense<'a, V> {
    /// The views.
    pub views: &'a [V],
    /// The points.
    pub points: &'a [Point3<f64>],
    /// The observations, in any order.
    pub observations: &'a [Observation<f64>],
    /// How much a residual counts.
    pub loss: Loss<f64>,
    /// The numbers that a view's step may have, as columns of N rows: none for a view that is held.
    pub free: Vec<DMatrix<f64>>,
}

impl<V> Dense<'_, V> {
    /// Residuals and their derivatives by all unknowns, weighted by the loss: the free numbers of the views,
    /// then three of each point.
    pub fn linear<const N: usize>(&self) -> (DVector<f64>, DMatrix<f64>)
    where
        V: View<f64, N>,
    {
        let columns: usize = self.free.iter().map(DMatrix::ncols).sum();
        let mut residuals = DVector::zeros(2 * self.observations.len());
        let mut slopes = DMatrix::zeros(residuals.len(), columns + 3 * self.points.len());
        for (n, observation) in self.observations.iter().enumerate() {
            let (view, point) =
                (&self.views[usize::from(observation.view)], &self.points[observation.point as usize]);
            let seen = |view: &V, point: &Point3<f64>| {
                view.project(observation.eye, point).expect("seen") - observation.pixel
            };
            let off = seen(view, point);
            let weight = self.loss.weight(off.norm_squared()).sqrt();
            residuals.rows_mut(2 * n, 2).copy_from(&(off * weight));
            let free = &self.free[usize::from(observation.view)];
            let before: usize = self.free[..usize::from(observation.view)].iter().map(DMatrix::ncols).sum();
            for (k, direction) in free.column_iter().enumerate() {
                let by = |h: f64| seen(&view.moved(&std::array::from_fn(|i| h * direction[i])), point);
                let h = 1e-5;
                slopes
                    .view_mut((2 * n, before + k), (2, 1))
                    .copy_from(&((by(h) - by(-h)) * (weight / (2.0 * h))));
            }
            for k in 0..3 {
                let mut shift = Vector3::zeros();
                shift[k] = 1e-6;
                let off = (seen(view, &(point + shift)) - seen(view, &(point - shift))) * (weight / 2e-6);
                slopes
                    .view_mut((2 * n, columns + 3 * observation.point as usize + k), (2, 1))
                    .copy_from(&off);
            }
        }
        (residuals, slopes)
    }

    /// The step of all unknowns with so much damping: `(J^T J + damping diag(J^T J)) x = -J^T r`.
    pub fn step<const N: usize>(&self, damping: f64) -> DVector<f64>
    where
        V: View<f64, N>,
    {
        let (residuals, slopes) = self.linear();
        let mut normal = slopes.tr_mul(&slopes);
        for k in 0..normal.nrows() {
            normal[(k, k)] *= 1.0 + damping;
        }
        let solution = normal.lu().solve(&-slopes.tr_mul(&residuals));
        solution.expect("damped equations have a solution")
    }

    /// The covariance of all unknowns, where every coordinate has the deviation of one: `(J^T J)^-1`.
    pub fn covariance<const N: usize>(&self) -> DMatrix<f64>
    where
        V: View<f64, N>,
    {
        let (_, slopes) = self.linear();
        slopes.tr_mul(&slopes).try_inverse().expect("determined")
    }
}
