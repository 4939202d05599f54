//! How far off a calibration may be, by the residuals of its views.
//!
//! Residuals of one view go together: its board is not flat, it moved, or the lens is not quite of the model.
//! Then many corners say less than as many independent ones, and the usual covariance, the inverse of the
//! normal equations times the variance of a residual, is several times too small. What is independent are the
//! views: the sum over these of what each one alone moves the result by, squared, holds for any residuals
//! within a view (the "sandwich", Liang & Zeger 1986, with views as clusters). A view draws the result
//! towards itself, so that its residuals are too small; they are scaled as it would need were all corners
//! independent (CR2, Bell & McCaffrey 2002). Of half a dozen views, deviations without that correction (CR1)
//! are up to a quarter too small, and those of the jackknife by views (CR3) up to twice too large.

use super::bundle::Bundle;
use nalgebra::{DMatrix, SymmetricEigen};

/// The share of the information that is left without a view is taken to be this at the least: what is known
/// from one view only leaves no residual to judge it by.
const LEAST_SHARE: f64 = 1e-6;

/// Two estimates of the covariance of the cameras' parameters and of the pose between them, with views as
/// clusters and of independent corners: in px, radians and the board's unit of length.
pub(super) struct Deviations([DMatrix<f64>; 2]);

impl Deviations {
    /// The covariances at a minimum of the bundle; `None` where the views do not determine all parameters.
    pub fn of(bundle: &Bundle<'_>) -> Option<Self> {
        let normal = bundle.normal()?;
        let (shared, ..) = normal.reduced(0.0)?;
        let cholesky = shared.cholesky()?;
        // The Schur complement's inverse is that part of the whole inverse.
        let independent = cholesky.inverse() * (normal.cost / freedom(bundle)?.max(1) as f64);
        let root = cholesky.unpack();
        let mut clustered = DMatrix::zeros(root.nrows(), root.nrows());
        for view in 0..bundle.views.len() {
            // All scores are zero together: that of the other views is the view's own with another sign.
            let (others, score, _) = without(bundle, view).normal()?.reduced(0.0)?;
            // In units in which the information of all views is one, that of the others is `1 - H`, where H
            // is the view's leverage.
            let half = root.solve_lower_triangular(&others)?.transpose();
            let left = SymmetricEigen::try_new(root.solve_lower_triangular(&half)?, f64::EPSILON, 1000)?;
            let score = left.eigenvectors.tr_mul(&root.solve_lower_triangular(&score)?);
            let scaled =
                score.zip_map(&left.eigenvalues, |score, share| score / share.max(LEAST_SHARE).sqrt());
            let step = root.tr_solve_lower_triangular(&(left.eigenvectors * scaled))?;
            clustered += &step * step.transpose();
        }
        Some(Self([clustered, independent]))
    }

    /// The standard deviation of a sum of parameters, each times its slope, in the sum's unit. It is the
    /// larger one of both estimates: of three or four views the clustered one has two or three degrees of
    /// freedom and is often small by chance, and residuals of one view hardly ever cancel each other, so that
    /// independent ones are the best case.
    pub fn sigma(&self, slopes: &[(usize, f64)]) -> f64 {
        let variance = |covariance: &DMatrix<f64>| -> f64 {
            let of =
                |&(i, a): &(usize, f64)| slopes.iter().map(|&(j, b)| a * b * covariance[(i, j)]).sum::<f64>();
            slopes.iter().map(of).sum()
        };
        self.0.iter().map(variance).fold(f64::NAN, f64::max).sqrt()
    }
}

/// The coordinates that are seen less the parameters that are found; `None` where these are more.
fn freedom(bundle: &Bundle<'_>) -> Option<usize> {
    let seen = 2 * bundle.seen.iter().flatten().map(|seen| seen.corners.len()).sum::<usize>();
    let fixed = bundle.inner.len() * bundle.free.iter().filter(|free| !**free).count();
    seen.checked_sub(bundle.parameters() - fixed)
}

/// The bundle of all other views.
fn without<'a>(bundle: &Bundle<'a>, view: usize) -> Bundle<'a> {
    let mut others = bundle.clone();
    others.views.remove(view);
    others.seen.iter_mut().for_each(|camera| {
        camera.remove(view);
    });
    others
}
