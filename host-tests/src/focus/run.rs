//! A focus stack through the core's map: where each pixel is in focus, how sure that is, and a picture that
//! is sharp all over.

use super::memory::MapMemory;
use super::stack::{Frame, StackError};
use image::RgbImage;
use stereopsis::focus::{
    Breathing, FocusConfig, FocusConfigError, FocusLineError, FocusPeak, FocusScale, NoFocus, median_row,
    plane_row,
};

/// What a stack tells, a value for each cell, row by row.
#[derive(Clone, Debug)]
pub struct FocusResult {
    /// Cells in a row.
    pub width: usize,
    /// The peaks.
    pub peaks: Vec<Result<FocusPeak, NoFocus>>,
    /// Every cell as in the frame in which it was sharpest.
    pub picture: RgbImage,
}

/// Why a stack tells nothing.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FocusError {
    /// A frame cannot be read.
    #[error(transparent)]
    Stack(#[from] StackError),
    /// The map cannot be made like that.
    #[error(transparent)]
    Config(#[from] FocusConfigError),
    /// A frame is not taken.
    #[error("frame {frame}: {source}")]
    Frame {
        /// Which, from 1.
        frame: usize,
        /// Why.
        source: FocusLineError,
    },
}

/// Passes all frames through the core's map, each magnified as `breathing` tells of its index, and takes
/// medians of answers, then planes through them.
pub fn run(
    config: &FocusConfig,
    frames: impl IntoIterator<Item = Result<Frame, StackError>>,
    breathing: impl Fn(usize) -> Result<Breathing, FocusLineError>,
) -> Result<FocusResult, FocusError> {
    let (columns, rows, side) = (config.columns(), config.rows(), usize::from(config.cell_px));
    let (width, height) = (usize::from(config.width), usize::from(config.height));
    let mut memory = MapMemory::new(config);
    let mut map = memory.view()?;
    map.start(config)?;
    let mut picture = RgbImage::new(config.width.into(), config.height.into());
    for (index, frame) in frames.into_iter().enumerate() {
        let Frame { grey, colours } = frame?;
        let named = |source| FocusError::Frame { frame: index + 1, source };
        let scale = breathing(index).map_err(named)?;
        map.begin_frame(scale).map_err(named)?;
        let mut copy = |row: usize, column: usize| {
            for y in row * side..((row + 1) * side).min(height) {
                for x in column * side..((column + 1) * side).min(width) {
                    let from = (scale.source(x, width) as u32, scale.source(y, height) as u32);
                    picture.put_pixel(x as u32, y as u32, *colours.get_pixel(from.0, from.1));
                }
            }
        };
        for line in grey.chunks_exact(width) {
            map.push(line, |row| {
                let sharper = row.sharper.iter().enumerate().filter(|(_, is_sharper)| **is_sharper);
                sharper.for_each(|(column, _)| copy(row.index, column));
            })
            .map_err(named)?;
        }
    }
    let frames = map.frames() as usize;
    map.finish().map_err(|source| FocusError::Frame { frame: frames, source })?;
    let raw: Vec<_> = (0..columns * rows).map(|i| map.peak(i % columns, i / columns)).collect();
    let mut peaks = raw.clone();
    for (y, out) in peaks.chunks_exact_mut(columns).enumerate() {
        let near =
            [y.saturating_sub(2), y.saturating_sub(1), y, (y + 1).min(rows - 1), (y + 2).min(rows - 1)];
        median_row(near.map(|y| &raw[y * columns..][..columns]), out);
        plane_row(&raw, columns, y, out);
    }
    Ok(FocusResult { width: columns, peaks, picture })
}

impl FocusResult {
    /// The frames in which the cells are in focus, from 1; `f32::INFINITY` where there is no answer.
    pub fn index(&self) -> Vec<f32> {
        self.peaks.iter().map(|peak| peak.map_or(f32::INFINITY, |peak| peak.position() + 1.0)).collect()
    }

    /// The frames in which the cells are in focus, as numbers of a stack of which frames were left out;
    /// `f32::INFINITY` where there is no answer. `numbers` has the number of each frame of the map. Between
    /// two frames lies what lies between their numbers, and nothing lies beyond the last.
    pub fn index_in(&self, numbers: &[usize]) -> Vec<f32> {
        let number = |peak: &Result<FocusPeak, NoFocus>| {
            let position = peak.as_ref().ok()?.position();
            let before = (position as usize).min(numbers.len().checked_sub(1)?);
            let after = (before + 1).min(numbers.len() - 1);
            let (a, b) = (numbers[before] as f32, numbers[after] as f32);
            Some(a + (b - a) * (position - before as f32))
        };
        self.peaks.iter().map(|peak| number(peak).unwrap_or(f32::INFINITY)).collect()
    }

    /// How sure that is, 0 to 1; 0 where there is no answer.
    pub fn confidence(&self) -> Vec<f32> {
        self.peaks.iter().map(|peak| peak.map_or(0.0, |peak| f32::from(peak.confidence) / 255.0)).collect()
    }

    /// Depths, m; `f32::INFINITY` where there is no answer.
    pub fn depth_m(&self, scale: &FocusScale<'_>) -> Vec<f32> {
        let depth = |peak: &FocusPeak| scale.depth(peak).map_or(f32::INFINITY, |depth| depth.depth_m);
        self.peaks.iter().map(|peak| peak.as_ref().map_or(f32::INFINITY, depth)).collect()
    }

    /// How many cells have an answer.
    pub fn answers(&self) -> usize {
        self.peaks.iter().flatten().count()
    }
}
