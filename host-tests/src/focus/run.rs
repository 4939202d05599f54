//! A focus stack through the core's maps: where each pixel is in focus, how sure that is, and a picture that
//! is sharp all over.

use super::memory::MapMemory;
use super::stack::{Frame, StackError};
use image::RgbImage;
use stereopsis::focus::{
    Breathing, FocusConfig, FocusConfigError, FocusLineError, FocusOrder, FocusPeak, FocusScale, NoFocus,
    extend_row, median_row, narrowest_steady, partly_hidden_row, plane_row, uncover_row,
};

/// What a stack tells, a value for each pixel, row by row.
#[derive(Clone, Debug)]
pub struct FocusResult {
    /// Pixels in a row.
    pub width: usize,
    /// The peaks.
    pub peaks: Vec<Result<FocusPeak, NoFocus>>,
    /// Every pixel as in the frame in which it was sharpest.
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

/// What an interpolated sharpness moves a peak by, 1/256 frame: an eighth of a frame, of which no roughness
/// from frame to frame tells.
const BREATHING_NOISE: u32 = 32;

/// Passes all frames, `width` by `height` pixels, through maps of the core with windows of several sizes. The
/// frames are as they are, or, if they breathe, magnified as `scale` says, without which none do. A pixel's
/// answer is that of the narrowest window in which it is steady; then medians of answers are taken, and
/// planes through them. Beside edges in depth what is in front gives back what it took of what is behind,
/// where `scale` or the answers tell which is which.
pub fn run(
    (width, height): (u16, u16),
    frames: impl IntoIterator<Item = Result<Frame, StackError>>,
    scale: Option<&FocusScale<'_>>,
    breathes: bool,
) -> Result<FocusResult, FocusError> {
    let breathing = scale.filter(|_| breathes);
    // Beside those that are asked the map of the picture that is sharp all over: its window averages noise
    // out, and it has a cell for each pixel.
    let (configs, pictured) = match breathing {
        Some(_) => {
            let [narrow, wide] = FocusConfig::breathing_windows(width, height);
            ([FocusConfig::pixels(width, height), narrow, wide], 0)
        }
        None => (FocusConfig::windows(width, height), 1),
    };
    let mut memories = configs.each_ref().map(MapMemory::new);
    let mut maps = Vec::new();
    for (memory, config) in memories.iter_mut().zip(&configs) {
        let mut map = memory.view()?;
        map.start(config)?;
        maps.push(map);
    }
    let (width, height) = (usize::from(width), usize::from(height));
    let mut picture = RgbImage::new(width as u32, height as u32);
    let mut count = 0;
    for (index, frame) in frames.into_iter().enumerate() {
        let Frame { grey, colours } = frame?;
        let named = |source| FocusError::Frame { frame: index + 1, source };
        let scale = breathing.map_or(Ok(Breathing::NONE), |scale| scale.breathing(index)).map_err(named)?;
        let mut copy = |y: usize, x: usize| {
            let from = (scale.source(x, width) as u32, scale.source(y, height) as u32);
            picture.put_pixel(x as u32, y as u32, *colours.get_pixel(from.0, from.1));
        };
        for (window, map) in maps.iter_mut().enumerate() {
            map.begin_frame(scale).map_err(named)?;
            for line in grey.chunks_exact(width) {
                map.push(line, |row| {
                    let sharper = row.sharper.iter().enumerate().filter(|(_, is_sharper)| **is_sharper);
                    sharper.filter(|_| window == pictured).for_each(|(column, _)| copy(row.index, column));
                })
                .map_err(named)?;
            }
        }
        count = index + 1;
    }
    for map in &mut maps {
        map.finish().map_err(|source| FocusError::Frame { frame: count, source })?;
    }
    let (asked, more) = if breathing.is_some() { (1.., BREATHING_NOISE) } else { (0.., 0) };
    let answer = |i: usize| {
        let mut answers = [Err(NoFocus::Untextured); 3];
        for ((answer, map), config) in answers.iter_mut().zip(&maps).zip(&configs) {
            let side = usize::from(config.cell_px);
            let peak = map.peak(i % width / side, i / width / side);
            *answer = peak.map(|peak| FocusPeak { noise_q8: peak.noise_q8 + more, ..peak });
        }
        narrowest_steady(&answers[asked.clone()])
    };
    let raw: Vec<_> = (0..width * height).map(answer).collect();
    let mut peaks = raw.clone();
    for (y, out) in peaks.chunks_exact_mut(width).enumerate() {
        let rows = [y.saturating_sub(2), y.saturating_sub(1), y, y + 1, y + 2].map(|y| y.min(height - 1));
        median_row(rows.map(|y| &raw[y * width..][..width]), out);
        plane_row(&raw, width, y, out);
    }
    if let Some(order) = scale.map(FocusScale::order).or_else(|| FocusOrder::of_answers(&peaks, width)) {
        beside_edges(&mut peaks, width, order, count as u32);
    }
    Ok(FocusResult { width, peaks, picture })
}

/// Takes the rim of what is in front away, and carries what is behind up to the edge.
fn beside_edges(peaks: &mut [Result<FocusPeak, NoFocus>], width: usize, order: FocusOrder, frames: u32) {
    let whole = peaks.to_vec();
    for (y, out) in peaks.chunks_exact_mut(width).enumerate() {
        uncover_row(&whole, width, y, order, out);
    }
    let uncovered = peaks.to_vec();
    let mut is_hidden = vec![false; peaks.len()];
    for (y, out) in is_hidden.chunks_exact_mut(width).enumerate() {
        partly_hidden_row(&uncovered, width, y, order, out);
    }
    for (y, out) in peaks.chunks_exact_mut(width).enumerate() {
        extend_row(&uncovered, &is_hidden, width, y, frames, out);
    }
}

impl FocusResult {
    /// The frames in which the pixels are in focus, from 1; `f32::INFINITY` where there is no answer.
    pub fn index(&self) -> Vec<f32> {
        self.peaks.iter().map(|peak| peak.map_or(f32::INFINITY, |peak| peak.position() + 1.0)).collect()
    }

    /// The frames in which the pixels are in focus, as numbers of a stack of which frames were left out;
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

    /// How many pixels have an answer, or are sharper in some frames than noise tells, without a peak.
    pub fn textured(&self) -> usize {
        self.peaks.iter().filter(|peak| !matches!(peak, Err(NoFocus::Untextured))).count()
    }

    /// How many pixels have an answer.
    pub fn answers(&self) -> usize {
        self.peaks.iter().flatten().count()
    }
}
