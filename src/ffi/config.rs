//! What a pipeline is asked to do, as C says it.
#![allow(unsafe_code)]

use super::Status;
use super::instance::either;
use crate::imaging::Noise;
use crate::matching::{self, Checks, ConfigError, Filter, Method, Penalties};
use crate::units::Disparity;

/// `stereopsis_config_default` and `_noise`: an answer wherever there is a candidate.
pub const STEREOPSIS_PRESET_DENSE: i32 = 0;
/// `stereopsis_config_default` and `_noise`: drops what the other image or the neighbourhood contradicts.
pub const STEREOPSIS_PRESET_DEFAULT: i32 = 1;
/// `stereopsis_config_default` and `_noise`: drops what is ambiguous or has little texture as well.
pub const STEREOPSIS_PRESET_STRICT: i32 = 2;

/// In `left_right_px` and `uniqueness_percent` of a configuration: not checked.
pub const STEREOPSIS_NOT_CHECKED: i16 = -1;

/// In `noise` of a configuration: little, so that pixels are compared as they are.
pub const STEREOPSIS_NOISE_NONE: u8 = 0;
/// In `noise` of a configuration: a deviation of about 2 grey levels.
pub const STEREOPSIS_NOISE_LOW: u8 = 1;
/// In `noise` of a configuration: a deviation from about 3 grey levels on.
pub const STEREOPSIS_NOISE_HIGH: u8 = 2;

/// Frame size, search range and checks. `stereopsis_config_default` fills it, fields may be changed after
/// that.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct CConfig {
    /// Pixels in a line: 1 to `stereopsis_max_width()`.
    pub width: u16,
    /// Lines in a frame, at least 1.
    pub height: u16,
    /// How many whole disparities are searched: 16 to `stereopsis_max_disparities()`.
    pub disparities: u16,
    /// The smallest disparity searched, px.
    pub min_disparity: u16,
    /// Left-right check: the largest difference of the two answers, 0 to 255 px, or
    /// `STEREOPSIS_NOT_CHECKED`.
    pub left_right_px: i16,
    /// Uniqueness: by how much the second best has to cost more, 0 to 99 percent, or
    /// `STEREOPSIS_NOT_CHECKED`.
    pub uniqueness_percent: i16,
    /// Texture: a pixel counts when its neighbours left and right differ by this many grey levels.
    pub texture_gradient: u8,
    /// Texture: how many such pixels the window of an answer holds at least; 0 is not checked.
    pub texture_pixels: u8,
    /// Whether a winner at the largest disparity searched is refused; 0 is no.
    pub refuse_ceiling: u8,
    /// Whether a winner is refused that costs as much as both its neighbours; 0 is no.
    pub refuse_flat: u8,
    /// Answers are averaged along the line with this many pairs of neighbours of their surface, 0 to 8.
    pub smoothing_radius: u8,
    /// Whether every answer becomes the middle one of those in 3 x 3 pixels around it; 0 is no.
    pub median: u8,
    /// Neighbours are of one surface when they differ by at most this, in 1/32 px, 0 to 32.
    pub surface_step: u16,
    /// Speckle: answers with fewer of their surface on a cross around them are dropped; with 0 none is.
    pub speckle_pixels: u8,
    /// Methods along paths: gradients are cut off at this many eighths of a grey level per pixel, 1 to 14.
    pub gradient: u8,
    /// Methods along paths: a pixel's cost is cut off at this, at least 1.
    pub cost: u8,
    /// Methods along paths: what a change of the disparity by one px costs where the brightness changes
    /// little, and more; at least 1, and the second at most the first.
    pub step: [u8; 2],
    /// Methods along paths: what a larger change costs where the brightness changes little, more, and much;
    /// each at least the first step. `cost + step + jump` is at most 127 and `3 cost + 2 jump` at most
    /// 254.
    pub jump: [u8; 3],
    /// Methods along paths: the changes of brightness, in grey levels, at which it is more, and much.
    pub edges: [u8; 2],
    /// Fill: gaps along the row of at most this many pixels, between two answers, get the farther of the two
    /// and `STEREOPSIS_FLAG_FILLED`; with 0 none does.
    pub fill_pixels: u8,
    /// Whether rows say how sure each answer is; 0 is no, and saves the search for each pixel's second best.
    pub confidence: u8,
    /// Fill: by how much the two answers may differ, in 1/32 px; 65535 for any two.
    pub fill_step: u16,
    /// How noisy both cameras are, a `STEREOPSIS_NOISE_`: what is compared is smoothed accordingly.
    /// `stereopsis_config_noise` sets it with the checks and penalties that suit it.
    pub noise: u8,
}

/// A filter by its `STEREOPSIS_PRESET_` number.
fn filter(preset: i32) -> Result<Filter, Status> {
    match preset {
        STEREOPSIS_PRESET_DENSE => Ok(Filter::Dense),
        STEREOPSIS_PRESET_DEFAULT => Ok(Filter::Default),
        STEREOPSIS_PRESET_STRICT => Ok(Filter::Strict),
        _ => Err(Status::Preset),
    }
}

/// A level of noise by its `STEREOPSIS_NOISE_` number.
fn level(noise: u8) -> Result<Noise, Status> {
    match noise {
        STEREOPSIS_NOISE_NONE => Ok(Noise::None),
        STEREOPSIS_NOISE_LOW => Ok(Noise::Low),
        STEREOPSIS_NOISE_HIGH => Ok(Noise::High),
        _ => Err(Status::Noise),
    }
}

/// The `STEREOPSIS_NOISE_` number of a level.
pub(super) const fn noise_number(level: Noise) -> u8 {
    match level {
        Noise::None => STEREOPSIS_NOISE_NONE,
        Noise::Low => STEREOPSIS_NOISE_LOW,
        Noise::High => STEREOPSIS_NOISE_HIGH,
    }
}

impl From<matching::Config> for CConfig {
    fn from(config: matching::Config) -> Self {
        let matching::Config {
            width,
            height,
            disparities,
            min_disparity,
            checks,
            penalties,
            confidence,
            noise,
        } = config;
        let Penalties { gradient, cost, step, jump, edges } = penalties;
        let or_not = |limit: Option<u8>| limit.map_or(STEREOPSIS_NOT_CHECKED, i16::from);
        Self {
            width,
            height,
            disparities,
            min_disparity,
            left_right_px: or_not(checks.left_right_px),
            uniqueness_percent: or_not(checks.uniqueness_percent),
            texture_gradient: checks.texture_gradient,
            texture_pixels: checks.texture_pixels,
            refuse_ceiling: checks.refuse_ceiling.into(),
            refuse_flat: checks.refuse_flat.into(),
            smoothing_radius: checks.smoothing_radius,
            median: checks.median.into(),
            surface_step: checks.surface_step.raw(),
            speckle_pixels: checks.speckle_pixels,
            gradient,
            cost,
            step,
            jump,
            edges,
            fill_pixels: checks.fill_pixels,
            confidence: confidence.into(),
            fill_step: checks.fill_step.raw(),
            noise: noise_number(noise),
        }
    }
}

impl CConfig {
    /// The same search with the checks of a preset and the penalties of the method for so much noise.
    fn with_filter<S: Method>(self, filter: Filter, noise: Noise) -> Self {
        let search = matching::Config::for_method::<S>(self.width, self.height, self.disparities);
        let config = matching::Config { noise, ..search }.with_filter::<S>(filter);
        Self { min_disparity: self.min_disparity, confidence: self.confidence, ..config.into() }
    }

    /// The same in the crate's own types, which check the rest.
    pub(super) fn checked(&self) -> Result<matching::Config, Status> {
        let limit = |value: i16, wrong: Status| match value {
            STEREOPSIS_NOT_CHECKED => Ok(None),
            value => u8::try_from(value).map(Some).map_err(|_| wrong),
        };
        Ok(matching::Config {
            width: self.width,
            height: self.height,
            disparities: self.disparities,
            min_disparity: self.min_disparity,
            checks: Checks {
                left_right_px: limit(self.left_right_px, Status::LeftRight)?,
                uniqueness_percent: limit(self.uniqueness_percent, Status::Uniqueness)?,
                texture_gradient: self.texture_gradient,
                texture_pixels: self.texture_pixels,
                refuse_ceiling: self.refuse_ceiling != 0,
                refuse_flat: self.refuse_flat != 0,
                smoothing_radius: self.smoothing_radius,
                surface_step: Disparity::from_raw(self.surface_step),
                speckle_pixels: self.speckle_pixels,
                median: self.median != 0,
                fill_pixels: self.fill_pixels,
                fill_step: Disparity::from_raw(self.fill_step),
            },
            penalties: Penalties {
                gradient: self.gradient,
                cost: self.cost,
                step: self.step,
                jump: self.jump,
                edges: self.edges,
            },
            confidence: self.confidence != 0,
            noise: level(self.noise)?,
        })
    }
}

impl From<ConfigError> for Status {
    fn from(e: ConfigError) -> Self {
        match e {
            ConfigError::Width { .. } => Self::Width,
            ConfigError::Height => Self::Height,
            ConfigError::Disparities { .. } => Self::Disparities,
            ConfigError::MinDisparity { .. } => Self::MinDisparity,
            ConfigError::Uniqueness => Self::Uniqueness,
            ConfigError::Smoothing => Self::Smoothing,
            ConfigError::SurfaceStep => Self::SurfaceStep,
            ConfigError::Gradient => Self::Gradient,
            ConfigError::Penalties => Self::Penalties,
        }
    }
}

/// Fills a configuration: `stereopsis_config_default`.
///
/// # Safety
///
/// `config` is null or points to a configuration's bytes.
pub unsafe fn config_default<S: Method>(
    width: u16,
    height: u16,
    disparities: u16,
    preset: i32,
    config: *mut CConfig,
) -> Status {
    if config.is_null() {
        return Status::Null;
    }
    either(filter(preset).map(|filter| {
        let search = matching::Config::for_method::<S>(width, height, disparities);
        // SAFETY: the caller's promise; no alignment is asked for.
        unsafe { config.write_unaligned(search.with_filter::<S>(filter).into()) };
        Status::Ok
    }))
}

/// Sets a configuration's checks and penalties for cameras with noise: `stereopsis_config_noise`.
///
/// # Safety
///
/// `config` is null or points to a configuration.
pub unsafe fn config_noise<S: Method>(preset: i32, noise: u8, config: *mut CConfig) -> Status {
    if config.is_null() {
        return Status::Null;
    }
    either(filter(preset).and_then(|filter| {
        let noise = level(noise)?;
        // SAFETY: the caller's promise; no alignment is asked for.
        unsafe { config.write_unaligned(config.read_unaligned().with_filter::<S>(filter, noise)) };
        Ok(Status::Ok)
    }))
}
