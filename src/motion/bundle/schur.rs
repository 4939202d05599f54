//! One damped step by the Schur complement: points eliminated, views solved, points back-substituted.

use super::envelope::{Envelope, Indefinite};
use super::gauge::{Freedom, Gauge};
use super::loss::Loss;
use super::point_equations::{Linear, PointEquations, PointFactor, add_term, damper};
use super::problem::{Problem, tracks};
use super::view::View;
use super::workspace::{BundleWorkspaceView, CrossBlock};
use crate::geometry::Real;

/// What a step promises and gives.
pub(super) struct Proposal<T> {
    /// The cost after it; infinite where a point is no longer seen.
    pub cost: T,
    /// Decrease of the cost that the linear model predicts.
    pub predicted: T,
    /// The largest part of the step beside the size of what it moves, squared: of a view's centre and of a
    /// point.
    pub moved: T,
}

/// Half the loss of all observations; infinite where a point is not seen.
pub(super) fn cost<V: View<T, N>, T: Real, const N: usize>(problem: &Problem<'_, V, T>, loss: &Loss<T>) -> T {
    let of = |observation: &super::problem::Observation<T>| {
        let view = problem.views.get(usize::from(observation.view))?;
        let seen = view.project(observation.eye, problem.points.get(observation.point as usize)?).ok()?;
        Some(loss.of((seen - observation.pixel).norm_squared()))
    };
    let sum = problem
        .observations
        .iter()
        .fold(T::ZERO, |sum, observation| sum + of(observation).unwrap_or(T::ONE / T::ZERO));
    sum * T::of(0.5)
}

/// Fills the reduced matrix and its right side, the points eliminated: for every point with the views i and
/// j, `S_ij = U_ij - W_i V^-1 W_j^T` and `b_i = -(g_i - W_i V^-1 g_p)` (Triggs et al. 2000, 6.1; Brown 1958),
/// where U and V have been damped.
pub(super) fn reduce<V: View<T, N>, T: Real, const N: usize>(
    problem: &Problem<'_, V, T>,
    workspace: &mut BundleWorkspaceView<'_, V, T, N>,
    gauge: &Gauge,
    loss: &Loss<T>,
    damping: T,
) {
    let BundleWorkspaceView { slots, terms, blocks, .. } = workspace;
    let Some(slots) = slots.get_mut(..problem.views.len()) else { return };
    for slot in slots.iter_mut() {
        (slot.gradient, slot.diagonal, slot.step) = ([T::ZERO; N], [T::ZERO; N], [T::ZERO; N]);
    }
    blocks.as_flattened_mut().as_flattened_mut().fill(T::ZERO);
    let mut reduced = Envelope { slots, blocks };
    for track in tracks(problem.observations) {
        let mut point = PointEquations::ZERO;
        let mut used = 0;
        for observation in track {
            let Some(linear) = Linear::of(problem, observation, gauge, loss) else { continue };
            point.add(&linear.by_point, linear.residual);
            used = add_term(terms, used, &linear);
            add_view(&mut reduced, &linear);
        }
        let factor = point.factor(damping);
        eliminate(&mut reduced, terms.get_mut(..used).unwrap_or(&mut []), &factor, &point.gradient);
    }
    for (at, _) in (0..).zip(problem.views.iter()) {
        let freedom = problem.freedom(gauge, at);
        let Some(slot) = reduced.slots.get_mut(usize::from(at)) else { return };
        for (step, &gradient) in slot.step.iter_mut().zip(&slot.gradient) {
            *step -= gradient;
        }
        let dampers = slot.diagonal.map(|x| damping * damper(x));
        let size = slot.diagonal.iter().fold(T::ZERO, |most, &x| most.max(x));
        let Some(block) = reduced.block(at.into(), at.into()) else { return };
        freedom.fill(block, size);
        for k in 0..N {
            block[k][k] += dampers[k];
        }
    }
}

/// Adds an observation to its view's block of `J^T J` and to its gradient.
#[inline(always)]
fn add_view<V, T: Real, const N: usize>(reduced: &mut Envelope<'_, V, T, N>, linear: &Linear<T, N>) {
    let Some(slot) = reduced.slots.get_mut(linear.view) else { return };
    for (row, r) in linear.by_view.iter().zip(linear.residual) {
        for k in 0..N {
            slot.gradient[k] += row[k] * r;
            slot.diagonal[k] += row[k] * row[k];
        }
    }
    let Some(block) = reduced.block(linear.view, linear.view) else { return };
    let [u, v] = &linear.by_view;
    for k in 0..N {
        let line = &mut block[k];
        for l in 0..N {
            line[l] += u[k] * u[l] + v[k] * v[l];
        }
    }
}

/// Takes a point out of the equations of the views that see it.
#[inline(always)]
fn eliminate<V, T: Real, const N: usize>(
    reduced: &mut Envelope<'_, V, T, N>,
    terms: &mut [CrossBlock<T, N>],
    factor: &PointFactor<T>,
    gradient: &[T; 3],
) {
    let z = factor.forward(*gradient);
    for term in terms.iter_mut() {
        factor.forward_rows(&mut term.cross);
        let Some(slot) = reduced.slots.get_mut(term.view) else { return };
        for (line, &z) in term.cross.iter().zip(&z) {
            for (x, &y) in slot.step.iter_mut().zip(line) {
                *x += y * z;
            }
        }
    }
    for (n, a) in terms.iter().enumerate() {
        for b in terms.iter().take(n + 1) {
            let (row, column) = if a.view > b.view { (a, b) } else { (b, a) };
            let Some(block) = reduced.block(row.view, column.view) else { return };
            // One pass over the block: three products for every element that is loaded.
            let ([a, b, c], [x, y, z]) = (&column.cross, row.cross);
            for k in 0..N {
                let (a, b, c) = (a[k], b[k], c[k]);
                let mut line = block[k];
                for l in 0..N {
                    line[l] -= a * x[l] + b * y[l] + c * z[l];
                }
                block[k] = line;
            }
        }
    }
}

/// Solves what [`reduce`] filled, and writes views and points after the step into the workspace.
pub(super) fn propose<V: View<T, N>, T: Real, const N: usize>(
    problem: &Problem<'_, V, T>,
    workspace: &mut BundleWorkspaceView<'_, V, T, N>,
    gauge: &Gauge,
    loss: &Loss<T>,
    damping: T,
) -> Result<Proposal<T>, Indefinite> {
    let BundleWorkspaceView { slots, blocks, trial_points, .. } = workspace;
    let slots = slots.get_mut(..problem.views.len()).ok_or(Indefinite)?;
    let mut reduced = Envelope { slots, blocks };
    reduced.factor(T::EPSILON)?;
    reduced.forward(0);
    reduced.backward();
    let half = T::of(0.5);
    let (mut predicted, mut cost, mut moved) = (T::ZERO, T::ZERO, T::ZERO);
    // -g x / 2 + damping x^T D x / 2.
    let mut promise =
        |x: T, gradient: T, diagonal: T| predicted += half * x * (damping * damper(diagonal) * x - gradient);
    for (at, (view, slot)) in (0..).zip(problem.views.iter().zip(reduced.slots.iter_mut())) {
        let freedom = problem.freedom(gauge, at);
        let trial = view.moved(&slot.step);
        slot.trial = match freedom {
            // To the bit where it was.
            Freedom::None => *view,
            freedom => trial.with_pose(freedom.settled(trial.pose())),
        };
        for k in 0..N {
            promise(slot.step[k], slot.gradient[k], slot.diagonal[k]);
        }
        let (from, to) = (view.pose().translation(), slot.trial.pose().translation());
        moved = moved.max((to - from).norm_squared() / (from.norm_squared() + T::ONE));
    }
    for track in tracks(problem.observations) {
        let mut free = PointEquations::ZERO;
        let mut shifted = PointEquations::ZERO;
        for observation in track {
            let Some(linear) = Linear::of(problem, observation, gauge, loss) else { continue };
            let Some(slot) = reduced.slots.get(linear.view) else { continue };
            free.add(&linear.by_point, linear.residual);
            let mut residual = linear.residual;
            for (r, row) in residual.iter_mut().zip(&linear.by_view) {
                *r += row.iter().zip(&slot.step).fold(T::ZERO, |sum, (&j, &x)| sum + j * x);
            }
            shifted.add(&linear.by_point, residual);
        }
        let factor = free.factor(damping);
        let step = factor.backward(factor.forward(shifted.gradient)).map(|x| -x);
        for ((&x, &gradient), diagonal) in step.iter().zip(&free.gradient).zip(free.diagonal()) {
            promise(x, gradient, diagonal);
        }
        let at = track.first().map_or(0, |observation| observation.point as usize);
        let (Some(from), Some(to)) = (problem.points.get(at), trial_points.get_mut(at)) else { continue };
        let [x, y, z] = step;
        *to = from + nalgebra::Vector3::new(x, y, z);
        moved = moved.max((*to - from).norm_squared() / (from.coords.norm_squared() + T::ONE));
        for observation in track {
            let seen = reduced
                .slots
                .get(usize::from(observation.view))
                .map(|slot| slot.trial.project(observation.eye, to));
            cost += match seen {
                Some(Ok(seen)) => loss.of((seen - observation.pixel).norm_squared()),
                _ => T::ONE / T::ZERO,
            };
        }
    }
    Ok(Proposal { cost: cost * half, predicted, moved })
}
