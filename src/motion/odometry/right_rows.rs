//! What rows say of the right camera: least squares over the points that both cameras see.

use super::frame::Moment;
use super::pose_estimate::PointMatch;
use super::right_error::RightError;
use crate::geometry::Real;
use crate::geometry::linear::{Ldl, dot};

/// What an older frame counts beside the next: the last twenty count.
const OLDER: f64 = 0.95;
/// What is known of each of the three numbers before the first frame, one deviation.
const PRIOR: f64 = 0.005;
/// How far off a row counts a quarter, in deviations of a place (Geman & McClure 1987).
const SCALE: f64 = 3.0;

/// Gathers by how much points stand lower in the right picture than in the left one, frame by frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct RightRows<T: Real> {
    /// `sum w A^T A / sigma^2` and `sum w A^T r / sigma^2`.
    information: [[T; 3]; 3],
    vector: [T; 3],
}

impl<T: Real> RightRows<T> {
    /// Before the first frame. All zeros.
    pub const EMPTY: Self = Self { information: [[T::ZERO; 3]; 3], vector: [T::ZERO; 3] };

    /// Adds the points of a frame that both cameras see.
    pub fn add(&mut self, now: &Moment<'_, T>, matches: &[PointMatch<T>]) {
        let (known, sigma, focal) = (self.error(), now.sigma(), now.rig.focal());
        let sums = self.information.iter_mut().flatten().chain(&mut self.vector);
        sums.for_each(|sum| *sum *= T::of(OLDER));
        for found in matches.iter().filter(|found| found.observation.in_right) {
            let at = found.observation.at;
            let slopes = RightError::row_slopes([at.x - at.z, at.y]);
            let lower = T::of(found.lower_px.into()) / focal;
            let off = (lower - dot(&slopes, &known)) / (sigma * T::of(SCALE));
            let near = T::ONE / (T::ONE + off * off);
            let weight = near * near / (sigma * sigma);
            for ((row, vector), &a) in self.information.iter_mut().zip(&mut self.vector).zip(&slopes) {
                row.iter_mut().zip(&slopes).for_each(|(sum, &b)| *sum += a * b * weight);
                *vector += a * lower * weight;
            }
        }
    }

    /// The three numbers that rows show: `row`, `roll` and `scale`.
    pub fn error(&self) -> [T; 3] {
        let mut matrix = self.information;
        let prior = T::ONE / T::of(PRIOR * PRIOR);
        (0..3).for_each(|i| matrix[i][i] += prior);
        Ldl::new(&mut matrix).solve(&self.vector)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::camera::RectifiedRig;
    use crate::imaging::Picture;
    use crate::motion::odometry::config::{OdometryConfig, OdometryRig};
    use crate::motion::odometry::frame::Frame;
    use crate::motion::odometry::inverse_depth::InversePoint;
    use crate::motion::odometry::whitening::PointObservation;
    use nalgebra::Vector3;

    #[test]
    fn what_moves_rows_is_told_apart_and_what_is_wrong_left_out() {
        let rig = RectifiedRig::new(320.0, 0.1, 160.0, 80.0).expect("a rig");
        let rig = OdometryRig::<f64>::stereo(&rig).expect("a camera");
        let frame =
            Frame { left: Picture::new(&[0; 1], 1, 1).expect("a picture"), right: None, features: &[] };
        let now = Moment { rig: &rig, config: &OdometryConfig::new(320), frame: &frame, number: 1 };
        let [row, roll, scale] = [0.002, -0.004, 0.003];
        // Every ninth row is four pixels off.
        let seen: [PointMatch<f64>; 90] = core::array::from_fn(|n| {
            let k = n as f64;
            let [x, y] = [0.45 * (k * 1.3).sin(), 0.22 * (k * 2.1).cos()];
            let wrong = if n % 9 == 0 { 4.0 } else { 0.0 };
            let lower_px = (320.0 * (row + roll * x + scale * y) + wrong) as f32;
            let (at, in_right) = (Vector3::new(x + 0.02, y, 0.02), n != 44);
            let observation = PointObservation { at, in_right, sigma: 1e-3 };
            PointMatch { point: InversePoint::ZERO, observation, lower_px, owner: 0 }
        });
        let mut rows = RightRows::EMPTY;
        assert_eq!(rows.error(), [0.0; 3]);
        for _ in 0..10 {
            rows.add(&now, &seen);
        }
        let off = rows.error().map(|x| x * 320.0);
        let truth = [row, roll, scale].map(|x| x * 320.0);
        // A weight of 0.003 each, of a ninth of them: 4 px / 9 of it at most.
        assert!(off.iter().zip(&truth).all(|(a, b)| (a - b).abs() < 0.02), "{off:?} {truth:?}");
    }
}
