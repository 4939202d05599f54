//! Covariances of views and points (Hartley & Zisserman 2004, A6.4).

use super::envelope::Envelope;
use super::gauge::Gauge;
use super::loss::Loss;
use super::point_equations::{Linear, PointEquations, add_term};
use super::problem::{BundleError, Problem, prepare, tracks};
use super::schur::reduce;
use super::view::View;
use super::workspace::BundleWorkspaceView;
use crate::geometry::Real;
use nalgebra::Matrix3;

/// The covariances of a problem's views and points to first order, where every coordinate of an observation
/// has the same standard deviation: blocks of `sigma^2 (J^T W J)^-1` (Hartley & Zisserman 2004, A6.4 and
/// 18.1), in the frame and the scale that the gauge holds. What is held has none.
///
/// Each block costs the solution of the reduced equations once per row. In `f32` a view is good to some
/// percent.
pub struct Covariances<'a, V, T: Real, const N: usize> {
    problem: Problem<'a, V, T>,
    reduced: BundleWorkspaceView<'a, V, T, N>,
    gauge: Gauge,
    loss: Loss<T>,
    variance: T,
}

/// Why there is no covariance.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum CovarianceError {
    /// The problem is none.
    Problem(BundleError),
    /// The views are not determined: the gauge leaves the frame or the scale open, or there are too few
    /// observations.
    Undetermined,
    /// The observations of this point do not determine it.
    Point(usize),
}

error_text!(CovarianceError {
    Self::Problem(error) => "{error}",
    Self::Undetermined => "the views are not determined: hold a view and a distance, or add observations",
    Self::Point(at) => "point {at} is not determined by its observations",
});

impl<'a, V: View<T, N>, T: Real, const N: usize> Covariances<'a, V, T, N> {
    /// Factors the equations of the problem as it is, without damping. `sigma_px` is the standard deviation
    /// of a coordinate.
    pub fn new(
        problem: Problem<'a, V, T>,
        mut workspace: BundleWorkspaceView<'a, V, T, N>,
        gauge: Gauge,
        loss: Loss<T>,
        sigma_px: T,
    ) -> Result<Self, CovarianceError> {
        prepare(&problem, &gauge, &mut workspace).map_err(CovarianceError::Problem)?;
        // What is left of a pivot that should be zero may, in `f32`, be more than one that counts: asked of
        // the gauge first.
        let lengths = problem.observations.iter().any(|observation| observation.eye > 0);
        if !gauge.is_complete(lengths) {
            return Err(CovarianceError::Undetermined);
        }
        for track in tracks(problem.observations) {
            let mut point = PointEquations::ZERO;
            for observation in track {
                if let Some(linear) = Linear::of(&problem, observation, &gauge, &loss) {
                    point.add(&linear.by_point, linear.residual);
                }
            }
            if !point.factor(T::ZERO).is_whole() {
                return Err(CovarianceError::Point(
                    track.first().map_or(0, |observation| observation.point as usize),
                ));
            }
        }
        reduce(&problem, &mut workspace, &gauge, &loss, T::ZERO);
        let mut found = Self { problem, reduced: workspace, gauge, loss, variance: sigma_px * sigma_px };
        found.envelope().factor(T::EPSILON * T::of(1024.0)).map_err(|_| CovarianceError::Undetermined)?;
        Ok(found)
    }

    fn envelope(&mut self) -> Envelope<'_, V, T, N> {
        let BundleWorkspaceView { slots, blocks, .. } = &mut self.reduced;
        let views = self.problem.views.len().min(slots.len());
        Envelope { slots: slots.get_mut(..views).unwrap_or(&mut []), blocks }
    }

    /// Solves the reduced equations for what `fill` writes into the right side.
    fn solve(&mut self, fill: impl FnOnce(&mut Envelope<'_, V, T, N>)) {
        let mut reduced = self.envelope();
        reduced.slots.iter_mut().for_each(|slot| slot.step = [T::ZERO; N]);
        fill(&mut reduced);
        reduced.forward(0);
        reduced.backward();
    }

    /// The covariance of a view's step, rows and columns in its order: turn in radians, centre in the scene's
    /// unit, lens. Zeros for a view that there is not.
    pub fn view(&mut self, view: u16) -> [[T; N]; N] {
        let freedom = self.problem.freedom(&self.gauge, view);
        let (at, variance) = (usize::from(view), self.variance);
        let mut covariance = [[T::ZERO; N]; N];
        for (k, row) in covariance.iter_mut().enumerate() {
            let mut unit = [T::ZERO; N];
            if let Some(x) = unit.get_mut(k) {
                *x = T::ONE;
            }
            freedom.restrict(&mut unit);
            self.solve(|reduced| {
                if let Some(slot) = reduced.slots.get_mut(at) {
                    slot.step = unit;
                }
            });
            if let Some(slot) = self.reduced.slots.get(at) {
                *row = slot.step.map(|x| x * variance);
            }
        }
        covariance
    }

    /// The covariance of a point, in the scene's unit squared; refused when it has no observation.
    ///
    /// `V^-1 + V^-1 W^T S^-1 W V^-1`.
    pub fn point(&mut self, point: usize) -> Result<Matrix3<T>, CovarianceError> {
        let track = tracks(self.problem.observations)
            .find(|track| track.first().is_some_and(|s| s.point as usize == point));
        let (mut equations, mut used) = (PointEquations::ZERO, 0);
        for observation in track.ok_or(CovarianceError::Point(point))? {
            let Some(linear) = Linear::of(&self.problem, observation, &self.gauge, &self.loss) else {
                continue;
            };
            equations.add(&linear.by_point, linear.residual);
            used = add_term(self.reduced.terms, used, &linear);
        }
        let factor = equations.factor(T::ZERO);
        let solve = |b: [T; 3]| factor.backward(factor.forward(b));
        for term in self.reduced.terms.iter_mut().take(used) {
            for k in 0..N {
                let [x, y, z] = solve([term.cross[0][k], term.cross[1][k], term.cross[2][k]]);
                (term.cross[0][k], term.cross[1][k], term.cross[2][k]) = (x, y, z);
            }
        }
        let (o, l) = (T::ZERO, T::ONE);
        let mut columns = [solve([l, o, o]), solve([o, l, o]), solve([o, o, l])];
        for (c, column) in columns.iter_mut().enumerate() {
            let views = self.problem.views.len();
            let BundleWorkspaceView { slots, blocks, terms, .. } = &mut self.reduced;
            let mut reduced = Envelope { slots: slots.get_mut(..views).unwrap_or(&mut []), blocks };
            reduced.slots.iter_mut().for_each(|slot| slot.step = [T::ZERO; N]);
            for term in terms.iter().take(used) {
                if let (Some(slot), Some(line)) = (reduced.slots.get_mut(term.view), term.cross.get(c)) {
                    slot.step = *line;
                }
            }
            reduced.forward(0);
            reduced.backward();
            for term in terms.iter().take(used) {
                let Some(slot) = reduced.slots.get(term.view) else { continue };
                for (sum, line) in column.iter_mut().zip(&term.cross) {
                    *sum += line.iter().zip(&slot.step).fold(T::ZERO, |sum, (&a, &b)| sum + a * b);
                }
            }
        }
        let covariance = Matrix3::from(columns) * self.variance;
        // The two triangles differ by rounding.
        Ok((covariance + covariance.transpose()) * T::of(0.5))
    }
}
