//! Points by inverse depth with their covariance (Civera, Davison & Montiel 2008).

use super::whitening::{PointObservation, Whitener};
use crate::geometry::linear::columns3;
use crate::geometry::{Real, camera::Pose, linear::skew};
use nalgebra::{ArrayStorage, Matrix3, Matrix6, SMatrix, Vector3};

/// A point as `(x, y, r) = (X / Z, Y / Z, 1 / Z)`, which is finite for points at infinity, and in which what
/// both cameras of a rectified pair see is linear (Civera, Davison & Montiel 2008 have the same with a point
/// of reference); with its covariance.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct InversePoint<T: Real> {
    pub at: Vector3<T>,
    pub covariance: Matrix3<T>,
}

/// A point from another camera.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moved<T: Real> {
    /// Three numbers of the point in the other camera.
    pub at: Vector3<T>,
    /// Jacobian by the numbers in this camera.
    pub by_point: Matrix3<T>,
    /// Jacobian by a rotation and a step of the other camera along its own axes.
    pub by_pose: SMatrix<T, 3, 6>,
}

/// Points whose observation would be wider than this are not followed: 1/8 is 83 degrees from the axis.
const LEAST_FORWARD: f64 = 0.125;

impl<T: Real> InversePoint<T> {
    /// All zeros.
    pub const ZERO: Self = {
        let o = T::ZERO;
        Self { at: Vector3::new(o, o, o), covariance: Matrix3::new(o, o, o, o, o, o, o, o, o) }
    };

    /// A point of unknown depth on this ray: its inverse depth is `usual_inverse`, and uncertain by as much.
    pub fn of_unknown_depth(ray: &Vector3<T>, usual_inverse: T, sigma: T) -> Self {
        let (variance, of_depth) = (sigma * sigma, usual_inverse * usual_inverse);
        let covariance = Matrix3::from_diagonal(&Vector3::new(variance, variance, of_depth));
        Self { at: Vector3::new(ray.x, ray.y, usual_inverse), covariance }
    }

    /// The point as if it were at infinity.
    pub fn at_infinity(&self, sigma: T) -> Self {
        let variance = sigma * sigma;
        let covariance = Matrix3::from_diagonal(&Vector3::new(variance, variance, T::ZERO));
        Self { at: Vector3::new(self.at.x, self.at.y, T::ZERO), covariance }
    }

    /// The point as a camera sees it that stands at `pose` (P = R P' + t); `None` behind it.
    ///
    /// `h = R^T ((x, y, 1) - r t)` is the point over its old depth: `x' = h_x / h_z`, `y' = h_y / h_z`, `r' =
    /// r / h_z`. The camera's turn w and step d are `P' = exp(-[w]x) P' - d`, so that `dh/dw = [h]x` and
    /// `dh/dd = -r`.
    ///
    /// Where the depth is no more than noise the step has no slope: squares of noise would look like
    /// knowledge of it.
    pub fn moved(&self, pose: &Pose<T>) -> Option<Moved<T>> {
        let (x, y, r) = (self.at.x, self.at.y, self.at.z);
        let back = pose.rotation().transpose();
        let step = back * pose.translation();
        let h = back * Vector3::new(x, y, T::ONE) - step * r;
        if !(h.z > T::of(LEAST_FORWARD)) {
            return None;
        }
        let by = T::ONE / h.z;
        let at = Vector3::new(h.x * by, h.y * by, r * by);
        let o = T::ZERO;
        let by_h = Matrix3::new(by, o, -at.x * by, o, by, -at.y * by, o, o, -at.z * by);
        let columns = Matrix3::new(
            back.m11, back.m12, -step.x, back.m21, back.m22, -step.y, back.m31, back.m32, -step.z,
        );
        let mut by_point = by_h * columns;
        by_point.m33 += by;
        let step = if self.is_near() { by_h * -r } else { Matrix3::zeros() };
        let ([a, b, c], [d, e, f]) = (columns3(&(by_h * skew(&h))), columns3(&step));
        let by_pose =
            SMatrix::<T, 3, 6>::from_array_storage(ArrayStorage([a, b, c, d, e, f].map(|v| [v.x, v.y, v.z])));
        Some(Moved { at, by_point, by_pose })
    }

    /// Whether the point is nearer than infinity, to three deviations.
    pub fn is_near(&self) -> bool {
        let r = self.at.z;
        r > T::ZERO && r * r > self.covariance.m33 * T::of(9.0)
    }

    /// The point in the frame of a camera at `pose`, whose own covariance makes it less sure.
    pub fn carried(&self, pose: &Pose<T>, of_pose: &Matrix6<T>) -> Option<Self> {
        let moved = self.moved(pose)?;
        let covariance = moved.by_point * self.covariance * moved.by_point.transpose()
            + moved.by_pose * of_pose * moved.by_pose.transpose();
        Some(Self { at: moved.at, covariance })
    }

    /// The point after it was seen from a camera whose pose is taken for exact: the likeliest one by Gauss
    /// and Newton's method on both what was known and what is seen (an iterated Kalman update; Bell &
    /// Cathey 1993), three steps.
    pub fn updated(&self, pose: &Pose<T>, observation: &PointObservation<T>, baseline: T) -> Option<Self> {
        let mut at = self.at;
        let mut covariance = self.covariance;
        for _ in 0..3 {
            let moved = Self { at, covariance }.moved(pose)?;
            let slope = seen(baseline) * moved.by_point;
            let whitener = Whitener::of(&slope, &self.covariance, observation)?;
            // The innovation around the point that was known.
            let off = observation.at - seen(baseline) * moved.at - slope * (self.at - at);
            // C J^T S^-1 = (L^-1 J C)^T L^-1.
            let gain = whitener.apply(&(slope * self.covariance));
            at = self.at + gain.tr_mul(&whitener.apply(&off));
            covariance = self.covariance - gain.tr_mul(&gain);
        }
        // What rounding left of the two triangles, and of the diagonal.
        covariance = (covariance + covariance.transpose()) * T::of(0.5);
        let floor = observation.sigma * observation.sigma * T::of(1e-4);
        covariance += Matrix3::identity() * floor;
        at.iter().all(|x| x.is_finite()).then_some(Self { at, covariance })
    }
}

/// From a point's three numbers to what is seen of it: the disparity is `b r`.
pub(super) fn seen<T: Real>(baseline: T) -> Matrix3<T> {
    let (o, l) = (T::ZERO, T::ONE);
    Matrix3::new(l, o, o, o, l, o, o, o, baseline)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: f64, b: f64) {
        assert!((a - b).abs() < 1e-7, "{a} {b}");
    }

    fn point(variances: [f64; 3]) -> InversePoint<f64> {
        InversePoint {
            at: Vector3::new(0.25, 0.0, 0.25),
            covariance: Matrix3::from_diagonal(&Vector3::from(variances)),
        }
    }

    #[test]
    fn a_step_of_one_towards_a_point_four_ahead() {
        // (1, 0, 4) is (1, 0, 3) from there.
        let pose = Pose::of_parts(Matrix3::identity(), Vector3::new(0.0, 0.0, 1.0));
        let moved = point([1e-8; 3]).moved(&pose).expect("before it");
        near(moved.at.x, 1.0 / 3.0);
        near(moved.at.z, 1.0 / 3.0);
        // x' = x / (1 - r) and r' = r / (1 - r).
        near(moved.by_point.m11, 4.0 / 3.0);
        near(moved.by_point.m33, 16.0 / 9.0);
        // Behind it, and too far to the side.
        let beyond = Pose::of_parts(Matrix3::identity(), Vector3::new(0.0, 0.0, 3.9));
        assert!(point([1e-8; 3]).moved(&beyond).is_none());
    }

    #[test]
    fn two_that_are_as_sure_meet_in_the_middle() {
        // The point and the observation have a variance of 4e-4: half the way, half the variance, and 4e-8
        // for rounding.
        let observation = PointObservation { at: Vector3::new(0.27, 0.0, 0.0), in_right: false, sigma: 0.02 };
        let point = point([4e-4, 4e-4, 1e-4]).updated(&Pose::identity(), &observation, 0.0).expect("numbers");
        near(point.at.x, 0.26);
        near(point.at.z, 0.25);
        near(point.covariance.m11, 2e-4 + 4e-8);
        near(point.covariance.m33, 1e-4 + 4e-8);
    }

    #[test]
    fn a_disparity_tells_the_depth() {
        // b r = 0.125 of a variance of 0.5^2 x 16e-4 = 4e-4, as the observation's: r by half of 0.01 / 0.5.
        let observation =
            PointObservation { at: Vector3::new(0.25, 0.0, 0.135), in_right: true, sigma: 0.02 };
        let point =
            point([4e-4, 4e-4, 16e-4]).updated(&Pose::identity(), &observation, 0.5).expect("numbers");
        near(point.at.z, 0.26);
        near(point.covariance.m33, 8e-4 + 4e-8);
    }
}
