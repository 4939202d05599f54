//! F or E by the least robust loss of Sampson's distances (Hartley & Zisserman 2004, 11.4.3).

#![allow(
    clippy::needless_range_loop,
    reason = "an element is named by its row and column, as in the equations"
)]

use super::factored::{FREE, Factored};
use super::frame::Frame;
use super::loss::{Biweight, weight_and_gain};
use crate::geometry::Real;
use crate::geometry::linear::{LeastSquares, NormalEquations, levenberg_marquardt};
use crate::geometry::two_view::Correspondence;
use nalgebra::{Matrix3, Vector3};

/// The matrix to refine, which says which of its seven parameters are free.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Matrix {
    /// All: a fundamental matrix.
    Fundamental,
    /// Five: U's rotation about its last axis stands for V's too, and the singular values stay alike.
    Essential,
}

/// The loss of Sampson's distances, over the seven or five numbers of the matrix.
struct SampsonLoss<'a, T: Real> {
    kind: Matrix,
    seen: &'a [Correspondence<T>],
    frames: &'a [Frame<T>; 2],
    loss: Biweight<T>,
    /// Stride through the correspondences: every `every`th one is used.
    every: usize,
}

/// The estimate near `start` with the least loss of Sampson's distances, by Levenberg-Marquardt, `steps` at
/// most. Of the correspondences every `every`th is used.
///
/// One pass over the correspondences a step: about 150 operations for each that has a weight, 40 for one that
/// has none.
#[inline(never)]
pub(super) fn refine<T: Real>(
    start: Factored<T>,
    kind: Matrix,
    seen: &[Correspondence<T>],
    frames: &[Frame<T>; 2],
    loss: Biweight<T>,
    (every, steps): (usize, usize),
) -> Factored<T> {
    let problem = SampsonLoss { kind, seen, frames, loss, every };
    levenberg_marquardt(&problem, start, steps).map_or(start, |(best, _)| best)
}

/// A correspondence beside an estimate, in the frames.
struct Beside<T: Real> {
    p: Vector3<T>,
    q: Vector3<T>,
    /// What a step of a pixel along the normals of the lines is.
    steps: [(T, T); 2],
    residual: T,
    /// One over the squared gradient of the residual, by px.
    per_steep: T,
    weight: T,
    gain: T,
}

impl<T: Real> SampsonLoss<'_, T> {
    /// Calls `each` with all that have a weight beside the matrix m.
    #[inline(always)]
    fn for_each_beside(&self, m: &Matrix3<T>, mut each: impl FnMut(Beside<T>)) {
        let Self { seen, frames: [first, second], loss, every, .. } = *self;
        let per_width = T::ONE / loss.width_squared;
        // Never 0, which the compiler has to see.
        for s in seen.iter().step_by(every.max(1)) {
            let (p, q) = (first.apply(s.first), second.apply(s.second));
            let (p, q) = (Vector3::new(p.x, p.y, T::ONE), Vector3::new(q.x, q.y, T::ONE));
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
            let (weight, gain) = weight_and_gain(squared * per_steep * per_width);
            each(Beside { p, q, steps: [(gx, gy), (hx, hy)], residual, per_steep, weight, gain });
        }
    }
}

impl<T: Real> LeastSquares<T, FREE> for SampsonLoss<'_, T> {
    type Estimate = Factored<T>;

    #[inline(never)]
    fn equations(&self, f: &Factored<T>, _bound: Option<T>) -> Option<NormalEquations<T, FREE>> {
        let mut cost = T::ZERO;
        let mut matrix = [[T::ZERO; FREE]; FREE];
        let mut right = [T::ZERO; FREE];
        let (u, v) = (f.u, f.v);
        self.for_each_beside(&f.matrix(), |Beside { p, q, steps, residual, per_steep, weight, gain }| {
            cost -= gain;
            // The derivative of Sampson's distance is the residual's at the corrected points, to within the
            // square of the correction over the size of the picture.
            let by = residual * per_steep;
            let [(gx, gy), (hx, hy)] = steps;
            let p = Vector3::new(p.x - by * gx, p.y - by * gy, T::ONE);
            let q = Vector3::new(q.x - by * hx, q.y - by * hy, T::ONE);
            let d = f.derivatives(&u.tr_mul(&p), &v.tr_mul(&q));
            let w = weight * per_steep;
            for i in 0..FREE {
                let wd = w * d[i];
                right[i] -= wd * residual;
                for j in i..FREE {
                    matrix[i][j] += wd * d[j];
                }
            }
        });
        let upper = matrix;
        for (i, row) in matrix.iter_mut().enumerate() {
            for (element, other) in row.iter_mut().zip(&upper).take(i) {
                *element = other.get(i).copied().unwrap_or(T::ZERO);
            }
        }
        if self.kind == Matrix::Essential {
            let [.., sixth, seventh] = &mut right;
            (*sixth, *seventh) = (T::ZERO, T::ZERO);
            for (k, row) in matrix.iter_mut().enumerate() {
                for (j, element) in row.iter_mut().enumerate().filter(|(j, _)| k.max(*j) >= 5) {
                    *element = if j == k { T::ONE } else { T::ZERO };
                }
            }
        }
        Some(NormalEquations { matrix, right, cost })
    }

    /// The cost alone: the estimate is what is wanted.
    #[inline(never)]
    fn last_equations(&self, f: &Factored<T>, _bound: Option<T>) -> Option<NormalEquations<T, FREE>> {
        let mut equations = NormalEquations::new();
        self.for_each_beside(&f.matrix(), |Beside { gain, .. }| equations.cost -= gain);
        Some(equations)
    }

    fn moved(&self, from: &Factored<T>, step: &[T; FREE]) -> Factored<T> {
        from.moved(step)
    }

    fn is_better(&self, before: T, after: T) -> bool {
        after < before
    }

    fn is_settled(&self, before: T, after: T) -> bool {
        before - after <= -after * T::of(1e-7).max(T::EPSILON * T::of(4.0))
    }

    fn after_taken(&self, damping: T) -> T {
        (damping * T::of(0.1)).max(T::of(1e-6))
    }

    fn after_refused(&self, damping: T, step: &[T; FREE]) -> Option<T> {
        // In f32 the gain may be the same to rounding; a larger damping does not make it better.
        let least = T::EPSILON.sqrt() * T::of(1e-2);
        let size = step.iter().fold(T::ZERO, |sum, &x| sum.max(x.abs()));
        (size > least && size.is_finite()).then(|| damping * T::of(16.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point2;

    fn frames() -> [Frame<f64>; 2] {
        Frame::of_points(&places()).expect("points that are apart")
    }

    /// An estimate, in the frames.
    fn estimate() -> Factored<f64> {
        let matrix = Matrix3::new(0.1, -0.3, 0.4, 0.2, 0.05, -1.0, -0.3, 0.9, 0.1);
        Factored::new(&matrix).expect("two singular values")
    }

    /// Places all over two images, not near any line.
    fn places() -> [Correspondence<f64>; 12] {
        core::array::from_fn(|i| {
            let (u, v) = ((i * 37 % 11) as f64 * 20.0, (i * 53 % 13) as f64 * 15.0);
            Correspondence::new(u, v, 1.1 * u - (i % 5) as f64, 0.9 * v + 40.0)
        })
    }

    /// Places all over two images, at most `off` px above or below the estimate's lines in the first one.
    fn seen(off: f64) -> [Correspondence<f64>; 12] {
        let (places, [first, second]) = (places(), frames());
        let (m, matrix) = (first.matrix(), estimate().matrix());
        core::array::from_fn(|i| {
            let Correspondence { first: p, second: q } = places[i];
            let line = m.tr_mul(&(matrix * second.apply(q).to_homogeneous()));
            let v = -(line.x * p.x + line.z) / line.y;
            let off = off * ((i % 5) as f64 - 2.0) / 2.0;
            Correspondence { first: Point2::new(p.x, v + off), second: q }
        })
    }

    fn along(axis: usize, by: f64) -> [f64; FREE] {
        core::array::from_fn(|i| if i == axis { by } else { 0.0 })
    }

    #[test]
    fn the_equations_are_slope_and_curvature_of_the_loss() {
        let (seen, frames, f) = (seen(0.02), frames(), estimate());
        let loss = Biweight { width_squared: 4.0 };
        let problem = SampsonLoss { kind: Matrix::Fundamental, seen: &seen, frames: &frames, loss, every: 1 };
        let cost = |step: &[f64; FREE]| problem.last_equations(&f.moved(step), None).expect("a cost").cost;
        let equations = problem.equations(&f, None).expect("equations");
        assert_eq!(equations.cost, cost(&[0.0; FREE]));
        assert!(equations.cost < -11.9 && equations.cost > -12.0, "{}", equations.cost);
        for i in 0..FREE {
            // Of -(1 - e / w^2)^3 the slope is -6 / w^2 times the weighted residual's.
            let slope = (cost(&along(i, 1e-6)) - cost(&along(i, -1e-6))) / 2e-6;
            let (expected, size) = (-1.5 * equations.right[i], equations.matrix[i][i].sqrt());
            assert!((slope - expected).abs() < 1e-3 * size, "{i}: {slope} {expected} {size}");
            for j in 0..FREE {
                let by = |other: f64| {
                    let (one, two) = (along(i, 1e-5), along(j, other));
                    cost(&core::array::from_fn(|k| one[k] + two[k]))
                };
                // Twice the curvature 3 / w^2, of squares of sums and of differences.
                let differences = by(1e-5) - by(-1e-5) - (cost(&along(j, 1e-5)) - cost(&along(j, -1e-5)));
                let curvature = differences / 2e-10 / 1.5;
                let size = size * equations.matrix[j][j].sqrt();
                let element = equations.matrix[i][j];
                assert!((element - curvature).abs() < 0.02 * size, "{i} {j}: {element} {curvature} {size}");
                assert_eq!(element, equations.matrix[j][i]);
            }
        }
    }

    #[test]
    fn an_essential_matrix_moves_by_five_numbers() {
        let (seen, frames, f) = (seen(0.02), frames(), estimate().essential());
        let loss = Biweight { width_squared: 1e6 };
        let of =
            |kind| SampsonLoss { kind, seen: &seen, frames: &frames, loss, every: 1 }.equations(&f, None);
        let all = of(Matrix::Fundamental).expect("equations");
        let five = of(Matrix::Essential).expect("equations");
        assert!(five.right[..5] == all.right[..5] && five.right[5..] == [0.0; 2]);
        for (i, j) in (0..FREE).flat_map(|i| (0..FREE).map(move |j| (i, j))) {
            let expected = if i.max(j) < 5 { all.matrix[i][j] } else { f64::from(u8::from(i == j)) };
            assert_eq!(five.matrix[i][j], expected, "{i} {j}");
        }
    }

    #[test]
    fn every_third_counts_where_that_is_asked_for() {
        let (seen, frames) = (seen(0.02), frames());
        let cost = |seen: &[Correspondence<f64>], every: usize| {
            let loss = Biweight { width_squared: 4.0 };
            let problem = SampsonLoss { kind: Matrix::Fundamental, seen, frames: &frames, loss, every };
            problem.equations(&estimate(), None).expect("equations").cost
        };
        let third = [seen[0], seen[3], seen[6], seen[9]];
        assert_eq!(cost(&seen, 3), cost(&third, 1));
    }

    #[test]
    fn the_distance_is_sampsons_in_pixels() {
        let (seen, frames, f) = (seen(3.0), frames(), estimate());
        let loss = Biweight { width_squared: 1e9 };
        let problem = SampsonLoss { kind: Matrix::Fundamental, seen: &seen, frames: &frames, loss, every: 1 };
        let in_pixels = frames[0].matrix().tr_mul(&(f.matrix() * frames[1].matrix()));
        let mut of_seen = seen.iter();
        problem.for_each_beside(&f.matrix(), |beside| {
            let s = of_seen.next().expect("one for each");
            let (squared, steep) = crate::geometry::robust::sprt::sampson(&in_pixels, s);
            let (expected, found) = (squared / steep, beside.residual * beside.residual * beside.per_steep);
            assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        });
        assert!(of_seen.next().is_none());
    }

    #[test]
    fn what_is_off_by_more_than_the_width_has_no_weight() {
        let (seen, frames) = (seen(3.0), frames());
        let problem = |width_squared: f64| {
            let loss = Biweight { width_squared };
            let problem =
                SampsonLoss { kind: Matrix::Fundamental, seen: &seen, frames: &frames, loss, every: 1 };
            let mut count = 0;
            problem.for_each_beside(&estimate().matrix(), |beside| {
                let share = beside.residual * beside.residual * beside.per_steep / width_squared;
                let left = 1.0 - share;
                assert!((beside.gain - left.powi(3)).abs() < 1e-12);
                assert!((beside.weight - left.powi(2)).abs() < 1e-12);
                count += 1;
            });
            count
        };
        // Two of them are on their lines.
        assert_eq!([1e-9, 1e9].map(problem), [2, 12]);
    }

    #[test]
    fn steps_are_damped_taken_and_refused_by_marquardts_rules() {
        let (seen, frames) = (seen(0.02), frames());
        let loss = Biweight { width_squared: 4.0 };
        let problem = SampsonLoss { kind: Matrix::Fundamental, seen: &seen, frames: &frames, loss, every: 1 };
        assert!(problem.is_better(-3.0, -3.5) && !problem.is_better(-3.0, -3.0));
        assert!(!problem.is_better(-3.0, -2.5));
        // A tenth after each step, a millionth at least; sixteen times as much after one that is none.
        assert!((problem.after_taken(0.5) - 0.05).abs() < 1e-15 && problem.after_taken(2e-6) == 1e-6);
        assert_eq!(problem.after_refused(0.5, &along(3, -0.1)), Some(8.0));
        // It has settled when the gain grows by no more than a ten millionth of it.
        let settled = [0.0, 0.9e-6, 1.1e-6, 1.0].map(|more| problem.is_settled(-10.0, -10.0 - more));
        assert_eq!(settled, [true, true, false, false]);
        // A step of 1.5e-10 is one to rounding: a smaller one than that is not tried.
        let tried = [0.0, 1e-10, 2e-10, f64::INFINITY, f64::NAN]
            .map(|by| problem.after_refused(1.0, &along(2, by)).is_some());
        assert_eq!(tried, [false, false, true, false, false]);
    }

    #[test]
    fn in_f32_rounding_settles_it() {
        let seen: [_; 12] = seen(0.02)
            .map(|s| Correspondence { first: s.first.cast::<f32>(), second: s.second.cast::<f32>() });
        let frames = Frame::of_points(&seen).expect("points that are apart");
        let loss = Biweight { width_squared: 4.0_f32 };
        let problem = SampsonLoss { kind: Matrix::Fundamental, seen: &seen, frames: &frames, loss, every: 1 };
        // Four times the rounding of 10 is 4.8e-6, a ten millionth would be 1e-6.
        let settled = [3.8e-6, 5.8e-6].map(|more| problem.is_settled(-10.0, -10.0 - more));
        assert_eq!(settled, [true, false]);
    }

    #[test]
    fn a_refinement_ends_where_its_matches_are() {
        // From an estimate that is off: all twenty steps, or none at all.
        let (seen, frames) = (seen(0.0), frames());
        let loss = Biweight { width_squared: 1e4 };
        let start = estimate().moved(&[0.02, -0.01, 0.015, -0.02, 0.01, 0.02, -0.03]);
        let refine = |steps: usize| {
            let found = refine(start, Matrix::Fundamental, &seen, &frames, loss, (0, steps)).matrix();
            let truth = estimate().matrix();
            (found - truth).amax().min((found + truth).amax())
        };
        let off = (start.matrix() - estimate().matrix()).amax();
        assert!(refine(0) == off && refine(1) < 0.5 * off && refine(20) < 1e-6, "{off} {}", refine(20));
    }

    #[test]
    fn slopes_are_right_far_from_the_lines() {
        // Up to eight pixels off, the derivative is taken where the points belong.
        let (seen, frames, f) = (seen(8.0), frames(), estimate());
        let loss = Biweight { width_squared: 400.0 };
        let problem = SampsonLoss { kind: Matrix::Fundamental, seen: &seen, frames: &frames, loss, every: 1 };
        let cost = |step: &[f64; FREE]| problem.last_equations(&f.moved(step), None).expect("a cost").cost;
        let equations = problem.equations(&f, None).expect("equations");
        for i in 0..FREE {
            let slope = (cost(&along(i, 1e-6)) - cost(&along(i, -1e-6))) / 2e-6;
            let expected = -6.0 / 400.0 * equations.right[i];
            // Where they were seen, some would be off by twenty times as much.
            let size = equations.matrix[i][i].sqrt();
            assert!((slope - expected).abs() < 2e-4 * size, "{i}: {slope} {expected} {size}");
        }
    }
}
