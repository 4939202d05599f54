//! From free space to a decision: go on, slow down, stop, or nothing is known.

use super::beside::{Beside, Sides};
use super::column::{NARROW_PX, StixelKind};
use super::config::GroundSource;
use super::finder::ObstaclesView;
use super::held::{Held, Hysteresis};
use super::hides::Needed;
use super::watchdog::BlindReason;

/// How a vehicle drives and brakes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DriveConfig {
    /// Width of the corridor that the vehicle drives through, mm, half of it on each side of the optical axis
    /// of the left camera: where the vehicle's middle is elsewhere, twice the distance of the two more.
    pub corridor_mm: u16,
    /// Gap between the camera and an obstacle at standstill, mm.
    pub margin_mm: u16,
    /// Reaction time from the exposure to the brakes, ms.
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
    /// Stopping distance at this speed, mm, margin included.
    pub stopping_mm: u16,
}

/// Speed of a vehicle of which odometry gave the last step, mm/s; 65535 at most, and where the period is 0.
pub fn speed_mm_s(step_mm: u16, period_us: u32) -> u16 {
    let speed = (u64::from(step_mm) * 1_000_000).checked_div(u64::from(period_us)).unwrap_or(u64::MAX);
    speed.min(u16::MAX.into()) as u16
}

/// The rule that turns frames into decisions; it calls no hardware.
#[derive(Clone, Debug)]
pub struct DriveRule {
    config: DriveConfig,
    held: Held,
    /// What left the picture at its left and at its right side.
    beside: [Beside; 2],
}

impl DriveRule {
    /// Creates a rule without history.
    pub const fn new(config: DriveConfig) -> Self {
        Self { config, held: Held::NOTHING, beside: [Beside::NOTHING; 2] }
    }

    /// Stopping distance `margin + v t + v^2 / (2 a)`, mm, 65535 at most.
    pub fn stopping_mm(&self, speed_mm_s: u16) -> u16 {
        let v = u64::from(speed_mm_s);
        let brake = 2 * u64::from(self.config.brake_mm_s2.max(1));
        let way = v * u64::from(self.config.reaction_ms) / 1000 + (v * v).checked_div(brake).unwrap_or(0);
        (way + u64::from(self.config.margin_mm)).min(u16::MAX.into()) as u16
    }

    /// Decides on a finished frame, at a speed.
    ///
    /// In this order: blind by the watchdog; stop for what is within the stopping distance, and for what is
    /// in the corridor and leaves the picture at a side; blind where the ground is not found, more than an
    /// eighth of the corridor's columns, with those that it has beside the picture there, do not see it for
    /// twice the stopping distance or up to an obstacle, or one of them sees something else before that and
    /// nothing nearer is known; slow for what is within twice the stopping distance or the time to contact;
    /// clear.
    ///
    /// A camera of `w` px and a focal length of `f` px sees a corridor of width `c` from `c f / w` on, and
    /// its left side, which both cameras have to see, from `(c + 2 b) f / w` on. Nearer than that a
    /// thing at the corridor's edge is beside the picture, and no frame can show that it is gone. So the
    /// decision is `Stop` where such a thing is about to leave the picture, and stays so at the distance at
    /// which it was seen last, until a frame shows it again. A vehicle that has turned away from it, or gone
    /// past it, begins with a new rule.
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
        let leaving = self.leaving(frame, speed_mm_s);
        let nearest = [nearest, leaving].into_iter().flatten().min();
        let contact_ms = nearest.and_then(|mm| (u32::from(mm) * 1000).checked_div(u32::from(speed_mm_s)));
        if let Some(mm) = nearest.filter(|&mm| mm <= stopping_mm || leaving.is_some()) {
            return verdict(Decision::Stop(mm), contact_ms);
        }
        let searched = frame.setup().is_some_and(|s| s.config.ground != GroundSource::Absent);
        if searched && frame.state.carried.ground.is_none() {
            return verdict(Decision::Blind(BlindReason::NoGround), contact_ms);
        }
        let is_hidden = corridor.hidden.is_some_and(|mm| nearest.is_none_or(|nearest| mm < nearest));
        if 8 * corridor.unseen > corridor.columns || corridor.columns == 0 || is_hidden {
            return verdict(Decision::Blind(BlindReason::Unseen), contact_ms);
        }
        let soon = contact_ms.is_some_and(|ms| ms <= self.config.slow_ms.into());
        // Or seen, but not confirmed yet.
        let slow = nearest.filter(|&mm| mm <= needed || soon);
        let slow = slow.or(corridor.nearest.filter(|&mm| mm <= needed));
        verdict(slow.map_or(Decision::Clear, Decision::Slow), contact_ms)
    }

    /// Takes what a frame shows at the picture's sides, and returns the nearest that left there or is about
    /// to.
    fn leaving(&mut self, frame: &ObstaclesView<'_>, speed_mm_s: u16) -> Option<u16> {
        let setup = frame.setup()?;
        // A picture later is no later than the brakes.
        let way = u32::from(speed_mm_s) * u32::from(self.config.reaction_ms) / 1000;
        let sides = Sides {
            setup: &setup,
            columns: frame.columns.get(..setup.columns)?,
            half_mm: i64::from(self.config.corridor_mm) / 2,
            way_mm: way.min(u16::MAX.into()) as u16,
        };
        for (is_right, beside) in [false, true].into_iter().zip(&mut self.beside) {
            beside.update(sides.shown(is_right), self.held.frames(), self.config.hysteresis);
        }
        self.beside.iter().filter_map(Beside::mm).min()
    }
}

/// What a frame shows of a corridor.
#[derive(Clone, Copy, Debug)]
struct Corridor {
    kind: StixelKind,
    /// Depth of the nearest surface less two deviations, mm.
    nearest: Option<u16>,
    /// Columns that the corridor reaches over at the needed depth, at least one where there is any, and as
    /// many more as it would beside the picture.
    columns: usize,
    /// Those of them that see the ground neither for the needed depth nor up to an obstacle.
    unseen: usize,
    /// Depth of the nearest that is neither ground nor a surface that is believed in, mm.
    hidden: Option<u16>,
}

impl Corridor {
    fn new(frame: &ObstaclesView<'_>, width_mm: u16, needed_mm: u16) -> Self {
        let mut found =
            Self { kind: StixelKind::Nothing, nearest: None, columns: 0, unseen: 0, hidden: None };
        let Some(setup) = frame.setup() else { return found };
        let ground = frame.state.carried.ground;
        let needed = Needed::new(&setup, ground.as_ref(), needed_mm);
        let (half, mut low) = (i32::from(width_mm) / 2, Low::default());
        let middle = (0..setup.columns).min_by_key(|&x| setup.across_mm(x, u16::MAX).abs());
        for (x, column) in frame.columns.iter().enumerate().take(setup.columns) {
            let depth = setup.depth_mm(column.parallax);
            let surely = depth.saturating_sub(setup.sigma_mm(column).saturating_mul(2));
            let inside = |mm: u16| setup.across_mm(x, mm).abs() <= half || Some(x) == middle;
            if column.is_supported() && inside(surely) && found.nearest.is_none_or(|mm| surely < mm) {
                (found.nearest, found.kind) = (Some(surely), column.kind);
            }
            let hides = ground.and_then(|ground| frame.hides(&setup, x, column, &ground, &needed));
            if inside(needed_mm) {
                found.columns += 1;
                let seen = setup.seen_mm(x, column, ground.as_ref()).is_some_and(|mm| mm >= needed_mm);
                let ends_there = column.is_supported() && (depth <= needed_mm || column.is_seen_up_to());
                found.unseen += usize::from(!seen && !ends_there && hides.is_none());
            }
            let Some(hides) = hides.filter(|hides| hides.from_mm < needed_mm && inside(hides.from_mm)) else {
                found.end(&mut low);
                continue;
            };
            low.columns_px += u32::from(setup.config.cell_width);
            let nearest = if hides.is_low { &mut low.nearest } else { &mut found.hidden };
            *nearest = Some(nearest.map_or(hides.to_mm, |mm| mm.min(hides.to_mm)));
        }
        found.end(&mut low);
        let beside = setup.columns_beside(half.into(), needed_mm);
        (found.columns, found.unseen) = (found.columns + beside, found.unseen + beside);
        found
    }

    /// Ends a run of columns: what is low is passed over where the run is wide enough to tell its height.
    fn end(&mut self, run: &mut Low) {
        if run.columns_px <= NARROW_PX {
            self.hidden = [self.hidden, run.nearest].into_iter().flatten().min();
        }
        *run = Low::default();
    }
}

/// A run of columns whose sight of the ground ends.
#[derive(Clone, Copy, Default)]
struct Low {
    columns_px: u32,
    /// Depth of the nearest of what is lower than an obstacle, mm.
    nearest: Option<u16>,
}
