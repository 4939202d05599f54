//! Normal equations of one point, and the Cholesky factor of their 3 x 3 block.

use super::gauge::{Freedom, Gauge};
use super::loss::Loss;
use super::problem::{Observation, Problem};
use super::view::View;
use super::workspace::CrossBlock;
use crate::geometry::Real;

/// An observation's residual and its derivatives, weighted by the root of the loss's jacobian, and limited to
/// what the gauge lets move.
pub(super) struct Linear<T, const N: usize> {
    pub view: usize,
    pub residual: [T; 2],
    pub by_view: [[T; N]; 2],
    pub by_point: [[T; 3]; 2],
}

impl<T: Real, const N: usize> Linear<T, N> {
    /// `None` when the observation cannot be: [`prepare`](super::problem::prepare) and every step taken since
    /// made sure that it can.
    #[inline(always)]
    pub fn of<V: View<T, N>>(
        problem: &Problem<'_, V, T>,
        observation: &Observation<T>,
        gauge: &Gauge,
        loss: &Loss<T>,
    ) -> Option<Self> {
        let view = problem.views.get(usize::from(observation.view))?;
        let jacobian =
            view.jacobian(observation.eye, problem.points.get(observation.point as usize)?).ok()?;
        let mut by_view = jacobian.by_view;
        let (u, v) = (jacobian.pixel.x - observation.pixel.x, jacobian.pixel.y - observation.pixel.y);
        let (mut residual, mut by_point) = ([u, v], jacobian.by_point);
        let freedom = problem.freedom(gauge, observation.view);
        if freedom != Freedom::All {
            by_view.iter_mut().for_each(|row| freedom.restrict(row));
        }
        let weight = loss.weight(u * u + v * v);
        if weight != T::ONE {
            let root = weight.sqrt();
            residual.iter_mut().for_each(|x| *x *= root);
            by_view.as_flattened_mut().iter_mut().for_each(|x| *x *= root);
            by_point.as_flattened_mut().iter_mut().for_each(|x| *x *= root);
        }
        Some(Self { view: usize::from(observation.view), residual, by_view, by_point })
    }
}

/// The equations of a point, the views' steps left out: `V x = -g`.
#[derive(Clone, Copy)]
pub(super) struct PointEquations<T> {
    /// The lower triangle of V, row by row.
    matrix: [T; 6],
    pub gradient: [T; 3],
}

/// L of `L L^T = V`, row by row, with the inverse of its diagonal.
#[derive(Clone, Copy)]
pub(super) struct PointFactor<T> {
    l21: T,
    l31: T,
    l32: T,
    inverse: [T; 3],
}

/// What is added to a diagonal element, in units of the damping: the element itself, within what a number can
/// bear (Marquardt 1963).
pub(super) fn damper<T: Real>(diagonal: T) -> T {
    diagonal.max(T::of(1e-6)).min(T::of(1e30))
}

impl<T: Real> PointEquations<T> {
    pub const ZERO: Self = Self { matrix: [T::ZERO; 6], gradient: [T::ZERO; 3] };

    /// Adds an observation, its residual after the views' step.
    #[inline(always)]
    pub fn add(&mut self, rows: &[[T; 3]; 2], residual: [T; 2]) {
        for (&[x, y, z], r) in rows.iter().zip(residual) {
            let [a, b, c, d, e, f] = &mut self.matrix;
            *a += x * x;
            *b += x * y;
            *c += y * y;
            *d += x * z;
            *e += y * z;
            *f += z * z;
            for (g, x) in self.gradient.iter_mut().zip([x, y, z]) {
                *g += x * r;
            }
        }
    }

    /// The diagonal of V.
    pub fn diagonal(&self) -> [T; 3] {
        let [a, _, c, _, _, f] = self.matrix;
        [a, c, f]
    }

    /// The factor of V with so much damping.
    pub fn factor(&self, damping: T) -> PointFactor<T> {
        let [a, b, c, d, e, f] = self.matrix;
        let damped = |x: T| x + damping * damper(x);
        // What rounding makes of nothing is nothing: the point stays where it is along there.
        let root = |pivot: T, of: T| {
            if pivot > of * T::EPSILON { T::ONE / pivot.sqrt() } else { T::ZERO }
        };
        let (a, c, f) = (damped(a), damped(c), damped(f));
        let first = root(a, a);
        let (l21, l31) = (b * first, d * first);
        let second = root(c - l21 * l21, c);
        let l32 = (e - l31 * l21) * second;
        let third = root(f - l31 * l31 - l32 * l32, f);
        PointFactor { l21, l31, l32, inverse: [first, second, third] }
    }
}

impl<T: Real> PointFactor<T> {
    /// Whether V has its full rank.
    pub fn is_whole(&self) -> bool {
        self.inverse.iter().all(|&x| x > T::ZERO)
    }

    /// `L^-1 b`.
    pub fn forward(&self, [x, y, z]: [T; 3]) -> [T; 3] {
        let [i, j, k] = self.inverse;
        let x = x * i;
        let y = (y - self.l21 * x) * j;
        [x, y, (z - self.l31 * x - self.l32 * y) * k]
    }

    /// `L^-T b`.
    pub fn backward(&self, [x, y, z]: [T; 3]) -> [T; 3] {
        let [i, j, k] = self.inverse;
        let z = z * k;
        let y = (y - self.l32 * z) * j;
        [(x - self.l21 * y - self.l31 * z) * i, y, z]
    }

    /// `L^-1 W^T` of the transposed W, in place.
    pub fn forward_rows<const N: usize>(&self, [x, y, z]: &mut [[T; N]; 3]) {
        let [i, j, k] = self.inverse;
        for ((x, y), z) in x.iter_mut().zip(y).zip(z) {
            [*x, *y, *z] = {
                let x = *x * i;
                let y = (*y - self.l21 * x) * j;
                [x, y, (*z - self.l31 * x - self.l32 * y) * k]
            };
        }
    }
}

/// Adds an observation to the term of its view, among the first `used`; how many there are then. More than
/// there is room for are not kept: [`prepare`](super::problem::prepare) made sure that there is.
#[inline(always)]
pub(super) fn add_term<T: Real, const N: usize>(
    terms: &mut [CrossBlock<T, N>],
    used: usize,
    observation: &Linear<T, N>,
) -> usize {
    let known = terms.iter().take(used).position(|term| term.view == observation.view);
    let Some(term) = terms.get_mut(known.unwrap_or(used)) else { return used };
    if known.is_none() {
        *term = CrossBlock { view: observation.view, ..CrossBlock::EMPTY };
    }
    for (by_view, by_point) in observation.by_view.iter().zip(&observation.by_point) {
        for (line, &by) in term.cross.iter_mut().zip(by_point) {
            for (x, &y) in line.iter_mut().zip(by_view) {
                *x += by * y;
            }
        }
    }
    if known.is_none() { used + 1 } else { used }
}
