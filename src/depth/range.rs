//! Depth range of a rig and a search range.

use super::DepthScale;
use crate::matching::Config;
use crate::units::{Disparity, Metres};

/// Depths that a search range covers.
#[derive(Clone, Copy, PartialEq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DepthRange {
    /// Depth at the largest disparity that is no ceiling, `min_disparity + disparities - 2`.
    pub nearest: Metres,
    /// Standard deviation at [`Self::nearest`].
    pub sigma_nearest: Metres,
    /// Depth at the smallest disparity searched, but at no less than one px of parallax: beyond, an error of
    /// a pixel cannot be told from infinity.
    pub farthest: Metres,
    /// Standard deviation at [`Self::farthest`].
    pub sigma_farthest: Metres,
}

impl DepthScale {
    /// Returns the depths that a search covers, for answers with standard deviation `sigma_px`; `None` when
    /// the whole search lies at or behind infinity.
    pub fn range(&self, config: &Config, sigma_px: f32) -> Option<DepthRange> {
        let last = config.min_disparity.saturating_add(config.disparities).saturating_sub(2);
        let (nearest, sigma_nearest) = self.metres_and_sigma(f32::from(last), sigma_px)?;
        let one_px_of_parallax = 1.0 - self.rig().disparity_offset_px();
        let first = f32::from(config.min_disparity).max(one_px_of_parallax).min(f32::from(last));
        let (farthest, sigma_farthest) = self.metres_and_sigma(first, sigma_px)?;
        Some(DepthRange { nearest, sigma_nearest, farthest, sigma_farthest })
    }
}

/// Disparity that no answer of a search is over: 1 px more than the largest one searched.
pub(super) fn largest(config: &Config) -> Disparity {
    Disparity::from_pixels(config.min_disparity.saturating_add(config.disparities))
}
