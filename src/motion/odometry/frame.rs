//! A frame: pictures and features of one moment.

use super::config::{OdometryConfig, OdometryRig};
use crate::features::Feature;
use crate::geometry::Real;
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

/// A frame with its rig, its configuration and its number, as the stages of the odometry take it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment<'a, T: Real> {
    pub rig: &'a OdometryRig<T>,
    pub config: &'a OdometryConfig,
    pub frame: &'a Frame<'a>,
    /// The number of the frame, from 1.
    pub number: u32,
}

impl<T: Real> Moment<'_, T> {
    /// The standard deviation of a place found by its pixels, on the normalised image plane.
    pub fn sigma(&self) -> T {
        T::of(self.config.sigma_px.into()) / self.rig.focal()
    }
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
    /// The caller's memory is not as long in all its parts as it must be.
    Memory {
        /// The length that would be right.
        needed: usize,
    },
    /// The configuration can never work, see [`OdometryConfig::is_usable`](super::OdometryConfig::is_usable).
    Config,
}

error_text!(OdometryError {
    Self::NotStarted => "the odometry was not started",
    Self::NoRight => "the rig is a pair and the frame has no right picture",
    Self::Size => "the pictures differ in size",
    Self::Memory { needed } => "a part of the memory must hold {needed} items",
    Self::Config => "no frame can be followed with this configuration",
});
