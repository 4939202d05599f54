//! What a rectification is asked for, and why there is none.

use crate::geometry::Real;
use crate::geometry::camera::CameraModelError;

/// Along which direction of the images the second camera stands beside the first.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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
    /// The cameras are rotated against each other by more than 104 degrees.
    Apart,
    /// The rectified images would show nothing of one of the cameras, or its lens model has no ray for most
    /// of its image.
    NothingShared,
    /// Alpha is not from 0 to 1.
    Alpha,
    /// A side of the rectified images is not from 2 to 4096 px.
    Size,
    /// The shared camera's numbers are out of range.
    Camera(CameraModelError),
}

error_text!(RectifyError {
    Self::Swapped(Axis::Horizontal) => "the second camera stands left of the first: the cameras are swapped",
    Self::Swapped(Axis::Vertical) => "the second camera stands above the first: the cameras are swapped",
    Self::Forward => "one camera stands before the other, not beside it",
    Self::Apart => "the cameras are turned away from each other",
    Self::NothingShared => "the rectified images would show nothing of one of the cameras",
    Self::Alpha => "alpha must be from 0 to 1",
    Self::Size => "the rectified images' columns and rows must be from 2 to 4096",
    Self::Camera(error) => "{error}",
});
