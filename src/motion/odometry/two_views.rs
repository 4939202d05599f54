//! Equations of two views of a pair: its motion between them and its right camera's error, as least squares.

use super::inverse_depth::{InversePoint, seen};
use super::pose_estimate::{PointMatch, WIDTH};
use super::right_error::RightError;
use super::track::Track;
use super::whitening::{PointObservation, Whitener};
use crate::geometry::linear::{LeastSquares, NormalEquations};
use crate::geometry::robust::weight_and_gain;
use crate::geometry::{Real, camera::Pose};
use nalgebra::{Matrix3, SMatrix, Vector3};

/// Points that two views of a pair see, from the view that they are anchored in to that of the matches.
pub(super) struct PairOfViews<'a, T: Real> {
    pub tracks: &'a [Track<T>],
    pub matches: &'a [PointMatch<T>],
    pub baseline: T,
    /// The standard deviation of each number that is seen.
    pub sigma: T,
    /// What is known of the right camera before; what its rows say is not asked again.
    pub mean: RightError<T>,
    /// The information on the two numbers that move columns alone.
    pub information: [[T; 2]; 2],
}

/// A residual of three numbers in deviations, and its slopes by a turn, a step and the two numbers that
/// move columns alone.
type Residual<T> = (Vector3<T>, SMatrix<T, 3, 6>, SMatrix<T, 3, 2>);

impl<T: Real> PairOfViews<'_, T> {
    /// What the two views see of the points that both see in both pictures.
    pub fn common(&self) -> impl Iterator<Item = (Vector3<T>, &PointObservation<T>)> {
        self.matches.iter().filter(|found| found.observation.in_right).filter_map(|found| {
            let track = self.tracks.get(usize::from(found.owner))?;
            track.anchor.filter(|_| track.is_followed()).map(|anchor| (anchor, &found.observation))
        })
    }

    /// The equations of the points alone, how many count, and the sum of their squared residuals.
    pub fn equations_of_points(
        &self,
        pose: &Pose<T>,
        error: &RightError<T>,
    ) -> (NormalEquations<T, 8>, usize, T) {
        let mut sum = NormalEquations::new();
        let (mut kept, mut squares) = (0, T::ZERO);
        let width_squared = T::of(WIDTH * WIDTH);
        let most = width_squared * T::of(1.0 / 3.0);
        for (anchor, observation) in self.common() {
            let found = self.residual(pose, error, &anchor, observation);
            let share = found.as_ref().map_or(T::ONE, |(off, ..)| off.norm_squared() / width_squared);
            let Some((off, by_pose, by_error)) = found.filter(|_| share < T::ONE) else {
                sum.cost += most;
                continue;
            };
            let (weight, gain) = weight_and_gain(share);
            sum.cost += most * (T::ONE - gain);
            kept += 1;
            squares += off.norm_squared();
            let root = weight.sqrt();
            let [a, b, c, d, e, f] = by_pose.data.0;
            let [g, h] = by_error.data.0;
            let columns = [a, b, c, d, e, f, g, h];
            let rows = [
                (off.x, columns.map(|[x, _, _]| x * root)),
                (off.y, columns.map(|[_, y, _]| y * root)),
                (off.z, columns.map(|[_, _, z]| z * root)),
            ];
            rows.iter().for_each(|(error, row)| sum.add(row, *error * root));
        }
        (sum, kept, squares)
    }

    /// How far off the second view's observation is.
    ///
    /// The slopes are those of the point that both views make likeliest: with those of the first view's
    /// alone, its noise would be in both factors of the gradient, and its square would look like an error of
    /// the camera.
    fn residual(
        &self,
        pose: &Pose<T>,
        error: &RightError<T>,
        anchor: &Vector3<T>,
        observation: &PointObservation<T>,
    ) -> Option<Residual<T>> {
        let [first, second] = [anchor, &observation.at].map(|seen| [seen.x - seen.z, seen.y]);
        let variance = self.sigma * self.sigma;
        let of_depth = variance / (self.baseline * self.baseline);
        let r = (anchor.z + error.correction(first)) / self.baseline;
        let point = InversePoint {
            at: Vector3::new(anchor.x, anchor.y, r),
            covariance: Matrix3::from_diagonal(&Vector3::new(variance, variance, of_depth)),
        };
        let mut observation = *observation;
        observation.at.z += error.correction(second);
        let seen_of = seen(self.baseline);
        let moved = point.moved(pose)?;
        let whitener = Whitener::of(&(seen_of * moved.by_point), &point.covariance, &observation)?;
        let off = observation.at - seen_of * moved.at;
        let better = point.updated(pose, &observation, self.baseline)?.moved(pose)?;
        let by_depth = (seen_of * better.by_point).column(2) / self.baseline;
        let [a, b] = RightError::slopes(first[0]).map(|slope| by_depth * slope);
        let [c, d] = RightError::slopes(second[0]);
        let by_error = SMatrix::<T, 3, 2>::new(a.x, b.x, a.y, b.y, a.z - c, b.z - d);
        Some((whitener.apply(&off), whitener.apply(&(seen_of * better.by_pose)), whitener.apply(&by_error)))
    }

    /// Adds what was known before to equations about `at`.
    pub fn add_prior(&self, equations: &mut NormalEquations<T, 8>, at: &RightError<T>) {
        let off = [self.mean.principal - at.principal, self.mean.yaw - at.yaw];
        let places = equations.matrix.iter_mut().zip(&mut equations.right).skip(6);
        for (((to, right), row), &own) in places.zip(&self.information).zip(&off) {
            let pull = row.iter().zip(&off).fold(T::ZERO, |sum, (&a, &b)| sum + a * b);
            to.iter_mut().skip(6).zip(row).for_each(|(to, &from)| *to += from);
            *right += pull;
            equations.cost += pull * own;
        }
    }
}

impl<T: Real> LeastSquares<T, 8> for PairOfViews<'_, T> {
    type Estimate = (Pose<T>, RightError<T>);

    const FIRST_DAMPING: f64 = 1e-6;
    const DIAGONAL_FLOOR: f64 = 1e-3;

    fn equations(&self, (pose, error): &Self::Estimate, _bound: Option<T>) -> Option<NormalEquations<T, 8>> {
        let (mut sum, ..) = self.equations_of_points(pose, error);
        self.add_prior(&mut sum, error);
        Some(sum)
    }

    fn moved(
        &self,
        (pose, error): &Self::Estimate,
        &[a, b, c, x, y, z, principal, yaw]: &[T; 8],
    ) -> Self::Estimate {
        (pose.moved(&[a, b, c, x, y, z]), error.plus(&RightError { principal, yaw, ..RightError::NONE }))
    }
}
