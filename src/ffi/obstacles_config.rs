//! Limits of the obstacle stages in C.
#![allow(unsafe_code)]

use super::Status;
use super::state::checked;
use super::status::either;
use crate::obstacles::{GroundSource, ObstacleConfig, ObstacleError};

/// Ground: there is none, as for a camera that flies; every surface in range is an obstacle.
pub const STEREOPSIS_GROUND_ABSENT: u8 = 0;
/// Ground: the camera's `pitch_mrad`, `roll_mrad` and `height_mm` are known, as from an inertial sensor.
pub const STEREOPSIS_GROUND_GIVEN: u8 = 1;
/// Ground: it is searched in each frame, within the heights, the pitch and the roll of the configuration.
pub const STEREOPSIS_GROUND_SEARCHED: u8 = 2;

/// Limits by which rows of disparity become ground, obstacles and drops, filled by
/// `stereopsis_obstacles_default` and then open to changes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct CObstacleConfig {
    /// Standard deviation of a right answer, in 1/32 px, 1 to 320.
    pub sigma_steps: u16,
    /// Least height of an obstacle above the ground, mm.
    pub obstacle_mm: u16,
    /// Least depth of a drop below the ground, mm.
    pub drop_mm: u16,
    /// Height above which a surface is passed under, mm; 65535 where nothing is.
    pub headroom_mm: u16,
    /// Least area of the connected surface of an obstacle or a drop, px.
    pub min_pixels: u16,
    /// Smallest height of the camera above a ground that is searched, mm.
    pub least_height_mm: u16,
    /// Largest height of the camera above a ground that is searched, mm.
    pub most_height_mm: u16,
    /// Largest tangent of the camera's pitch above a ground that is searched, up or down, in thousandths.
    pub most_pitch: u16,
    /// Largest tangent of the camera's roll above a ground that is searched, to either side, in thousandths.
    pub most_roll: u16,
    /// Height of the camera above a ground that is given, mm.
    pub height_mm: u16,
    /// Downward pitch of the camera above a ground that is given, thousandths of a radian, -500 to 500.
    pub pitch_mrad: i16,
    /// Roll of the camera above a ground that is given, thousandths of a radian, -500 to 500: positive where
    /// its right side is the lower one.
    pub roll_mrad: i16,
    /// Where the ground comes from: a `STEREOPSIS_GROUND_` number.
    pub ground: u8,
    /// Columns of pixels in a cell, 1 to 16.
    pub cell_width: u8,
    /// Rows of pixels in a cell, 1 to 16; a cell has at most 255 pixels.
    pub cell_height: u8,
    /// Least confidence of an answer that counts, where rows have confidences.
    pub min_confidence: u8,
    /// Least confidence of an answer above the horizon, where rows have confidences.
    pub sky_confidence: u8,
    /// Number of sectors that the field of view is cut into, 1 to 32.
    pub sectors: u8,
    /// Least share of cells with an answer in a frame, percent; fewer make it blind.
    pub least_answered: u8,
    /// Largest share of rows that were lost or are damaged, percent; more make a frame blind.
    pub most_lost: u8,
}

impl From<ObstacleError> for Status {
    fn from(e: ObstacleError) -> Self {
        match e {
            ObstacleError::NotStarted => Self::NotStarted,
            ObstacleError::Cells => Self::ObstacleCells,
            ObstacleError::Sectors => Self::ObstacleSectors,
            ObstacleError::Pose => Self::ObstaclePose,
            ObstacleError::Limits => Self::ObstacleLimits,
            ObstacleError::Columns { .. } | ObstacleError::Rows { .. } => Self::ObstacleSize,
        }
    }
}

impl From<ObstacleConfig> for CObstacleConfig {
    fn from(config: ObstacleConfig) -> Self {
        let mut c = Self {
            sigma_steps: config.sigma_steps,
            obstacle_mm: config.obstacle_mm,
            drop_mm: config.drop_mm,
            headroom_mm: config.headroom_mm,
            min_pixels: config.min_pixels,
            least_height_mm: 0,
            most_height_mm: 0,
            most_pitch: 0,
            most_roll: 0,
            height_mm: 0,
            pitch_mrad: 0,
            roll_mrad: 0,
            ground: STEREOPSIS_GROUND_ABSENT,
            cell_width: config.cell_width,
            cell_height: config.cell_height,
            min_confidence: config.min_confidence,
            sky_confidence: config.sky_confidence,
            sectors: config.sectors,
            least_answered: config.least_answered,
            most_lost: config.most_lost,
        };
        match config.ground {
            GroundSource::Absent => {}
            GroundSource::Given { pitch_mrad, roll_mrad, height_mm } => {
                c.ground = STEREOPSIS_GROUND_GIVEN;
                (c.pitch_mrad, c.roll_mrad, c.height_mm) = (pitch_mrad, roll_mrad, height_mm);
            }
            GroundSource::Searched { least_height_mm, most_height_mm, most_pitch, most_roll } => {
                c.ground = STEREOPSIS_GROUND_SEARCHED;
                (c.least_height_mm, c.most_height_mm) = (least_height_mm, most_height_mm);
                (c.most_pitch, c.most_roll) = (most_pitch, most_roll);
            }
        }
        c
    }
}

impl CObstacleConfig {
    pub(super) fn checked(self) -> Result<ObstacleConfig, Status> {
        let Self { least_height_mm, most_height_mm, most_pitch, most_roll, .. } = self;
        let Self { height_mm, pitch_mrad, roll_mrad, .. } = self;
        let ground = match self.ground {
            STEREOPSIS_GROUND_ABSENT => GroundSource::Absent,
            STEREOPSIS_GROUND_GIVEN => GroundSource::Given { pitch_mrad, roll_mrad, height_mm },
            STEREOPSIS_GROUND_SEARCHED => {
                GroundSource::Searched { least_height_mm, most_height_mm, most_pitch, most_roll }
            }
            _ => return Err(Status::ObstacleGround),
        };
        Ok(ObstacleConfig {
            cell_width: self.cell_width,
            cell_height: self.cell_height,
            sigma_steps: self.sigma_steps,
            min_confidence: self.min_confidence,
            sky_confidence: self.sky_confidence,
            ground,
            obstacle_mm: self.obstacle_mm,
            drop_mm: self.drop_mm,
            headroom_mm: self.headroom_mm,
            min_pixels: self.min_pixels,
            sectors: self.sectors,
            least_answered: self.least_answered,
            most_lost: self.most_lost,
        })
    }
}

/// Fills a configuration, as `stereopsis_obstacles_default`.
///
/// # Safety
///
/// `config` is null or points to a configuration's bytes.
pub unsafe fn obstacles_default(config: *mut CObstacleConfig) -> Status {
    either(checked(config).map(|()| {
        // SAFETY: the caller's promise, and it is aligned.
        unsafe { config.write(ObstacleConfig::default().into()) };
        Status::Ok
    }))
}
