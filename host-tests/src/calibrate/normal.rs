//! Normal equations of cameras that see one board in many views, solved by the views' Schur complement.

use nalgebra::{DMatrix, DVector, Matrix6, Vector6};

/// Parameters of a pose: a small turn and a way.
pub(super) const OUTER: usize = 6;

/// J^T J and J^T r: a view has to do with the cameras and not with another view.
pub(super) struct Normal {
    /// Of the cameras and the pose between them.
    pub shared: DMatrix<f64>,
    pub of_shared: DVector<f64>,
    /// Of each view, and between it and the cameras.
    pub own: Vec<Matrix6<f64>>,
    pub of_own: Vec<Vector6<f64>>,
    pub between: Vec<DMatrix<f64>>,
    pub cost: f64,
}

impl Normal {
    pub fn new(shared: usize, views: usize) -> Self {
        Self {
            shared: DMatrix::zeros(shared, shared),
            of_shared: DVector::zeros(shared),
            own: vec![Matrix6::zeros(); views],
            of_own: vec![Vector6::zeros(); views],
            between: vec![DMatrix::zeros(OUTER, shared); views],
            cost: 0.0,
        }
    }

    /// The equations of the shared parameters alone, by the Schur complement of the views, whose diagonals
    /// are raised by a share; and each view's factors.
    pub fn reduced(&self, damping: f64) -> Option<(DMatrix<f64>, DVector<f64>, Vec<Factors>)> {
        let (mut shared, mut vector) = (self.shared.clone(), self.of_shared.clone());
        (0..shared.nrows()).for_each(|i| shared[(i, i)] *= 1.0 + damping);
        let mut all = Vec::with_capacity(self.own.len());
        for ((own, of_own), between) in self.own.iter().zip(&self.of_own).zip(&self.between) {
            let mut own = *own;
            (0..OUTER).for_each(|i| own[(i, i)] *= 1.0 + damping);
            let factors = own.cholesky()?;
            let across = between.transpose();
            shared -= &across * factors.solve(between);
            vector -= &across * factors.solve(of_own);
            all.push(factors);
        }
        Some((shared, vector, all))
    }

    /// The step of all parameters, the shared ones first.
    pub fn step(&self, damping: f64) -> Option<DVector<f64>> {
        let (shared, vector, all) = self.reduced(damping)?;
        let first = shared.cholesky()?.solve(&vector);
        let mut step: Vec<f64> = first.iter().copied().collect();
        for ((factors, of_own), between) in all.iter().zip(&self.of_own).zip(&self.between) {
            step.extend(factors.solve(&(of_own - between * &first)).iter());
        }
        Some(DVector::from_vec(step))
    }
}

/// Of a view's matrix.
type Factors = nalgebra::Cholesky<f64, nalgebra::U6>;
