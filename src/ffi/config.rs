//! Configuration of a matcher in C.
#![allow(unsafe_code)]

use super::Status;
use super::state::checked;
use super::status::either;
use crate::imaging::Noise;
use crate::matching::{self, Checks, ConfigError, Filter, Method, Penalties};
use crate::units::Disparity;

/// Preset of checks: an answer wherever there is a candidate.
pub const STEREOPSIS_PRESET_DENSE: i32 = 0;
/// Preset of checks: drops what the other image or the neighbourhood contradicts.
pub const STEREOPSIS_PRESET_DEFAULT: i32 = 1;
/// Preset of checks: drops what is ambiguous and larger speckle as well, and of methods with windows what has
/// little texture.
pub const STEREOPSIS_PRESET_STRICT: i32 = 2;

/// Value of `left_right_px` and `uniqueness_percent` that disables the check.
pub const STEREOPSIS_NOT_CHECKED: i16 = -1;

/// Noise level: little noise, so that pixels are compared as they are.
pub const STEREOPSIS_NOISE_NONE: u8 = 0;
/// Noise level: a standard deviation of about 2 grey levels.
pub const STEREOPSIS_NOISE_LOW: u8 = 1;
/// Noise level: a standard deviation from about 3 grey levels on.
pub const STEREOPSIS_NOISE_HIGH: u8 = 2;

/// Frame size, search range and checks, filled by `stereopsis_config_default` and then open to changes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct CConfig {
    /// Pixels in a line: 1 to `stereopsis_max_width()`.
    pub width: u16,
    /// Lines in a frame, at least 1.
    pub height: u16,
    /// Number of whole disparities searched: 16 to `stereopsis_max_disparities()`.
    pub disparities: u16,
    /// Smallest disparity searched, px.
    pub min_disparity: u16,
    /// Left-right check: largest difference of the two answers, 0 to 255 px, or
    /// `STEREOPSIS_NOT_CHECKED`.
    pub left_right_px: i16,
    /// Uniqueness check: least extra cost of the second best, 0 to 99 percent, or
    /// `STEREOPSIS_NOT_CHECKED`.
    pub uniqueness_percent: i16,
    /// Texture check: least difference of a textured pixel's left and right neighbours, grey levels.
    pub texture_gradient: u8,
    /// Texture check: least number of textured pixels in the window of an answer; 0 disables it.
    pub texture_pixels: u8,
    /// Whether a winner at the largest disparity searched, or one whose partner is the first column of the
    /// right image, is refused; 0 means no.
    pub refuse_ceiling: u8,
    /// Whether a winner that costs as much as both its neighbours is refused; 0 means no.
    pub refuse_flat: u8,
    /// Smoothing: pairs of neighbours along the line that are averaged within a surface, 0 to 8.
    pub smoothing_radius: u8,
    /// Whether a median filter of 3 x 3 pixels is applied; 0 means no.
    pub median: u8,
    /// Largest difference of neighbours of one surface, in 1/32 px, 0 to 32.
    pub surface_step: u16,
    /// Speckle filter: least number of answers of one surface on a cross around an answer; 0 disables it.
    pub speckle_pixels: u8,
    /// Semi-global matching: truncation of gradients, eighths of a grey level per pixel, 1 to 14.
    pub gradient: u8,
    /// Semi-global matching: truncation of a pixel's cost, at least 1.
    pub cost: u8,
    /// Semi-global matching: penalty P1 of a disparity change by one px, at small and larger changes of
    /// brightness; at least 1, and the second at most the first.
    pub step: [u8; 2],
    /// Semi-global matching: penalty P2 of larger disparity changes, at small, larger and large changes of
    /// brightness; the first at least the first step, the others at least the second. `cost + step + jump` is
    /// at most 127, `3 cost + 2 jump` at most 254.
    pub jump: [u8; 3],
    /// Semi-global matching: least larger and least large change of brightness, grey levels.
    pub edges: [u8; 2],
    /// Gap filling: longest gap in a row, pixels, that is filled with the farther of the answers at its ends
    /// and flagged `STEREOPSIS_FLAG_FILLED`; 0 disables it.
    pub fill_pixels: u8,
    /// Whether rows have confidences; 0 means no, and saves the search for each pixel's second best.
    pub confidence: u8,
    /// Gap filling: largest difference of the two answers, in 1/32 px; 65535 for no limit.
    pub fill_step: u16,
    /// Noise level of both cameras, a `STEREOPSIS_NOISE_`, which selects the smoothing of compared pixels;
    /// `stereopsis_config_noise` sets it with matching checks and penalties.
    pub noise: u8,
    /// Speckle filter: most answers of one row of a surface that count; 0 for no limit.
    pub speckle_run: u8,
    /// Fattening check: by how much an answer may be nearer than others in its row, in 1/32 px for each pixel
    /// between, where no edge of brightness lies between; 65535 disables it.
    pub fattening_slope: u16,
    /// Least confidence of an answer, 1 to 207: one that is less sure is refused and flagged
    /// `STEREOPSIS_FLAG_AMBIGUOUS`, and rows have confidences; 0 refuses none.
    pub min_confidence: u8,
    /// Open check: in and beside a place without edges that reaches up to the first row, as a sky does, most
    /// answers of one row of a surface that count for its speckle; 0 for as many as anywhere.
    pub open_run: u8,
    /// Open check: how much more than an answer's its second best has to cost there, up to 127; 0 disables
    /// it.
    pub open_margin: u8,
    /// Whether the methods along paths refuse answers on patterns that repeat along the row within the
    /// search, such as a chessboard's; 0 means no.
    pub refuse_repeats: u8,
}

/// Returns the filter of a `STEREOPSIS_PRESET_` number.
fn filter(preset: i32) -> Result<Filter, Status> {
    match preset {
        STEREOPSIS_PRESET_DENSE => Ok(Filter::Dense),
        STEREOPSIS_PRESET_DEFAULT => Ok(Filter::Default),
        STEREOPSIS_PRESET_STRICT => Ok(Filter::Strict),
        _ => Err(Status::Preset),
    }
}

/// Returns the noise level of a `STEREOPSIS_NOISE_` number.
fn level(noise: u8) -> Result<Noise, Status> {
    match noise {
        STEREOPSIS_NOISE_NONE => Ok(Noise::None),
        STEREOPSIS_NOISE_LOW => Ok(Noise::Low),
        STEREOPSIS_NOISE_HIGH => Ok(Noise::High),
        _ => Err(Status::Noise),
    }
}

/// Returns the `STEREOPSIS_NOISE_` number of a noise level.
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
            min_confidence,
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
            min_confidence,
            fill_step: checks.fill_step.raw(),
            speckle_run: checks.speckle_run,
            fattening_slope: checks.fattening_slope.raw(),
            open_run: checks.open_run,
            open_margin: checks.open_margin,
            refuse_repeats: checks.refuse_repeats.into(),
            noise: noise_number(noise),
        }
    }
}

impl CConfig {
    /// Replaces the checks by a preset's and the penalties by the method's for a noise level.
    fn with_filter<S: Method>(self, filter: Filter, noise: Noise) -> Self {
        let search = matching::Config::for_method::<S>(self.width, self.height, self.disparities);
        let config = matching::Config { noise, ..search }.with_filter::<S>(filter);
        Self {
            min_disparity: self.min_disparity,
            confidence: self.confidence,
            min_confidence: self.min_confidence,
            ..config.into()
        }
    }

    /// Converts to the crate's own types, which check the rest.
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
                speckle_run: self.speckle_run,
                fattening_slope: Disparity::from_raw(self.fattening_slope),
                open_run: self.open_run,
                open_margin: self.open_margin,
                refuse_repeats: self.refuse_repeats != 0,
            },
            penalties: Penalties {
                gradient: self.gradient,
                cost: self.cost,
                step: self.step,
                jump: self.jump,
                edges: self.edges,
            },
            confidence: self.confidence != 0,
            min_confidence: self.min_confidence,
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
            ConfigError::OpenMargin => Self::OpenMargin,
            ConfigError::MinConfidence => Self::MinConfidence,
            ConfigError::Gradient => Self::Gradient,
            ConfigError::Penalties => Self::Penalties,
        }
    }
}

/// Fills a configuration, as `stereopsis_config_default`.
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
    either(checked(config).and_then(|()| filter(preset)).map(|filter| {
        let search = matching::Config::for_method::<S>(width, height, disparities);
        // SAFETY: the caller's promise, and it is aligned.
        unsafe { config.write(search.with_filter::<S>(filter).into()) };
        Status::Ok
    }))
}

/// Sets a configuration's checks and penalties for a noise level, as `stereopsis_config_noise`.
///
/// # Safety
///
/// `config` is null or points to a configuration.
pub unsafe fn config_noise<S: Method>(preset: i32, noise: u8, config: *mut CConfig) -> Status {
    either(checked(config).and_then(|()| filter(preset)).and_then(|filter| {
        let noise = level(noise)?;
        // SAFETY: the caller's promise, and it is aligned.
        unsafe { config.write(config.read().with_filter::<S>(filter, noise)) };
        Ok(Status::Ok)
    }))
}
