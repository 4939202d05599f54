//! From free space to a decision: go on, slow down, stop, or nothing is known.

use super::column::StixelKind;
use super::config::GroundSource;
use super::finder::ObstaclesView;
use super::held::{Held, Hysteresis};
use super::watchdog::BlindReason;

/// How a vehicle drives and brakes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DriveConfig {
    /// Width of the corridor that the vehicle drives through, mm, half of it on each side of the optical
    /// axis.
    pub corridor_mm: u16,
    /// Distance from the camera at which the vehicle has to stand, mm.
    pub margin_mm: u16,
    /// Time from a picture to the brakes, ms.
    pub reaction_ms: u16,
    /// Deceleration of the brakes, mm/s^2; 0 is taken as 1.
    pub brake_mm_s2: u16,
    /// Time to contact below which to slow down, ms.
    pub slow_ms: u16,
    /// Frames to believe in an obstacle and to let go of one.
    pub hysteresis: Hysteresis,
}

impl Default for DriveConfig {
    /// A small robot: 0.4 m wide, stands 0.2 m before an obstacle, 100 ms from picture to brakes, 1 m/s^2.
    fn default() -> Self {
        Self {
            corridor_mm: 400,
            margin_mm: 200,
            reaction_ms: 100,
            brake_mm_s2: 1000,
            slow_ms: 2000,
            hysteresis: Hysteresis::default(),
        }
    }
}

/// What to do.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Decision {
    /// The corridor is seen to be free for twice the stopping distance.
    Clear,
    /// Something is in the corridor at this distance, mm, less two standard deviations: slow down.
    Slow(u16),
    /// Something is in the corridor at this distance, mm, less two standard deviations: stop.
    Stop(u16),
    /// Nothing is known: stop.
    Blind(BlindReason),
}

/// What a decision rests on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Verdict {
    /// What to do.
    pub decision: Decision,
    /// What is nearest in this frame's corridor; nothing where the decision is held from an earlier frame.
    pub nearest: StixelKind,
    /// Time until the vehicle reaches it at its speed, ms; `None` where nothing is there or it stands.
    pub contact_ms: Option<u32>,
    /// Way that the vehicle needs to stand, mm, margin included.
    pub stopping_mm: u16,
}

/// Speed of a vehicle of which odometry gave the last step, mm/s; 65535 at most.
pub fn speed_mm_s(step_mm: u16, period_us: u32) -> u16 {
    let speed = (u64::from(step_mm) * 1_000_000).checked_div(u64::from(period_us)).unwrap_or(0);
    speed.min(u16::MAX.into()) as u16
}

/// The rule that turns frames into decisions; it calls no hardware.
#[derive(Clone, Debug)]
pub struct DriveRule {
    config: DriveConfig,
    held: Held,
}

impl DriveRule {
    /// Creates a rule without history.
    pub const fn new(config: DriveConfig) -> Self {
        Self { config, held: Held::NOTHING }
    }

    /// Way that a vehicle needs to stand: `margin + v t + v^2 / (2 a)`, mm.
    pub fn stopping_mm(&self, speed_mm_s: u16) -> u16 {
        let v = u64::from(speed_mm_s);
        let brake = 2 * u64::from(self.config.brake_mm_s2.max(1));
        let way = v * u64::from(self.config.reaction_ms) / 1000 + (v * v).checked_div(brake).unwrap_or(0);
        (way + u64::from(self.config.margin_mm)).min(u16::MAX.into()) as u16
    }

    /// Decides on a finished frame, at a speed.
    ///
    /// In this order: blind by the watchdog; stop for what is within the stopping distance; blind where the
    /// ground is not found, or more than an eighth of the corridor's columns do not see it for twice the
    /// stopping distance or up to an obstacle; slow for what is within twice the stopping distance or the
    /// time to contact; clear.
    pub fn decide(&mut self, frame: &ObstaclesView<'_>, speed_mm_s: u16) -> Verdict {
        let stopping_mm = self.stopping_mm(speed_mm_s);
        let needed = stopping_mm.saturating_mul(2);
        let corridor = Corridor::new(frame, self.config.corridor_mm, needed);
        let verdict =
            |decision, contact_ms| Verdict { decision, nearest: corridor.kind, contact_ms, stopping_mm };
        if let Some(reason) = frame.blind() {
            return verdict(Decision::Blind(reason), None);
        }
        let nearest = self.held.update(corridor.nearest, self.config.hysteresis);
        let contact_ms = nearest.and_then(|mm| (u32::from(mm) * 1000).checked_div(u32::from(speed_mm_s)));
        if let Some(mm) = nearest.filter(|&mm| mm <= stopping_mm) {
            return verdict(Decision::Stop(mm), contact_ms);
        }
        let searched = frame.setup().is_some_and(|s| s.config.ground != GroundSource::Absent);
        if searched && frame.state.carried.ground.is_none() {
            return verdict(Decision::Blind(BlindReason::NoGround), contact_ms);
        }
        if 8 * corridor.unseen > corridor.columns || corridor.columns == 0 {
            return verdict(Decision::Blind(BlindReason::Unseen), contact_ms);
        }
        let soon = contact_ms.is_some_and(|ms| ms <= self.config.slow_ms.into());
        match nearest.filter(|&mm| mm <= needed || soon) {
            Some(mm) => verdict(Decision::Slow(mm), contact_ms),
            // Seen, but not believed in yet.
            None => match corridor.nearest.filter(|&mm| mm <= needed) {
                Some(mm) => verdict(Decision::Slow(mm), contact_ms),
                None => verdict(Decision::Clear, contact_ms),
            },
        }
    }
}

/// What a frame shows of a corridor.
#[derive(Clone, Copy, Debug)]
struct Corridor {
    kind: StixelKind,
    /// Depth of the nearest surface less two deviations, mm.
    nearest: Option<u16>,
    /// Columns that the corridor reaches over at the needed depth, at least one where there is any.
    columns: usize,
    /// Those of them that see the ground neither for the needed depth nor up to an obstacle.
    unseen: usize,
}

impl Corridor {
    fn new(frame: &ObstaclesView<'_>, width_mm: u16, needed_mm: u16) -> Self {
        let mut found = Self { kind: StixelKind::Nothing, nearest: None, columns: 0, unseen: 0 };
        let Some(setup) = frame.setup() else { return found };
        let ground = frame.state.carried.ground;
        let half = i32::from(width_mm) / 2;
        let middle = (0..setup.columns).min_by_key(|&x| setup.across_mm(x, u16::MAX).abs());
        for (x, column) in frame.columns.iter().enumerate().take(setup.columns) {
            let depth = setup.depth_mm(column.parallax);
            let surely = depth.saturating_sub(setup.sigma_mm(column).saturating_mul(2));
            let inside = |mm: u16| setup.across_mm(x, mm).abs() <= half || Some(x) == middle;
            if column.is_supported() && inside(surely) && found.nearest.is_none_or(|mm| surely < mm) {
                (found.nearest, found.kind) = (Some(surely), column.kind);
            }
            if inside(needed_mm) {
                found.columns += 1;
                let seen = setup.seen_mm(x, column, ground.as_ref()).is_some_and(|mm| mm >= needed_mm);
                let ends_there = column.is_supported() && (depth <= needed_mm || column.is_seen_up_to());
                found.unseen += usize::from(!seen && !ends_there);
            }
        }
        found
    }
}
