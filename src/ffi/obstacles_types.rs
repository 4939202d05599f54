//! Ground, stixels, sectors and a laser scan in C.

use crate::obstacles::{BlindReason, Ground, LaserScan, Sector, SectorState, Stixel, StixelKind};

/// Stixel: nothing that enough cells show; that is not to say that the column is free.
pub const STEREOPSIS_STIXEL_NOTHING: u8 = 0;
/// Stixel: a surface that rises above the ground.
pub const STEREOPSIS_STIXEL_OBSTACLE: u8 = 1;
/// Stixel: the edge of a surface that is deeper than the ground.
pub const STEREOPSIS_STIXEL_DROP: u8 = 2;

/// Sector: too little is seen to say anything; never take it for free.
pub const STEREOPSIS_SECTOR_BLIND: u8 = 0;
/// Sector: there is no obstacle up to `seen_mm`.
pub const STEREOPSIS_SECTOR_FREE: u8 = 1;
/// Sector: there is an obstacle.
pub const STEREOPSIS_SECTOR_OBSTACLE: u8 = 2;
/// Sector: the ground ends.
pub const STEREOPSIS_SECTOR_DROP: u8 = 3;

/// Blind: it is not, the frame is to be trusted.
pub const STEREOPSIS_BLIND_NOT: u8 = 0;
/// Blind: no frame has been finished since the start.
pub const STEREOPSIS_BLIND_NO_FRAME: u8 = 1;
/// Blind: too many rows were lost or are damaged.
pub const STEREOPSIS_BLIND_ROWS_LOST: u8 = 2;
/// Blind: too few cells have an answer, as in the dark, behind a covered lens, before a white wall.
pub const STEREOPSIS_BLIND_FEW_ANSWERS: u8 = 3;
/// Blind: a camera's picture is black, saturated, flat or repeating.
pub const STEREOPSIS_BLIND_CAMERA: u8 = 4;
/// Blind: the left and the right camera are swapped.
pub const STEREOPSIS_BLIND_SWAPPED: u8 = 5;
/// Blind: a ground was to be searched and is not found.
pub const STEREOPSIS_BLIND_NO_GROUND: u8 = 6;
/// Blind: too little of the ground that is driven on next is seen.
pub const STEREOPSIS_BLIND_UNSEEN: u8 = 7;

/// The constants are literals for the header; these assertions check their values.
const _: () = {
    assert!(STEREOPSIS_STIXEL_NOTHING == StixelKind::Nothing as u8);
    assert!(STEREOPSIS_STIXEL_OBSTACLE == StixelKind::Obstacle as u8);
    assert!(STEREOPSIS_STIXEL_DROP == StixelKind::Drop as u8);
    assert!(STEREOPSIS_SECTOR_BLIND == SectorState::Blind as u8);
    assert!(STEREOPSIS_SECTOR_FREE == SectorState::Free as u8);
    assert!(STEREOPSIS_SECTOR_OBSTACLE == SectorState::Obstacle as u8);
    assert!(STEREOPSIS_SECTOR_DROP == SectorState::Drop as u8);
    assert!(STEREOPSIS_BLIND_NO_FRAME == BlindReason::NoFrame as u8);
    assert!(STEREOPSIS_BLIND_ROWS_LOST == BlindReason::RowsLost as u8);
    assert!(STEREOPSIS_BLIND_FEW_ANSWERS == BlindReason::FewAnswers as u8);
    assert!(STEREOPSIS_BLIND_CAMERA == BlindReason::Camera as u8);
    assert!(STEREOPSIS_BLIND_SWAPPED == BlindReason::Swapped as u8);
    assert!(STEREOPSIS_BLIND_NO_GROUND == BlindReason::NoGround as u8);
    assert!(STEREOPSIS_BLIND_UNSEEN == BlindReason::Unseen as u8);
};

/// Number of a reason, 0 for none.
pub(super) fn blind_number(reason: Option<BlindReason>) -> u8 {
    reason.map_or(STEREOPSIS_BLIND_NOT, |reason| reason as u8)
}

/// Ground plane: its parallax grows by `slope` from row to row and by `lean` from column to column.
#[derive(Clone, Copy, PartialEq, Debug)]
#[repr(C)]
pub struct CGround {
    /// Parallax at row 0 in the column of the principal point, in 1/32 px, in 65536ths.
    pub level: i64,
    /// Growth of the parallax from a row to the next, in 1/32 px, in 65536ths.
    pub slope: i64,
    /// Growth of the parallax from a column to the next, in 1/32 px, in 65536ths.
    pub lean: i32,
    /// Downward pitch of the camera, radians.
    pub pitch_rad: f32,
    /// Roll of the camera, radians: positive where its right side is the lower one.
    pub roll_rad: f32,
    /// Standard deviation of the pitch, radians.
    pub pitch_sigma_rad: f32,
    /// Variance of the parallax, squares of 1/32 px.
    pub variance: u32,
    /// Height of the camera above the ground, mm.
    pub height_mm: u16,
    /// Whether the ground is known: three deviations of its pitch are within half a degree. Where it is not,
    /// the rest is the plane from which heights are measured, of which too little is seen to be sure of its
    /// pitch; the height is 0 where there is none, as is all else.
    pub is_known: u8,
}

/// Nearest obstacle or drop of a column of cells.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct CStixel {
    /// First row of pixels.
    pub top_row: u16,
    /// Last row of pixels.
    pub base_row: u16,
    /// Disparity in 1/32 px, `STEREOPSIS_NONE` for nothing; of a drop that of the ground at its edge.
    pub disparity: u16,
    /// Standard deviation of the disparity, in 1/32 px, at most 255.
    pub sigma_steps: u16,
    /// Depth along the optical axis, mm; 0 for nothing.
    pub depth_mm: u16,
    /// Uppermost row of pixels to which the ground is seen from the lowest one on; the first row below
    /// the cells where it is not, and 65535 in a frame that is not finished.
    pub seen_row: u16,
    /// What it is: a `STEREOPSIS_STIXEL_` number.
    pub kind: u8,
}

/// Nearest surface in a sector of the field of view.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct CSector {
    /// Area of the connected surface, px, in whole cells.
    pub pixels: u32,
    /// Bearing of the surface, or of the sector's middle where there is none, thousandths of a radian, to the
    /// right.
    pub bearing_mrad: i16,
    /// Depth of the surface along the optical axis, mm; 0 where there is none.
    pub depth_mm: u16,
    /// Standard deviation of the depth, mm.
    pub sigma_mm: u16,
    /// Distance of the surface in the plane of the optical axis and the rows, mm.
    pub range_mm: u16,
    /// Height of the surface's upper end above the ground, mm; 0 where no ground is known.
    pub height_mm: i16,
    /// Depth up to which the ground is seen in all columns that show it, mm; without a ground, 65535.
    pub seen_mm: u16,
    /// What the sector shows: a `STEREOPSIS_SECTOR_` number.
    pub state: u8,
}

/// Angles and limits of a laser scan: radians to the left, as ROS has them, and metres.
#[derive(Clone, Copy, PartialEq, Debug)]
#[repr(C)]
pub struct CScan {
    /// Angle of the first range, rad: the middle of the rightmost sector.
    pub angle_min: f32,
    /// Angle of the last range that was written, rad: the middle of the leftmost sector where all are.
    pub angle_max: f32,
    /// Angle between two ranges, rad.
    pub angle_increment: f32,
    /// Smallest range that can be measured, m.
    pub range_min: f32,
    /// The range up to which a free sector is free, m: that up to which all of them are seen. Obstacles
    /// beyond it are there, but who takes a scan leaves them out.
    pub range_max: f32,
    /// Number of ranges that were written.
    pub count: u32,
}

impl From<Option<Ground>> for CGround {
    fn from(ground: Option<Ground>) -> Self {
        let Some(ground) = ground else {
            return Self {
                level: 0,
                slope: 0,
                lean: 0,
                pitch_rad: 0.0,
                roll_rad: 0.0,
                pitch_sigma_rad: 0.0,
                variance: 0,
                height_mm: 0,
                is_known: 0,
            };
        };
        let (pitch_rad, roll_rad, pitch_sigma_rad) =
            (ground.pitch_rad(), ground.roll_rad(), ground.pitch_sigma_rad());
        let (is_known, Ground { level, slope, lean, variance, height_mm, .. }) =
            (ground.is_sure().into(), ground);
        Self { level, slope, lean, pitch_rad, roll_rad, pitch_sigma_rad, variance, height_mm, is_known }
    }
}

impl From<Stixel> for CStixel {
    fn from(stixel: Stixel) -> Self {
        let Stixel { kind, top_row, base_row, disparity, sigma_steps, depth_mm, seen_row } = stixel;
        let (disparity, kind) = (disparity.raw(), kind as u8);
        Self { top_row, base_row, disparity, sigma_steps, depth_mm, seen_row, kind }
    }
}

impl From<Sector> for CSector {
    fn from(sector: Sector) -> Self {
        let Sector { state, bearing_mrad, depth_mm, sigma_mm, range_mm, pixels, height_mm, seen_mm } = sector;
        Self { pixels, bearing_mrad, depth_mm, sigma_mm, range_mm, height_mm, seen_mm, state: state as u8 }
    }
}

impl From<LaserScan> for CScan {
    fn from(scan: LaserScan) -> Self {
        let LaserScan { angle_min, angle_max, angle_increment, range_min, range_max, count } = scan;
        Self { angle_min, angle_max, angle_increment, range_min, range_max, count: count as u32 }
    }
}
