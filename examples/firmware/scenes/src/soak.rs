//! Frames of a camera with faults: for every row its checksum, and whether it is flagged as damaged.
//!
//! It knows no hardware: the board reads the frames from a recording, the host plays the same one and holds
//! every row to the frame without a fault.

use stereopsis::camera::StereoSource;
use stereopsis::matching::{Config, ConfigError, Fast, Row};
use stereopsis::pipeline::{FaultCounters, Guarded};
use stereopsis::units::PixelFlags;

/// Pixels in a line.
pub const WIDTH: usize = 320;
/// Lines of a frame.
pub const HEIGHT: u16 = 240;
/// Disparities that are searched.
pub const DISPARITIES: usize = 32;

/// What the frames go through.
pub type Soaked = Guarded<Fast, WIDTH, DISPARITIES>;

/// What a frame gives.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Told {
    /// The camera could not begin it, or began the one before again.
    NoFrame,
    /// A row: its checksum, and whether each pixel is flagged as damaged.
    Row(u32, bool),
    /// It ended; whether all its rows came.
    End(bool),
}

impl Told {
    /// In eight bytes.
    pub fn bytes(self) -> [u8; 8] {
        let (kind, sum) = match self {
            Self::NoFrame => (0, 0),
            Self::Row(sum, is_damaged) => (1 + u32::from(is_damaged), sum),
            Self::End(is_whole) => (3 + u32::from(is_whole), 0),
        };
        let mut bytes = [0; 8];
        let both = kind.to_le_bytes().into_iter().chain(sum.to_le_bytes());
        bytes.iter_mut().zip(both).for_each(|(to, byte)| *to = byte);
        bytes
    }
}

/// What is searched.
pub fn config() -> Config {
    Config { confidence: true, ..Config::for_method::<Fast>(WIDTH as u16, HEIGHT, DISPARITIES as u16) }
}

/// Begins anew.
///
/// # Errors
/// When the pipeline cannot do what is asked; which it can.
pub fn start(pipeline: &mut Soaked) -> Result<(), ConfigError> {
    pipeline.start(&config())
}

/// A frame of the camera, as it is told.
pub fn frame<C: StereoSource>(pipeline: &mut Soaked, camera: &mut C, mut put: impl FnMut(Told)) {
    if pipeline.begin_frame(camera).is_err() {
        return put(Told::NoFrame);
    }
    loop {
        match pipeline.next_row(camera) {
            Ok(Some(row)) => put(told(&row)),
            Ok(None) => return put(Told::End(true)),
            Err(_) => return put(Told::End(false)),
        }
    }
}

/// A row, as it is told.
fn told(row: &Row<'_>) -> Told {
    let is_damaged = row.flags().iter().all(|flags| flags.contains(PixelFlags::DAMAGED));
    // FNV-1a over words: a pixel is one.
    let add = |sum: u32, word: u32| (sum ^ word).wrapping_mul(0x0100_0193);
    let pixels = row.disparities().iter().zip(row.flags()).zip(row.confidences());
    let sum = pixels.fold(0x811C_9DC5, |sum, ((d, flags), &confidence)| {
        add(sum, u32::from(d.raw()) | u32::from(flags.bits()) << 16 | u32::from(confidence) << 24)
    });
    Told::Row(sum, is_damaged)
}

/// The counters that tell rows and faults apart, in the order in which they are compared.
pub fn counts(counters: &FaultCounters) -> [u32; 20] {
    [
        counters.frames,
        counters.frames_whole,
        counters.frames_damaged,
        counters.frames_broken,
        counters.frames_failed,
        counters.frames_skipped,
        counters.frames_stale,
        counters.restarts,
        counters.rows,
        counters.rows_damaged,
        counters.lines,
        counters.lines_dropped,
        counters.lines_repeated,
        counters.lines_torn,
        counters.lines_late,
        counters.lines_stale,
        counters.lines_failed,
        counters.lines_timed_out,
        counters.lines_short,
        counters.syncs_lost,
    ]
}
