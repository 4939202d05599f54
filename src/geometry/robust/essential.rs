//! The essential matrix by the least robust loss of Sampson's distances.

use super::factored::Factored;
use super::frame::Frame;
use super::loss::Biweight;
use super::refine::{Matrix, refine};
use crate::geometry::Real;
use crate::geometry::camera::Camera;
use crate::geometry::two_view::{Correspondence, Essential, EssentialError};

/// Steps of the refinement at most.
const STEPS: usize = 20;

impl<T: Real> Essential<T> {
    /// The essential matrix near this one that makes Sampson's distances least, px, over the five numbers
    /// that it has; at most twenty steps of Levenberg's and Marquardt's method.
    ///
    /// `seen` are undistorted px ([`Camera::undistort`]), outliers among them: weights fall with the
    /// distance, to zero at one and a half times the threshold, as in
    /// [`robust_fundamental`](crate::geometry::robust::robust_fundamental). A correspondence that is not
    /// finite has no weight. The error is that of a matrix that is no estimate at all.
    pub fn refined(
        &self,
        seen: &[Correspondence<T>],
        first: &Camera<T>,
        second: &Camera<T>,
        threshold_px: T,
    ) -> Result<Self, EssentialError> {
        let frames = [Frame::of_camera(first), Frame::of_camera(second)];
        let start = Factored::new(self.matrix()).ok_or(EssentialError::Rank)?.essential();
        let loss = Biweight::new(threshold_px);
        // From far to near: the start may come from a matrix that knew nothing of the cameras.
        let wide = refine(start, Matrix::Essential, seen, &frames, loss.widened(T::of(2.5)), (1, STEPS / 2));
        let near = refine(wide, Matrix::Essential, seen, &frames, loss, (1, STEPS / 2));
        Self::nearest(&near.matrix())
    }
}
