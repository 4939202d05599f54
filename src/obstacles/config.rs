//! Limits of the obstacle stages, and why they cannot be had.

use crate::units::Disparity;

/// Where the ground plane comes from.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum GroundSource {
    /// There is none, as for a camera that flies: every surface in range is an obstacle. A column is seen
    /// where it has answers from the picture's upper edge to the lower one, with gaps of at most two rows of
    /// cells.
    Absent,
    /// The camera's pose is known, as from an inertial sensor.
    Given {
        /// Downward pitch of the camera, thousandths of a radian, -500 to 500.
        pitch_mrad: i16,
        /// Roll of the camera, thousandths of a radian, -500 to 500: positive where its right side is the
        /// lower one.
        roll_mrad: i16,
        /// Height of the camera above the ground, mm.
        height_mm: u16,
    },
    /// The plane is searched in each frame.
    Searched {
        /// Smallest height of the camera above the ground, mm.
        least_height_mm: u16,
        /// Largest height of the camera above the ground, mm.
        most_height_mm: u16,
        /// Largest tangent of the camera's pitch, up or down, in thousandths.
        most_pitch: u16,
        /// Largest tangent of the camera's roll, to either side, in thousandths; 0 where it is upright.
        most_roll: u16,
    },
}

/// Limits by which rows of disparity become ground, obstacles and drops.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ObstacleConfig {
    /// Columns of pixels in a cell, 1 to 16.
    pub cell_width: u8,
    /// Rows of pixels in a cell, 1 to 16; a cell has at most 255 pixels.
    pub cell_height: u8,
    /// Standard deviation of a right answer, steps of 1/32 px, 1 to 320.
    pub sigma_steps: u16,
    /// Least confidence of an answer that counts, where confidences are given.
    pub min_confidence: u8,
    /// Least confidence of an answer above the horizon, where confidences are given: below it the ground
    /// tells what is wrong, above it nothing does. The methods along paths carry wrong matches over a noisy
    /// sky, and need it.
    pub sky_confidence: u8,
    /// Where the ground comes from.
    pub ground: GroundSource,
    /// Least height of an obstacle above the ground, mm.
    pub obstacle_mm: u16,
    /// Least depth of a drop below the ground, mm.
    pub drop_mm: u16,
    /// Height above which a surface is passed under, mm; `u16::MAX` where nothing is.
    pub headroom_mm: u16,
    /// Least area of the connected surface of an obstacle or a drop, px.
    pub min_pixels: u16,
    /// Number of sectors that the field of view is cut into, 1 to 32.
    pub sectors: u8,
    /// Least share of cells with an answer in a frame, percent; fewer make it blind.
    pub least_answered: u8,
    /// Largest share of rows that were lost or are damaged, percent; more make a frame blind.
    pub most_lost: u8,
}

impl ObstacleConfig {
    /// Largest number of sectors.
    pub const MOST_SECTORS: usize = 32;

    /// Smallest parallax at which a distance is reported, in standard deviations of disparity: there
    /// `sigma_Z` is a tenth of `Z`.
    pub const FARTHEST_SIGMAS: u16 = 10;

    /// The limits before a start, which find nothing.
    pub(super) const ZERO: Self = Self {
        cell_width: 0,
        cell_height: 0,
        sigma_steps: 0,
        min_confidence: 0,
        sky_confidence: 0,
        ground: GroundSource::Absent,
        obstacle_mm: 0,
        drop_mm: 0,
        headroom_mm: 0,
        min_pixels: 0,
        sectors: 0,
        least_answered: 0,
        most_lost: 0,
    };

    /// Least confidence of an answer, above the horizon or below it.
    pub(super) fn least_confidence(&self, is_sky: bool) -> u8 {
        self.min_confidence.max(if is_sky { self.sky_confidence } else { 0 })
    }

    pub(super) fn check(&self) -> Result<(), ObstacleError> {
        let side = 1..=16;
        let area = u16::from(self.cell_width) * u16::from(self.cell_height);
        if !side.contains(&self.cell_width) || !side.contains(&self.cell_height) || area > 255 {
            return Err(ObstacleError::Cells);
        }
        if !(1..=Self::MOST_SECTORS as u8).contains(&self.sectors) {
            return Err(ObstacleError::Sectors);
        }
        let pose = match self.ground {
            GroundSource::Absent => true,
            GroundSource::Given { pitch_mrad, roll_mrad, height_mm } => {
                height_mm > 0 && pitch_mrad.unsigned_abs().max(roll_mrad.unsigned_abs()) <= 500
            }
            GroundSource::Searched { least_height_mm, most_height_mm, .. } => {
                0 < least_height_mm && least_height_mm <= most_height_mm
            }
        };
        if !pose {
            return Err(ObstacleError::Pose);
        }
        if !(1..=10 * Disparity::ONE).contains(&self.sigma_steps)
            || self.obstacle_mm == 0
            || self.drop_mm == 0
        {
            return Err(ObstacleError::Limits);
        }
        Ok(())
    }
}

impl Default for ObstacleConfig {
    /// Cells of 4 x 5 px, a deviation of 0.15 px as all methods have it, a ground 0.1 m to 3 m below a camera
    /// that is pitched by at most 27 degrees and rolled by at most 7, obstacles and drops of 5 cm, 16
    /// sectors, and a confidence of 100 in the sky.
    ///
    /// The least area is four matching windows of 9 x 9 px: a wrong answer spreads over one window, and the
    /// next one agrees with it within one px by chance in one case of sixteen, with 32 disparities. A tenth
    /// of the cells has to have answers, and at most a tenth of the rows may be lost.
    fn default() -> Self {
        Self {
            cell_width: 4,
            cell_height: 5,
            sigma_steps: 5,
            min_confidence: 0,
            sky_confidence: 100,
            ground: GroundSource::Searched {
                least_height_mm: 100,
                most_height_mm: 3000,
                most_pitch: 500,
                most_roll: 120,
            },
            obstacle_mm: 50,
            drop_mm: 50,
            headroom_mm: u16::MAX,
            min_pixels: 324,
            sectors: 16,
            least_answered: 10,
            most_lost: 10,
        }
    }
}

/// Why obstacles cannot be found with a configuration.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ObstacleError {
    /// The finder was not started.
    NotStarted,
    /// A cell's side is not 1 to 16 px, or its area is over 255 px.
    Cells,
    /// The number of sectors is not 1 to 32.
    Sectors,
    /// The given height is zero, the given pitch or roll is over 500 mrad, or the heights searched are in no
    /// order.
    Pose,
    /// The deviation is not 1 to 320 steps, or the height of an obstacle or the depth of a drop is zero.
    Limits,
    /// The picture has too many columns of cells, or none.
    Columns {
        /// Columns of cells in the picture, at least 1.
        needed: usize,
    },
    /// The picture has too many rows of cells, or none.
    Rows {
        /// Rows of cells in the picture, at least 1.
        needed: usize,
    },
}

error_text!(ObstacleError {
    Self::NotStarted => "the finder is not started",
    Self::Cells => "a cell must have sides of 1 to 16 px and at most 255 px",
    Self::Sectors => "there must be 1 to 32 sectors",
    Self::Pose => "the ground needs a height over zero, pitch and roll up to 500 mrad, and heights in order",
    Self::Limits => "the deviation must be 1 to 320 steps, and obstacles and drops over 0 mm",
    Self::Columns { needed } => "the memory must hold {needed} columns of cells",
    Self::Rows { needed } => "the memory must hold {needed} rows of cells, at most 255",
});
