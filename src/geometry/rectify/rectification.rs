//! A stereo rig with its rows aligned.

use super::align::aligned;
use super::crop::{Turned, shared_camera};
use super::warp::Warp;
use crate::geometry::Real;
use crate::geometry::camera::{Camera, CameraModelError, ImageSize, RectifiedRig, RigError, StereoRig};
use nalgebra::Matrix4;

/// Along which direction of the images the second camera stands beside the first.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Axis {
    /// To the right: rows are aligned, `d = u - u'`.
    Horizontal,
    /// Below: columns are aligned, `d = v - v'`. Matching wants both images transposed.
    Vertical,
}

impl Axis {
    /// Whether it is [`Axis::Horizontal`].
    pub const fn is_horizontal(self) -> bool {
        matches!(self, Self::Horizontal)
    }
}

/// How much of the raw images the rectified ones show.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Crop<T: Real> {
    /// At the scale of the raw images: their mean focal length is kept. OpenCV's default, -1.
    Natural,
    /// From 0, nothing but what both cameras see, to 1, all of both raw images: OpenCV's alpha.
    Alpha(T),
}

/// Why a rig cannot be rectified.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RectifyError {
    /// The second camera stands on the other side: left of the first, or above it.
    Swapped(Axis),
    /// One camera stands before the other, more than 60 degrees from beside it.
    Forward,
    /// The cameras are turned against each other by more than 104 degrees.
    Apart,
    /// The rectified images would show nothing of one of the cameras, or its lens model has no sight for most
    /// of its image.
    NothingShared,
    /// Alpha is not from 0 to 1.
    Alpha,
    /// A side of the rectified images is not from 2 to 4096 px.
    Size,
    /// The shared camera's numbers are out of range.
    Camera(CameraModelError),
}

impl core::fmt::Display for RectifyError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Swapped(Axis::Horizontal) => {
                "the second camera stands left of the first: the cameras are swapped"
            }
            Self::Swapped(Axis::Vertical) => {
                "the second camera stands above the first: the cameras are swapped"
            }
            Self::Forward => "one camera stands before the other, not beside it",
            Self::Apart => "the cameras are turned away from each other",
            Self::NothingShared => "the rectified images would show nothing of one of the cameras",
            Self::Alpha => "alpha must be from 0 to 1",
            Self::Size => "the rectified images' columns and rows must be from 2 to 4096",
            Self::Camera(error) => return error.fmt(f),
        })
    }
}

impl core::error::Error for RectifyError {}

/// Two warps into images whose rows (or columns, below each other) are aligned, and the cameras that those
/// images are of.
///
/// ```
/// use stereopsis::geometry::{camera::{Camera, ImageSize, Pose, StereoRig}, rectify::{Crop, Rectification}};
/// use nalgebra::{Matrix3, Point2, Vector3};
/// // The right camera sees everything one row higher.
/// let (left, right) = (Camera::new(500.0_f64, 500.0, 320.0, 240.0)?, Camera::new(500.0, 500.0, 320.0, 239.0)?);
/// let size = ImageSize { width: 641, height: 481 };
/// let pose = Pose::new(Matrix3::identity(), Vector3::new(0.06, 0.0, 0.0))?;
/// let rectified = Rectification::new(&StereoRig::new([left, right], pose, [size; 2])?, Crop::Natural, size)?;
/// let [first, second] = rectified.warps();
/// let (cx, cy) = rectified.camera().principal_point();
/// let middle = Point2::new(cx, cy);
/// assert_eq!(first.source(&middle)?.pixel, Point2::new(320.0, 240.0));
/// assert_eq!(second.source(&middle)?.pixel, Point2::new(320.0, 239.0));
/// assert_eq!(rectified.rig()?.baseline_m(), 0.06);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, PartialEq, Debug)]
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
        let turned = [
            Turned { camera: left, size: left_size, rotation: &first },
            Turned { camera: right, size: right_size, rotation: &second },
        ];
        let camera = shared_camera(&turned, axis, crop, size)?;
        let warps = turned.map(|t| Warp::new(*t.camera, t.size, *t.rotation, camera, size));
        Ok(Self { warps, axis, camera, baseline_m: rig.baseline_m(), size })
    }

    /// The same with other warps, into the same camera.
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
