//! Configuration and peaks of a focus map in C.
#![allow(unsafe_code)]

use super::Status;
use super::state::checked;
use super::status::either;
use crate::focus::{FocusConfig, FocusConfigError, FocusLineError, FocusPeak, NoFocus};

/// Focus of a cell: the peak is known.
pub const STEREOPSIS_FOCUS_FOUND: u8 = 0;
/// Focus of a cell: too few frames came, three are enough.
pub const STEREOPSIS_FOCUS_FEW: u8 = 1;
/// Focus of a cell: the sharpness changes no more than noise does.
pub const STEREOPSIS_FOCUS_UNTEXTURED: u8 = 2;
/// Focus of a cell: the peak is so broad that noise hides where it is.
pub const STEREOPSIS_FOCUS_BROAD: u8 = 3;

/// Size and cells of a focus map, filled by `stereopsis_focus_default` and then open to changes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct CFocusConfig {
    /// Pixels in a line.
    pub width: u16,
    /// Lines in a frame.
    pub height: u16,
    /// Side of a cell, px: 1 for an answer a pixel.
    pub cell_px: u16,
    /// A cell's sharpness is that of the window of `4 r + 1` by `4 r + 1` cells around it, nearer ones
    /// counting more.
    pub radius: u8,
    /// Whether frames differ in exposure: each one's sharpness counts in proportion to its brightness; 0
    /// means no.
    pub exposure_varies: u8,
}

/// Where a cell is in focus, and how sure that is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct CFocusPeak {
    /// The frame, counted from 0, in 1/256; 0 where there is none.
    pub position_q8: u32,
    /// Standard deviation of a right peak, in 1/256 frame.
    pub sigma_q8: u32,
    /// How far the peak stands out, in 1/255.
    pub confidence: u8,
    /// Whether there is a peak: a `STEREOPSIS_FOCUS_` number.
    pub found: u8,
}

impl From<FocusConfigError> for Status {
    fn from(e: FocusConfigError) -> Self {
        match e {
            FocusConfigError::Window => Self::FocusWindow,
            _ => Self::FocusSize,
        }
    }
}

impl From<FocusLineError> for Status {
    fn from(e: FocusLineError) -> Self {
        match e {
            FocusLineError::NoLineDue => Self::NoLineLeft,
            FocusLineError::NotStarted => Self::NotStarted,
            FocusLineError::Length { .. } => Self::LineLength,
            FocusLineError::FrameIncomplete { .. } => Self::LinesMissing,
            FocusLineError::TooManyFrames => Self::FocusFrames,
            FocusLineError::Scale => Self::FocusScale,
        }
    }
}

impl From<CFocusConfig> for FocusConfig {
    fn from(config: CFocusConfig) -> Self {
        let CFocusConfig { width, height, cell_px, radius, exposure_varies } = config;
        Self { width, height, cell_px, radius, exposure_varies: exposure_varies != 0 }
    }
}

/// Fills a configuration, as `stereopsis_focus_default`.
///
/// # Safety
///
/// `config` is null or points to a configuration's bytes.
pub unsafe fn focus_default(width: u16, height: u16, config: *mut CFocusConfig) -> Status {
    either(checked(config).map(|()| {
        let FocusConfig { width, height, cell_px, radius, exposure_varies } =
            FocusConfig::pixels(width, height);
        let filled = CFocusConfig { width, height, cell_px, radius, exposure_varies: exposure_varies.into() };
        // SAFETY: the caller's promise, and it is aligned.
        unsafe { config.write(filled) };
        Status::Ok
    }))
}

impl From<Result<FocusPeak, NoFocus>> for CFocusPeak {
    fn from(peak: Result<FocusPeak, NoFocus>) -> Self {
        let none = |found| Self { position_q8: 0, sigma_q8: 0, confidence: 0, found };
        match peak {
            Ok(FocusPeak { position_q8, sigma_q8, confidence, .. }) => {
                Self { position_q8, sigma_q8, confidence, found: STEREOPSIS_FOCUS_FOUND }
            }
            Err(NoFocus::TooFewFrames { .. }) => none(STEREOPSIS_FOCUS_FEW),
            Err(NoFocus::Untextured) => none(STEREOPSIS_FOCUS_UNTEXTURED),
            Err(NoFocus::Broad) => none(STEREOPSIS_FOCUS_BROAD),
        }
    }
}
