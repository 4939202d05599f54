//! Configuration, pictures and steps of an odometry in C.
#![allow(unsafe_code)]

use super::Status;
use super::state::checked;
use super::status::either;
use super::two_view::{CPose, rows_of};
use crate::imaging::Picture;
use crate::motion::odometry::{OdometryConfig, OdometryError, OdometryRigError, State, Step};
use core::slice::from_raw_parts;

/// Motion: this is the first frame.
pub const STEREOPSIS_MOTION_FIRST: u8 = 0;
/// Motion: rotation and step are measured.
pub const STEREOPSIS_MOTION_TRACKED: u8 = 1;
/// Motion: the pictures are the same to their noise, and the motion is none.
pub const STEREOPSIS_MOTION_STATIONARY: u8 = 2;
/// Motion: the rotation is measured, a step is too small to be measured.
pub const STEREOPSIS_MOTION_ROTATION_ONLY: u8 = 3;
/// Motion: the rotation is measured, the step is not known.
pub const STEREOPSIS_MOTION_STEP_UNKNOWN: u8 = 4;
/// Motion: too little was found again, and nothing is known; the next frame that is found has the whole
/// motion.
pub const STEREOPSIS_MOTION_LOST: u8 = 5;
/// Motion: found again, by points that were known before.
pub const STEREOPSIS_MOTION_FOUND: u8 = 6;
/// Motion: begun anew; the motion since the last known pose is not known.
pub const STEREOPSIS_MOTION_RESTARTED: u8 = 7;
/// Motion: an estimate that is not sure; its covariance says how little, or few points say that it differs
/// much from the one before.
pub const STEREOPSIS_MOTION_UNCERTAIN: u8 = 8;
/// Motion: measured by the left camera alone, for what the right one sees disagrees with all that was known.
pub const STEREOPSIS_MOTION_LEFT_ONLY: u8 = 9;

/// Configuration of an odometry, filled by `stereopsis_odometry_default` and then open to changes.
#[derive(Clone, Copy, PartialEq, Debug)]
#[repr(C)]
pub struct COdometryConfig {
    /// Seed of the random samples: equal seeds give equal motions.
    pub seed: u64,
    /// Radius of the search around a predicted place while the motion is not known, px; over 0.
    pub far_px: f32,
    /// Radius of the search while the motion is known, px; over 0.
    pub near_px: f32,
    /// Standard deviation of a place found by template alignment, px; 0.001 to 1000.
    pub sigma_px: f32,
    /// Smallest distance of a new point from all others, px; finite.
    pub spacing_px: f32,
    /// Largest number of RANSAC samples for a frame, which bounds its time; over 0.
    pub most_samples: u32,
    /// Largest disparity of a new point, px; over 0.
    pub most_disparity_px: u16,
}

/// Whole picture in memory, 8-bit grey, row by row.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct CPicture {
    /// `width * height` bytes.
    pub pixels: *const u8,
    /// Number of columns.
    pub width: u16,
    /// Number of rows.
    pub height: u16,
}

/// Motion from the frame before to this one.
#[derive(Clone, Copy, PartialEq, Debug)]
#[repr(C)]
pub struct CStep {
    /// Carries a point of this camera into the one before, P = R P' + t: t is where this one stands, m.
    pub motion: CPose,
    /// Covariance of the motion, row by row: a rotation vector, radians, and a step, m, both along this
    /// camera's axes. Very large where nothing is known.
    pub covariance: [f32; 36],
    /// Root mean square of what is left of the observations, in units of what was expected.
    pub residual: f32,
    /// Points that are followed.
    pub points: u32,
    /// Points that were found in this frame.
    pub found: u32,
    /// Points that agree with the pose.
    pub inliers: u32,
    /// What is known of the motion: a `STEREOPSIS_MOTION_` number.
    pub state: u8,
}

impl From<OdometryError> for Status {
    fn from(e: OdometryError) -> Self {
        match e {
            OdometryError::NotStarted => Self::NotStarted,
            OdometryError::NoRight => Self::Null,
            OdometryError::Size => Self::PictureSize,
            OdometryError::Memory { .. } => Self::OdometryPoints,
            OdometryError::Config => Self::OdometryConfig,
        }
    }
}

impl From<OdometryRigError> for Status {
    fn from(_: OdometryRigError) -> Self {
        Self::PinholeNumbers
    }
}

impl From<COdometryConfig> for OdometryConfig {
    fn from(config: COdometryConfig) -> Self {
        let COdometryConfig { seed, far_px, near_px, sigma_px, spacing_px, most_samples, most_disparity_px } =
            config;
        Self {
            seed,
            far_px,
            near_px,
            sigma_px,
            spacing_px,
            most_samples,
            most_disparity_px,
            corrects_rig: false,
        }
    }
}

impl From<Step<f32>> for CStep {
    fn from(step: Step<f32>) -> Self {
        let t = step.motion.translation();
        let motion = CPose { rotation: rows_of(step.motion.rotation()), translation: [t.x, t.y, t.z] };
        let mut covariance = [0.0; 36];
        covariance.iter_mut().zip(step.covariance.transpose().iter()).for_each(|(to, from)| *to = *from);
        Self {
            motion,
            covariance,
            residual: step.residual,
            points: step.points as u32,
            found: step.found as u32,
            inliers: step.inliers as u32,
            state: match step.state {
                State::First => STEREOPSIS_MOTION_FIRST,
                State::Tracked => STEREOPSIS_MOTION_TRACKED,
                State::Stationary => STEREOPSIS_MOTION_STATIONARY,
                State::RotationOnly => STEREOPSIS_MOTION_ROTATION_ONLY,
                State::TranslationUnknown => STEREOPSIS_MOTION_STEP_UNKNOWN,
                // A pair never waits for its unit of length.
                State::Lost | State::Waiting => STEREOPSIS_MOTION_LOST,
                State::Found => STEREOPSIS_MOTION_FOUND,
                State::Restarted => STEREOPSIS_MOTION_RESTARTED,
                State::Uncertain => STEREOPSIS_MOTION_UNCERTAIN,
                State::LeftOnly => STEREOPSIS_MOTION_LEFT_ONLY,
            },
        }
    }
}

/// Fills a configuration, as `stereopsis_odometry_default`.
///
/// # Safety
///
/// `config` is null or points to a configuration's bytes.
pub unsafe fn odometry_default(width: u16, config: *mut COdometryConfig) -> Status {
    either(checked(config).map(|()| {
        let OdometryConfig {
            far_px,
            near_px,
            most_disparity_px,
            sigma_px,
            spacing_px,
            most_samples,
            seed,
            ..
        } = OdometryConfig::new(width);
        let filled =
            COdometryConfig { seed, far_px, near_px, sigma_px, spacing_px, most_samples, most_disparity_px };
        // SAFETY: the caller's promise, and it is aligned.
        unsafe { config.write(filled) };
        Status::Ok
    }))
}

/// Returns the picture at a pointer.
///
/// # Safety
///
/// `picture` is null or points to a picture whose pixels are null or there, and nothing writes them during
/// `'a`.
pub(super) unsafe fn picture_of<'a>(picture: *const CPicture) -> Result<Picture<'a>, Status> {
    checked(picture)?;
    // SAFETY: the caller's promise, and it is aligned.
    let CPicture { pixels, width, height } = unsafe { picture.read() };
    checked(pixels)?;
    // 32 bits hold it, and so does an address space that holds the pixels.
    let count = usize::from(width).checked_mul(usize::from(height)).filter(|&n| n <= isize::MAX as usize);
    let count = count.ok_or(Status::TooMany)?;
    // SAFETY: the caller's promise.
    let pixels = unsafe { from_raw_parts(pixels, count) };
    Picture::new(pixels, width, height).map_err(|_| Status::PictureSize)
}
