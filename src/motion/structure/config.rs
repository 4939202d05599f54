//! Configuration, states and errors of structure from motion.

use crate::geometry::Real;
use crate::motion::bundle::BundleError;

/// Configuration of structure from motion.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StructureConfig<T> {
    /// Largest residual of an inlier, px.
    pub threshold_px: T,
    /// Smallest angle between two rays to a point for its triangulation, radians.
    pub min_angle_rad: T,
    /// Largest number of RANSAC samples of each robust estimate.
    pub most_samples: u32,
    /// Seed of the random samples.
    pub seed: u64,
}

impl<T: Real> StructureConfig<T> {
    /// With a threshold in px; one degree, 2 000 samples, seed 0.
    pub fn new(threshold_px: T) -> Self {
        Self { threshold_px, min_angle_rad: T::of(0.0175), most_samples: 2000, seed: 0 }
    }
}

/// Why two views give no pose.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum InitialPairError {
    /// The two views have fewer than twelve points in common.
    TooFew,
    /// What they have in common agrees on nothing.
    NoAgreement,
    /// The camera has not moved: what agrees is where it was, within the threshold.
    NoMotion,
    /// The camera has turned about its centre, or all that both see is far away beside the motion: a turn
    /// explains what agrees.
    PureRotation,
    /// What both see is on a plane, and two motions explain it.
    Plane,
    /// Too few points are seen at the least angle.
    SmallAngle,
}

/// Why there is no structure.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum StructureError {
    /// There are fewer than two views.
    Views,
    /// The threshold or the angle is not greater than zero, or no sample is allowed.
    Config,
    /// No two views give a pose; this is why, of those with most in common.
    NoPair(InitialPairError),
    /// There is no observation; or one is out of order, not finite, or names a view or a point that there is
    /// not; or the bundle's workspace is too small.
    Bundle(BundleError),
    /// The slices for matches, landmarks, inliers or observations are too short; so many are needed.
    Memory(usize),
}

/// What is known of a view.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum ViewState {
    /// The view's pose has not been looked for yet.
    Unknown,
    /// The view's pose is known.
    Registered,
    /// The view sees fewer than six points that are known.
    TooFew,
    /// The view's observations agree on no pose.
    NoAgreement,
}

/// What is known of a point.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum PointState {
    /// Fewer than two views of known pose see the point.
    Unknown,
    /// The point's position is known.
    Triangulated,
    /// The observations are nearly parallel: the point is far away, or at infinity.
    Far,
    /// The observations do not meet before the cameras, or fewer than half of them do.
    Inconsistent,
}

impl core::fmt::Display for InitialPairError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::TooFew => "fewer than twelve points are seen by both views",
            Self::NoAgreement => "what both views see agrees on nothing",
            Self::NoMotion => "the camera has not moved",
            Self::PureRotation => "the camera has only turned, or all is far away",
            Self::Plane => "what both views see is on a plane, and two motions explain it",
            Self::SmallAngle => "too few points are seen at an angle",
        })
    }
}

impl core::fmt::Display for StructureError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Views => f.write_str("structure needs two views"),
            Self::Config => f.write_str("the threshold, the angle and the samples must be greater than zero"),
            Self::NoPair(fault) => write!(f, "no two views give a pose: {fault}"),
            Self::Bundle(error) => error.fmt(f),
            Self::Memory(needed) => write!(f, "slices of {needed} are needed"),
        }
    }
}

impl core::error::Error for InitialPairError {}
impl core::error::Error for StructureError {}
