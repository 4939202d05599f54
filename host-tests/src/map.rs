//! Whole maps: what the core says row by row, kept for files and figures.

use crate::sparsification::Judged;
use stereopsis::depth::DepthScale;
use stereopsis::matching::Row;
use stereopsis::units::{Disparity, PixelFlags};

/// A disparity for each pixel of the left image, row by row, with its flags and its uncertainty.
#[derive(Clone, PartialEq, Debug)]
pub struct DisparityMap {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// The disparities.
    pub disparity: Vec<Disparity>,
    /// Why there is no answer, and what is to be known about one.
    pub flags: Vec<PixelFlags>,
    /// Standard deviation of the answers, px; NaN where there is none.
    pub sigma_px: Vec<f32>,
    /// How sure the answers are; 0 where there is none, and everywhere where the configuration did not ask.
    pub confidence: Vec<u8>,
}

impl DisparityMap {
    /// A map without answers.
    pub fn new(width: usize, height: usize) -> Self {
        let pixels = width * height;
        Self {
            width,
            height,
            disparity: vec![Disparity::NONE; pixels],
            flags: vec![PixelFlags::CLEAR; pixels],
            sigma_px: vec![f32::NAN; pixels],
            confidence: vec![0; pixels],
        }
    }

    /// Keeps what the core says of row `y`.
    ///
    /// # Panics
    ///
    /// When the map has no such row.
    pub fn put(&mut self, y: usize, row: Row<'_>) {
        let places = y * self.width..(y + 1) * self.width;
        self.disparity[places.clone()].copy_from_slice(row.disparities());
        self.flags[places.clone()].copy_from_slice(row.flags());
        if !row.confidences().is_empty() {
            self.confidence[places.clone()].copy_from_slice(row.confidences());
        }
        for (x, sigma) in self.sigma_px[places].iter_mut().enumerate() {
            *sigma = row.sigma_px(x).unwrap_or(f32::NAN);
        }
    }

    /// Goes on with the rows of another map of the same width.
    pub fn append(&mut self, rows: Self) {
        self.height += rows.height;
        self.disparity.extend(rows.disparity);
        self.flags.extend(rows.flags);
        self.sigma_px.extend(rows.sigma_px);
        self.confidence.extend(rows.confidence);
    }

    /// The disparities in px; `f32::INFINITY` where there is no answer.
    pub fn pixels(&self) -> Vec<f32> {
        self.disparity.iter().map(|d| d.to_f32().unwrap_or(f32::INFINITY)).collect()
    }

    /// Depths in metres; `f32::INFINITY` where there is no answer, or one at or behind infinity.
    pub fn depth_m(&self, scale: &DepthScale) -> Vec<f32> {
        self.disparity.iter().map(|&d| scale.metres(d).map_or(f32::INFINITY, |m| m.0)).collect()
    }

    /// How many pixels have an answer.
    pub fn answers(&self) -> usize {
        self.disparity.iter().filter(|d| d.is_some()).count()
    }

    /// Share of the pixels that have an answer, 0 to 1.
    pub fn density(&self) -> f64 {
        self.answers() as f64 / self.disparity.len().max(1) as f64
    }

    /// How sure the answers are, with what `loss` makes of each that it knows something of: by its pixel and
    /// disparity in px.
    pub fn judged(&self, loss: impl Fn(usize, f32) -> Option<f32>) -> Vec<Judged> {
        let pixels = self.disparity.iter().zip(&self.confidence).enumerate();
        let judged = |(i, (d, &confidence)): (usize, (&Disparity, &u8))| {
            Some(Judged { confidence, loss: loss(i, d.to_f32()?)? })
        };
        pixels.filter_map(judged).collect()
    }

    /// How many pixels carry `flag`, with or without an answer.
    pub fn flagged(&self, flag: PixelFlags) -> usize {
        self.flags.iter().filter(|f| f.contains(flag)).count()
    }

    /// The answers in px, in ascending order.
    pub fn sorted(&self) -> Vec<f32> {
        let mut answers: Vec<f32> = self.disparity.iter().filter_map(|d| d.to_f32()).collect();
        answers.sort_by(f32::total_cmp);
        answers
    }
}

/// The value below which a share of the sorted values lies, 0 the least and 1 the largest; `None` of nothing.
///
/// ```
/// use stereopsis_host::map::quantile;
/// assert_eq!(quantile(&[1.0, 2.0, 4.0], 0.5), Some(2.0));
/// assert_eq!(quantile(&[], 0.5), None);
/// ```
pub fn quantile(sorted: &[f32], share: f64) -> Option<f32> {
    let last = sorted.len().checked_sub(1)?;
    sorted.get((share.clamp(0.0, 1.0) * last as f64).round() as usize).copied()
}
