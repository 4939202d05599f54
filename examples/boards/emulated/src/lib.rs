//! What the programs share. Each is a board's matcher as it stands in the board's folder, in memory of the
//! chip's size, with the built-in scene in place of the capture. It prints the checksum of the rows, which
//! are those of one pipeline on a desktop.
#![no_std]

use embassy_futures::yield_now;
use firmware_scenes::scene::{Scene, SceneCamera};
use semihosting::{println, process};
use stereopsis::camera::{FrameStart, LineListener, LineStart, StereoSource};
use stereopsis::matching::{Block, Kernel, Row};
use stereopsis::pipeline::Guarded;

#[cfg(target_arch = "arm")]
pub use cortex_m_rt::entry;
#[cfg(target_arch = "riscv32")]
pub use riscv_rt::entry;

/// The longest line of the scene, px.
const LONGEST: usize = 160;

/// A line of both cameras.
pub type Lines<'a> = (&'a [u8], &'a [u8]);

/// Gives a frame of the scene to `hand_on`, line by line, and gives way after each, as an interrupt does.
pub async fn capture(width: u16, height: u16, mut hand_on: impl FnMut(FrameStart, LineStart, Lines<'_>)) {
    let mut scene = SceneCamera::new(Scene { width, height });
    let (mut left, mut right) = ([0; LONGEST], [0; LONGEST]);
    let frame = scene.start_frame().expect("the scene begins");
    for _ in 0..height {
        let start = scene.next_lines(&mut left, &mut right).expect("the scene has so many lines");
        let width = usize::from(width);
        hand_on(frame, start, (&left[..width], &right[..width]));
        yield_now().await;
    }
}

/// Matches a frame that the capture hands on, and takes those rows that are asked for.
pub async fn matched<const W: usize, const D: usize>(
    pipeline: &mut Guarded<Block, W, D>,
    cameras: &mut impl StereoSource,
    lines: &mut LineListener<'_>,
    is_taken: impl Fn(u16) -> bool,
    checksum: &mut Checksum,
) {
    assert!(pipeline.begin_frame_async(cameras, lines).await.is_ok(), "a frame begins");
    while let Ok(Some(row)) = pipeline.next_row_async(cameras, lines).await {
        if is_taken(row.index()) {
            checksum.add(&row);
        }
    }
    assert_eq!(pipeline.lost_lines(), 0, "no line is lost");
}

/// CRC-32 of rows, as in Ethernet and PNG: of every pixel the disparity's steps, the low byte first, and the
/// flags.
pub struct Checksum {
    crc: u32,
    rows: u16,
}

impl Checksum {
    /// Of no rows.
    #[expect(clippy::new_without_default, reason = "a program has one")]
    pub const fn new() -> Self {
        Self { crc: u32::MAX, rows: 0 }
    }

    /// Adds a row.
    pub fn add(&mut self, row: &Row<'_>) {
        for (disparity, flags) in row.disparities().iter().zip(row.flags()) {
            let [low, high] = disparity.raw().to_le_bytes();
            self.crc = [low, high, flags.bits()].into_iter().fold(self.crc, with_byte);
        }
        self.rows += 1;
    }

    /// Prints it, and ends the emulation.
    pub fn end(&self) -> ! {
        println!("{} rows, crc32 {:08x}, {}", self.rows, !self.crc, Kernel::detect().name());
        process::exit(0)
    }
}

/// The checksum with one more byte: reflected 0x04C11DB7, bit by bit.
fn with_byte(crc: u32, byte: u8) -> u32 {
    (0..8).fold(crc ^ u32::from(byte), |crc, _| (crc >> 1) ^ (0xEDB8_8320 & (crc & 1).wrapping_neg()))
}
