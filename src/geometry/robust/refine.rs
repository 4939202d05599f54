//! The estimate that makes the geometric error least.

#![allow(
    clippy::needless_range_loop,
    reason = "an element is named by its row and column, as in the equations"
)]

use super::factored::{FREE, Factored};
use super::frame::Frame;
use super::loss::Loss;
use crate::geometry::Real;
use crate::geometry::linear::Ldl;
use crate::geometry::two_view::Correspondence;
use nalgebra::Vector3;

/// Which of the seven numbers may move.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Matrix {
    /// All: a fundamental matrix.
    Fundamental,
    /// Five: U's turn about its last axis stands for V's too, and the singular values stay alike.
    Essential,
}

/// The normal equations of weighted least squares about an estimate.
struct Equations<T: Real> {
    /// The sum of `(1 - d^2 / w^2)^3`: more is better.
    gain: T,
    matrix: [[T; FREE]; FREE],
    slope: [T; FREE],
}

/// Estimates at which equations are set up, at most.
const MOST_STEPS: usize = 20;

/// Levenberg's and Marquardt's method, `steps` at most, on the sum of the loss of Sampson's distances, by the
/// seven or five numbers of the matrix; the estimate and its gain. Of the correspondences every `every`th is
/// used.
///
/// One pass over the correspondences a step: about 150 operations for each that has a weight, 40 for one that
/// has none.
#[inline(never)]
pub(super) fn refine<T: Real>(
    start: Factored<T>,
    kind: Matrix,
    seen: &[Correspondence<T>],
    frames: &[Frame<T>; 2],
    loss: Loss<T>,
    (every, steps): (usize, usize),
) -> (Factored<T>, T) {
    let mut best = start;
    let mut equations = Equations::about(&best, kind, seen.iter().step_by(every.max(1)), frames, loss);
    let mut damping = T::of(1e-4);
    for _ in 0..steps.min(MOST_STEPS) {
        let step = equations.step(damping);
        let size = step.iter().fold(T::ZERO, |sum, &x| sum.max(x.abs()));
        if !size.is_finite() {
            break;
        }
        let moved = best.moved(&step);
        let there = Equations::about(&moved, kind, seen.iter().step_by(every.max(1)), frames, loss);
        if there.gain > equations.gain {
            let better = there.gain - equations.gain;
            let settled = better <= there.gain * T::of(1e-7).max(T::EPSILON * T::of(4.0));
            (best, equations) = (moved, there);
            damping = (damping * T::of(0.1)).max(T::of(1e-6));
            if settled {
                break;
            }
        } else {
            // In f32 the gain may be the same to rounding; a larger damping does not make it better.
            if size <= T::EPSILON.sqrt() * T::of(1e-2) {
                break;
            }
            damping *= T::of(16.0);
        }
    }
    (best, equations.gain)
}

impl<T: Real> Equations<T> {
    #[inline(never)]
    fn about<'a>(
        f: &Factored<T>,
        kind: Matrix,
        seen: impl Iterator<Item = &'a Correspondence<T>>,
        [first, second]: &[Frame<T>; 2],
        loss: Loss<T>,
    ) -> Self {
        let mut gain = T::ZERO;
        let mut matrix = [[T::ZERO; FREE]; FREE];
        let mut slope = [T::ZERO; FREE];
        let (u, v) = (f.u, f.v);
        let m = f.matrix();
        let per_width = T::ONE / loss.width_squared;
        for s in seen {
            let (p, q) = (first.apply(s.first), second.apply(s.second));
            let (p, q) = (Vector3::new(p.x, p.y, T::ONE), Vector3::new(q.x, q.y, T::ONE));
            // The lines, and what a step of a pixel along their normals is in the frame.
            let line = m * q;
            let other = m.tr_mul(&p);
            let (gx, gy) = first.steepest(line.x, line.y);
            let (hx, hy) = second.steepest(other.x, other.y);
            let steep = gx * line.x + gy * line.y + hx * other.x + hy * other.y;
            let residual = p.dot(&line);
            let squared = residual * residual;
            if !(squared < steep * loss.width_squared) {
                continue;
            }
            let per_steep = T::ONE / steep;
            let left = T::ONE - squared * per_steep * per_width;
            let weight = left * left;
            gain += weight * left;
            // The derivative of Sampson's distance is the residual's at the corrected points, to within the
            // square of the correction over the size of the picture.
            let by = residual * per_steep;
            let p = Vector3::new(p.x - by * gx, p.y - by * gy, T::ONE);
            let q = Vector3::new(q.x - by * hx, q.y - by * hy, T::ONE);
            let d = f.derivatives(&u.tr_mul(&p), &v.tr_mul(&q));
            let w = weight * per_steep;
            for i in 0..FREE {
                let wd = w * d[i];
                slope[i] += wd * residual;
                for j in i..FREE {
                    matrix[i][j] += wd * d[j];
                }
            }
        }
        let upper = matrix;
        for (i, row) in matrix.iter_mut().enumerate() {
            for (element, other) in row.iter_mut().zip(&upper).take(i) {
                *element = other.get(i).copied().unwrap_or(T::ZERO);
            }
        }
        if kind == Matrix::Essential {
            let [.., fifth, sixth] = &mut slope;
            (*fifth, *sixth) = (T::ZERO, T::ZERO);
            for (k, row) in matrix.iter_mut().enumerate() {
                for (j, element) in row.iter_mut().enumerate().filter(|(j, _)| k.max(*j) >= 5) {
                    *element = if j == k { T::ONE } else { T::ZERO };
                }
            }
        }
        Self { gain, matrix, slope }
    }

    /// `-(A + damping diag A)^-1 slope`.
    fn step(&self, damping: T) -> [T; FREE] {
        let mut damped = self.matrix;
        for (k, row) in damped.iter_mut().enumerate() {
            if let Some(diagonal) = row.get_mut(k) {
                *diagonal += *diagonal * damping;
            }
        }
        Ldl::new(&mut damped).solve(&self.slope).map(|x| -x)
    }
}
