//! A rectified stereo rig: two warps and the camera that they lead into.

use super::align::aligned;
use super::config::{Axis, Crop, RectifyError};
use super::crop::{Rotated, shared_camera};
use super::warp::Warp;
use crate::geometry::Real;
use crate::geometry::camera::{Camera, ImageSize, RectifiedRig, RigError, StereoRig};
use nalgebra::Matrix4;

/// Two warps into images whose rows (or columns, below each other) are aligned, and the cameras that those
/// images are of.
///
/// ```
/// use stereopsis::geometry::camera::{Camera, ImageSize, Pose, StereoRig};
/// use stereopsis::geometry::rectify::{Crop, Rectification};
/// use nalgebra::{Matrix3, Point2, Vector3};
/// // The right camera sees everything one row higher.
/// let left = Camera::new(500.0_f64, 500.0, 320.0, 240.0)?;
/// let right = Camera::new(500.0, 500.0, 320.0, 239.0)?;
/// let size = ImageSize { width: 641, height: 481 };
/// let pose = Pose::new(Matrix3::identity(), Vector3::new(0.06, 0.0, 0.0))?;
/// let rig = StereoRig::new([left, right], pose, [size; 2])?;
/// let rectified = Rectification::new(&rig, Crop::Natural, size)?;
/// let [first, second] = rectified.warps();
/// let (cx, cy) = rectified.camera().principal_point();
/// let middle = Point2::new(cx, cy);
/// assert_eq!(first.source(&middle)?.pixel, Point2::new(320.0, 240.0));
/// assert_eq!(second.source(&middle)?.pixel, Point2::new(320.0, 239.0));
/// assert_eq!(rectified.rig()?.baseline_m(), 0.06);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Rectification<T: Real> {
    warps: [Warp<T>; 2],
    axis: Axis,
    camera: Camera<T>,
    baseline_m: T,
    size: ImageSize,
}

impl<T: Real> Rectification<T> {
    /// Rectifies a rig into images of `size` px.
    pub fn new(rig: &StereoRig<T>, crop: Crop<T>, size: ImageSize) -> Result<Self, RectifyError> {
        if !size.is_possible() {
            return Err(RectifyError::Size);
        }
        let ([first, second], axis) = aligned(rig.pose())?;
        let ([left, right], [left_size, right_size]) = (rig.cameras(), rig.sizes());
        let rotated = [
            Rotated { camera: left, size: left_size, rotation: &first },
            Rotated { camera: right, size: right_size, rotation: &second },
        ];
        let camera = shared_camera(&rotated, axis, crop, size)?;
        let warps = rotated.map(|t| Warp::new(*t.camera, t.size, *t.rotation, camera, size));
        Ok(Self { warps, axis, camera, baseline_m: rig.baseline_m(), size })
    }

    /// A rectification with other warps, into the same camera.
    pub(super) fn with_warps(&self, warps: [Warp<T>; 2]) -> Self {
        Self { warps, ..*self }
    }

    /// The warps of the first and of the second camera.
    pub fn warps(&self) -> &[Warp<T>; 2] {
        &self.warps
    }

    /// What is aligned.
    pub fn axis(&self) -> Axis {
        self.axis
    }

    /// The camera that both rectified images are of; the second stands [`Self::baseline_m`] beside the first.
    pub fn camera(&self) -> &Camera<T> {
        &self.camera
    }

    /// Distance between the two optical centres, m.
    pub fn baseline_m(&self) -> T {
        self.baseline_m
    }

    /// The size of the rectified images.
    pub fn size(&self) -> ImageSize {
        self.size
    }

    /// The rectified rig, for depths; that of the transposed images where the cameras stand below each other.
    pub fn rig(&self) -> Result<RectifiedRig, RigError> {
        let (f, (cx, cy)) = (self.camera.focal_px().0, self.camera.principal_point());
        let (along, across) = if self.axis.is_horizontal() { (cx, cy) } else { (cy, cx) };
        let [f, b, along, across] = [f, self.baseline_m, along, across].map(|x| x.to_f64() as f32);
        RectifiedRig::new(f, b, along, across)
    }

    /// The re-projection matrix Q: `(X Y Z W)^T = Q (u v d 1)^T` in the first rectified camera, metres, with
    /// the disparity of [`Axis`]; the images are not transposed.
    pub fn q(&self) -> Matrix4<T> {
        let (f, (cx, cy)) = (self.camera.focal_px().0, self.camera.principal_point());
        let mut q = Matrix4::identity();
        q.m14 = -cx;
        q.m24 = -cy;
        q.m33 = T::ZERO;
        q.m34 = f;
        q.m43 = T::ONE / self.baseline_m;
        q.m44 = T::ZERO;
        q
    }
}
