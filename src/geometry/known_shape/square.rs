//! The pose of a square marker: infinitesimal plane-based pose estimation, IPPE (Collins & Bartoli 2014).

use super::tilts::rotations;
use crate::geometry::Real;
use crate::geometry::camera::{Camera, Pose, ProjectionError};
use crate::geometry::linear::{LeastSquares, NormalEquations, cayley, levenberg_marquardt};
use crate::geometry::two_view::{Correspondence, Homography, HomographyError};
use nalgebra::{Matrix3, Point2, Point3, Vector2, Vector3};

/// A flat square: a marker, a tile, a board.
///
/// Its frame has the origin in its middle, X to the right and Y down for who looks at it, and Z into it: a
/// camera right before it has the same axes.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct SquareMark<T: Real> {
    side_m: T,
}

deserialize_checked! { SquareMark<T> { side_m: T } by |mark| Self::new(mark.side_m) }

/// A pose that a mark may have.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MarkPose<T: Real> {
    /// R and t carry a point of the mark's frame into the camera, m.
    pub pose: Pose<T>,
    /// The re-projection error: the root mean square of the four corners' distances, undistorted px.
    pub rms_px: T,
}

/// The poses that a picture of a mark may mean.
///
/// A small or distant square looks nearly the same when it is tilted the other way about its line of sight.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MarkPoses<T: Real> {
    /// The pose with the smaller re-projection error.
    pub best: MarkPose<T>,
    /// The pose with the larger error; `None` where the two are the same to a milliradian, or it is not
    /// before the camera.
    pub other: Option<MarkPose<T>>,
}

/// Why a mark has no pose.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SquareMarkError {
    /// A number is infinite or not a number.
    NotFinite,
    /// The side is not positive.
    Side,
    /// Three corners are on a line, or two are the same.
    Line,
    /// The corners are no convex quadrilateral.
    NotConvex,
    /// The corners go round against the clock: the mark is seen from behind, or they are in another order.
    Mirrored,
    /// No pose is before the camera.
    Behind,
    /// A pixel has no ray.
    Pixel(ProjectionError),
}

error_text!(SquareMarkError {
    Self::NotFinite => "a number is not finite",
    Self::Side => "the side must be positive",
    Self::Line => "three corners are on a line",
    Self::NotConvex => "the corners are no convex quadrilateral",
    Self::Mirrored => "the corners go round against the clock",
    Self::Behind => "no pose is before the camera",
    Self::Pixel(error) => "{error}",
});

/// Steps of the refinement at most; three or four are enough for any corners that were tried.
const MOST_STEPS: usize = 12;

impl<T: Real> SquareMark<T> {
    /// A square of this side, m.
    pub fn new(side_m: T) -> Result<Self, SquareMarkError> {
        if !side_m.is_finite() {
            return Err(SquareMarkError::NotFinite);
        }
        if !(side_m > T::ZERO) {
            return Err(SquareMarkError::Side);
        }
        Ok(Self { side_m })
    }

    /// The corners in the mark's frame, m: top left, top right, bottom right, bottom left.
    pub fn corners(&self) -> [Point3<T>; 4] {
        let half = self.side_m * T::of(0.5);
        [(-half, -half), (half, -half), (half, half), (-half, half)].map(|(x, y)| Point3::new(x, y, T::ZERO))
    }

    /// The pose of the mark whose corners are seen at four pixels, in the order of [`Self::corners`], px as
    /// the camera gives them.
    ///
    /// Both poses come in closed form from the homography's derivative at the mark's middle (Collins &
    /// Bartoli 2014, "Infinitesimal plane-based pose estimation", 4.1); each is refined to the least
    /// re-projection error by Levenberg-Marquardt, and that error decides between them.
    pub fn locate(
        &self,
        camera: &Camera<T>,
        corners: &[Point2<T>; 4],
    ) -> Result<MarkPoses<T>, SquareMarkError> {
        if !corners.iter().all(|p| p.x.is_finite() && p.y.is_finite()) {
            return Err(SquareMarkError::NotFinite);
        }
        let mut seen = [Point2::origin(); 4];
        for (seen, corner) in seen.iter_mut().zip(corners) {
            *seen = camera.undistort(corner).map_err(SquareMarkError::Pixel)?;
        }
        goes_round(&seen)?;
        let (two, k) = (T::of(2.0), camera.inverse_matrix());
        let [a, b, c, d] = seen.map(|p| (k * p.to_homogeneous()).xy());
        // In half sides, which the homography is best conditioned in.
        let at = |p: Vector2<T>, x: T, y: T| Correspondence::new(p.x, p.y, x, y);
        let (minus, one) = (-T::ONE, T::ONE);
        let seen_at = [at(a, minus, minus), at(b, one, minus), at(c, one, one), at(d, minus, one)];
        let homography = Homography::from_correspondences(&seen_at).map_err(|error| match error {
            HomographyError::NotFinite => SquareMarkError::NotFinite,
            _ => SquareMarkError::Line,
        })?;
        let (scale, rotations) = rotations(homography.matrix()).ok_or(SquareMarkError::Mirrored)?;
        let middle = homography.to_first(&Point2::origin()).ok_or(SquareMarkError::Behind)?;
        // In half sides: the depth of the middle is one over the scale of the picture there.
        let start = middle.to_homogeneous() / scale;
        let refine =
            |rotation| self.refined(camera, &seen, Pose::of_parts(rotation, start * (self.side_m / two)));
        match rotations.map(refine) {
            [Some(one), Some(two)] => {
                let (best, other) = if one.rms_px <= two.rms_px { (one, two) } else { (two, one) };
                let apart = best.pose.inverse().then(&other.pose).angle_rad();
                Ok(MarkPoses { best, other: (apart > T::of(1e-3)).then_some(other) })
            }
            [Some(best), None] | [None, Some(best)] => Ok(MarkPoses { best, other: None }),
            [None, None] => Err(SquareMarkError::Behind),
        }
    }

    /// The pose near `start` with the least re-projection error; `None` where a corner is behind the camera.
    fn refined(&self, camera: &Camera<T>, seen: &[Point2<T>; 4], start: Pose<T>) -> Option<MarkPose<T>> {
        let problem = Corners { mark: self, k: camera.matrix(), seen };
        let (pose, equations) = levenberg_marquardt(&problem, start, MOST_STEPS)?;
        let rms_px = (equations.cost * T::of(0.25)).sqrt();
        Some(MarkPose { pose: pose.sound()?, rms_px }).filter(|_| rms_px.is_finite())
    }
}

/// The corners' re-projection errors, over a rotation (in the camera's frame, about the mark's middle) and a
/// translation in sides.
struct Corners<'a, T: Real> {
    mark: &'a SquareMark<T>,
    k: Matrix3<T>,
    seen: &'a [Point2<T>; 4],
}

impl<T: Real> LeastSquares<T, 6> for Corners<'_, T> {
    type Estimate = Pose<T>;

    fn equations(&self, pose: &Pose<T>, _bound: Option<T>) -> Option<NormalEquations<T, 6>> {
        let k = &self.k;
        let mut equations = NormalEquations::new();
        for (corner, seen) in self.mark.corners().iter().zip(self.seen) {
            let arm = pose.rotation() * corner.coords;
            let p = arm + pose.translation();
            if !(p.z > T::ZERO) {
                return None;
            }
            let by = T::ONE / p.z;
            let pixel = (k * p * by).xy();
            let error = seen.coords - pixel;
            // d(u, v)/dP = (K - pixel (0 0 1)) / Z, row by row.
            for (row, (value, error)) in [(pixel.x, error.x), (pixel.y, error.y)].into_iter().enumerate() {
                let by_point = Vector3::new(k[(row, 0)], k[(row, 1)], k[(row, 2)] - value) * by;
                // dP = w x arm + t: by_point . (w x arm) = w . (arm x by_point)
                let (by_rotation, moved) = (arm.cross(&by_point), by_point * self.mark.side_m);
                equations
                    .add(&[by_rotation.x, by_rotation.y, by_rotation.z, moved.x, moved.y, moved.z], error);
                equations.cost += error * error;
            }
        }
        Some(equations)
    }

    fn moved(&self, from: &Pose<T>, &[a, b, c, x, y, z]: &[T; 6]) -> Pose<T> {
        let rotation = cayley(&Vector3::new(a, b, c)) * from.rotation();
        Pose::of_parts(rotation, from.translation() + Vector3::new(x, y, z) * self.mark.side_m)
    }
}

impl<T: Real> MarkPoses<T> {
    /// The better pose's re-projection error over the other's, 0 to 1: near one the picture does not show
    /// which of the two it is; 0 where there is one pose only.
    pub fn ambiguity(&self) -> T {
        self.other.map_or(T::ZERO, |other| {
            if other.rms_px > T::ZERO { self.best.rms_px / other.rms_px } else { T::ONE }
        })
    }
}

/// Checks that four corners are convex and go round with the clock (v is down).
fn goes_round<T: Real>([a, b, c, d]: &[Point2<T>; 4]) -> Result<(), SquareMarkError> {
    let cross = |a: &Point2<T>, b: &Point2<T>, c: &Point2<T>| (b - a).perp(&(c - b));
    let crosses = [cross(a, b, c), cross(b, c, d), cross(c, d, a), cross(d, a, b)];
    let size = (c - a).norm_squared().max((d - b).norm_squared());
    if crosses.iter().any(|cross| cross.abs() <= size * T::EPSILON * T::of(32.0)) {
        return Err(SquareMarkError::Line);
    }
    match crosses.iter().filter(|&&cross| cross > T::ZERO).count() {
        4 => Ok(()),
        0 => Err(SquareMarkError::Mirrored),
        _ => Err(SquareMarkError::NotConvex),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;

    fn camera() -> Camera<f64> {
        Camera::new(500.0, 500.0, 320.0, 240.0).expect("a camera")
    }

    #[test]
    fn right_before_the_camera() {
        // 0.2 m at 1 m: 100 px.
        let corners =
            [(270.0, 190.0), (370.0, 190.0), (370.0, 290.0), (270.0, 290.0)].map(|(u, v)| Point2::new(u, v));
        let poses = SquareMark::new(0.2).and_then(|mark| mark.locate(&camera(), &corners)).expect("a pose");
        assert!((poses.best.pose.rotation() - Matrix3::identity()).amax() < 1e-6, "{:?}", poses.best);
        assert!((poses.best.pose.translation() - Vector3::new(0.0, 0.0, 1.0)).amax() < 1e-9);
        assert!(poses.best.rms_px < 1e-9);
        assert_eq!((poses.other, poses.ambiguity()), (None, 0.0));
    }

    #[test]
    fn what_is_no_square_is_refused() {
        let mark = SquareMark::new(0.2).expect("a mark");
        let of = |corners: [(f64, f64); 4]| mark.locate(&camera(), &corners.map(|(u, v)| Point2::new(u, v)));
        assert_eq!(of([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (0.0, 2.0)]), Err(SquareMarkError::Line));
        assert_eq!(of([(0.0, 0.0), (0.0, 9.0), (9.0, 9.0), (9.0, 0.0)]), Err(SquareMarkError::Mirrored));
        assert_eq!(of([(0.0, 0.0), (9.0, 9.0), (9.0, 0.0), (0.0, 9.0)]), Err(SquareMarkError::NotConvex));
        assert_eq!(
            of([(0.0, 0.0), (9.0, 0.0), (f64::NAN, 9.0), (0.0, 9.0)]),
            Err(SquareMarkError::NotFinite)
        );
        assert_eq!(SquareMark::new(0.0_f32), Err(SquareMarkError::Side));
    }
}
