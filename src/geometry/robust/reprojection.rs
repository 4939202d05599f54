//! Re-projection errors of landmarks: their robust gain, and the pose of most gain by Gauss-Newton.

use super::loss::{Biweight, weight_and_gain};
use crate::geometry::Real;
use crate::geometry::absolute::Landmark;
use crate::geometry::camera::Pose;
use crate::geometry::linear::{LeastSquares, NormalEquations, levenberg_marquardt, skew};
use nalgebra::{Matrix3, Vector3};

/// The re-projection errors of landmarks, over a rotation and a step along the camera's axes.
pub(super) struct Reprojection<'a, T: Real> {
    pub(super) landmarks: &'a [Landmark<T>],
    pub(super) k: Matrix3<T>,
    pub(super) inverse: Matrix3<T>,
    pub(super) loss: Biweight<T>,
}

impl<T: Real> Reprojection<'_, T> {
    /// The squared distance of a landmark's projection from its pixel, px^2; `None` behind the camera.
    #[inline(always)]
    pub(super) fn squared(&self, pose: &Pose<T>, landmark: &Landmark<T>) -> Option<T> {
        let p = self.k * pose.inverse_transform(&landmark.world).coords;
        if !(p.z > T::ZERO) {
            return None;
        }
        let by = T::ONE / p.z;
        let (x, y) = (p.x * by - landmark.pixel.x, p.y * by - landmark.pixel.y);
        Some(x * x + y * y)
    }

    /// The sum of the loss's gains, if it is more than `best`.
    pub(super) fn gain(&self, pose: &Pose<T>, best: T) -> Option<T> {
        let per_width = T::ONE / self.loss.width_squared;
        let mut ahead = T::count(self.landmarks.len());
        let mut gain = T::ZERO;
        for landmark in self.landmarks {
            ahead -= T::ONE;
            gain += self.squared(pose, landmark).map_or(T::ZERO, |e| gain_of(e * per_width));
            if gain + ahead <= best {
                return None;
            }
        }
        (gain > best).then_some(gain)
    }

    /// How many landmarks are within a threshold, and the sum of their squared distances.
    pub(super) fn within(&self, pose: &Pose<T>, threshold_px: T) -> (usize, T) {
        let squared = self.landmarks.iter().filter_map(|landmark| self.squared(pose, landmark));
        let near = squared.filter(|&e| e <= threshold_px * threshold_px);
        near.fold((0, T::ZERO), |(count, sum), e| (count + 1, sum + e))
    }

    /// The pose after some steps of Gauss-Newton, each of which makes the gain larger, and the weighted
    /// information at it, px^-2.
    pub(super) fn refined(&self, start: Pose<T>, steps: usize) -> (Pose<T>, [[T; 6]; 6]) {
        let none = [[T::ZERO; 6]; 6];
        let found = levenberg_marquardt(self, start, steps);
        found.map_or((start, none), |(pose, equations)| (pose, equations.matrix))
    }
}

/// The gain of a landmark with this share of the squared width.
fn gain_of<T: Real>(share: T) -> T {
    weight_and_gain(share.min(T::ONE)).1
}

impl<T: Real> LeastSquares<T, 6> for Reprojection<'_, T> {
    type Estimate = Pose<T>;

    const FIRST_DAMPING: f64 = 0.0;

    fn equations(&self, pose: &Pose<T>, bound: Option<T>) -> Option<NormalEquations<T, 6>> {
        let per_width = T::ONE / self.loss.width_squared;
        let mut ahead = T::count(self.landmarks.len());
        let mut gain = T::ZERO;
        let (mut matrix, mut right) = ([[T::ZERO; 6]; 6], [T::ZERO; 6]);
        for landmark in self.landmarks {
            ahead -= T::ONE;
            let p = pose.inverse_transform(&landmark.world).coords;
            let seen = self.k * p;
            if seen.z > T::ZERO {
                let by = T::ONE / seen.z;
                let (u, v) = (seen.x * by, seen.y * by);
                let (du, dv) = (landmark.pixel.x - u, landmark.pixel.y - v);
                let squared = du * du + dv * dv;
                gain += gain_of(squared * per_width);
                let share = squared / self.loss.width_squared;
                if share < T::ONE {
                    let (weight, _) = weight_and_gain(share);
                    // P' = exp(-[w]x) P' - d, so that its Jacobian by w and d is [P']x and -1.
                    let cross = skew(&p);
                    let k = &self.k;
                    for (across, at, error) in [
                        (Vector3::new(k.m11, k.m12, k.m13), u, du), //
                        (Vector3::new(k.m21, k.m22, k.m23), v, dv),
                    ] {
                        let by_point = (across - Vector3::new(k.m31, k.m32, k.m33) * at) * by;
                        let by_turn = cross.tr_mul(&by_point);
                        let j = [by_turn.x, by_turn.y, by_turn.z, -by_point.x, -by_point.y, -by_point.z];
                        for ((row, right), &a) in matrix.iter_mut().zip(&mut right).zip(&j) {
                            *right += a * error * weight;
                            for (sum, &b) in row.iter_mut().zip(&j) {
                                *sum += a * b * weight;
                            }
                        }
                    }
                }
            }
            if bound.is_some_and(|bound| gain + ahead <= -bound) {
                return None;
            }
        }
        Some(NormalEquations { matrix, right, cost: -gain })
    }

    fn moved(&self, from: &Pose<T>, step: &[T; 6]) -> Pose<T> {
        from.moved(step)
    }

    fn is_better(&self, before: T, after: T) -> bool {
        after < before
    }

    fn is_settled(&self, before: T, after: T) -> bool {
        before - after <= -before * T::EPSILON.sqrt()
    }

    fn after_refused(&self, _damping: T, _step: &[T; 6]) -> Option<T> {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Point2, Point3, Rotation3};

    /// A camera with skew, and where it stands.
    fn camera_and_pose() -> (Matrix3<f64>, Pose<f64>) {
        let turn = Rotation3::new(Vector3::new(0.1, -0.2, 0.3));
        let pose = Pose::new(turn.into_inner(), Vector3::new(0.5, -0.1, 0.2)).expect("a rotation");
        (Matrix3::new(500.0, 3.0, 320.0, 0.0, 510.0, 240.0, 0.0, 0.0, 1.0), pose)
    }

    /// Landmarks whose pixels are off by up to `off` px, the last one behind the camera.
    fn landmarks(off: f64) -> [Landmark<f64>; 9] {
        let (k, pose) = camera_and_pose();
        core::array::from_fn(|i| {
            let at = |n: usize, m: usize| (i * n % m) as f64 / m as f64 - 0.4;
            let z = if i == 8 { -2.0 } else { 3.0 + at(5, 7) };
            let point = Vector3::new(2.0 * at(3, 8), at(5, 9), z);
            let seen = k * point;
            let pixel = Point2::new(seen.x / z + off * at(4, 7), seen.y / z - off * at(2, 5));
            Landmark { world: pose.transform(&Point3::from(point)), pixel }
        })
    }

    fn problem(landmarks: &[Landmark<f64>]) -> Reprojection<'_, f64> {
        let (k, _) = camera_and_pose();
        let inverse = k.try_inverse().expect("focal lengths");
        Reprojection { landmarks, k, inverse, loss: Biweight { width_squared: 25.0 } }
    }

    fn along(axis: usize, by: f64) -> [f64; 6] {
        core::array::from_fn(|i| if i == axis { by } else { 0.0 })
    }

    #[test]
    fn the_right_side_is_the_slope_of_the_gain() {
        let (landmarks, (_, pose)) = (landmarks(8.0), camera_and_pose());
        let problem = problem(&landmarks);
        let equations = problem.equations(&pose, None).expect("no bound");
        let gain = |pose: &Pose<f64>| problem.gain(pose, 0.0).expect("more than nothing");
        assert!((equations.cost + gain(&pose)).abs() < 1e-12);
        for axis in 0..6 {
            let moved = |by: f64| gain(&pose.moved(&along(axis, by)));
            let slope = (moved(1e-6) - moved(-1e-6)) / 2e-6;
            // Of (1 - e / w^2)^3 the slope is 6 / w^2 times the weighted residual's.
            let expected = equations.right[axis] * 6.0 / 25.0;
            assert!((slope - expected).abs() < 1e-5 * (1.0 + expected.abs()), "{axis}: {slope} {expected}");
        }
    }

    #[test]
    fn the_matrix_is_the_curvature_of_the_squares() {
        let (landmarks, (_, pose)) = (landmarks(0.0), camera_and_pose());
        let problem = problem(&landmarks);
        let equations = problem.equations(&pose, None).expect("no bound");
        let squares = |step: &[f64; 6]| problem.within(&pose.moved(step), 5.0).1;
        for (i, row) in equations.matrix.iter().enumerate() {
            for (j, &element) in row.iter().enumerate() {
                // Of squares of x_i + x_j and of x_i - x_j.
                let by = |other: f64| {
                    let (one, two) = (along(i, 1e-5), along(j, other));
                    squares(&core::array::from_fn(|k| one[k] + two[k]))
                };
                let expected = (by(1e-5) - by(-1e-5)) / 4e-10;
                let size = (equations.matrix[i][i] * equations.matrix[j][j]).sqrt();
                assert!((element - expected).abs() < 1e-3 * size, "{i} {j}: {element} {expected}");
            }
        }
    }

    #[test]
    fn what_cannot_be_better_is_broken_off() {
        let (landmarks, (_, pose)) = (landmarks(8.0), camera_and_pose());
        let problem = problem(&landmarks);
        let gain = problem.gain(&pose, 0.0).expect("more than nothing");
        assert!(problem.gain(&pose, gain - 1e-9).is_some() && problem.gain(&pose, gain).is_none());
        let equations = |best: f64| problem.equations(&pose, Some(-best));
        assert!(equations(gain - 1e-9).is_some() && equations(gain + 1e-9).is_none());
    }

    #[test]
    fn squares_are_of_pixels_and_none_behind_the_camera() {
        let (landmarks, (k, pose)) = (landmarks(8.0), camera_and_pose());
        let problem = problem(&landmarks);
        let (mut count, mut sum) = (0, 0.0);
        for landmark in &landmarks[..8] {
            let seen = k * pose.inverse_transform(&landmark.world).coords;
            let squared = (seen.xy() / seen.z - landmark.pixel.coords).norm_squared();
            let found = problem.squared(&pose, landmark).expect("before the camera");
            assert!((found - squared).abs() < 1e-9, "{found} {squared}");
            if squared <= 9.0 {
                (count, sum) = (count + 1, sum + squared);
            }
        }
        assert_eq!(problem.squared(&pose, &landmarks[8]), None);
        let (found, squares) = problem.within(&pose, 3.0);
        assert!(found == count && (squares - sum).abs() < 1e-9 && (1..8).contains(&count), "{found} {count}");
    }

    #[test]
    fn a_step_is_taken_while_the_gain_grows() {
        let landmarks = landmarks(8.0);
        let problem = problem(&landmarks);
        assert!(problem.is_better(-3.0, -3.5) && !problem.is_better(-3.0, -3.0));
        assert!(!problem.is_better(-3.0, -2.5));
        // It has settled when the gain grows by no more than 1.5e-8 of it.
        let settled = [0.0, 1e-7, 2e-7, 1.0].map(|more| problem.is_settled(-10.0, -10.0 - more));
        assert_eq!(settled, [true, true, false, false]);
        // Gauss and Newton have no shorter step.
        assert_eq!(problem.after_refused(1.0, &along(0, 1.0)), None);
    }

    #[test]
    fn a_pose_is_refined_to_the_landmarks() {
        let (landmarks, (_, pose)) = (landmarks(0.0), camera_and_pose());
        let problem = problem(&landmarks);
        let start = pose.moved(&[2e-3, -1e-3, 1e-3, 2e-3, 1e-3, -3e-3]);
        let (found, information) = problem.refined(start, 12);
        assert!((found.translation() - pose.translation()).norm() < 1e-9, "{found:?}");
        assert!((found.rotation() - pose.rotation()).amax() < 1e-9, "{found:?}");
        let there = problem.equations(&found, None).expect("no bound").matrix;
        for (row, expected) in information.iter().flatten().zip(there.iter().flatten()) {
            assert!((row - expected).abs() < 1e-6 * (1.0 + expected.abs()), "{row} {expected}");
        }
        assert_eq!(problem.refined(start, 0).0, start);
    }

    #[test]
    fn what_is_off_by_the_threshold_is_within_it() {
        let (k, pose) = camera_and_pose();
        let world = pose.transform(&Point3::new(0.0, 0.0, 2.0));
        let centre = k * Vector3::new(0.0, 0.0, 1.0);
        let off = [0.0, 2.9, 3.1].map(|by| Landmark { world, pixel: Point2::new(centre.x + by, centre.y) });
        let (count, sum) = problem(&off).within(&pose, 3.0);
        assert!(count == 2 && (sum - 2.9 * 2.9).abs() < 1e-9, "{count} {sum}");
    }
}
