//! Hysteresis over frames, and the free space by sectors.

use super::config::ObstacleConfig;
use super::finder::ObstaclesView;
use super::sector::{Sector, SectorState};

/// Frames that it takes to believe in an obstacle, and to let go of one.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Hysteresis {
    /// Frames in a row that have to show an obstacle before it counts; 1 is at once.
    pub confirm: u8,
    /// Frames in a row without an obstacle for which it still counts; 255 is for ever.
    pub release: u8,
}

impl Default for Hysteresis {
    /// Believes at once, and lets go with the third frame that shows nothing.
    fn default() -> Self {
        Self { confirm: 1, release: 2 }
    }
}

/// A distance over frames.
#[derive(Clone, Copy, Default, Debug)]
pub(super) struct Held {
    value: Option<u16>,
    seen: u8,
    missing: u8,
}

impl Held {
    pub(super) const NOTHING: Self = Self { value: None, seen: 0, missing: 0 };

    /// Frames in a row, up to the last one, that show something.
    pub(super) fn frames(&self) -> u8 {
        self.seen
    }

    /// Takes what a frame shows and returns what counts.
    pub(super) fn update(&mut self, shown: Option<u16>, rule: Hysteresis) -> Option<u16> {
        if shown.is_some() {
            self.seen = self.seen.saturating_add(1);
            self.missing = 0;
            if self.value.is_some() || self.seen >= rule.confirm {
                self.value = shown;
            }
        } else {
            self.seen = 0;
            self.missing = self.missing.saturating_add(1);
            if self.missing > rule.release {
                self.value = None;
            }
        }
        self.value
    }
}

/// Free space by sectors over frames, with hysteresis.
#[derive(Clone, Debug)]
pub struct FreeSpace {
    rule: Hysteresis,
    held: [Held; ObstacleConfig::MOST_SECTORS],
    sectors: [Sector; ObstacleConfig::MOST_SECTORS],
    /// The last surface that was seen in each sector: what is held, also through frames that are blind.
    surfaces: [Sector; ObstacleConfig::MOST_SECTORS],
}

impl FreeSpace {
    /// Creates a free space without history: all sectors are blind.
    pub const fn new(rule: Hysteresis) -> Self {
        const BLIND: Sector = Sector {
            state: SectorState::Blind,
            bearing_mrad: 0,
            depth_mm: 0,
            sigma_mm: 0,
            range_mm: 0,
            pixels: 0,
            height_mm: 0,
            seen_mm: 0,
        };
        let held = [Held::NOTHING; ObstacleConfig::MOST_SECTORS];
        let sectors = [BLIND; ObstacleConfig::MOST_SECTORS];
        Self { rule, held, sectors, surfaces: sectors }
    }

    /// Takes a finished frame. A sector that turns blind is blind at once, whatever it was before. What is
    /// held there is shown again by a frame that sees nothing in its place, while it counts.
    pub fn update(&mut self, frame: &ObstaclesView<'_>) {
        let sectors = self.sectors.iter_mut().zip(&mut self.surfaces);
        for (index, (held, (kept, surface))) in self.held.iter_mut().zip(sectors).enumerate() {
            let now = frame.sector(index);
            let shows = matches!(now.state, SectorState::Obstacle | SectorState::Drop);
            let counts = held.update(shows.then_some(now.depth_mm), self.rule);
            if shows {
                *surface = now;
            }
            *kept = match (now.state, counts) {
                (SectorState::Obstacle | SectorState::Drop, None) => {
                    Sector { state: SectorState::Blind, ..now }
                }
                // What is held is the last surface that was seen here.
                (SectorState::Free, Some(_)) => *surface,
                _ => now,
            };
        }
    }

    /// A sector, counted from the left; blind for one that is not there. An obstacle that is not confirmed
    /// yet makes it blind, not free.
    pub fn sector(&self, index: usize) -> Sector {
        self.sectors.get(index).copied().unwrap_or_default()
    }
}
