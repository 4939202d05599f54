//! The motions in a homography (Faugeras & Lustman 1988).

use super::correspondence::Correspondence;
use super::homography::Homography;
use super::relative::{RelativePose, ScaleError, scaled};
use crate::geometry::Real;
use crate::geometry::camera::{Camera, Pose};
use crate::geometry::linear::{Svd3, columns3};
use nalgebra::{Matrix3, Vector3};

/// What a homography can mean: a pose and the plane that both cameras see.
///
/// The unit of length is the distance of the plane from camera 2, which the images do not show.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PlaneMotion<T: Real> {
    rotation: Matrix3<T>,
    translation: Vector3<T>,
    normal: Vector3<T>,
}

/// Why a homography has no pose.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum PlaneMotionError {
    /// The camera has rotated but not moved, to 64 roundings: the plane is not in the homography.
    /// [`Homography::rotation`] has what there is.
    NoBaseline,
    /// A number of a motion would not be finite.
    NotFinite,
}

error_text!(PlaneMotionError {
    Self::NoBaseline => "the camera has rotated but not moved",
    Self::NotFinite => "a number of the motion would not be finite",
});

impl<T: Real> PlaneMotion<T> {
    /// R, from camera 2 into camera 1.
    pub fn rotation(&self) -> &Matrix3<T> {
        &self.rotation
    }

    /// The translation t over the distance d of the plane: no unit.
    pub fn translation_per_distance(&self) -> &Vector3<T> {
        &self.translation
    }

    /// The normal n, of length one, in camera 2: the plane is `n^T P' = d` with d > 0.
    pub fn normal(&self) -> &Vector3<T> {
        &self.normal
    }

    /// The pose without its scale; `None` when t is zero.
    pub fn relative_pose(&self) -> Option<RelativePose<T>> {
        RelativePose::of(&Pose::of_parts(self.rotation, self.translation))
    }

    /// The pose in metres of a plane that is `distance_m` from camera 2.
    pub fn with_distance(&self, distance_m: T) -> Result<Pose<T>, ScaleError> {
        scaled(self.rotation, self.translation, distance_m)
    }

    /// Whether the plane, where a ray of camera 2 meets it, is in front of both cameras.
    pub fn in_front(&self, second: &Vector3<T>) -> bool {
        let along = self.normal.dot(second);
        // P' = p' / (n^T p'), in plane distances.
        along > T::ZERO && self.rotation.row(2).transpose().dot(second) + self.translation.z * along > T::ZERO
    }
}

impl<T: Real> Homography<T> {
    /// `K^-1 H K'`, with its middle singular value one: `R + t n^T / d`. Its determinant is positive, for
    /// both cameras see one side of the plane.
    fn euclidean(&self, first: &Camera<T>, second: &Camera<T>) -> (Matrix3<T>, Svd3<T>) {
        let matrix = first.inverse_matrix() * self.matrix() * second.matrix();
        let matrix = matrix / matrix.amax();
        let svd = Svd3::new(&matrix);
        let by = if svd.values[2] < T::ZERO { -svd.values[1] } else { svd.values[1] };
        let values = svd.values.map(|value| value / by.abs());
        (matrix / by, Svd3 { values, ..svd })
    }

    /// The rotation nearest to `K^-1 H K'`: the whole answer when the camera has only rotated.
    pub fn rotation(&self, first: &Camera<T>, second: &Camera<T>) -> Matrix3<T> {
        let (matrix, _) = self.euclidean(first, second);
        let svd = Svd3::new(&matrix);
        svd.u * svd.v.transpose()
    }

    /// The poses and planes that the homography allows, in closed form (Ma, Soatto, Kosecka & Sastry 2004,
    /// 5.3.3; Faugeras & Lustman 1988): two with the plane ahead of camera 2's axis, then the same two
    /// mirrored (-t and -n). Without distortion, as H is.
    ///
    /// [`Self::recover_motions`] puts them in order by what is in front of the cameras. Where two remain, a
    /// third view or the plane's normal decides.
    pub fn motions(
        &self,
        first: &Camera<T>,
        second: &Camera<T>,
    ) -> Result<[PlaneMotion<T>; 4], PlaneMotionError> {
        let (h, Svd3 { values: [s0, _, s2], v, .. }) = self.euclidean(first, second);
        let s2 = s2.abs();
        let (up, down) = ((s0 * s0 - T::ONE).max(T::ZERO), (T::ONE - s2 * s2).max(T::ZERO));
        let spread = up + down;
        if !(spread > T::EPSILON * T::of(64.0)) {
            return Err(PlaneMotionError::NoBaseline);
        }
        let (along, across) = ((down / spread).sqrt(), (up / spread).sqrt());
        let [v0, v1, v2] = columns3(&v);
        // Vectors of the plane at right angles to v1 whose length H keeps.
        let motion = |u: Vector3<T>| {
            let n = v1.cross(&u);
            let (a, b) = (h * v1, h * u);
            let from = Matrix3::from_columns(&[v1, u, n]);
            let to = Matrix3::from_columns(&[a, b, a.cross(&b)]);
            // To a rotation exactly: H's columns are of length one to rounding.
            let svd = Svd3::new(&(to * from.transpose()));
            let rotation = svd.u * svd.v.transpose();
            let translation = (h - rotation) * n;
            let sign = if n.z < T::ZERO { -T::ONE } else { T::ONE };
            PlaneMotion { rotation, translation: translation * sign, normal: n * sign }
        };
        let (one, other) = (motion(v0 * along + v2 * across), motion(v0 * along - v2 * across));
        let is_sound = |m: &PlaneMotion<T>| {
            let is_unit = (m.normal.norm() - T::ONE).abs() < T::of(1e-4);
            is_unit && Pose::of_parts(m.rotation, m.translation).sound().is_some()
        };
        if !(is_sound(&one) && is_sound(&other)) {
            return Err(PlaneMotionError::NotFinite);
        }
        let mirrored =
            |m: PlaneMotion<T>| PlaneMotion { translation: -m.translation, normal: -m.normal, ..m };
        Ok([one, other, mirrored(one), mirrored(other)])
    }

    /// The two likeliest of [`Self::motions`], each with how many of the correspondences it has in front of
    /// both cameras; the one with more first. They are equally likely when the numbers are equal.
    pub fn recover_motions(
        &self,
        seen: impl IntoIterator<Item = Correspondence<T>>,
        first: &Camera<T>,
        second: &Camera<T>,
    ) -> Result<[(PlaneMotion<T>, usize); 2], PlaneMotionError> {
        let mut ranked = self.motions(first, second)?.map(|motion| (motion, 0_usize));
        for seen in seen {
            let Ok(ray) = second.unproject(&seen.second) else { continue };
            for (motion, votes) in &mut ranked {
                *votes += usize::from(motion.in_front(&ray));
            }
        }
        // Insertion: stable, so that equals stay in the order above.
        let mut best: [(PlaneMotion<T>, usize); 2] = [ranked[0], ranked[1]];
        if best[1].1 > best[0].1 {
            best.swap(0, 1);
        }
        for other in [ranked[2], ranked[3]] {
            if other.1 > best[0].1 {
                best = [other, best[0]];
            } else if other.1 > best[1].1 {
                best[1] = other;
            }
        }
        Ok(best)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Point2;

    #[test]
    fn a_wall_ahead() {
        // A wall 2 m ahead of camera 2, which stands 1 m to the right.
        let camera = Camera::new(500.0, 500.0, 320.0, 240.0_f64).expect("a camera");
        let pose = Pose::new(Matrix3::identity(), Vector3::new(1.0, 0.0, 0.0)).expect("a pose");
        let h = Homography::from_plane(&pose, &camera, &camera, &Vector3::z(), 2.0).expect("a plane");
        // The wall moves by f t / d = 250 px.
        let there = h.to_first(&Point2::new(100.0, 50.0)).expect("it is finite");
        assert!((there - Point2::new(350.0, 50.0)).amax() < 1e-10, "{there}");
        let motions = h.motions(&camera, &camera).expect("a baseline");
        let right = |m: &&PlaneMotion<f64>| {
            (m.rotation() - Matrix3::identity()).amax() < 1e-12
                && (m.translation_per_distance() - Vector3::new(0.5, 0.0, 0.0)).amax() < 1e-12
                && (m.normal() - Vector3::z()).amax() < 1e-12
        };
        let found = motions.iter().find(right).expect("one of the four is right");
        let metric = found.with_distance(2.0).expect("a distance");
        assert!((metric.translation() - pose.translation()).amax() < 1e-12);
        for distance_m in [0.0, -2.0, f64::INFINITY, f64::NAN, 1e200] {
            assert_eq!(found.with_distance(distance_m), Err(ScaleError::Length), "{distance_m}");
        }
        let turned = Homography::from_matrix(&Matrix3::<f64>::identity()).expect("H");
        assert_eq!(turned.motions(&camera, &camera), Err(PlaneMotionError::NoBaseline));
        assert!((turned.rotation(&camera, &camera) - Matrix3::identity()).amax() < 1e-15);
    }
}
