//! How a vehicle drives, and what to do, in C.
#![allow(unsafe_code)]

use super::Status;
use super::obstacles_types::blind_number;
use super::state::checked;
use super::status::either;
use crate::obstacles::{Decision, DriveConfig, Hysteresis, Verdict, speed_mm_s};

/// Decision: nothing is known, and `blind` says why: stop.
pub const STEREOPSIS_DECISION_BLIND: u8 = 0;
/// Decision: something is in the corridor at `distance_mm`: stop.
pub const STEREOPSIS_DECISION_STOP: u8 = 1;
/// Decision: something is in the corridor at `distance_mm`: slow down.
pub const STEREOPSIS_DECISION_SLOW: u8 = 2;
/// Decision: the corridor is seen to be free for twice the stopping distance.
pub const STEREOPSIS_DECISION_CLEAR: u8 = 3;

/// Time to contact where nothing is there, or the vehicle stands.
pub const STEREOPSIS_NO_CONTACT: u32 = 0xFFFF_FFFF;

/// How a vehicle drives and brakes, filled by `stereopsis_drive_default` and then open to changes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct CDriveConfig {
    /// Width of the corridor that the vehicle drives through, mm, half of it on each side of the optical axis
    /// of the left camera: where the vehicle's middle is elsewhere, twice the distance of the two more.
    pub corridor_mm: u16,
    /// Distance from the camera at which the vehicle has to stand, mm.
    pub margin_mm: u16,
    /// Time from a picture to the brakes, ms.
    pub reaction_ms: u16,
    /// Deceleration of the brakes, mm/s^2; 0 is taken as 1.
    pub brake_mm_s2: u16,
    /// Time to contact below which to slow down, ms.
    pub slow_ms: u16,
    /// Frames in a row that have to show an obstacle before it counts; 1 is at once.
    pub confirm: u8,
    /// Frames in a row without an obstacle for which it still counts.
    pub release: u8,
}

/// What to do, and what that rests on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[repr(C)]
pub struct CVerdict {
    /// Time until the vehicle reaches what is nearest at its speed, ms, or `STEREOPSIS_NO_CONTACT`.
    pub contact_ms: u32,
    /// Distance of what stops the vehicle or slows it down, less two standard deviations, mm; 0 of others.
    pub distance_mm: u16,
    /// Way that the vehicle needs to stand, mm, margin included.
    pub stopping_mm: u16,
    /// What to do: a `STEREOPSIS_DECISION_` number.
    pub decision: u8,
    /// Why nothing is known: a `STEREOPSIS_BLIND_` number, 0 of other decisions.
    pub blind: u8,
    /// What is nearest in this frame's corridor, a `STEREOPSIS_STIXEL_` number; nothing where the decision is
    /// held from an earlier frame.
    pub nearest: u8,
}

impl From<DriveConfig> for CDriveConfig {
    fn from(config: DriveConfig) -> Self {
        let DriveConfig { corridor_mm, margin_mm, reaction_ms, brake_mm_s2, slow_ms, hysteresis } = config;
        let Hysteresis { confirm, release } = hysteresis;
        Self { corridor_mm, margin_mm, reaction_ms, brake_mm_s2, slow_ms, confirm, release }
    }
}

impl From<CDriveConfig> for DriveConfig {
    fn from(config: CDriveConfig) -> Self {
        let CDriveConfig { corridor_mm, margin_mm, reaction_ms, brake_mm_s2, slow_ms, confirm, release } =
            config;
        let hysteresis = Hysteresis { confirm, release };
        Self { corridor_mm, margin_mm, reaction_ms, brake_mm_s2, slow_ms, hysteresis }
    }
}

impl From<Verdict> for CVerdict {
    fn from(verdict: Verdict) -> Self {
        let (decision, distance_mm, reason) = match verdict.decision {
            Decision::Clear => (STEREOPSIS_DECISION_CLEAR, 0, None),
            Decision::Slow(mm) => (STEREOPSIS_DECISION_SLOW, mm, None),
            Decision::Stop(mm) => (STEREOPSIS_DECISION_STOP, mm, None),
            Decision::Blind(reason) => (STEREOPSIS_DECISION_BLIND, 0, Some(reason)),
        };
        Self {
            contact_ms: verdict.contact_ms.unwrap_or(STEREOPSIS_NO_CONTACT),
            distance_mm,
            stopping_mm: verdict.stopping_mm,
            decision,
            blind: blind_number(reason),
            nearest: verdict.nearest as u8,
        }
    }
}

/// Fills a configuration, as `stereopsis_drive_default`.
///
/// # Safety
///
/// `config` is null or points to a configuration's bytes.
pub unsafe fn drive_default(config: *mut CDriveConfig) -> Status {
    either(checked(config).map(|()| {
        // SAFETY: the caller's promise, and it is aligned.
        unsafe { config.write(DriveConfig::default().into()) };
        Status::Ok
    }))
}

/// Returns the speed of a vehicle of which odometry gave the last step, as `stereopsis_speed_mm_s`.
pub fn drive_speed_mm_s(step_mm: u16, period_us: u32) -> u16 {
    speed_mm_s(step_mm, period_us)
}
