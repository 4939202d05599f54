//! Levenberg-Marquardt: damped least squares (Levenberg 1944; Marquardt 1963; Nocedal & Wright 2006, 10.3).

use super::ldl::Ldl;
use crate::geometry::Real;

/// The normal equations `A x = b` of weighted least squares about an estimate: `A = J^T W J` and
/// `b = -J^T W r`, of the residuals r, their Jacobian J and their weights W.
pub(crate) struct NormalEquations<T, const N: usize> {
    /// The left side A, the information of the N numbers.
    pub(crate) matrix: [[T; N]; N],
    /// The right side b: the negative gradient of half the cost.
    pub(crate) right: [T; N],
    /// The cost that is minimised.
    pub(crate) cost: T,
}

impl<T: Real, const N: usize> NormalEquations<T, N> {
    /// Normal equations without a residual: all zeros.
    pub(crate) fn new() -> Self {
        Self { matrix: [[T::ZERO; N]; N], right: [T::ZERO; N], cost: T::ZERO }
    }

    /// Adds a residual of weight one to both sides: a row of J, and `-r`.
    pub(crate) fn add(&mut self, jacobian: &[T; N], error: T) {
        for ((row, right), &a) in self.matrix.iter_mut().zip(&mut self.right).zip(jacobian) {
            for (element, &b) in row.iter_mut().zip(jacobian) {
                *element += a * b;
            }
            *right += a * error;
        }
    }
}

/// What [`levenberg_marquardt`] estimates: N numbers that move an estimate, and the rules of the search.
pub(crate) trait LeastSquares<T: Real, const N: usize> {
    type Estimate: Copy;

    /// The damping of the first step, as a share of the diagonal; zero for Gauss-Newton.
    const FIRST_DAMPING: f64 = 1e-4;

    /// Added to every damped element of the diagonal, so that a direction without information takes no step.
    const DIAGONAL_FLOOR: f64 = 0.0;

    /// The normal equations about an estimate; `None` where it has no cost. The search may end as soon as the
    /// cost is known not to be below `bound`.
    fn equations(&self, at: &Self::Estimate, bound: Option<T>) -> Option<NormalEquations<T, N>>;

    /// The equations about the estimate of the last step that is allowed, which moves no further: a problem
    /// whose caller does not want them may leave all but the cost at zero.
    fn last_equations(&self, at: &Self::Estimate, bound: Option<T>) -> Option<NormalEquations<T, N>> {
        self.equations(at, bound)
    }

    /// The estimate after a step of the N numbers.
    fn moved(&self, from: &Self::Estimate, step: &[T; N]) -> Self::Estimate;

    /// Whether a step that changes the cost so is taken.
    fn is_better(&self, before: T, after: T) -> bool {
        after <= before
    }

    /// Whether a step that was taken is the last one.
    fn is_settled(&self, before: T, after: T) -> bool {
        before - after <= after * T::EPSILON.sqrt()
    }

    /// The damping after a step that was taken.
    fn after_taken(&self, damping: T) -> T {
        damping * T::of(0.1)
    }

    /// The damping after a step that was not taken; `None` when no shorter one would be.
    fn after_refused(&self, damping: T, _step: &[T; N]) -> Option<T> {
        Some(damping * T::of(10.0))
    }
}

/// The estimate with the least cost near `start`, of at most `most_steps` steps, and the equations about it;
/// `None` when the start has no cost.
pub(crate) fn levenberg_marquardt<T: Real, P: LeastSquares<T, N>, const N: usize>(
    problem: &P,
    start: P::Estimate,
    most_steps: usize,
) -> Option<(P::Estimate, NormalEquations<T, N>)> {
    let mut best = start;
    let mut equations = problem.equations(&best, None)?;
    let mut damping = T::of(P::FIRST_DAMPING);
    for steps in 1..=most_steps {
        let mut matrix = equations.matrix;
        for (i, row) in matrix.iter_mut().enumerate() {
            if let Some(diagonal) = row.get_mut(i) {
                *diagonal += *diagonal * damping + T::of(P::DIAGONAL_FLOOR);
            }
        }
        let step = Ldl::new(&mut matrix).solve(&equations.right);
        let there = problem.moved(&best, &step);
        let before = equations.cost;
        let next = if steps < most_steps {
            problem.equations(&there, Some(before))
        } else {
            problem.last_equations(&there, Some(before))
        };
        let next = next.filter(|next| problem.is_better(before, next.cost));
        if let Some(next) = next {
            (best, equations) = (there, next);
            damping = problem.after_taken(damping);
            if problem.is_settled(before, equations.cost) {
                break;
            }
        } else if let Some(more) = problem.after_refused(damping, &step) {
            damping = more;
        } else {
            break;
        }
    }
    Some((best, equations))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `exp(k x)` through (0, 1), (1, 2) and (2, 4): k is the logarithm of two.
    struct Growth;

    impl LeastSquares<f64, 1> for Growth {
        type Estimate = f64;

        fn equations(&self, &k: &f64, _bound: Option<f64>) -> Option<NormalEquations<f64, 1>> {
            let mut all = NormalEquations::new();
            for (x, y) in [(0.0, 1.0), (1.0, 2.0), (2.0, 4.0)] {
                let value = (k * x).exp();
                all.add(&[x * value], y - value);
                all.cost += (y - value) * (y - value);
            }
            all.cost.is_finite().then_some(all)
        }

        fn moved(&self, k: &f64, [step]: &[f64; 1]) -> f64 {
            k + step
        }
    }

    #[test]
    fn an_exponent_from_afar() {
        // From -1 the first Gauss-Newton step overshoots: it is refused, and a damped one is taken.
        for start in [-1.0, 0.0, 3.0] {
            let (k, equations) = levenberg_marquardt(&Growth, start, 60).expect("a finite start");
            assert!((k - 2.0_f64.ln()).abs() < 1e-7 && equations.cost < 1e-12, "{start}: {k}");
        }
        assert!(levenberg_marquardt(&Growth, 1e3, 60).is_none());
    }
}
