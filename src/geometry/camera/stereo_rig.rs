//! A calibrated stereo rig as it is mounted, before rectification.

use super::pinhole::Camera;
use super::pose::{Pose, PoseError};
use crate::geometry::Real;
use nalgebra::{Matrix3, Vector3};

/// The size of an image, px.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ImageSize {
    /// Columns.
    pub width: u16,
    /// Rows.
    pub height: u16,
}

impl ImageSize {
    /// The least columns and rows of an image that a camera of a rig can have.
    pub const LEAST: u16 = 2;
    /// The most.
    pub const MOST: u16 = 4096;

    /// Whether both sides are from [`Self::LEAST`] to [`Self::MOST`].
    pub const fn is_possible(self) -> bool {
        self.width >= Self::LEAST
            && self.width <= Self::MOST
            && self.height >= Self::LEAST
            && self.height <= Self::MOST
    }
}

/// Two cameras with their lenses, where the second stands beside the first, and the sizes of their images:
/// what a stereo calibration finds. Whoever has one needs to check none of its numbers again.
///
/// ```
/// use stereopsis::geometry::camera::{Camera, ImageSize, Pose, StereoRig, StereoRigError};
/// use nalgebra::{Matrix3, Vector3};
/// let camera = Camera::new(500.0, 500.0, 319.5, 239.5)?;
/// let size = ImageSize { width: 640, height: 480 };
/// let beside = Pose::new(Matrix3::identity(), Vector3::new(0.06, 0.0, 0.0))?;
/// let rig = StereoRig::new([camera; 2], beside, [size; 2])?;
/// assert_eq!(rig.baseline_m(), 0.06);
/// let nowhere = StereoRig::new([camera; 2], Pose::identity(), [size; 2]);
/// assert_eq!(nowhere, Err(StereoRigError::NoBaseline));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct StereoRig<T: Real> {
    cameras: [Camera<T>; 2],
    pose: Pose<T>,
    sizes: [ImageSize; 2],
}

deserialize_checked! {
    StereoRig<T> { cameras: [Camera<T>; 2], pose: Pose<T>, sizes: [ImageSize; 2] }
    by |rig| Self::new(rig.cameras, rig.pose, rig.sizes)
}

/// Why numbers are no stereo rig.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum StereoRigError {
    /// R or t are no pose: not finite, or R is no rotation.
    Pose(PoseError),
    /// The two cameras are at one place.
    NoBaseline,
    /// The cameras are not from a micrometre to 1000 km apart.
    Baseline,
    /// A side of an image is not from 2 to 4096 px.
    Size,
}

error_text!(StereoRigError {
    Self::Pose(error) => "{error}",
    Self::NoBaseline => "the baseline is zero: both cameras are at one place",
    Self::Baseline => "the baseline must be from 0.000001 to 1000000 m",
    Self::Size => "the images' columns and rows must be from 2 to 4096",
});

impl<T: Real> StereoRig<T> {
    /// A rig of the first (left) and the second camera, the pose of the second in the first (metres), and
    /// their images' sizes.
    pub fn new(
        cameras: [Camera<T>; 2],
        pose: Pose<T>,
        sizes: [ImageSize; 2],
    ) -> Result<Self, StereoRigError> {
        if pose.translation().amax() == T::ZERO {
            return Err(StereoRigError::NoBaseline);
        }
        let baseline = pose.translation().norm();
        if !(baseline >= T::of(1e-6) && baseline <= T::of(1e6)) {
            return Err(StereoRigError::Baseline);
        }
        if !sizes.iter().all(|size| size.is_possible()) {
            return Err(StereoRigError::Size);
        }
        Ok(Self { cameras, pose, sizes })
    }

    /// A rig of R and T as OpenCV's `stereoCalibrate` writes them, `P' = R P + T`, T in metres.
    pub fn from_opencv(
        cameras: [Camera<T>; 2],
        rotation: Matrix3<T>,
        translation: Vector3<T>,
        sizes: [ImageSize; 2],
    ) -> Result<Self, StereoRigError> {
        let pose = Pose::from_opencv(rotation, translation).map_err(StereoRigError::Pose)?;
        Self::new(cameras, pose, sizes)
    }

    /// The first and the second camera.
    pub fn cameras(&self) -> &[Camera<T>; 2] {
        &self.cameras
    }

    /// R and t, which carry a point of camera 2 into camera 1.
    pub fn pose(&self) -> &Pose<T> {
        &self.pose
    }

    /// The sizes of the first and the second camera's images.
    pub fn sizes(&self) -> [ImageSize; 2] {
        self.sizes
    }

    /// Distance between the two optical centres, m.
    pub fn baseline_m(&self) -> T {
        self.pose.translation().norm()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_rig_is_refused_by_name() {
        let camera = Camera::new(500.0_f64, 500.0, 319.5, 239.5).expect("a camera");
        let size = ImageSize { width: 640, height: 480 };
        let beside = Vector3::new(-0.1, 0.0, 0.0);
        let rig = |r, t, sizes| StereoRig::from_opencv([camera; 2], r, t, sizes);
        assert!(rig(Matrix3::identity(), beside, [size; 2]).is_ok());
        let skewed = rig(Matrix3::identity() * 1.01, beside, [size; 2]);
        assert_eq!(skewed, Err(StereoRigError::Pose(PoseError::NotARotation)));
        let nan = rig(Matrix3::identity(), beside * f64::NAN, [size; 2]);
        assert_eq!(nan, Err(StereoRigError::Pose(PoseError::NotFinite)));
        assert_eq!(rig(Matrix3::identity(), Vector3::zeros(), [size; 2]), Err(StereoRigError::NoBaseline));
        for far in [1e-200, 1e-7, 1e7, 1e150, -1e150] {
            let found = rig(Matrix3::identity(), Vector3::new(far, 0.0, 0.0), [size; 2]);
            assert_eq!(found, Err(StereoRigError::Baseline), "{far}");
        }
        let thin = ImageSize { width: 640, height: 1 };
        assert_eq!(rig(Matrix3::identity(), beside, [size, thin]), Err(StereoRigError::Size));
    }
}
