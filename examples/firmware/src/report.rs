//! One frame through the pipeline, told in numbers that do not depend on the core: the same text on board and host.

use crate::camera::{BOARD_COLUMNS, BOARD_DISPARITY, BOARD_ROWS, BoardCamera, HEIGHT, WIDTH, floor_disparity};
use core::fmt;
use stereopsis::depth::DepthScale;
use stereopsis::geometry::RectifiedRig;
use stereopsis::matching::{Block, Config, Row};
use stereopsis::pipeline::Pipeline;
use stereopsis::units::{Disparity, Millimetres, PixelFlags};

/// Disparities that are searched.
pub const DISPARITIES: u16 = 32;

/// The pipeline that fits the camera.
pub type BoardPipeline = Pipeline<Block, { WIDTH as usize }, { DISPARITIES as usize }>;

/// What a frame came to.
#[derive(Default)]
pub struct Report {
    rows: u16,
    answers: u32,
    within_1px: u32,
    flags: [u32; PixelFlags::NAMES.len()],
    board: Millimetres,
    crc: Crc32,
}

/// The cameras' focal length, px, and baseline, m: the board is 450 mm away.
const FOCAL_PX: f32 = 150.0;
const BASELINE_M: f32 = 0.06;
/// The pixel at the middle of the board.
const BOARD_MIDDLE: (i32, i32) =
    ((BOARD_COLUMNS.start + BOARD_COLUMNS.end) / 2, (BOARD_ROWS.start + BOARD_ROWS.end) / 2);

impl Report {
    /// Takes a frame.
    pub fn take_frame(pipeline: &mut BoardPipeline, camera: &mut BoardCamera) -> Result<Self, Failure> {
        let (cx, cy) = (f32::from(WIDTH - 1) / 2.0, f32::from(HEIGHT - 1) / 2.0);
        let rig = RectifiedRig::new(FOCAL_PX, BASELINE_M, cx, cy).map_err(|_| Failure::Rig)?;
        let scale = DepthScale::new(&rig).map_err(|_| Failure::Rig)?;
        pipeline.start(&Config::new(WIDTH, HEIGHT, DISPARITIES)).map_err(|_| Failure::Start)?;
        pipeline.begin_frame(camera).map_err(|_| Failure::Frame)?;
        let mut report = Self::default();
        while let Some(row) = pipeline.next_row(camera).map_err(|_| Failure::Row(report.rows))? {
            report.take_row(&row, &scale);
        }
        Ok(report)
    }

    fn take_row(&mut self, row: &Row<'_>, scale: &DepthScale) {
        let v = i32::from(row.index());
        for ((u, disparity), flags) in (0..).zip(row.disparities()).zip(row.flags()) {
            for byte in disparity.raw().to_le_bytes() {
                self.crc.take(byte);
            }
            self.crc.take(flags.bits());
            for (count, (flag, _)) in self.flags.iter_mut().zip(PixelFlags::NAMES) {
                *count += u32::from(flags.contains(flag));
            }
            if (u, v) == BOARD_MIDDLE {
                self.board = scale.millimetres(*disparity);
            }
            if let Some(error) = disparity.distance(true_disparity(u, v)) {
                self.answers += 1;
                self.within_1px += u32::from(error <= Disparity::ONE);
            }
        }
        self.rows += 1;
    }
}

/// The disparity of the surface that the left camera sees.
fn true_disparity(u: i32, v: i32) -> Disparity {
    if BOARD_COLUMNS.contains(&u) && BOARD_ROWS.contains(&v) {
        Disparity::from_pixels(BOARD_DISPARITY)
    } else {
        // 1/16 px to the type's steps.
        Disparity::from_raw(floor_disparity(v) as u16 * (Disparity::ONE / 16))
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "method block, {WIDTH}x{HEIGHT}, {DISPARITIES} disparities")?;
        writeln!(f, "rows {}", self.rows)?;
        writeln!(f, "answers {} of {}", self.answers, u32::from(WIDTH) * u32::from(HEIGHT))?;
        writeln!(f, "within 1 px of the truth {}", self.within_1px)?;
        writeln!(f, "depth of the board {} mm", self.board.0)?;
        for (count, (_, name)) in self.flags.iter().zip(PixelFlags::NAMES) {
            writeln!(f, "flag {name} {count}")?;
        }
        writeln!(f, "crc32 of disparities and flags {:08x}", self.crc.value())
    }
}

/// Where a frame broke off.
#[derive(Debug)]
pub enum Failure {
    /// The rig has no depths.
    Rig,
    /// The pipeline did not take the configuration.
    Start,
    /// No frame began.
    Frame,
    /// No row came out after this many.
    Row(u16),
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rig => f.write_str("the rig has no depths"),
            Self::Start => f.write_str("the pipeline did not take the configuration"),
            Self::Frame => f.write_str("no frame began"),
            Self::Row(rows) => write!(f, "no row came out after {rows}"),
        }
    }
}

/// CRC-32 as in Ethernet and PNG (reflected 0x04C11DB7, all ones before and after), bit by bit.
struct Crc32(u32);

impl Default for Crc32 {
    fn default() -> Self {
        Self(u32::MAX)
    }
}

impl Crc32 {
    fn take(&mut self, byte: u8) {
        self.0 ^= u32::from(byte);
        for _ in 0..8 {
            self.0 = (self.0 >> 1) ^ (0xEDB8_8320 & (self.0 & 1).wrapping_neg());
        }
    }

    fn value(&self) -> u32 {
        !self.0
    }
}
