//! Problems of bundle adjustment in the format of "Bundle Adjustment in the Large" (Agarwal et al. 2010),
//! which others write too.
//!
//! A file holds numbers between white space: how many cameras, points and observations there are; for each
//! observation its camera, its point, and where it is seen, px from the image's centre, right and up; for
//! each camera its rotation vector, translation, focal length, k1 and k2, `P' = R P + t`, Z backward; for
//! each point its three coordinates.
//!
//! * [`read_problem`], with [`BalError`] for what is wrong. [`BalProblem::write`].
//! * [`BalProblem::start`]: through the core's bundle adjustment.

mod error;
mod read;
mod solve;

pub use error::{BalError, BalFault};
pub use read::read_problem;
pub use solve::Running;

use nalgebra::{Matrix3, Point3, Rotation3, UnitQuaternion, Vector3};
use std::io::{self, Write};
use stereopsis::geometry::camera::Pose;
use stereopsis::motion::bundle::{Loss, Observation, RadialView, View};

/// Cameras, points and what the cameras see of them.
#[derive(Clone, PartialEq, Debug)]
pub struct BalProblem {
    /// The cameras: Y down, Z forward.
    pub views: Vec<RadialView<f64>>,
    /// The points.
    pub points: Vec<Point3<f64>>,
    /// The observations, those of a point together, rows downward.
    pub observations: Vec<Observation<f64>>,
    /// Which line of the file each was, from 0.
    order: Vec<u32>,
}

/// Between axes with Y down and Z forward and those with Y up and Z backward.
fn turned_over() -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0))
}

/// A camera of nine numbers.
fn view([a, b, c, x, y, z, focal_px, k1, k2]: [f64; 9]) -> RadialView<f64> {
    // By way of a quaternion: a rotation to the last digit, of any angle.
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(a, b, c)).to_rotation_matrix();
    let into_camera = turned_over() * turn.matrix();
    let centre = -(into_camera.transpose() * (turned_over() * Vector3::new(x, y, z)));
    // A product of rotations is refused only where a number is not finite, which the reader has seen to.
    let pose = Pose::new(into_camera.transpose(), centre).unwrap_or_else(|_| Pose::identity());
    RadialView { pose, focal_px, k1, k2 }
}

/// The nine numbers of a camera.
fn numbers(view: &RadialView<f64>) -> [f64; 9] {
    let into_camera = turned_over() * view.pose.rotation().transpose();
    let turn =
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(into_camera)).scaled_axis();
    let t = -(into_camera * view.pose.translation());
    [turn.x, turn.y, turn.z, t.x, t.y, t.z, view.focal_px, view.k1, view.k2]
}

impl BalProblem {
    /// A problem of parts; observations in any order.
    pub fn new(
        views: Vec<RadialView<f64>>,
        points: Vec<Point3<f64>>,
        observations: &[Observation<f64>],
    ) -> Self {
        let mut order: Vec<u32> = (0..observations.len() as u32).collect();
        order.sort_by_key(|&at| observations[at as usize].point);
        let observations = order.iter().map(|&at| observations[at as usize]).collect();
        Self { views, points, observations, order }
    }

    /// Half the loss of all observations, px^2; infinite where a point is not seen.
    pub fn cost(&self, loss: &Loss<f64>) -> f64 {
        let of = |observation: &Observation<f64>| {
            let seen = self.views[usize::from(observation.view)]
                .project(0, &self.points[observation.point as usize]);
            seen.map_or(f64::INFINITY, |seen| loss.of((seen - observation.pixel).norm_squared()))
        };
        0.5 * self.observations.iter().map(of).sum::<f64>()
    }

    /// Writes the problem in the file's format, the observations as and where they were read.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "{} {} {}", self.views.len(), self.points.len(), self.observations.len())?;
        let mut lines = vec![&self.observations[..0]; self.observations.len()];
        for (n, &at) in self.order.iter().enumerate() {
            lines[at as usize] = &self.observations[n..=n];
        }
        for observation in lines.into_iter().flatten() {
            writeln!(
                out,
                "{} {} {:e} {:e}",
                observation.view, observation.point, observation.pixel.x, -observation.pixel.y
            )?;
        }
        for number in
            self.views.iter().flat_map(numbers).chain(self.points.iter().flat_map(|p| [p.x, p.y, p.z]))
        {
            writeln!(out, "{number:e}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_before_and_above() {
        // Without a turn, two units back: (1, 2, -4) is (1, 2, -6) there, seen at 600 / 6 to the right and
        // 1200 / 6 up.
        let view = view([0.0, 0.0, 0.0, 0.0, 0.0, -2.0, 600.0, 0.0, 0.0]);
        let pixel = view.project(0, &Point3::new(1.0, 2.0, -4.0)).expect("seen");
        assert!((pixel.x - 100.0).abs() < 1e-12 && (pixel.y + 200.0).abs() < 1e-12, "{pixel}");
    }

    #[test]
    fn numbers_come_back() {
        for turn in [0.0, 1e-9, 0.5, std::f64::consts::PI - 1e-7] {
            let given = [0.48 * turn, -0.64 * turn, 0.6 * turn, 1.0, -2.0, 3.0, 500.0, 1e-3, -1e-6];
            let back = numbers(&view(given));
            assert!(given.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-12), "{given:?} {back:?}");
        }
    }
}
