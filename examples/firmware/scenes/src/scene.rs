//! A pair of cameras without hardware: they look at a floor that tilts away and a square board in front of
//! it.
//!
//! Everything is integer arithmetic on row and column, so that every core sees the same pixels. In a product
//! this file is the driver: `start_frame` waits for the sensors' frame sync, `next_lines` copies what the DMA
//! brought.

use core::convert::Infallible;
use core::ops::Range;
use stereopsis::camera::{
    CameraError, ErrorType, FrameStart, LineFormat, LineStart, PixelFormat, StereoSource,
};

/// Fractional bits of a position in a texture: disparities of the floor are multiples of 1/16 px.
const FRACTION_BITS: i32 = 4;
/// Microseconds from frame to frame.
const FRAME_US: u64 = 33_333;
/// Microseconds from line to line.
const LINE_US: u64 = 250;

/// The two cameras.
pub struct SceneCamera {
    scene: Scene,
    frames: u32,
    next_row: Option<u16>,
}

/// What the cameras look at, as large as their pictures: the board is an eighth of the width away.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Scene {
    /// Pixels in a line.
    pub width: u16,
    /// Lines in a frame.
    pub height: u16,
}

impl Scene {
    /// The disparity of the board, px.
    pub const fn board_disparity(self) -> u16 {
        self.width / 8
    }

    /// Where the left camera sees the board, columns.
    pub const fn board_columns(self) -> Range<i32> {
        let width = self.width as i32;
        width * 3 / 8..width * 11 / 16
    }

    /// Where both cameras see the board, rows.
    pub const fn board_rows(self) -> Range<i32> {
        let height = self.height as i32;
        height / 4..height * 2 / 3
    }

    /// The disparity of the floor in row `v`, 1/16 px: a fortieth of the width at the top, under three at the
    /// bottom.
    pub const fn floor_disparity(self, v: i32) -> i32 {
        let (width, height) = (self.width as u32, if self.height == 0 { 1 } else { self.height as u32 });
        (width * 16 / 40 + v as u32 * (width * 3 / 4) / height) as i32
    }

    /// Whether the left camera's pixel is the board's.
    pub fn on_board(self, u: i32, v: i32) -> bool {
        self.board_columns().contains(&u) && self.board_rows().contains(&v)
    }

    /// What the left camera sees at column `u`, row `v`: textures are fixed to its columns.
    fn left_pixel(self, u: i32, v: i32) -> u8 {
        texture(u << FRACTION_BITS, v, if self.on_board(u, v) { BOARD } else { FLOOR })
    }

    /// What the right camera sees: the board's pixel if it hides the floor there, else the floor's.
    fn right_pixel(self, u: i32, v: i32, floor_disparity: i32) -> u8 {
        let on_board_at = u + i32::from(self.board_disparity());
        if self.on_board(on_board_at, v) {
            texture(on_board_at << FRACTION_BITS, v, BOARD)
        } else {
            texture((u << FRACTION_BITS) + floor_disparity, v, FLOOR)
        }
    }
}

impl SceneCamera {
    /// Cameras that have not begun a frame yet.
    pub const fn new(scene: Scene) -> Self {
        Self { scene, frames: 0, next_row: None }
    }

    /// When the frame that was started last began, microseconds.
    fn frame_us(&self) -> u64 {
        u64::from(self.frames) * FRAME_US
    }
}

impl ErrorType for SceneCamera {
    type Error = Infallible;
}

impl StereoSource for SceneCamera {
    fn format(&self) -> LineFormat {
        LineFormat { width: self.scene.width, height: self.scene.height, pixel: PixelFormat::Grey8 }
    }

    fn max_row_skew_us(&self) -> u32 {
        0
    }

    fn start_frame(&mut self) -> Result<FrameStart, CameraError<Infallible>> {
        self.frames = self.frames.wrapping_add(1);
        self.next_row = Some(0);
        Ok(FrameStart { sequence: self.frames, timestamp_us: self.frame_us(), exposure_us: 8_000 })
    }

    fn next_lines(
        &mut self,
        left: &mut [u8],
        right: &mut [u8],
    ) -> Result<LineStart, CameraError<Infallible>> {
        let row = self.next_row.filter(|&row| row < self.scene.height).ok_or(CameraError::NoLineLeft)?;
        let needed = usize::from(self.scene.width);
        let (Some(left), Some(right)) = (left.get_mut(..needed), right.get_mut(..needed)) else {
            return Err(CameraError::BufferTooShort { needed });
        };
        let v = i32::from(row);
        let floor = self.scene.floor_disparity(v);
        for ((u, l), r) in (0..).zip(left).zip(right) {
            *l = noisy(self.scene.left_pixel(u, v), u, v, 1);
            *r = noisy(self.scene.right_pixel(u, v, floor), u, v, 2);
        }
        self.next_row = Some(row + 1);
        Ok(LineStart { row, timestamp_us: self.frame_us() + u64::from(row) * LINE_US })
    }
}

/// Seeds of the two surfaces' textures.
const FLOOR: u32 = 0x5EED_0001;
const BOARD: u32 = 0x5EED_0002;

/// The brightness of a surface at a column in 1/16 px: between two columns the straight line.
pub(crate) fn texture(u: i32, v: i32, seed: u32) -> u8 {
    let column = u >> FRACTION_BITS;
    let part = (u & ((1 << FRACTION_BITS) - 1)) as u32;
    let (a, b) = (grain(column, v, seed), grain(column + 1, v, seed));
    ((a * (16 - part) + b * part + 8) >> FRACTION_BITS) as u8
}

/// The brightness at a whole column: coarse grains of 4x4 pixels and fine ones of one, 32 to 223.
fn grain(u: i32, v: i32, seed: u32) -> u32 {
    let coarse = hash(u >> 2, v >> 2, seed) & 127;
    let fine = hash(u, v, !seed) & 63;
    32 + coarse + fine
}

/// Sensor noise of up to 2 grey levels either way, different in the two cameras.
fn noisy(pixel: u8, u: i32, v: i32, camera: u32) -> u8 {
    let noise = (hash(u, v, 0xA015_E000 + camera) % 5) as u8;
    // A pixel is between 32 and 223, so this cannot wrap.
    pixel + noise - 2
}

/// A well-mixed word for each pair of coordinates (a multiply-xorshift hash).
pub(crate) fn hash(u: i32, v: i32, seed: u32) -> u32 {
    let mut h = seed ^ (u as u32).wrapping_mul(0x9E37_79B1) ^ (v as u32).wrapping_mul(0x85EB_CA77);
    h = (h ^ (h >> 15)).wrapping_mul(0x2C1B_3C6D);
    h = (h ^ (h >> 12)).wrapping_mul(0x297A_2D39);
    h ^ (h >> 15)
}
