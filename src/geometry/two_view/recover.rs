//! The pose in an essential matrix, by the points in front of both cameras (Hartley & Zisserman 2004, 9.6).

use super::correspondence::Correspondence;
use super::essential::Essential;
use super::relative::RelativePose;
use crate::geometry::Real;
use crate::geometry::camera::Camera;
use crate::geometry::linear::{Svd3, columns3, product};
use nalgebra::{Matrix3, Unit, Vector3};

/// The pose that most correspondences vote for, and the vote.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RecoveredPose<T: Real> {
    /// The pose of camera 2 beside camera 1, without its scale.
    pub pose: RelativePose<T>,
    /// How many correspondences are in front of both cameras with it.
    pub in_front: usize,
    /// How many could vote: what is left out has parallel rays, or is outside of what the lens model
    /// describes.
    pub voters: usize,
}

/// Why an essential matrix and correspondences give no pose.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RecoverError {
    /// No correspondence has two rays.
    NoCorrespondence,
    /// All rays are parallel, to 0.0001 rad, with either rotation: they are in front of any camera.
    SmallAngle,
    /// With none of the four poses more than half of the correspondences are in front of both cameras.
    Cheirality,
}

error_text!(RecoverError {
    Self::NoCorrespondence => "no correspondence to tell the four poses apart",
    Self::SmallAngle => "the rays are parallel: too far away to tell the four poses apart",
    Self::Cheirality => "with none of the four poses most points are in front of both cameras",
});

impl<T: Real> Essential<T> {
    /// The four poses that have this essential matrix: `E = U diag(1, 1, 0) V^T`, `R = U W V^T` or `U W^T
    /// V^T` with W a quarter turn about Z, `t = u3` or `-u3` (Hartley & Zisserman 2004, 9.6.2). Two and
    /// two have one rotation.
    pub fn poses(&self) -> [RelativePose<T>; 4] {
        let svd = Svd3::new(self.matrix());
        let ([u0, u1, direction], back) = (columns3(&svd.u), svd.v.transpose());
        // U W and U W^T.
        let one = product(&Matrix3::from_columns(&[u1, -u0, direction]), &back);
        let other = product(&Matrix3::from_columns(&[-u1, u0, direction]), &back);
        let t = Unit::new_unchecked(direction);
        [
            RelativePose::new(one, t),
            RelativePose::new(one, -t),
            RelativePose::new(other, t),
            RelativePose::new(other, -t),
        ]
    }

    /// The one of [`Self::poses`] with which most correspondences are in front of both cameras, more than
    /// half of those whose rays are not parallel.
    ///
    /// What only noise sets apart is in front or behind by chance. Of a camera that has only turned the
    /// direction is therefore any, with a little more than half in front: of 150 such pairs of views nine in
    /// ten had under .8 of [`RecoveredPose::voters`] in [`RecoveredPose::in_front`], half under .54. A share
    /// under .8 is to be doubted; with a homography that explains the same points as well
    /// ([`choose`](crate::geometry::two_view::choose)) the camera has only turned, or has seen one plane, of
    /// which a second motion may be as good.
    pub fn recover_pose(
        &self,
        seen: impl IntoIterator<Item = Correspondence<T>>,
        first: &Camera<T>,
        second: &Camera<T>,
    ) -> Result<RecoveredPose<T>, RecoverError> {
        let poses = self.poses();
        let mut votes = [0_usize; 4];
        let mut angled = [0_usize; 4];
        let mut any = false;
        for seen in seen {
            let (Ok(p), Ok(q)) = (first.unproject(&seen.first), second.unproject(&seen.second)) else {
                continue;
            };
            any = true;
            for ((pose, vote), angled) in poses.iter().zip(&mut votes).zip(&mut angled) {
                match in_front(pose, &p, &q) {
                    None => {}
                    Some(front) => {
                        *angled += 1;
                        *vote += usize::from(front);
                    }
                }
            }
        }
        if !any {
            return Err(RecoverError::NoCorrespondence);
        }
        let [mut pose, ..] = poses;
        let (mut in_front, mut voters) = (0, 0);
        for ((candidate, &vote), &angled) in poses.iter().zip(&votes).zip(&angled) {
            if vote > in_front {
                (pose, in_front) = (*candidate, vote);
            }
            voters = voters.max(angled);
        }
        if voters == 0 {
            return Err(RecoverError::SmallAngle);
        }
        if 2 * in_front <= voters {
            return Err(RecoverError::Cheirality);
        }
        Ok(RecoveredPose { pose, in_front, voters })
    }
}

/// Whether two rays come nearest to each other in front of both cameras; `None` when they are parallel.
fn in_front<T: Real>(pose: &RelativePose<T>, first: &Vector3<T>, second: &Vector3<T>) -> Option<bool> {
    let (p, q, t) = (first, pose.rotation() * second, pose.direction().into_inner());
    let across = p.cross(&q);
    // The sine of 0.0001 rad.
    if !(across.norm_squared() > T::of(1e-8) * p.norm_squared() * q.norm_squared()) {
        return None;
    }
    // The depths, times |p x q|^2.
    Some(t.cross(&q).dot(&across) > T::ZERO && t.cross(p).dot(&across) > T::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::camera::Pose;

    #[test]
    fn a_camera_to_the_right() {
        let camera = Camera::new(1.0, 1.0, 0.0, 0.0_f64).expect("a camera");
        let pose = Pose::new(Matrix3::identity(), Vector3::new(2.0, 0.0, 0.0)).expect("a pose");
        let e = Essential::from_pose(&pose).expect("a baseline");
        // (0, 0, 4), (2, 4, 8) of camera 1 are (-2, 0, 4), (0, 4, 8) of camera 2.
        let seen = [Correspondence::new(0.0, 0.0, -0.5, 0.0), Correspondence::new(0.25, 0.5, 0.0, 0.5)];
        let found = e.recover_pose(seen, &camera, &camera).expect("a pose");
        assert!((found.pose.rotation() - Matrix3::identity()).amax() < 1e-15);
        assert!((found.pose.direction().into_inner() - Vector3::x()).amax() < 1e-15);
        assert_eq!((found.in_front, found.voters), (2, 2));
        assert_eq!(e.recover_pose([], &camera, &camera), Err(RecoverError::NoCorrespondence));
    }
}
