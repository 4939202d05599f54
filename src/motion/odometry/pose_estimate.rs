//! Pose of a frame by robust maximum likelihood: Levenberg-Marquardt with a biweight (Beaton & Tukey 1974).

use super::inverse_depth::{InversePoint, seen};
use super::whitening::{PointObservation, Whitener};
use crate::geometry::Real;
use crate::geometry::camera::Pose;
use crate::geometry::linear::{LeastSquares, NormalEquations, levenberg_marquardt};
use crate::geometry::robust::weight_and_gain;
use nalgebra::{SMatrix, Vector3};

/// A point and where the new camera sees it.
#[derive(Clone, Copy, Debug)]
pub struct PointMatch<T: Real> {
    pub(super) point: InversePoint<T>,
    pub(super) observation: PointObservation<T>,
    /// How much lower the right picture shows it than the left one, px, where the right camera sees it.
    pub(super) lower_px: f32,
    /// Whose point it is.
    pub(super) owner: u16,
}

impl<T: Real> PointMatch<T> {
    /// Not in use. All zeros.
    pub const EMPTY: Self =
        Self { point: InversePoint::ZERO, observation: PointObservation::ZERO, lower_px: 0.0, owner: 0 };

    /// The match as it is where the right camera is not believed: without its observation, and with so much
    /// more variance of the inverse depth. With none it stays as it is.
    #[inline]
    pub(super) fn doubted(&self, doubt: T) -> Self {
        let mut doubted = *self;
        if doubt > T::ZERO {
            doubted.observation.in_right = false;
            doubted.point.covariance.m33 += doubt;
        }
        doubted
    }
}

/// What of the pose is looked for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Free {
    /// Turn and step.
    All,
    /// The turn alone.
    Rotation,
    /// Nothing: the pose is judged.
    Nothing,
}

/// A pose, and what the matches say of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Solved<T: Real> {
    pub pose: Pose<T>,
    /// The information in units of the observations' deviations.
    pub information: [[T; 6]; 6],
    /// The sum of the robust loss `w^2 / 3 (1 - (1 - d^2 / w^2)^3)`, which is d^2 for small distances d.
    pub cost: T,
    /// Matches within the loss's width, the numbers in their observations, and the sum of their squared
    /// distances.
    pub kept: usize,
    pub numbers: usize,
    pub squares: T,
}

/// The least number of inliers that make a pose.
pub(super) const FEWEST: usize = 8;
/// Distances, in deviations, at which a match has no weight any more: from far to near.
const WIDTHS: [f64; 3] = [12.0, 7.0, 4.5];
/// Steps for each width at most.
const STEPS: usize = 6;
/// The last width.
pub(super) const WIDTH: f64 = WIDTHS[2];

impl<T: Real> Solved<T> {
    /// The root mean square of the inliers' residuals in deviations, where `free` numbers were estimated.
    pub fn residual(&self, free: usize) -> T {
        (self.squares / T::count(self.numbers.saturating_sub(free).max(1))).sqrt()
    }
}

/// The matches of a frame, and the baseline by which their disparities are measured.
pub(super) struct Problem<'a, T: Real> {
    pub matches: &'a [PointMatch<T>],
    pub baseline: T,
    /// The variance that inverse depths have beside their own where the right camera is not believed: none of
    /// its observations counts then. Zero where it is.
    pub doubt: T,
}

impl<T: Real> Problem<'_, T> {
    /// The likeliest pose near a start: each match's distance is in units of the observation's noise
    /// and the point's own uncertainty together, which to first order is as if points and pose were found
    /// together.
    pub fn solve(&self, start: Pose<T>, free: Free) -> Solved<T> {
        let mut pose = start;
        if free != Free::Nothing {
            for width in WIDTHS.map(T::of) {
                let descent = Descent { problem: self, width, free };
                pose = levenberg_marquardt(&descent, pose, STEPS).map_or(pose, |(pose, _)| pose);
            }
        }
        self.normal(pose, T::of(WIDTH)).0
    }

    fn normal(&self, pose: Pose<T>, width: T) -> (Solved<T>, [T; 6]) {
        let none = [[T::ZERO; 6]; 6];
        let mut sum =
            Solved { pose, information: none, cost: T::ZERO, kept: 0, numbers: 0, squares: T::ZERO };
        let mut slope = [T::ZERO; 6];
        let width_squared = width * width;
        let most = width_squared * T::of(1.0 / 3.0);
        for point_match in self.matches {
            let Some((off, by_pose)) = self.residual(&pose, point_match) else {
                sum.cost += most;
                continue;
            };
            let squared = off.norm_squared();
            let share = squared / width_squared;
            if !(share < T::ONE) {
                sum.cost += most;
                continue;
            }
            let (weight, gain) = weight_and_gain(share);
            sum.cost += most * (T::ONE - gain);
            sum.kept += 1;
            sum.numbers += if self.doubt > T::ZERO { 2 } else { point_match.observation.rows() };
            sum.squares += squared;
            let columns = &by_pose.data.0;
            let rows = [
                (off.x, columns.map(|[x, _, _]| x)),
                (off.y, columns.map(|[_, y, _]| y)),
                (off.z, columns.map(|[_, _, z]| z)),
            ];
            for (error, j) in rows {
                let error = error * weight;
                for ((line, slope), &a) in sum.information.iter_mut().zip(&mut slope).zip(&j) {
                    *slope += a * error;
                    let a = a * weight;
                    line.iter_mut().zip(&j).for_each(|(sum, &b)| *sum += a * b);
                }
            }
        }
        (sum, slope)
    }

    /// How far off an observation is, in deviations, and the slopes of what is expected.
    fn residual(
        &self,
        pose: &Pose<T>,
        point_match: &PointMatch<T>,
    ) -> Option<(Vector3<T>, SMatrix<T, 3, 6>)> {
        let PointMatch { point, observation, .. } = &point_match.doubted(self.doubt);
        let moved = point.moved(pose)?;
        let seen = seen(self.baseline);
        let whitener = Whitener::of(&(seen * moved.by_point), &point.covariance, observation)?;
        let off = observation.at - seen * moved.at;
        Some((whitener.apply(&off), whitener.apply(&(seen * moved.by_pose))))
    }

    /// The squared distance of a match, in deviations.
    pub fn squared(&self, pose: &Pose<T>, point_match: &PointMatch<T>) -> Option<T> {
        self.residual(pose, point_match).map(|(off, _)| off.norm_squared())
    }
}

/// The descent to the likeliest pose with one width of the loss.
struct Descent<'a, T: Real> {
    problem: &'a Problem<'a, T>,
    width: T,
    free: Free,
}

impl<T: Real> LeastSquares<T, 6> for Descent<'_, T> {
    type Estimate = Pose<T>;

    const FIRST_DAMPING: f64 = 1e-6;
    const DIAGONAL_FLOOR: f64 = 1e-3;

    fn equations(&self, pose: &Pose<T>, _bound: Option<T>) -> Option<NormalEquations<T, 6>> {
        let (Solved { information: mut matrix, cost, .. }, mut right) =
            self.problem.normal(*pose, self.width);
        if self.free == Free::Rotation {
            for (i, row) in matrix.iter_mut().enumerate() {
                for (j, x) in row.iter_mut().enumerate().filter(|(j, _)| i >= 3 || *j >= 3) {
                    *x = if i == j { T::ONE } else { T::ZERO };
                }
            }
            right.iter_mut().skip(3).for_each(|x| *x = T::ZERO);
        }
        Some(NormalEquations { matrix, right, cost })
    }

    fn moved(&self, from: &Pose<T>, step: &[T; 6]) -> Pose<T> {
        from.moved(step)
    }

    fn is_better(&self, before: T, after: T) -> bool {
        after < before
    }

    fn is_settled(&self, before: T, after: T) -> bool {
        before - after <= before * T::of(1e-6)
    }

    fn after_refused(&self, damping: T, _step: &[T; 6]) -> Option<T> {
        let damping = damping.max(T::of(1e-6)) * T::of(100.0);
        (damping <= T::of(1e3)).then_some(damping)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;

    /// What a camera at a pose sees of points that are sure.
    fn seen(pose: &Pose<f64>, wrong: usize) -> [PointMatch<f64>; 12] {
        core::array::from_fn(|n| {
            let k = n as f64;
            let at = Vector3::new(0.4 * (k * 1.3).sin(), 0.3 * (k * 2.1).cos(), 0.1 + 0.03 * k);
            let point = InversePoint { at, covariance: Matrix3::identity() * 1e-12 };
            let there = point.moved(pose).map_or(at, |moved| moved.at);
            let off = if n < wrong { 0.2 } else { 0.0 };
            let observation = PointObservation {
                at: Vector3::new(there.x + off, there.y, 0.5 * there.z),
                in_right: true,
                sigma: 1e-3,
            };
            PointMatch { point, observation, lower_px: 0.0, owner: 0 }
        })
    }

    #[test]
    fn the_pose_that_was_and_what_is_wrong_left_out() {
        let truth = Pose::identity().moved(&[0.01, -0.02, 0.005, 0.1, -0.05, 0.3]);
        for wrong in [0, 2] {
            let matches = seen(&truth, wrong);
            let problem = Problem { matches: &matches, baseline: 0.5, doubt: 0.0 };
            let near = truth.moved(&[0.002, 0.001, 0.0, 0.005, 0.0, -0.01]);
            let solved = problem.solve(near, Free::All);
            let off = truth.inverse().then(&solved.pose);
            assert!(off.translation().norm() < 1e-6 && off.angle_rad() < 1e-7, "{wrong}: {off:?}");
            assert_eq!((solved.kept, solved.numbers), (12 - wrong, 3 * (12 - wrong)));
            // What is wrong costs w^2 / 3 each.
            assert!((solved.cost - wrong as f64 * WIDTH * WIDTH / 3.0).abs() < 1e-6, "{}", solved.cost);
        }
    }

    #[test]
    fn a_turn_alone_leaves_the_step() {
        // Within the widest reach, twelve deviations.
        let truth = Pose::identity().moved(&[0.004, -0.003, 0.002, 0.0, 0.0, 0.0]);
        let matches = seen(&truth, 0);
        let problem = Problem { matches: &matches, baseline: 0.5, doubt: 0.0 };
        let solved = problem.solve(Pose::identity(), Free::Rotation);
        assert!(truth.inverse().then(&solved.pose).angle_rad() < 1e-7);
        assert_eq!(solved.pose.translation().norm(), 0.0);
    }
}
