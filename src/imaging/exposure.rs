//! Automatic exposure: one exposure and gain for both cameras of a pair.

use super::histogram::Histogram;

/// Exposure and gain for both sensors.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ExposureCommand {
    /// Exposure, microseconds.
    pub exposure_us: u32,
    /// Gain in sixteenths.
    pub gain_16ths: u16,
}

/// Limits of exposure and gain.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ExposureLimits {
    /// Shortest exposure, microseconds; at least 1, if the longest is.
    pub least_us: u32,
    /// Longest exposure, microseconds.
    pub most_us: u32,
    /// Largest gain in sixteenths; 16 is no gain.
    pub most_gain_16ths: u16,
}

/// Controller of one exposure for both cameras of a pair, from the histograms of their frames.
///
/// The brighter camera counts, so that neither saturates. The controlled variable is `light = exposure x
/// gain`, with the exposure raised to its limit before the gain. With mean grey `m`, `light <- light x
/// clamp(TARGET / m, 1/2, 2)`; where more than [`AutoExposure::MOST_SATURATED`] per mille of the pixels are
/// saturated, the light decreases by a quarter to a half.
///
/// After a change, [`AutoExposure::DELAY`] frames are ignored, as sensors apply settings late. Within
/// [`AutoExposure::DEAD_BAND`] of the target nothing changes. A linear response therefore reaches the band in
/// as many steps as the light has doublings, and stays.
///
/// The caller passes the resulting [`ExposureCommand`] to both sensors
/// ([`ExposureControl`](crate::camera::ExposureControl)).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AutoExposure {
    limits: ExposureLimits,
    current: ExposureCommand,
    /// Number of frames to ignore.
    waiting: u8,
}

impl AutoExposure {
    /// Target of the mean, grey levels.
    pub const TARGET: u16 = 100;
    /// Deviation from the target that is tolerated, grey levels.
    pub const DEAD_BAND: u16 = 12;
    /// Number of frames that do not show a change yet.
    pub const DELAY: u8 = 2;
    /// Largest share of saturated pixels, per mille.
    pub const MOST_SATURATED: u16 = 100;

    /// Starts with the middle of the exposures and no gain. Contradictory limits are put in order. No
    /// command leaves them: where no exposure is allowed, each is 0.
    pub const fn new(limits: ExposureLimits) -> Self {
        let least_us = if limits.least_us == 0 && limits.most_us > 0 { 1 } else { limits.least_us };
        let most_us = if limits.most_us < least_us { least_us } else { limits.most_us };
        let most_gain_16ths = if limits.most_gain_16ths < 16 { 16 } else { limits.most_gain_16ths };
        let current = ExposureCommand { exposure_us: least_us + (most_us - least_us) / 2, gain_16ths: 16 };
        Self { limits: ExposureLimits { least_us, most_us, most_gain_16ths }, current, waiting: 0 }
    }

    /// Returns the current setting.
    pub fn current(&self) -> ExposureCommand {
        self.current
    }

    /// Takes a frame's histograms, left and right, and returns the new setting if it changes.
    pub fn frame(&mut self, histograms: [&Histogram; 2]) -> Option<ExposureCommand> {
        if let Some(left) = self.waiting.checked_sub(1) {
            self.waiting = left;
            return None;
        }
        let [left, right] = histograms;
        let brighter = if left.mean_16ths() < right.mean_16ths() { right } else { left };
        if brighter.count() == 0 {
            return None;
        }
        let (mean, target) = (u64::from(brighter.mean_16ths().max(1)), u64::from(16 * Self::TARGET));
        let is_saturated = left.saturated_per_mille().max(right.saturated_per_mille()) > Self::MOST_SATURATED;
        if !is_saturated && mean.abs_diff(target) <= u64::from(16 * Self::DEAD_BAND) {
            return None;
        }
        // 16ths of a microsecond at no gain.
        let light = u64::from(self.current.exposure_us) * u64::from(self.current.gain_16ths);
        let most = if is_saturated { light - light / 4 } else { light * 2 };
        let wanted = (light * target / mean).clamp(light / 2, most);
        let next = self.split(wanted);
        if next == self.current {
            return None;
        }
        (self.current, self.waiting) = (next, Self::DELAY);
        Some(next)
    }

    /// Splits light into exposure and gain, the exposure as long as its limit.
    fn split(&self, light: u64) -> ExposureCommand {
        let ExposureLimits { least_us, most_us, most_gain_16ths } = self.limits;
        let exposure_us = (light / 16).clamp(least_us.into(), most_us.into());
        let gain = light.checked_div(exposure_us).unwrap_or(16).clamp(16, most_gain_16ths.into());
        ExposureCommand { exposure_us: exposure_us as u32, gain_16ths: gain as u16 }
    }
}
