//! One exposure for two cameras.

use super::histogram::Histogram;

/// What both sensors are to be set to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ExposureCommand {
    /// The exposure, microseconds.
    pub exposure_us: u32,
    /// The gain in sixteenths.
    pub gain_16ths: u16,
}

/// What the exposure may be.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ExposureLimits {
    /// The shortest exposure, microseconds; 1 at least.
    pub least_us: u32,
    /// The longest.
    pub most_us: u32,
    /// The most gain, in sixteenths; 16 is none.
    pub most_gain_16ths: u16,
}

/// Chooses one exposure for both cameras of a pair, from the histograms of their frames.
///
/// The brighter camera is looked at, so that neither saturates. What counts is `light = exposure x gain`: the
/// exposure goes first, up to its limit, and then the gain. With `m` the mean grey and
/// [`AutoExposure::TARGET`] where it is to be, `light <- light x clamp(TARGET / m, 1/2, 2)`; where more than
/// [`AutoExposure::MOST_SATURATED`] of 1000 pixels are saturated the mean says too little, and the light is
/// halved at most and goes down by a quarter at least.
///
/// A sensor takes a frame or two until a setting counts: after a change, [`AutoExposure::DELAY`] frames are
/// waited for, so that none is corrected twice. Within [`AutoExposure::DEAD_BAND`] of the target nothing
/// changes. With these, a response that is linear reaches the band in as many steps as the light has
/// doublings, and stays: each step either doubles or halves, or lands on the target.
///
/// The result is a command, a value: whoever has the sensors gives it to both
/// ([`ExposureControl`](crate::camera::ExposureControl)).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct AutoExposure {
    limits: ExposureLimits,
    current: ExposureCommand,
    /// Frames that show the setting of before.
    waiting: u8,
}

impl AutoExposure {
    /// Where the mean is to be: grey levels.
    pub const TARGET: u16 = 100;
    /// How far from it nothing changes: grey levels.
    pub const DEAD_BAND: u16 = 12;
    /// Frames that do not show a change yet.
    pub const DELAY: u8 = 2;
    /// Saturated pixels of 1000 that are too many.
    pub const MOST_SATURATED: u16 = 100;

    /// Begins with the middle of the exposures, and no gain. Limits that contradict themselves are put in
    /// order.
    pub const fn new(limits: ExposureLimits) -> Self {
        let least_us = if limits.least_us == 0 { 1 } else { limits.least_us };
        let most_us = if limits.most_us < least_us { least_us } else { limits.most_us };
        let most_gain_16ths = if limits.most_gain_16ths < 16 { 16 } else { limits.most_gain_16ths };
        let current = ExposureCommand { exposure_us: least_us + (most_us - least_us) / 2, gain_16ths: 16 };
        Self { limits: ExposureLimits { least_us, most_us, most_gain_16ths }, current, waiting: 0 }
    }

    /// What the sensors are set to.
    pub fn current(&self) -> ExposureCommand {
        self.current
    }

    /// Takes a frame's histograms, left and right, and says what to set, if anything.
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

    /// Light as exposure and gain: as long an exposure as there is, and what is missing as gain.
    fn split(&self, light: u64) -> ExposureCommand {
        let ExposureLimits { least_us, most_us, most_gain_16ths } = self.limits;
        let exposure_us = (light / 16).clamp(least_us.into(), most_us.into());
        let gain = light.checked_div(exposure_us).unwrap_or(16).clamp(16, most_gain_16ths.into());
        ExposureCommand { exposure_us: exposure_us as u32, gain_16ths: gain as u16 }
    }
}
