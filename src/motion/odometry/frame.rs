//! What comes in.

use crate::features::Feature;
use crate::imaging::Picture;

/// A moment: the picture, its features, and what the right camera sees.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// The picture of the camera; of a pair the left one.
    pub left: Picture<'a>,
    /// The right one. Its rows are those of the left one.
    pub right: Option<Picture<'a>>,
    /// Features of the left picture. What is beyond the odometry's capacity is not looked at.
    pub features: &'a [Feature],
}

/// Why a frame was not taken.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum OdometryError {
    /// The odometry was not started.
    NotStarted,
    /// The rig is a pair, and the frame has no right picture.
    NoRight,
    /// The picture's size is not that of the frames before, or the right one's is another.
    Size,
}

impl core::fmt::Display for OdometryError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::NotStarted => "the odometry was not started",
            Self::NoRight => "the rig is a pair and the frame has no right picture",
            Self::Size => "the pictures differ in size",
        })
    }
}

impl core::error::Error for OdometryError {}
