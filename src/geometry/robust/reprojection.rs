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
