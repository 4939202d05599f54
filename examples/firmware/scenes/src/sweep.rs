//! A camera whose lens moves before a slope, and the frame in which each tile of it is sharpest.
//!
//! It knows no hardware: the same runs on the host, which compares. In a product the lines are those of a
//! camera, and a `stereopsis::focus::LensActuator` moves the lens between two frames.

use stereopsis::focus::{Breathing, FocusConfig, FocusConfigError, FocusLineError, FocusMap};

/// Pixels in a line.
pub const WIDTH: usize = 160;
/// Lines in a frame.
pub const HEIGHT: usize = 120;
/// Frames of a sweep.
pub const FRAMES: u32 = 9;
/// An answer a tile of 8x8 pixels.
pub const CONFIG: FocusConfig = FocusConfig::tiles(WIDTH as u16, HEIGHT as u16);

/// The map with room for all tiles: the state that stays from frame to frame.
pub type Map = FocusMap<WIDTH, { CONFIG.columns() }, { CONFIG.cells() }>;

/// The lens moves, and the map sees what the camera sees.
pub struct Sweep {
    /// Where each tile is in focus.
    pub map: Map,
    line: [u8; WIDTH],
}

/// Why a sweep broke off; which it does not.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Broken {
    /// The map cannot be of this kind.
    Config(FocusConfigError),
    /// A line or a frame was not due.
    Line(FocusLineError),
}

impl Sweep {
    /// The lens has not moved yet.
    pub const fn new() -> Self {
        Self { map: Map::new(), line: [0; WIDTH] }
    }

    /// All frames through the map, whose ticks by the clock are counted, the camera's not; how many.
    ///
    /// # Errors
    /// When the map is too small for the frames; which it is not.
    pub fn run(&mut self, clock: impl Fn() -> u64) -> Result<u64, Broken> {
        let mut ticks = 0;
        self.map.start(&CONFIG).map_err(Broken::Config)?;
        for frame in 0..FRAMES {
            let start = clock();
            self.map.begin_frame(Breathing::NONE).map_err(Broken::Line)?;
            ticks += clock() - start;
            for row in 0..HEIGHT {
                see(frame, row, &mut self.line);
                let start = clock();
                self.map.push(&self.line, |_| {}).map_err(Broken::Line)?;
                ticks += clock() - start;
            }
        }
        let start = clock();
        self.map.finish().map_err(Broken::Line)?;
        Ok(ticks + clock() - start)
    }
}

impl Default for Sweep {
    fn default() -> Self {
        Self::new()
    }
}

/// In which frame a column is in focus, in 1/256 from 0: from the second at the left to the last but one at
/// the right.
pub const fn in_focus_q8(column: usize) -> u32 {
    (256 + (FRAMES as usize - 3) * 256 * column / WIDTH) as u32
}

/// A line: grains of 2x2 pixels, whose contrast is `1 / (1 + d^2)` of the full one at `d` frames from focus.
fn see(frame: u32, row: usize, line: &mut [u8; WIDTH]) {
    for (column, pixel) in line.iter_mut().enumerate() {
        let off = (frame * 256).abs_diff(in_focus_q8(column)) as i32;
        let grain = (hash(column as u32 / 2, row as u32 / 2) & 0x7f) as i32 - 64;
        // At most 2^11 away: squared, 22 bits. Never nothing, which the compiler cannot see.
        let contrast = (grain << 16).checked_div((1 << 16) + off * off).unwrap_or(0);
        *pixel = (128 + contrast) as u8;
    }
}

/// A well-mixed word for each pair of coordinates (a multiply-xorshift hash).
fn hash(u: u32, v: u32) -> u32 {
    let mut h = 0x5EED_0003 ^ u.wrapping_mul(0x9E37_79B1) ^ v.wrapping_mul(0x85EB_CA77);
    h = (h ^ (h >> 15)).wrapping_mul(0x2C1B_3C6D);
    h = (h ^ (h >> 12)).wrapping_mul(0x297A_2D39);
    h ^ (h >> 15)
}
